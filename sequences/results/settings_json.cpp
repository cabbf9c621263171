// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/settings_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "sequences/results/settings_fields.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

Json setting_value(bool value) { return value; }
Json setting_value(int value) { return value; }
Json setting_value(std::int64_t value) { return value == regulator::kNoLimit ? Json(nullptr) : Json(value); }
Json setting_value(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json setting_value(float value) { return setting_value(static_cast<double>(value)); }
Json setting_value(const layers::ivec2& v) { return {v.x, v.y}; }
Json setting_value(const layers::dvec2& v) { return {v.x, v.y}; }
Json setting_value(regulator::Policy policy) { return regulator::name(policy); }
Json setting_value(regulator::Joining joining) { return regulator::name(joining); }
Json setting_value(regulator::Intervals intervals) { return regulator::name(intervals); }
Json setting_value(regulator::MotionNorm norm) { return regulator::name(norm); }
Json setting_value(regulator::LodSelector by) { return regulator::name(by); }
Json setting_value(regulator::LodBenefit benefit) { return regulator::name(benefit); }
Json setting_value(regulator::FirstAppearance first) { return regulator::name(first); }
Json setting_value(regulator::Regroup by) { return regulator::name(by); }
Json setting_value(regulator::Refresh refresh) { return regulator::name(refresh); }
Json setting_value(regulator::RegroupPrices prices) { return regulator::name(prices); }
Json setting_value(regulator::Prediction prediction) { return regulator::name(prediction); }
Json setting_value(regulator::ChoiceRule rule) { return regulator::name(rule); }
Json setting_value(warp::Curve curve) { return warp::name(curve); }

Json setting_value(layers::BoundKind bound) {
  switch (bound) {
    case layers::BoundKind::Box8:
      return "box8";
    case layers::BoundKind::Dop14:
      return "dop14";
    case layers::BoundKind::Dop26:
      return "dop26";
  }
  return nullptr;
}

Json setting_value(chunker::Shading shading) {
  switch (shading) {
    case chunker::Shading::Flat:
      return "flat";
    case chunker::Shading::Gouraud:
      return "gouraud";
    case chunker::Shading::Phong:
      return "phong";
  }
  return nullptr;
}

Json setting_value(chunker::TextureFilter filter) {
  switch (filter) {
    case chunker::TextureFilter::Nearest:
      return "nearest";
    case chunker::TextureFilter::Bilinear:
      return "bilinear";
    case chunker::TextureFilter::Trilinear:
      return "trilinear";
  }
  return nullptr;
}

Json setting_value(Cycles cycles) { return cycles == Cycles::Merge ? "merge" : "keep"; }
Json setting_value(const VisibilityOptions& visibility) { return text_of(visibility); }

Json setting_value(Compositor compositor) {
  return compositor == Compositor::Talisman ? "talisman" : "extended";
}

Json setting_value(const std::optional<chunker::CompressionOptions>& compression) {
  if (!compression) return nullptr;
  const auto& [quality] = *compression;
  return quality;
}

Json setting_value(const std::vector<layers::ExplicitPair>& pairs) {
  Json json = Json::array();
  for (const auto& [behind, front] : pairs) json.push_back({behind, front});
  return json;
}

}  // namespace

Json json_of(const Settings& settings) {
  Json json = Json::object();
  for_each_setting(settings,
                   [&json](const char* name, const auto& value) { json[name] = setting_value(value); });
  return json;
}

}  // namespace talisman::sequences
