// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/sequence_file.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include <glm/trigonometric.hpp>

#include "sequences/content/asset_paths.h"
#include "warp/warp.h"

namespace talisman::sequences {

namespace {

constexpr int kMaxFrames = 1'000'000;
constexpr int kMaxDisplay_px = 16384;
constexpr int kMaxDepthOfExtends = 8;

layers::FiducialWeights read_importance(YamlMap map) {
  layers::FiducialWeights weights;
  map.read("geometric", weights.geometric, kNotNegative);
  map.read("photometric", weights.photometric, kNotNegative);
  map.read("sampling", weights.sampling, kNotNegative);
  map.read("visibility", weights.visibility, kNotNegative);
  map.finish();
  return weights;
}

layers::LayerPreferences read_preferences(YamlMap map) {
  layers::LayerPreferences preferences;
  map.read("resolution_scale", preferences.resolution_scale, {0, 4, true});
  map.read("min_update_rate", preferences.min_update_rate, {0, 1});
  map.read("max_update_rate", preferences.max_update_rate, {0, 1, true});
  map.read("share_of_expected_motion", preferences.share_of_expected_motion, kNotNegative);
  map.read("bound_each_part", preferences.bound_each_part);
  map.read("motion_blur", preferences.motion_blur, {0, 1});
  if (const YamlValue* importance = map.find("importance"))
    preferences.importance = read_importance(importance->map());
  map.finish();
  return preferences;
}

/// Values over time, 0 … 1: one number, or a list of {t, value}.
layers::Keys<double> read_multiplier(const YamlValue& value) {
  layers::Keys<double> keys;
  if (!value.is_list()) return {{0}, {value.number({0, 1})}, layers::Interpolation::Step};
  for (const YamlValue& item : value.items()) {
    YamlMap map = item.map();
    const YamlValue& time = map.need("t");
    if (!keys.times_s.empty() && time.number() <= keys.times_s.back()) time.fail("after the key before it");
    keys.times_s.push_back(time.number());
    keys.values.push_back(map.need("value").number({0, 1}));
    map.finish();
  }
  return keys;
}

layers::ShadingSpec read_shading(YamlMap map) {
  layers::ShadingSpec shading;
  if (const YamlValue* term = map.find("shadows")) shading.shadows = read_preferences(term->map());
  if (const YamlValue* term = map.find("specular")) shading.specular = read_preferences(term->map());
  if (const YamlValue* term = map.find("reflection")) shading.reflection = read_preferences(term->map());
  if (const YamlValue* term = map.find("textures")) shading.textures = read_preferences(term->map());
  for (const auto& [key, keys] :
       {std::pair{"first_blend", &shading.first_blend}, std::pair{"second_blend", &shading.second_blend}})
    if (const YamlValue* blend = map.find(key)) {
      if (!shading.textures) blend->fail("only together with textures");
      *keys = read_multiplier(*blend);
    }
  map.finish();
  return shading;
}

LayerEntry read_layer(const YamlValue& value) {
  YamlMap map = value.map();
  LayerEntry entry;
  entry.line = value.line();
  entry.file = value.file();
  entry.spec.name = map.need("name").text();
  for (const YamlValue& glob : map.need("parts").items()) entry.spec.part_globs.push_back(glob.text());
  if (const YamlValue* group = map.find("group"))
    entry.spec.group =
        static_cast<layers::OrderGroup>(group->choice({"background", "normal", "foreground"}) - 1);
  if (const YamlValue* preferences = map.find("preferences"))
    entry.spec.preferences = read_preferences(preferences->map());
  if (const YamlValue* shading = map.find("shading")) entry.spec.shading = read_shading(shading->map());
  if (const YamlValue* fade = map.find("fade")) entry.spec.fade = read_multiplier(*fade);
  map.read("casts_shadows", entry.spec.casts_shadows);
  map.finish();
  return entry;
}

/// Zero switches a threshold off; else it lies in the range.
void read_threshold(YamlMap& map, const char* key, double& into, const Range& range) {
  const YamlValue* value = map.find(key);
  if (!value) return;
  into = value->number();
  if (into != 0) into = value->number(range);
}

void read_budget(YamlMap& map, const char* key, std::int64_t& into) {
  if (const YamlValue* value = map.find(key)) into = value->integer(0, std::numeric_limits<int>::max());
}

regulator::RegulatorOptions read_regulator(YamlMap map) {
  regulator::RegulatorOptions options;
  std::vector<std::string> names;
  for (const regulator::Policy policy : regulator::kAllPolicies) names.emplace_back(regulator::name(policy));
  if (const YamlValue* policy = map.find("policy"))
    options.policy = regulator::kAllPolicies[policy->choice(names)];
  map.read("hold_frames", options.hold_frames, 1, kMaxFrames);
  map.read("lookahead_frames", options.lookahead_frames, 0, kMaxFrames);
  read_budget(map, "budget_polygons", options.budget_polygons);
  read_budget(map, "budget_pixels", options.budget_pixels);
  read_budget(map, "budget_chunks", options.budget_chunks);
  map.read("budget_ms", options.budget_ms, kNotNegative);
  map.read("min_resolution", options.min_resolution, {0, 1, true});
  if (const YamlValue* predict = map.find("predict"))
    options.predict = regulator::kAllPredictions[predict->choice({"known", "linear"})];
  map.read("cutoff_px", options.cutoff_px, kNotNegative);
  map.read("geometric_px", options.geometric_px, kNotNegative);
  read_threshold(map, "magnification", options.magnification, {1, 1e6});
  read_threshold(map, "minification", options.minification, {0, 1});
  read_threshold(map, "anisotropy", options.anisotropy, {1, 1e6});
  map.read("uncovered_px", options.uncovered_px, kAnyNumber);
  map.read("turned_px", options.turned_px, kNotNegative);
  map.read("photometric", options.photometric, kNotNegative);
  if (const YamlValue* angle = map.find("light_angle_deg"))
    options.light_angle_rad = glm::radians(angle->number({0, 180}));
  map.read("color_warp", options.color_warp);
  map.finish();
  return options;
}

layers::ExtentOptions read_extents(YamlMap map) {
  layers::ExtentOptions extents;
  map.read("expected_reuse_frames", extents.expected_reuse_frames, {1, 10000});
  map.read("max_growth", extents.max_growth, {0, 1});
  map.finish();
  return extents;
}

layers::PlacementOptions read_placement(YamlMap map) {
  layers::PlacementOptions placement;
  map.read("slab_directions", placement.slab_directions, 2, 30);
  map.read("min_rotation_gain", placement.min_rotation_gain, {0, 1});
  map.read("resolution_scale", placement.resolution_scale, {0, 4, true});
  map.read("max_sprite_px", placement.max_sprite_px, 32, kMaxDisplay_px);
  map.finish();
  return placement;
}

chunker::CompressionOptions read_compression(YamlMap map) {
  chunker::CompressionOptions compression;
  map.read("quality", compression.quality, 1, 100);
  map.finish();
  return compression;
}

void read_film(YamlMap& map, Sequence& sequence) {
  map.need("frames");
  map.read("frames", sequence.frames, 1, kMaxFrames);
  map.read("fps", sequence.fps, {0, 1000, true});
  if (const YamlValue* display = map.find("display")) {
    const std::vector<YamlValue> sides = display->items(2);
    if (sides.size() != 2) display->fail("[width, height] in pixels");
    sequence.display_px = {sides[0].integer(1, kMaxDisplay_px), sides[1].integer(1, kMaxDisplay_px)};
  }
}

void read_settings(YamlMap& map, Sequence& sequence) {
  if (const YamlValue* v = map.find("regulator")) sequence.regulator = read_regulator(v->map());
  if (const YamlValue* v = map.find("extents")) sequence.extents = read_extents(v->map());
  if (const YamlValue* v = map.find("placement")) sequence.placement = read_placement(v->map());
  if (const YamlValue* v = map.find("compression")) sequence.compression = read_compression(v->map());
  if (const YamlValue* v = map.find("cycles"))
    sequence.cycles = static_cast<Cycles>(v->choice({"merge", "keep"}));
  if (const YamlValue* v = map.find("compositor"))
    sequence.compositor = static_cast<Compositor>(v->choice({"talisman", "extended"}));
  if (const YamlValue* v = map.find("clip_margin")) sequence.clip_margin = v->number({0, 1});
  if (const YamlValue* v = map.find("bound"))
    sequence.bound = static_cast<layers::BoundKind>(v->choice({"box8", "dop14", "dop26"}));
  if (const YamlValue* v = map.find("warp")) {
    sequence.warp = v->text();
    if (!warp::curve_from_name(sequence.warp))
      v->fail("one of the curves of [LS97 4.2], such as trn, so, aff, per2");
  }
}

/// Well-formed UTF-8 (RFC 3629): lead bytes with as many continuations as they ask for, no overlong forms.
bool is_utf8(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i++]);
    const int more = lead < 0x80                   ? 0
                     : lead >= 0xc2 && lead < 0xe0 ? 1
                     : lead >= 0xe0 && lead < 0xf0 ? 2
                     : lead >= 0xf0 && lead < 0xf5 ? 3
                                                   : -1;
    if (more < 0) return false;
    for (int k = 0; k < more; ++k, ++i)
      if (i >= text.size() || (static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) return false;
  }
  return true;
}

/// A variant says `extends: FILE` and then only what is different at the top level.
YamlMap read_with_base(const std::string& file, int depth) {
  YamlMap own = read_yaml_file(file);
  const YamlValue* base = own.find("extends");
  if (!base) return own;
  if (depth >= kMaxDepthOfExtends) base->fail("at most 8 files that extend each other, never in a circle");
  YamlMap merged = read_with_base(resolve_asset(base->text(), file, base->line()), depth + 1);
  merged.replace_by(own);
  return merged;
}

}  // namespace

/// Results go into a folder of this name: it must not lead anywhere else.
void read_name(YamlMap& map, std::string& name) {
  const YamlValue* value = map.find("name");
  if (!value) return;
  name = value->text();
  const bool leads_away = name.find('/') != std::string::npos || name.find("..") != std::string::npos ||
                          name == "." || name.empty();
  const bool printable =
      std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (leads_away || !printable) value->fail("a name: no '/', no '..' and no control characters");
  if (!is_utf8(name)) value->fail("UTF-8");
}

SequenceFile read_sequence_file(const std::string& file) {
  YamlMap map = read_with_base(file, 0);
  map.find("extends");
  SequenceFile result;
  result.settings.file = file;
  result.settings.name = std::filesystem::path(file).stem().string();
  read_name(map, result.settings.name);
  map.texts("packages");
  read_film(map, result.settings);
  read_settings(map, result.settings);
  if (const YamlValue* layers = map.find("layers"))
    for (const YamlValue& item : layers->items()) result.layers.push_back(read_layer(item));
  if (const YamlValue* order = map.find("order")) result.order = read_layer_pairs(*order);
  result.recipe = read_scene_recipe(map);
  map.finish();
  return result;
}

}  // namespace talisman::sequences
