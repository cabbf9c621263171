// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/settings_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "sequences/results/settings_fields.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

Json value_of(bool value) { return value; }
Json value_of(int value) { return value; }
Json value_of(std::int64_t value) { return value == regulator::kNoLimit ? Json(nullptr) : Json(value); }
Json value_of(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json value_of(float value) { return value_of(static_cast<double>(value)); }
Json value_of(const layers::ivec2& v) { return {v.x, v.y}; }
Json value_of(const layers::dvec2& v) { return {v.x, v.y}; }
Json value_of(regulator::Policy policy) { return regulator::name(policy); }
Json value_of(regulator::Prediction prediction) { return regulator::name(prediction); }
Json value_of(regulator::ChoiceRule rule) { return regulator::name(rule); }
Json value_of(warp::Curve curve) { return warp::name(curve); }

Json value_of(layers::BoundKind bound) {
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

Json value_of(chunker::Shading shading) {
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

Json value_of(chunker::TextureFilter filter) {
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

Json value_of(Cycles cycles) { return cycles == Cycles::Merge ? "merge" : "keep"; }
Json value_of(Compositor compositor) { return compositor == Compositor::Talisman ? "talisman" : "extended"; }

Json value_of(const std::optional<chunker::CompressionOptions>& compression) {
  if (!compression) return nullptr;
  const auto& [quality] = *compression;
  return quality;
}

Json value_of(const std::vector<layers::ExplicitPair>& pairs) {
  Json json = Json::array();
  for (const auto& [behind, front] : pairs) json.push_back({behind, front});
  return json;
}

}  // namespace

Json json_of(const Settings& settings) {
  Json json = Json::object();
  for_each_setting(settings, [&json](const char* name, const auto& value) { json[name] = value_of(value); });
  return json;
}

}  // namespace talisman::sequences
