// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/exports/trace_export.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <map>

#include "sequences/files/atomic_file.h"
#include "sequences/results/exports/finished_tables.h"
#include "sequences/results/exports/sprite_lives.h"
#include "sequences/results/finished_run.h"
#include "sequences/results/reason_tally.h"

namespace talisman::sequences {

namespace {

using Json = ExportedRow;

constexpr int kRunProcess = 1, kMeasuredProcess = 2;
constexpr int kFramesTrack = 1;  ///< of process 1; layers follow
constexpr int kStagesTrack = 1, kWritingTrack = 2;

/// The events of one file, each on a line of its own.
class TraceFile {
 public:
  explicit TraceFile(std::ostream& out, double fps) : out_(out), fps_(fps) {}

  std::int64_t us(int frame) const { return std::llround(frame * 1e6 / fps_); }

  void begin(const Json& about) {
    out_ << "{\"displayTimeUnit\":\"ms\",\"otherData\":" << about.dump() << ",\"traceEvents\":[";
  }
  void end() { out_ << "\n]}\n"; }
  void write(const Json& event) {
    out_ << (any_ ? ",\n" : "\n") << event.dump();
    any_ = true;
  }
  void name_process(int process, const std::string& name) {
    write({{"ph", "M"}, {"name", "process_name"}, {"pid", process}, {"tid", 0}, {"args", {{"name", name}}}});
    write({{"ph", "M"},
           {"name", "process_sort_index"},
           {"pid", process},
           {"tid", 0},
           {"args", {{"sort_index", process}}}});
  }
  void name_track(int process, int track, const std::string& name) {
    write(
        {{"ph", "M"}, {"name", "thread_name"}, {"pid", process}, {"tid", track}, {"args", {{"name", name}}}});
    write({{"ph", "M"},
           {"name", "thread_sort_index"},
           {"pid", process},
           {"tid", track},
           {"args", {{"sort_index", track}}}});
  }
  void counter(int process, int frame, const std::string& name, const Json& values) {
    write({{"ph", "C"}, {"name", name}, {"pid", process}, {"tid", 0}, {"ts", us(frame)}, {"args", values}});
  }

 private:
  std::ostream& out_;
  double fps_;
  bool any_ = false;
};

/// The tracks of the layers, by name.
class LayerTracks {
 public:
  explicit LayerTracks(TraceFile& trace) : trace_(trace) {}
  int of(const std::string& layer) {
    const auto [track, is_new] =
        tracks_.try_emplace(layer, kFramesTrack + 1 + static_cast<int>(tracks_.size()));
    if (is_new) trace_.name_track(kRunProcess, track->second, layer);
    return track->second;
  }

 private:
  TraceFile& trace_;
  std::map<std::string, int> tracks_;
};

/// "geometric" of "geometric 4.7 > 4 px".
std::string kind_of_reason(const std::string& reason) {
  ReasonTally tally;
  tally.add(reason);
  const ReasonKind* kind = tally.most_frequent();
  return kind ? kind->words : "drawn";
}

Json args_of(const SpriteLife& life) {
  Json args = {{"reason", life.first.at("reason")},
               {"frames", life.end - life.begin},
               {"max_geometric_px", life.max_geometric_px},
               {"ended", life.ended.empty() ? Json(nullptr) : Json(life.ended)}};
  for (const char* name : {"depicts_frame", "resolution", "fiducials", "cost"})
    args[name] = life.first.contains(name) ? life.first[name] : Json(nullptr);
  return args;
}

/// An arrow between two points of the run; time never runs backwards along one.
void write_flow(TraceFile& trace, std::int64_t id, int from_track, int from_frame, int to_track,
                int to_frame) {
  if (from_frame > to_frame) {
    std::swap(from_frame, to_frame);
    std::swap(from_track, to_track);
  }
  const auto point = [&](const char* phase, int track, int frame) {
    Json event = {{"ph", phase},        {"name", "depicts"}, {"cat", "depicts"},     {"id", id},
                  {"pid", kRunProcess}, {"tid", track},      {"ts", trace.us(frame)}};
    if (*phase == 'f') event["bp"] = "e";
    trace.write(event);
  };
  point("s", from_track, from_frame);
  point("f", to_track, to_frame);
}

/// The frames of the run that have a slice.
struct FramesShown {
  int first = 0, last = -1;
  bool contains(int frame) const { return frame >= first && frame <= last; }
};

void write_lives(TraceFile& trace, LayerTracks& tracks, const FinishedTable& decisions,
                 const FramesShown& frames) {
  std::int64_t flow = 0;
  SpriteLives lives([&](const SpriteLife& life) {
    const int track = tracks.of(life.layer);
    trace.write(
        {{"ph", "X"},
         {"name", life.drawn ? kind_of_reason(life.first.at("reason").get<std::string>()) : "drawn before"},
         {"cat", life.drawn ? "drawn" : "shown"},
         {"pid", kRunProcess},
         {"tid", track},
         {"ts", trace.us(life.begin)},
         {"dur", trace.us(life.end) - trace.us(life.begin)},
         {"args", args_of(life)}});
    const Json& depicts = life.first.at("depicts_frame");
    if (depicts.is_number() && frames.contains(depicts.get<int>()))
      write_flow(trace, ++flow, kFramesTrack, depicts.get<int>(), track, life.begin);
  });
  decisions.read([&](const Json& row) {
    tracks.of(row.at("layer").get<std::string>());
    lives.add(row);
  });
  lives.finish();
}

/// The values of a row under these names that are there; null: none is.
Json values_of(const Json& row, std::initializer_list<const char*> names) {
  Json values;
  for (const char* name : names)
    if (row.contains(name) && row[name].is_number()) values[name] = row[name];
  return values;
}

FramesShown write_frames(TraceFile& trace, const FinishedTable& frames) {
  FramesShown shown;
  frames.read([&](const Json& row) {
    const int frame = row.at("frame").get<int>();
    if (shown.last < shown.first) shown.first = frame;
    shown.last = frame;
    trace.write({{"ph", "X"},
                 {"name", "frame " + std::to_string(frame)},
                 {"cat", "frame"},
                 {"pid", kRunProcess},
                 {"tid", kFramesTrack},
                 {"ts", trace.us(frame)},
                 {"dur", trace.us(frame + 1) - trace.us(frame)},
                 {"args", {{"frame", frame}}}});
    const auto count = [&](const char* name, std::initializer_list<const char*> columns) {
      if (const Json values = values_of(row, columns); !values.is_null())
        trace.counter(kRunProcess, frame, name, values);
    };
    count("layers", {"renders", "reuses"});
    count("polygons", {"polygons_rendered"});
    count("texels", {"pixels_rendered"});
    count("modelled ms", {"modelled_ms"});
    count("geometric error, px", {"mean_geometric_px"});
    count("sprite bytes", {"sprite_bytes"});
  });
  return shown;
}

void write_measured(TraceFile& trace, const FinishedTable& timing) {
  trace.name_process(kMeasuredProcess, "measured, on a clock of its own");
  trace.name_track(kMeasuredProcess, kStagesTrack, "plan, render, composite");
  trace.name_track(kMeasuredProcess, kWritingTrack, "write pictures");
  std::array<double, kWritingTrack + 1> now_us{};
  const auto stage = [&](const Json& row, const char* column, const char* name, int track) {
    if (!row.contains(column) || !row[column].is_number()) return;
    const double begin = now_us[track];
    now_us[track] += row[column].get<double>() * 1000;
    const std::int64_t took = std::llround(now_us[track]) - std::llround(begin);
    if (took == 0) return;  // below the unit of the format
    trace.write({{"ph", "X"},
                 {"name", name},
                 {"cat", "measured"},
                 {"pid", kMeasuredProcess},
                 {"tid", track},
                 {"ts", std::llround(begin)},
                 {"dur", took},
                 {"args", {{"frame", row.at("frame")}}}});
  };
  timing.read([&](const Json& row) {
    for (const char* name : {"plan", "render", "composite"})
      stage(row, (std::string(name) + "_ms").c_str(), name, kStagesTrack);
    now_us[kWritingTrack] = std::max(now_us[kWritingTrack], now_us[kStagesTrack]);
    stage(row, "io_ms", "write", kWritingTrack);
  });
}

const FinishedTable& table_of(const std::vector<FinishedTable>& tables, const std::string& name) {
  return *std::find_if(tables.begin(), tables.end(), [&](const auto& table) { return table.name == name; });
}

void write_trace(TraceFile& trace, const std::vector<FinishedTable>& tables, const Json& run,
                 bool with_timing) {
  trace.begin({{"schema", "talisman.trace/1"},
               {"sequence", run.at("sequence")},
               {"identity", run.at("identity")},
               {"time", "of the sequence: frame / fps"}});
  trace.name_process(kRunProcess, run.at("sequence").get<std::string>() + ", " +
                                      run.at("settings").at("policy").get<std::string>());
  trace.name_track(kRunProcess, kFramesTrack, "frames");
  LayerTracks tracks(trace);
  table_of(tables, "layers").read([&](const Json& row) { tracks.of(row.at("name").get<std::string>()); });
  const FramesShown frames = write_frames(trace, table_of(tables, "frames"));
  write_lives(trace, tracks, table_of(tables, "decisions"), frames);
  if (with_timing) write_measured(trace, table_of(tables, "timing"));
  trace.end();
}

}  // namespace

std::string export_trace(const std::string& folder, bool with_timing) try {
  std::string name = "trace.json";
  const std::string target = folder + "/" + name;
  const std::vector<FinishedTable> tables = finished_tables(folder, with_timing);
  const Json run = finished_run(folder);
  require_all_decisions(run, folder, "a trace");
  const double fps = run.at("settings").at("fps").get<double>();
  if (!(fps > 0)) throw InputError("fps is " + run["settings"]["fps"].dump() + ", must be above 0", folder);
  write_atomically(target, [&](const std::string& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    TraceFile trace(out, fps);
    write_trace(trace, tables, run, with_timing);
    if (!out.flush()) throw OutputError(target + ": cannot be written");
  });
  return name;
} catch (const Json::exception& error) {
  throw InputError(std::string("holds lines that are not as the run wrote them: ") + error.what(), folder);
}

}  // namespace talisman::sequences
