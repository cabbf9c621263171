// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/surfaces/obj_materials.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <glm/mat3x3.hpp>

#include "sequences/import/limits.h"
#include "sequences/import/lower_case.h"
#include "sequences/import/pbr_surface.h"
#include "sequences/import/surfaces/bare_surface.h"
#include "sequences/import/surfaces/obj_text.h"
#include "sequences/import/wide_text.h"
#include "sequences/pictures/srgb.h"

namespace talisman::sequences {

namespace {

using layers::vec3;

constexpr float kObjDielectric = 0.04f;

using Words = std::vector<std::string>;

Words words_in(const std::string& text) {
  Words words;
  for (std::size_t at = 0; (at = text.find_first_not_of(" \t", at)) != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_of(" \t", at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

/// A finite number that is the whole word.
std::optional<double> number_in(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = error == std::errc() && end == word.data() + word.size() && std::isfinite(value);
  return whole ? std::optional(value) : std::nullopt;
}

/// One number for all three, or three; what follows them is left.
std::optional<vec3> three_in(std::span<const std::string> words) {
  if (words.empty() || words.size() == 2) return {};
  vec3 three;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto number = number_in(words[words.size() == 1 ? 0 : k]);
    if (!number) return {};
    three[static_cast<int>(k)] = static_cast<float>(*number);
  }
  return three;
}

float clean_part(float value) { return std::clamp(value, 0.0f, 100.0f); }

vec3 linear_from_xyz(const vec3& xyz) {
  const glm::mat3 columns(3.2404542f, -0.9692660f, 0.0556434f, -1.5371385f, 1.8760108f, -0.2040259f,
                          -0.4985314f, 0.0415560f, 1.0572252f);
  const vec3 rgb = columns * xyz;
  return {clean_part(rgb.x), clean_part(rgb.y), clean_part(rgb.z)};
}

/// Linear.
std::optional<vec3> color_in(const Words& words) {
  const std::span all(words);
  if (!words.empty() && lower(words[0]) == "xyz") {
    const auto xyz = three_in(all.subspan(1));
    return xyz ? std::optional(linear_from_xyz(*xyz)) : std::nullopt;
  }
  const auto color = three_in(all);
  if (!color) return {};
  return vec3(linear_from_srgb(clean_part(color->x)), linear_from_srgb(clean_part(color->y)),
              linear_from_srgb(clean_part(color->z)));
}

// --- Maps

/// How many numbers, or words, follow an option of a map, and whether the picture lacks what it does.
struct MapOption {
  const char* name;
  std::size_t least, most;
  bool numbers;
  bool is_drawn;  ///< or has nothing to do with colours, or with the picture
};

constexpr std::array<MapOption, 12> kMapOptions = {{{"-s", 1, 3, true, true},
                                                    {"-o", 1, 3, true, true},
                                                    {"-clamp", 1, 1, false, true},
                                                    {"-blendu", 1, 1, false, true},
                                                    {"-blendv", 1, 1, false, true},
                                                    {"-texres", 1, 1, true, true},
                                                    {"-boost", 1, 1, true, true},
                                                    {"-imfchan", 1, 1, false, true},
                                                    {"-bm", 1, 1, true, true},
                                                    {"-mm", 2, 2, true, false},
                                                    {"-t", 1, 3, true, false},
                                                    {"-cc", 1, 1, false, false}}};

const MapOption* map_option(const std::string& word) {
  const auto found = std::find_if(kMapOptions.begin(), kMapOptions.end(),
                                  [&](const MapOption& option) { return option.name == word; });
  return found == kMapOptions.end() ? nullptr : &*found;
}

/// The line of a map: its options, and the rest, which is the file's name.
struct MapLine {
  std::string file;
  MapPlacing placing;
  std::vector<std::string> losses;
};

class MapReader {
 public:
  explicit MapReader(const std::string& text) : text_(text) {}

  /// Options stand before the name; some exporters put them behind it.
  MapLine line() {
    options();
    const std::size_t first = at_;
    std::size_t end = text_.size();
    for (std::size_t space = text_.find(" -", first); space != std::string::npos && end == text_.size();
         space = text_.find(" -", space + 1)) {
      at_ = space + 1;
      if (map_option(word_at(at_))) end = space;
    }
    if (end < text_.size()) at_ = end + 1, options();
    const std::string name = text_.substr(first, end - first);
    line_.file = name.substr(0, name.find_last_not_of(" \t") + 1);
    return std::move(line_);
  }

 private:
  std::string word_at(std::size_t at) const {
    return text_.substr(at, std::min(text_.find_first_of(" \t", at), text_.size()) - at);
  }
  std::size_t after(std::size_t at) const {
    at = text_.find_first_of(" \t", at);
    return std::min(at == std::string::npos ? at : text_.find_first_not_of(" \t", at), text_.size());
  }

  void options() {
    while (at_ < text_.size()) {
      const MapOption* option = map_option(word_at(at_));
      if (!option) return;
      at_ = after(at_);
      Words values;
      while (values.size() < option->most && at_ < text_.size()) {
        std::string word = word_at(at_);
        if (option->numbers && !number_in(word)) break;
        values.push_back(std::move(word));
        at_ = after(at_);
      }
      if (values.size() < option->least)
        line_.losses.push_back(std::string(option->name) + " without its value is left out");
      else
        take(*option, values);
    }
  }

  void take(const MapOption& option, const Words& values) {
    const std::string name = option.name;
    if (name == "-clamp") line_.placing.clamped = lower(values[0]) == "on";
    for (std::size_t k = 0; k < 2 && k < values.size(); ++k) {
      if (name == "-s") line_.placing.scale[static_cast<int>(k)] = static_cast<float>(*number_in(values[k]));
      if (name == "-o") line_.placing.offset[static_cast<int>(k)] = static_cast<float>(*number_in(values[k]));
    }
    if (!option.is_drawn && !changes_nothing(name, values))
      line_.losses.push_back("the option " + name + " of map_Kd is not drawn");
  }

  static bool changes_nothing(const std::string& name, const Words& values) {
    const auto is = [&](std::size_t k, double number) {
      return k >= values.size() || number_in(values[k]) == number;
    };
    if (name == "-mm") return is(0, 0) && is(1, 1);
    if (name == "-t") return is(0, 0) && is(1, 0) && is(2, 0);
    return lower(values[0]) == "off";
  }

  const std::string& text_;
  std::size_t at_ = 0;
  MapLine line_;
};

struct KeywordLoss {
  const char* keyword;
  const char* loss;
};

constexpr std::array<KeywordLoss, 21> kLosses = {
    {{"map_ks", "specular maps are not drawn"},
     {"map_ns", "maps of the highlight's exponent are not drawn"},
     {"map_d", "opacity maps are not drawn"},
     {"map_tr", "opacity maps are not drawn"},
     {"map_opacity", "opacity maps are not drawn"},
     {"map_bump", "bump maps are not drawn"},
     {"bump", "bump maps are not drawn"},
     {"norm", "normal maps are not drawn"},
     {"map_kn", "normal maps are not drawn"},
     {"disp", "displacement maps are not drawn"},
     {"map_disp", "displacement maps are not drawn"},
     {"decal", "decals are not drawn"},
     {"refl", "reflection maps are not drawn"},
     {"map_refl", "reflection maps are not drawn"},
     {"map_ke", "emissive maps are not drawn"},
     {"map_emissive", "emissive maps are not drawn"},
     {"map_pr", "roughness maps are not drawn"},
     {"map_pm", "metalness maps are not drawn"},
     {"map_ps", "sheen is not drawn"},
     {"map_rma", "roughness maps are not drawn"},
     {"map_orm", "roughness maps are not drawn"}}};

/// They have nothing to do with a picture of ours.
constexpr std::array<const char*, 8> kQuiet = {"ka",  "ni",     "sharpness", "map_aat",
                                               "pcr", "anisor", "tf",        "km"};

// --- Statements

class LibraryReader {
 public:
  explicit LibraryReader(const std::string& path) : file_(std::filesystem::path(path).filename().string()) {
    const auto in = open_text(path);
    std::string line;
    for (number_ = 1; std::getline(*in, line); ++number_) {
      if (number_ == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0) line.erase(0, 3);
      for (std::size_t first = 0;
           first <= line.size();) {  // some end their lines with a carriage return alone
        const std::size_t end = std::min(line.find('\r', first), line.size());
        read_line(line.substr(first, end - first));
        first = end + 1;
      }
    }
  }

  std::map<std::string, ObjMaterial> take() {
    std::map<std::string, ObjMaterial> materials;
    for (auto& [name, draft] : drafts_) materials.emplace(name, finished(std::move(draft)));
    return materials;
  }

 private:
  struct Draft {
    ObjMaterial material = default_obj_material();
    std::optional<double> dissolve, transparency, roughness, metalness, illumination;
    std::string ambient_map;
    bool has_emissive_map = false;
  };

  void read_line(const std::string& line) {
    const std::size_t at = line.find_first_not_of(" \t");
    if (at == std::string::npos || line[at] == '#') return;
    const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
    const std::string keyword = lower(line.substr(at, end - at)), rest = rest_of_line(line, end);
    if (keyword == "newmtl") {
      now_ = &drafts_[rest];
      now_->material.look.name = rest;
      return;
    }
    if (!now_) return;
    line_ = rest_of_line(line, at);
    read_statement(keyword, rest);
  }

  void lose(const std::string& text) {
    std::vector<std::string>& losses = now_->material.losses;
    if (std::find(losses.begin(), losses.end(), text) == losses.end()) losses.push_back(text);
  }
  void odd(const std::string& rule) {
    lose(file_ + ", line " + std::to_string(number_) + ": '" + line_.substr(0, 60) + "' of material '" +
         now_->material.look.name + "', rule: " + rule + "; it is left out");
  }

  void read_statement(const std::string& keyword, const std::string& rest) {
    if (keyword == "map_kd") return read_map(rest);
    if (keyword == "map_ka") {
      now_->ambient_map = MapReader(rest).line().file;
      return;
    }
    for (const KeywordLoss& lacking : kLosses)
      if (keyword == lacking.keyword) {
        now_->has_emissive_map |= keyword == "map_ke" || keyword == "map_emissive";
        return lose(lacking.loss);
      }
    if (std::find(kQuiet.begin(), kQuiet.end(), keyword) != kQuiet.end()) return;
    const Words words = words_in(rest.substr(0, rest.find('#')));
    if (!read_color(keyword, words) && !read_number(keyword, words)) odd("a statement of MTL");
  }

  void read_map(const std::string& rest) {
    MapLine line = MapReader(rest).line();
    if (line.file.empty()) return odd("the name of a picture");
    now_->material.map = std::move(line.file);
    now_->material.placing = line.placing;
    for (const std::string& loss : line.losses) lose(loss);
  }

  bool read_color(const std::string& keyword, const Words& words) {
    layers::Material& look = now_->material.look;
    vec3* const target = keyword == "kd"   ? &look.base_color
                         : keyword == "ks" ? &look.specular
                         : keyword == "ke" ? &look.emissive
                                           : nullptr;
    if (!target) return false;
    if (const auto color = color_in(words))
      *target = *color;
    else if (!words.empty() && lower(words[0]) == "spectral")
      odd("spectral curves are not read");
    else
      odd("one number, three, or 'xyz' and such");
    return true;
  }

  bool read_number(const std::string& keyword, const Words& words) {
    const bool halo = keyword == "d" && !words.empty() && words[0] == "-halo";
    const std::size_t first = halo ? 1 : 0;
    const auto number = words.size() > first ? number_in(words[first]) : std::nullopt;
    if (halo) lose("halos (d -halo) are not drawn");
    const std::array<std::pair<const char*, std::optional<double>*>, 5> kept = {
        {{"d", &now_->dissolve},
         {"tr", &now_->transparency},
         {"pr", &now_->roughness},
         {"pm", &now_->metalness},
         {"illum", &now_->illumination}}};
    const std::array<std::pair<const char*, const char*>, 3> lacking = {
        {{"ps", "sheen is not drawn"},
         {"pc", "clearcoat is not drawn"},
         {"aniso", "anisotropy is not drawn"}}};
    bool known = keyword == "ns";
    if (known && number)
      now_->material.look.shininess = static_cast<float>(std::clamp(*number, 0.0, double{kMaxShininess}));
    for (const auto& [name, value] : kept)
      if (keyword == name) {
        known = true;
        if (number) *value = number;
      }
    for (const auto& [name, loss] : lacking)
      if (keyword == name) {
        known = true;
        if (number.value_or(0) != 0) lose(loss);
      }
    if (known && !number) odd("a number");
    return known;
  }

  ObjMaterial finished(Draft draft) {
    now_ = &draft;
    layers::Material& look = draft.material.look;
    const double opacity = draft.dissolve ? *draft.dissolve : 1 - draft.transparency.value_or(0);
    look.opacity = static_cast<float>(std::clamp(opacity, 0.0, 1.0));
    if (draft.has_emissive_map) look.emissive = vec3(0);  // alone it would glow all over
    const double illumination = draft.illumination.value_or(2);
    look.unlit = illumination == 0;
    if (illumination < 2) look.specular = vec3(0);
    if (illumination > 2 && illumination < 10)
      lose("reflections and refraction (illum 3 to 9) are not drawn");
    if (draft.roughness || draft.metalness) {
      const PbrSurface surface = pbr_surface(look.base_color, vec3(kObjDielectric),
                                             draft.metalness.value_or(0), draft.roughness.value_or(1));
      look.base_color = surface.color;
      look.specular = surface.specular;
      look.shininess = surface.shininess;
    }
    if (look.shininess < 1) look.specular = vec3(0);  // such a highlight would cover the whole surface evenly
    if (!draft.ambient_map.empty() && draft.ambient_map != draft.material.map)
      lose("ambient maps are not drawn");
    return std::move(draft.material);
  }

  std::string file_, line_;
  std::size_t number_ = 1;
  std::map<std::string, Draft> drafts_;
  Draft* now_ = nullptr;
};

}  // namespace

ObjMaterial default_obj_material() {
  ObjMaterial material;
  material.look = bare_look();
  return material;
}

std::map<std::string, ObjMaterial> read_obj_materials(const std::string& path) {
  return LibraryReader(path).take();
}

}  // namespace talisman::sequences
