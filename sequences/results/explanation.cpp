// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/explanation.h"

#include <algorithm>

#include "sequences/files/number_text.h"
#include "sequences/results/layer_words.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

enum class Limit { AtMost, AtLeast };
enum class Off { Never, AtZero, BelowZero };  ///< the limit that switches a fiducial off

/// Where a fiducial stands in a decision, and its limit in the settings.
struct FiducialRow {
  const char* name;
  const char* value;  ///< a JSON pointer into the line
  const char* limit;  ///< a key of the settings
  const char* unit;
  const char* where = nullptr;    ///< a JSON pointer to two numbers
  const char* light = nullptr;    ///< one to the name of a light
  const char* why_not = nullptr;  ///< one to the reason why it was not computed
  Limit kind = Limit::AtMost;
  Off off = Off::AtZero;
  bool always = false;  ///< always computed: null says that there is no bound
};

constexpr FiducialRow kFiducials[] = {
    {"geometric", "/fiducials/warp_geometric_px", "geometric_px", "px", "/fiducials/worst_at_px", nullptr,
     nullptr, Limit::AtMost, Off::Never, true},
    {"photometric", "/fiducials/photometric/color", "photometric", "", "/fiducials/photometric/worst_at_px",
     "/fiducials/photometric/light", "/fiducials/photometric/why_not"},
    {"light angle", "/fiducials/photometric/light_angle_rad", "light_angle_rad", "rad", nullptr,
     "/fiducials/photometric/angle_light", "/fiducials/photometric/why_not"},
    {"magnification", "/fiducials/magnification", "magnification", "", nullptr, nullptr, nullptr,
     Limit::AtMost, Off::AtZero, true},
    {"minification", "/fiducials/minification", "minification", "", nullptr, nullptr, nullptr,
     Limit::AtLeast},
    {"anisotropy", "/fiducials/anisotropy", "anisotropy", "", nullptr, nullptr, nullptr, Limit::AtMost,
     Off::AtZero, true},
    {"uncovered edge", "/fiducials/uncovered_px", "uncovered_px", "px", nullptr, nullptr,
     "/fiducials/uncovered_why_not", Limit::AtMost, Off::BelowZero},
    {"turned side", "/fiducials/turned_px", "turned_px", "px"}};

/// Of a shadow map: how far its shadows have run on the layers that look it up.
constexpr FiducialRow kOfMap = {"shadow moved", "/fiducials/warp_geometric_px", "shadow_map_px", "px"};

bool is_shadow_map(const std::string& layer) { return layer.rfind("shadow map of ", 0) == 0; }

/// Do these policies draw what is beyond a threshold? Others look at fiducials in their own way, or not at all.
bool has_limits(const Json& settings) {
  const std::string policy = settings.at("policy").get<std::string>();
  return policy == "threshold" || policy == "lookahead" || policy == "oracle";
}

/// What stands there; null: nothing does.
const Json* at(const Json& json, const char* pointer) {
  if (!pointer) return nullptr;
  const Json::json_pointer place(pointer);
  if (!json.contains(place)) return nullptr;
  const Json& value = json.at(place);
  return value.is_null() ? nullptr : &value;
}

bool is_off(Off off, double limit) {
  return (off == Off::AtZero && limit == 0) || (off == Off::BelowZero && limit < 0);
}

/// The layer's own limit: that of the settings, for displacements divided by their weight.
Json limit_of(const FiducialRow& row, const Json& line, const Json& settings) {
  const Json& limit = settings.at(row.limit);
  const Json* weight =
      std::string(row.limit) == "geometric_px" ? at(line, "/fiducials/geometric_weight") : nullptr;
  if (!weight || !limit.is_number()) return limit;
  return limit.get<double>() / weight->get<double>();
}

FiducialFinding finding_of(const FiducialRow& row, const Json& line, const Json& settings) {
  FiducialFinding finding{row.name, row.limit, {}, row.unit, {}, {}, {}, false};
  const Json* value = at(line, row.value);
  if (value) finding.value = value->dump();
  const Json limit = limit_of(row, line, settings);
  if (has_limits(settings) && limit.is_number() && !is_off(row.off, limit.get<double>()))
    finding.limit = limit.dump();
  if (!value && row.always) {
    finding.value = "no bound";
    finding.unit = "";
    finding.is_beyond = !finding.limit.empty();
  }
  if (value && !finding.limit.empty()) {
    const double v = value->get<double>(), most = limit.get<double>();
    finding.is_beyond = row.kind == Limit::AtMost ? v > most : v < most;
  }
  if (const Json* where = at(line, row.where); where && value)
    finding.where = formatted("at (%.1f, %.1f)", where->at(0).get<double>(), where->at(1).get<double>());
  if (const Json* light = at(line, row.light); light && value)
    finding.remark = "light '" + light->get<std::string>() + "'";
  if (const Json* why = at(line, row.why_not); why && !value) finding.remark = why->get<std::string>();
  return finding;
}

/// "beyond 4", "within 4", "not regulated".
std::string against_limit(const FiducialFinding& f) {
  if (f.value.empty()) return "not computed";
  if (f.limit.empty()) return "not regulated";
  return (f.is_beyond ? "beyond " : "within ") + f.limit;
}

std::string frame_or(const std::optional<int>& frame, const char* otherwise) {
  return frame ? "frame " + std::to_string(*frame) : otherwise;
}

std::string in_words(const std::string& decision) {
  if (decision == "rerender") return "drawn again";
  if (decision == "reuse") return "its sprite is used again";
  if (decision == "refresh") return "some chunks of its sprite are drawn again";
  return "not shown";
}

}  // namespace

std::vector<FiducialFinding> findings_of(const Json& line, const Json& settings) {
  std::vector<FiducialFinding> findings;
  if (!at(line, "/fiducials")) return findings;
  if (is_shadow_map(line.at("layer").get<std::string>())) return {finding_of(kOfMap, line, settings)};
  for (const FiducialRow& row : kFiducials) findings.push_back(finding_of(row, line, settings));
  return findings;
}

std::string explanation_of(const LayerHistory& layer, const Json& settings) {
  const Json& line = layer.line;
  std::string text = "layer '" + layer.layer + "': " + in_words(line.at("decision").get<std::string>()) +
                     ", " + line.at("reason").get<std::string>() + "\n";
  for (const FiducialFinding& f : findings_of(line, settings)) {
    const std::string value = f.value.empty() ? "" : f.value + (f.unit.empty() ? "" : " " + f.unit);
    text += formatted("  %-16s %-26s %-22s %s\n", f.name.c_str(), value.c_str(), against_limit(f).c_str(),
                      (f.where + (f.where.empty() || f.remark.empty() ? "" : ", ") + f.remark).c_str());
  }
  if (const Json* age = at(line, "/fiducials/frames_since_render"))
    text += "  age              " + age->dump() + " frames\n";
  text += "  displayed error  " + line.at("geometric_px").dump() + " px\n";
  // The lines of a run of --frames A-B begin at A.
  const char* unknown = at(line, "/fiducials") ? "before the first frame of the run" : "never";
  text += "  drawn before     " + frame_or(layer.drawn_before, unknown) + "\n";
  return text + "  drawn next       " + frame_or(layer.drawn_after, "not in this run") + "\n";
}

std::string overview_of(const std::vector<LayerHistory>& layers) {
  std::string text = formatted("  %-24s %-9s %7s %7s  %s\n", "layer", "decision", "before", "next", "why");
  for (const LayerHistory& layer : layers) {
    const std::string name = column_of(layer.layer);
    const auto number = [](const std::optional<int>& frame) { return frame ? std::to_string(*frame) : "-"; };
    text +=
        formatted("  %s %-9s %7s %7s  %s\n", name.c_str(),
                  layer.line.at("decision").get<std::string>().c_str(), number(layer.drawn_before).c_str(),
                  number(layer.drawn_after).c_str(), layer.line.at("reason").get<std::string>().c_str());
  }
  return text;
}

}  // namespace talisman::sequences
