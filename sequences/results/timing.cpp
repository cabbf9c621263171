// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/timing.h"

#include <sys/utsname.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>

#include <oneapi/tbb/global_control.h>

#include "sequences/files/utf8.h"
#include "sequences/results/column_json.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/json_text.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kProcess = "talisman.process/1";

/// A time of frames for which `applies`; else null.
template <typename Applies, typename Member>
Column<FrameLine> stage_time(const char* name, const char* meaning, Applies, Member member) {
  Column<FrameLine> column = stored<FrameLine>(name, name, "ms", meaning, member);
  column.get = [](const FrameLine& line) {
    return Applies{}(line) ? value_of(Member{}(line)) : Value(Null{});
  };
  return column;
}

std::vector<Column<FrameLine>> columns() {
  const auto always = [](const FrameLine&) { return true; };
  const auto drawn = [](const FrameLine& line) { return line.is_drawn(); };
  return {stored<FrameLine>(
              "frame", "frame", "", "number of the frame, from 0", [](auto& l) -> auto& { return l.frame; }),
          stage_time(
              "plan_ms", "to decide what is drawn", always, [](auto& l) -> auto& { return l.times.plan_ms; }),
          stage_time(
              "sort_ms", "of it, to sort the layers; null: they were not",
              [](const FrameLine& line) { return line.visibility.has_value(); },
              [](auto& l) -> auto& { return l.times.sort_ms; }),
          stage_time(
              "render_ms", "to draw sprites, also late ones; null: only planned", drawn,
              [](auto& l) -> auto& { return l.times.render_ms; }),
          stage_time(
              "compress_ms", "of it, to compress, decompress and compare sprites; null: they were not",
              [](const FrameLine& line) { return line.compression.has_value(); },
              [](auto& l) -> auto& { return l.times.compress_ms; }),
          stage_time(
              "composite_ms", "to put the frame together; null: only planned", drawn,
              [](auto& l) -> auto& { return l.times.composite_ms; }),
          stage_time(
              "io_ms", "to write the picture, while the next frame is drawn; null: only planned", drawn,
              [](auto& l) -> auto& { return l.times.io_ms; }),
          stored<FrameLine>(
              "late_pixels", "late_pixels", "px",
              "filled in chunks that no frame had shown yet, of sprites drawn for earlier frames",
              [](auto& l) -> auto& { return l.times.late_pixels; })};
}

const RowJson<FrameLine>& timing_row_json() {
  static const RowJson<FrameLine> json(timing_table());
  return json;
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

/// As /proc/cpuinfo names it; empty if it does not.
std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(std::min(line.size(), line.find(':') + 2));
  return {};
}

}  // namespace

const ColumnTable<FrameLine>& timing_table() {
  static const ColumnTable<FrameLine> table{"timing", "talisman.timing/1", columns(), {}};
  return table;
}

std::string timing_json(const FrameLine& line) { return timing_row_json().write(line).dump(); }

std::optional<FrameTiming> timing_from_json(const std::string& text) try {
  const Json json = Json::parse(text);
  if (!json.is_object() || json.at("schema") != timing_table().schema) return std::nullopt;
  FrameLine line;
  timing_row_json().read(json, line);
  return FrameTiming{line.frame, line.times};
} catch (const Json::exception&) {
  return std::nullopt;
} catch (const std::invalid_argument&) {
  return std::nullopt;
}

std::string process_json() {
  utsname system{};
  ::uname(&system);
  const std::size_t threads =
      oneapi::tbb::global_control::active_value(oneapi::tbb::global_control::max_allowed_parallelism);
  return Json{{"schema", kProcess},
              {"version", TALISMAN_VERSION},
              {"started", utc_now()},
              {"machine", utf8_from(system.nodename)},
              {"system", std::string(system.sysname) + " " + system.release + " " + system.machine},
              {"processor", processor()},
              {"threads", threads}}
      .dump();
}

bool is_process_line(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  return json.is_object() && text_in(json, "schema") == kProcess;
}

std::string total_timing_json(const Summary& s) {
  const auto total = [&s](double FrameTimes::*time) {
    return s.total([time](const FrameLine& line) { return line.times.*time; });
  };
  const auto measured = [&s](double value) { return s.planned_only ? Json(nullptr) : Json(value); };
  return Json{{"schema", "talisman.timing_total/1"},
              {"frames", s.frame_count()},
              {"planning_us_per_layer_and_frame", s.planning_us_per_layer_and_frame()},
              {"slowest_sort_ms", s.sums().slowest_sort_ms()},
              {"wall_ms",
               {{"plan", total(&FrameTimes::plan_ms)},
                {"sort", total(&FrameTimes::sort_ms)},
                {"render", measured(total(&FrameTimes::render_ms))},
                {"compress", measured(total(&FrameTimes::compress_ms))},
                {"composite", measured(total(&FrameTimes::composite_ms))},
                {"io", measured(total(&FrameTimes::io_ms))}}}}
      .dump();
}

}  // namespace talisman::sequences
