// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/factoring/layers_yaml.h"

#include <algorithm>

#include "layers/glob.h"
#include "sequences/content/starter/yaml_page.h"
#include "sequences/content/value_type.h"

namespace talisman::sequences {

namespace {

using layers::LayerPreferences;
using layers::LayerSpec;

using Items = std::vector<std::string>;

std::string map_yaml(const Items& items) { return items.empty() ? "" : "{" + joined(items) + "}"; }

void add(Items& items, const char* key, double value, double otherwise) {
  if (value != otherwise) items.push_back(std::string(key) + ": " + yaml_number(value));
}

void add(Items& items, const std::string& key, const std::string& value) {
  if (!value.empty()) items.push_back(key + ": " + value);
}

std::string importance_yaml(const layers::FiducialWeights& weights) {
  Items items;
  add(items, "geometric", weights.geometric, 1);
  add(items, "photometric", weights.photometric, 1);
  add(items, "sampling", weights.sampling, 1);
  add(items, "visibility", weights.visibility, 1);
  return map_yaml(items);
}

Items preference_items(const LayerPreferences& p) {
  Items items;
  add(items, "resolution_scale", p.resolution_scale, 1);
  add(items, "min_update_rate", p.min_update_rate, 0);
  add(items, "max_update_rate", p.max_update_rate, 1);
  add(items, "share_of_expected_motion", p.share_of_expected_motion, 1);
  if (p.bound_each_part) add(items, "bound_each_part", *p.bound_each_part ? "true" : "false");
  add(items, "motion_blur", p.motion_blur, 0);
  if (p.whole_extents) add(items, "extents", "whole");
  add(items, "warp", p.warp);
  add(items, "importance", importance_yaml(p.importance));
  return items;
}

std::string multiplier_yaml(const layers::Keys<double>& keys) {
  if (keys.values.empty()) return "";
  if (keys.values.size() == 1) return yaml_number(keys.values[0]);
  Items items;
  for (std::size_t i = 0; i < keys.values.size(); ++i)
    items.push_back("{t: " + yaml_number(keys.times_s[i]) + ", value: " + yaml_number(keys.values[i]) + "}");
  return yaml_list(items);
}

std::string word_of(layers::ShadowsAs as) {
  switch (as) {
    case layers::ShadowsAs::Shade:
      return "shade";
    case layers::ShadowsAs::Light:
      return "light";
    case layers::ShadowsAs::Multiply:
      return "multiply";
    case layers::ShadowsAs::Atop:
      return "atop";
  }
  return "";
}

std::string shading_yaml(const layers::ShadingSpec& shading) {
  Items items;
  const auto term = [&](const char* key, const std::optional<LayerPreferences>& preferences, Items first) {
    if (!preferences) return;
    const Items more = preference_items(*preferences);
    first.insert(first.end(), more.begin(), more.end());
    add(items, key, "{" + joined(first) + "}");
  };
  term("shadows", shading.shadows,
       shading.shadows_as ? Items{"as: " + word_of(*shading.shadows_as)} : Items{});
  term("specular", shading.specular, {});
  term("reflection", shading.reflection, {});
  term("textures", shading.textures, {});
  add(items, "first_blend", multiplier_yaml(shading.first_blend));
  add(items, "second_blend", multiplier_yaml(shading.second_blend));
  return map_yaml(items);
}

std::string group_yaml(layers::OrderGroup group) {
  if (group == layers::OrderGroup::Background) return "background";
  return group == layers::OrderGroup::Foreground ? "foreground" : "";
}

void add_layer(YamlPage& page, const LayerSpec& spec, const std::vector<std::string>& globs) {
  std::vector<std::string> parts;
  for (const std::string& glob : globs) parts.push_back(yaml_text(glob));
  page.key("  - ", "name", yaml_text(spec.name));
  page.list("    ", "parts", parts);
  const auto key = [&](const char* name, const std::string& value) {
    if (!value.empty()) page.key("    ", name, value);
  };
  key("group", group_yaml(spec.group));
  key("preferences", preferences_yaml(spec.preferences));
  key("shading", shading_yaml(spec.shading));
  key("fade", multiplier_yaml(spec.fade));
  if (!spec.casts_shadows) key("casts_shadows", "false");
}

std::string yaml_glob_of(const std::string& name) { return yaml_text(layers::glob_of_name(name)); }

}  // namespace

std::string preferences_yaml(const LayerPreferences& preferences) {
  return map_yaml(preference_items(preferences));
}

std::string order_yaml(std::span<const LayerSpec> specs, std::span<const SpecPair> order) {
  YamlPage page;
  page.key("", "order", order.empty() ? "[]" : "");
  for (const auto& [behind, front] : order)
    page.line("  - {behind: " + yaml_glob_of(specs[behind].name) +
              ", front: " + yaml_glob_of(specs[front].name) + "}");
  return page.text();
}

std::string layers_yaml(std::span<const LayerSpec> specs, std::span<const SpecPair> order,
                        const std::string& in_model, const std::vector<std::string>& of_sequence) {
  YamlPage page;
  page.key("", "layers", "");
  for (const LayerSpec& spec : specs) {
    std::vector<std::string> globs = spec.part_globs;
    for (std::string& glob : globs)
      if (std::find(of_sequence.begin(), of_sequence.end(), glob) == of_sequence.end())
        glob = in_model + glob;
    add_layer(page, spec, globs);
  }
  return page.text() + order_yaml(specs, order);
}

}  // namespace talisman::sequences
