// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/inspect/inspect_motion.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "sequences/content/value_type.h"
#include "sequences/files/errors.h"
#include "sequences/files/how_many.h"
#include "sequences/files/number_text.h"
#include "sequences/files/utf8.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostShown = 10;

TraceOptions options_of(const std::string& file, const MotionQuestion& question) {
  TraceOptions options;
  options.file = file;
  if (!question.format.empty()) options.format = trace_format_from(question.format);
  if (!question.joint.empty()) options.joint = question.joint;
  for (const auto& [name, value] : {std::pair{"--fps", question.fps}, {"--scale", question.scale}})
    if (value && !(*value > 0 && *value <= kMost))
      throw InputError(std::string(name) + " is " + shown(*value) + ", rule: above 0, at most 1e9");
  options.fps = question.fps;
  options.scale = question.scale.value_or(1);
  return options;
}

std::string speeds_line(const char* what, const LogHistogram& speed, const char* unit) {
  return formatted("  %-9s %.4g %s in the median, %.4g p95, %.4g at most\n", what, speed.quantile(0.5), unit,
                   speed.quantile(0.95), speed.max());
}

std::string gap_lines(const TraceFindings& findings) {
  const std::vector<TraceGap> gaps = findings.gaps();
  std::string text = "  gaps      ";
  if (gaps.empty()) return text + "none longer than three periods\n";
  text += how_many(gaps.size(), "step") + " longer than three periods\n";
  for (std::size_t i = 0; i < gaps.size() && i < kMostShown; ++i)
    text += formatted("            %.4g s at %.6g s, before line %d\n", gaps[i].length_s, gaps[i].at_s,
                      gaps[i].line);
  return text;
}

std::string jump_lines(const TraceFindings& findings) {
  std::string text = "  jumps     ";
  if (findings.jumps.empty()) return text + "none\n";
  text += how_many(static_cast<std::size_t>(findings.jump_count), "step") +
          " ten times as fast as those beside\n";
  for (std::size_t i = 0; i < findings.jumps.size() && i < kMostShown; ++i) {
    const TraceJump& jump = findings.jumps[i];
    text += formatted("            %.4g° and %.4g m at %.6g s, line %d\n", jump.turned_deg, jump.moved_m,
                      jump.at_s, jump.line);
  }
  return text;
}

std::string text_of(const TraceOptions& options, TraceFormat format, const TraceFindings& findings) {
  std::string text = formatted("%s (%s)\n", options.file.c_str(), word_of(format));
  text += formatted("  length    %lld poses in %.6g s, %.4g m of way\n",
                    static_cast<long long>(findings.poses), findings.length_s, findings.way_m);
  text += formatted("  rate      %.4g/s: a step is %.4g s in the median, %.4g p95, %.4g at most\n",
                    1 / findings.period_s(), findings.period_s(), findings.step_s.quantile(0.95),
                    findings.step_s.max());
  text += speeds_line("moves", findings.speed_m_per_s, "m/s");
  text += speeds_line("turns", findings.turn_deg_per_s, "°/s");
  text += gap_lines(findings) + jump_lines(findings);
  return findings.remark.empty() ? text : text + "  it        " + findings.remark + "\n";
}

Json speeds_json(const LogHistogram& speed) {
  return {{"p50", speed.quantile(0.5)}, {"p95", speed.quantile(0.95)}, {"max", speed.max()}};
}

Json json_of(const TraceOptions& options, TraceFormat format, const TraceFindings& findings) {
  Json gaps = Json::array(), jumps = Json::array();
  for (const TraceGap& gap : findings.gaps())
    gaps.push_back({{"at_s", gap.at_s}, {"length_s", gap.length_s}, {"line", gap.line}});
  for (const TraceJump& jump : findings.jumps)
    jumps.push_back({{"at_s", jump.at_s},
                     {"turned_deg", jump.turned_deg},
                     {"moved_m", jump.moved_m},
                     {"times", number_or_null(jump.times)},
                     {"line", jump.line}});
  Json json = {{"schema", "talisman.motion_trace/1"},
               {"file", utf8_from(options.file)},
               {"format", word_of(format)},
               {"poses", findings.poses},
               {"length_s", findings.length_s},
               {"way_m", findings.way_m},
               {"step_s", speeds_json(findings.step_s)},
               {"speed_m_per_s", speeds_json(findings.speed_m_per_s)},
               {"turn_deg_per_s", speeds_json(findings.turn_deg_per_s)},
               {"gaps", gaps},
               {"jump_count", findings.jump_count},
               {"jumps", jumps}};
  if (!findings.remark.empty()) json["remark"] = findings.remark;
  return json;
}

}  // namespace

std::string inspect_motion(const std::string& file, const MotionQuestion& question, bool json) {
  const TraceOptions options = options_of(file, question);
  const TraceFormat format = options.format.value_or(format_of_name(file));
  const TraceFindings findings = look_through_trace(options);
  return json ? json_of(options, format, findings).dump(2) + "\n" : text_of(options, format, findings);
}

}  // namespace talisman::sequences
