// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/surfaces/stl_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <sstream>

#include <glm/geometric.hpp>

#include "sequences/import/lower_case.h"
#include "sequences/import/surfaces/bare_surface.h"
#include "sequences/import/wide_text.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;
using layers::vec3;

constexpr std::size_t kStlHead = 84, kFacet = 50, kTitle = 80;

template <typename T>
T stl_value(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

void add_facet(const std::array<dvec3, 3>& places, BareSurface& surface) {
  const dvec3 n = glm::cross(places[1] - places[0], places[2] - places[0]);
  const double length = glm::length(n);
  for (const dvec3& place : places) {
    surface.indices.push_back(static_cast<std::uint32_t>(surface.positions.size()));
    surface.positions.push_back(place);
    surface.normals.push_back(length > 0 && std::isfinite(length) ? vec3(n / length) : vec3(0, 1, 0));
  }
}

// --- Binary

vec3 color_of(float red, float green, float blue) {
  return {linear_from_srgb(red), linear_from_srgb(green), linear_from_srgb(blue)};
}

/// What Materialise writes into the title.
struct StlTitle {
  std::optional<vec3> color;
  float opacity = 1;
  bool has_material = false;
};

StlTitle title_of(const std::string& bytes) {
  StlTitle title;
  const std::string text = bytes.substr(0, kTitle);
  const std::size_t at = text.find("COLOR=");
  if (at == std::string::npos || at + 10 > kTitle) return title;
  const auto part = [&](std::size_t k) {
    return static_cast<float>(static_cast<unsigned char>(text[at + 6 + k])) / 255;
  };
  title.color = color_of(part(0), part(1), part(2));
  title.opacity = part(3);
  title.has_material = text.find("MATERIAL=") != std::string::npos;
  return title;
}

std::optional<vec3> facet_color(unsigned attributes, bool is_materialise) {
  const auto part = [&](unsigned shift) { return static_cast<float>(attributes >> shift & 31u) / 31; };
  const bool is_set = (attributes >> 15 & 1u) != 0;
  if (is_materialise) return is_set ? std::nullopt : std::optional(color_of(part(0), part(5), part(10)));
  return is_set ? std::optional(color_of(part(10), part(5), part(0))) : std::nullopt;
}

void read_facets(const std::string& bytes, std::size_t count, ImportedModel& model, const ModelPlace& place) {
  const StlTitle title = title_of(bytes);
  BareSurface surface;
  layers::Material look = bare_look();
  const vec3 otherwise = title.color.value_or(look.base_color);
  bool has_colors = false;
  for (std::size_t f = 0; f < count; ++f) {
    const std::size_t at = kStlHead + f * kFacet;
    std::array<dvec3, 3> places;
    for (std::size_t k = 0; k < 9; ++k)
      places[k / 3][static_cast<int>(k % 3)] = stl_value<float>(bytes, at + 12 + 4 * k);
    add_facet(places, surface);
    const auto color = facet_color(stl_value<std::uint16_t>(bytes, at + 48), title.color.has_value());
    has_colors |= color.has_value();
    surface.colors.insert(surface.colors.end(), 3, color.value_or(otherwise));
  }
  look.base_color = has_colors ? vec3(1) : otherwise;
  if (!has_colors) surface.colors.clear();
  look.opacity = title.opacity;
  if (title.has_material) model.warnings.emplace_back("the highlight of its MATERIAL= is not drawn");
  add_surfaces(place, {surface}, look, model.scene);
}

// --- Text

class StlText {
 public:
  explicit StlText(const std::string& text) : in_(text) {
    for (std::string line; next_line(line);) read(line);
    if (corners_ != 0) refuse("ends within a facet");
  }
  std::vector<BareSurface> take() { return std::move(solids_); }

 private:
  /// Ends of lines are those of any system.
  bool next_line(std::string& line) {
    line.clear();
    for (int c = in_.get(); c != EOF; c = in_.get()) {
      if (c == '\r' && in_.peek() == '\n') in_.get();
      if (c == '\n' || c == '\r') {
        ++number_;
        return true;
      }
      line.push_back(static_cast<char>(c));
    }
    ++number_;
    return !line.empty();
  }

  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError("cannot be read as a model: line " + std::to_string(number_) + ": " + why);
  }

  void read(const std::string& line) {
    std::istringstream words(line);
    std::string word;
    while (words >> word) {
      const std::string keyword = lower(word);
      if (keyword == "solid") {
        std::getline(words >> std::ws, word);
        solids_.emplace_back().name = words.fail() ? "" : word.substr(0, word.find_last_not_of(" \t") + 1);
        return;
      }
      if (keyword == "endloop" || keyword == "endfacet") {
        if (corners_ != 0) refuse("a facet has " + std::to_string(corners_) + " vertices, rule: 3");
      }
      if (keyword == "vertex") add_corner(words, line);
    }
  }

  void add_corner(std::istringstream& words, const std::string& line) {
    dvec3 place;
    for (int k = 0; k < 3; ++k)
      if (!(words >> place[k]) || !std::isfinite(place[k]))
        refuse("'" + line.substr(0, 60) + "', rule: 'vertex' and three finite numbers");
    places_[corners_] = place;
    corners_ = (corners_ + 1) % 3;
    if (corners_ != 0) return;
    if (solids_.empty()) solids_.emplace_back();
    add_facet(places_, solids_.back());
  }

  std::istringstream in_;
  std::size_t number_ = 0, corners_ = 0;
  std::array<dvec3, 3> places_;
  std::vector<BareSurface> solids_;
};

/// One solid is the file; of several each has its name, or its number.
void name_solids(std::vector<BareSurface>& solids) {
  std::erase_if(solids, [](const BareSurface& solid) { return solid.indices.empty(); });
  for (std::size_t k = 0; k < solids.size(); ++k) {
    const auto same = [&](const BareSurface& other) { return other.name == solids[k].name; };
    if (solids.size() == 1)
      solids[k].name.clear();
    else if (solids[k].name.empty() || std::count_if(solids.begin(), solids.end(), same) > 1)
      solids[k].name += (solids[k].name.empty() ? "solid " : "#") + std::to_string(k + 1);
  }
}

}  // namespace

bool is_stl(const std::string& path) { return lower_extension(path) == ".stl"; }

ImportedModel read_stl(const ModelPlace& place) {
  FileUses files;
  files.add_code();
  files.look_for(place.path);
  const auto in = open_text(place.path);
  if (!*in) throw InputError("cannot be opened");
  const std::string bytes(std::istreambuf_iterator<char>(*in), {});
  ImportedModel model;
  const std::size_t count = bytes.size() >= kStlHead ? stl_value<std::uint32_t>(bytes, kTitle) : 0;
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  const bool says_solid = first != std::string::npos && lower(bytes.substr(first, 5)) == "solid" &&
                          bytes.find('\0') == std::string::npos;
  if (bytes.size() >= kStlHead && (bytes.size() == kStlHead + count * kFacet || !says_solid)) {
    if (bytes.size() < kStlHead + count * kFacet)
      throw InputError("cannot be read as a model: it says " + std::to_string(count) + " facets and holds " +
                       std::to_string((bytes.size() - kStlHead) / kFacet));
    read_facets(bytes, count, model, place);
  } else {
    if (!says_solid)
      throw InputError("cannot be read as a model: it is neither binary STL nor begins with 'solid'");
    std::vector<BareSurface> solids = StlText(bytes).take();
    name_solids(solids);
    add_surfaces(place, solids, bare_look(), model.scene);
  }
  model.files = files.take();
  return model;
}

}  // namespace talisman::sequences
