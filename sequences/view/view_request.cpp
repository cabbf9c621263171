// SPDX-License-Identifier: Apache-2.0
#include "sequences/view/view_request.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "layers/effects.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {

namespace {

using RequestJson = nlohmann::json;

constexpr std::size_t kLongestText_bytes = 200, kMostFrames = 1'000'000;
constexpr double kFarthest_m = 1e9;

/// For a message: no deeper and no longer than it can be read.
std::string shown(const RequestJson& value) {
  if (value.is_structured()) return value.is_array() ? "a list" : "an object";
  return value.dump().substr(0, kLongestText_bytes);
}

std::string text_from(const RequestJson& json, const char* key) {
  if (!json.contains(key)) return {};
  if (!json[key].is_string() || json[key].get_ref<const std::string&>().size() > kLongestText_bytes)
    throw InputError(std::string(key) + ": must be a text of at most 200 bytes");
  return json[key].get<std::string>();
}

std::int64_t whole_from(const RequestJson& json, const char* key, std::int64_t largest) {
  if (!json.contains(key)) return 0;
  if (!json[key].is_number_integer() || json[key] < 0 || json[key] > largest)
    throw InputError(std::string(key) + " is " + shown(json[key]) + ", must be a whole number from 0 to " +
                     std::to_string(largest));
  return json[key].get<std::int64_t>();
}

std::vector<std::string> words_from(const RequestJson& settings) {
  if (!settings.is_object()) throw InputError("settings: must be an object");
  std::vector<std::string> words;
  const auto& known = settable_options();
  for (const auto& [name, value] : settings.items()) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError("--" + name.substr(0, kLongestText_bytes) + " is no option of the live view");
    if (value.is_null()) continue;
    if (value.is_structured()) throw InputError("--" + name + ": must be a number or a word");
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    if (text.size() > kLongestText_bytes) throw InputError("--" + name + ": must be a number or a word");
    words.push_back("--" + name + "=" + text);
  }
  return words;
}

std::vector<layers::Effect> effects_from(const RequestJson& names) {
  std::vector<layers::Effect> effects;
  if (!names.is_array()) throw InputError("without: must be a list of effects");
  for (const RequestJson& name : names) {
    const auto effect = std::find_if(layers::kAllEffects.begin(), layers::kAllEffects.end(),
                                     [&](layers::Effect e) { return name == layers::name(e); });
    if (effect == layers::kAllEffects.end()) throw InputError("without: " + shown(name) + " is no effect");
    effects.push_back(*effect);
  }
  return effects;
}

std::vector<CameraPose> flight_from(const RequestJson& poses) {
  std::vector<CameraPose> flight;
  if (!poses.is_array()) throw InputError("flight: must be a list");
  for (const RequestJson& pose : poses) {
    const bool is_pose =
        pose.is_array() && pose.size() == 6 &&
        std::all_of(pose.begin(), pose.end(), [](const RequestJson& v) { return v.is_number(); });
    if (!is_pose) throw InputError("flight: must be six numbers per frame, position and target");
    CameraPose read;
    for (int axis = 0; axis < 3; ++axis) {
      read.position[axis] = pose[axis].get<double>();
      read.target[axis] = pose[axis + 3].get<double>();
    }
    double farthest = 0;
    for (int axis = 0; axis < 3; ++axis)
      farthest = std::max({farthest, std::abs(read.position[axis]), std::abs(read.target[axis])});
    if (!(farthest <= kFarthest_m) || read.position == read.target)
      throw InputError("flight: position and target must be two places within 1e9 m");
    flight.push_back(read);
  }
  return flight;
}

}  // namespace

const std::vector<std::string>& settable_options() {
  static const std::vector<std::string> names = {"policy",
                                                 "hold",
                                                 "stagger",
                                                 "blend",
                                                 "lookahead",
                                                 "predict",
                                                 "tree-k",
                                                 "joining",
                                                 "motion-norm",
                                                 "geometric-px",
                                                 "photometric",
                                                 "light-angle-deg",
                                                 "shadow-map-px",
                                                 "turned-px",
                                                 "regroup",
                                                 "regroup-prices",
                                                 "regroup-ceiling-ms",
                                                 "regroup-dwell",
                                                 "refresh",
                                                 "budget-polygons",
                                                 "budget-pixels",
                                                 "budget-chunks",
                                                 "budget-ms",
                                                 "min-resolution",
                                                 "cutoff-px",
                                                 "choice",
                                                 "depth-complexity",
                                                 "warp",
                                                 "color-warp",
                                                 "bound",
                                                 "material-points",
                                                 "cycles",
                                                 "compositor",
                                                 "visibility",
                                                 "expected-reuse",
                                                 "shading",
                                                 "samples",
                                                 "resolution",
                                                 "compression",
                                                 "late-chunks",
                                                 "size"};
  return names;
}

std::string ViewRequest::plan_key() const {
  std::string key;
  for (const std::string& word : words) key += word + "\n";
  for (const layers::Effect effect : without) key += "without " + std::string(layers::name(effect)) + "\n";
  key += RequestJson(scale).dump();
  for (const CameraPose& pose : flight)
    for (int axis = 0; axis < 3; ++axis)
      key += "," + RequestJson(pose.position[axis]).dump() + "," + RequestJson(pose.target[axis]).dump();
  return key;
}

ViewRequest view_request_from(const std::string& body) {
  const RequestJson json = RequestJson::parse(body, nullptr, false);
  if (!json.is_object()) throw InputError("the request is no JSON object");
  ViewRequest request;
  request.tab = text_from(json, "tab");
  request.request = whole_from(json, "request", std::int64_t{1} << 53);
  request.frame = static_cast<int>(whole_from(json, "frame", kMostFrames));
  request.from = static_cast<int>(whole_from(json, "from", kMostFrames));
  if (json.contains("mode")) request.mode = text_from(json, "mode");
  request.layer = text_from(json, "layer");
  request.name = text_from(json, "name");
  if (json.contains("settings")) request.words = words_from(json["settings"]);
  if (json.contains("without")) request.without = effects_from(json["without"]);
  if (json.contains("flight")) request.flight = flight_from(json["flight"]);
  if (json.contains("scale")) {
    if (!json["scale"].is_number() || !(json["scale"] > 0 && json["scale"] <= 1))
      throw InputError("scale is " + shown(json["scale"]) + ", must be above 0 and at most 1");
    request.scale = json["scale"].get<double>();
  }
  return request;
}

}  // namespace talisman::sequences
