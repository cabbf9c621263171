// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/texture_search.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <vector>

#include "sequences/import/lower_case.h"
#include "sequences/import/texture_io.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDosStem = 8;  // names of 3DS files and of their time

constexpr std::array kPictures = {".png", ".jpg", ".jpeg", ".tga", ".bmp", ".gif", ".tif",  ".tiff", ".webp",
                                  ".ppm", ".pgm", ".pbm",  ".pnm", ".rgb", ".sgi", ".rgba", ".bw",   ".dds",
                                  ".psd", ".hdr", ".exr",  ".ico", ".pic", ".iff", ".jp2",  ".jpe",  ".pcx"};

bool is_picture(const fs::path& path) {
  const std::string extension = lower_extension(path);
  return std::find(kPictures.begin(), kPictures.end(), extension) != kPictures.end();
}

/// Where files may lie: the model's folder, by the name it was given and by where the file really is, and the
/// further ones.
std::vector<fs::path> roots_of(const ModelPlace& place) {
  std::vector<fs::path> roots;
  std::error_code error;
  const auto add = [&](const fs::path& folder) {
    if (const fs::path real = fs::canonical(folder, error); !error) roots.push_back(real);
  };
  for (const fs::path& model : {fs::absolute(place.path), fs::canonical(place.path, error)}) {
    if (model.empty()) continue;
    add(model.parent_path());
    add(model.parent_path().parent_path() / "textures");
  }
  for (const std::string& folder : place.folders) add(folder);
  return roots;
}

bool is_below(const fs::path& path, const fs::path& root) {
  return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
}

/// The file if it is one and may be opened, else empty.
std::string allowed(const fs::path& candidate, const std::vector<fs::path>& roots, FileUses& files) {
  files.look_for(candidate.string());
  std::error_code error;
  if (!fs::is_regular_file(candidate, error)) return {};
  const fs::path real = fs::canonical(candidate, error);
  const bool inside = !error && std::any_of(roots.begin(), roots.end(),
                                            [&](const fs::path& root) { return is_below(real, root); });
  return inside ? candidate.string() : std::string();
}

/// To what a path as written is relative.
std::vector<fs::path> bases_of(const ModelPlace& model) {
  std::vector<fs::path> bases = {fs::absolute(model.path).parent_path()};
  for (const std::string& folder : model.folders) bases.push_back(fs::absolute(folder));
  return bases;
}

std::vector<fs::path> places_of(const ModelPlace& model) {
  const fs::path own = fs::absolute(model.path).parent_path();
  std::vector<fs::path> places = {own, own.parent_path() / "textures", own / "textures"};
  for (const std::string& folder : model.folders)
    places.insert(places.end(), {fs::absolute(folder), fs::absolute(folder) / "textures"});
  return places;
}

/// The files of a folder that are pictures and that `fits` takes, sorted: the order in a folder is nobody's
/// choice.
std::vector<fs::path> pictures_in(const fs::path& folder, const std::function<bool(const fs::path&)>& fits) {
  std::vector<fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file(error) && is_picture(entry.path()) && fits(entry.path()))
      found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

fs::path with_slashes(std::string written) {
  std::replace(written.begin(), written.end(), '\\', '/');
  return written;
}

/// Rule 3 in one folder.
std::string similar_in(const fs::path& folder, const fs::path& name, const std::vector<fs::path>& roots,
                       FileUses& files) {
  files.list(folder.string());
  const std::string wanted = lower(name.filename().string()), stem = lower(name.stem().string());
  if (stem.empty()) return {};
  const auto same_name = [&](const fs::path& p) { return lower(p.filename().string()) == wanted; };
  const auto same_stem = [&](const fs::path& p) { return lower(p.stem().string()) == stem; };
  const auto cut = [&](const fs::path& p) {
    return stem.size() == kDosStem && lower(p.stem().string()).rfind(stem, 0) == 0;
  };
  for (const std::function<bool(const fs::path&)>& fits :
       {std::function<bool(const fs::path&)>(same_name), {same_stem}, {cut}}) {
    const std::vector<fs::path> found = pictures_in(folder, fits);
    if (!found.empty()) return allowed(found.front(), roots, files);
  }
  return {};
}

}  // namespace

std::string find_file(const ModelPlace& model, const std::string& written, FileUses& files) {
  const fs::path path = with_slashes(written);
  if (path.empty()) return {};
  const std::vector<fs::path> roots = roots_of(model);
  for (const fs::path& base : bases_of(model))
    if (std::string found = allowed(base / path, roots, files); !found.empty()) return found;
  for (const fs::path& place : places_of(model))
    if (std::string found = allowed(place / path.filename(), roots, files); !found.empty()) return found;
  return {};
}

std::string find_texture(const ModelPlace& model, const std::string& written, FileUses& files) {
  const fs::path path = with_slashes(written);
  if (std::string found = find_file(model, written, files); !found.empty())
    return is_picture(found) ? found : std::string();
  const std::vector<fs::path> roots = roots_of(model);
  for (const fs::path& place : places_of(model))
    if (std::string found = similar_in(place, path, roots, files); !found.empty()) return found;
  return {};
}

layers::Texture read_named_texture(const ModelPlace& model, const std::string& written, FileUses& files) {
  const std::string file = find_texture(model, written, files);
  if (file.empty()) throw InputError("is missing");
  files.look_for(file);
  layers::Texture texture = read_texture(file);
  texture.name = fs::path(file).filename().string();
  return texture;
}

std::string without_empty_alpha(layers::Texture& texture) {
  if (!is_all_clear(texture)) return {};
  make_opaque(texture);
  return "texture '" + texture.name + "': every texel is clear (alpha 0): alpha is left out";
}

std::string missing_texture(const std::string& written, const std::string& why) {
  return "texture '" + written + "': " + why + "; a plain colour is used";
}

}  // namespace talisman::sequences
