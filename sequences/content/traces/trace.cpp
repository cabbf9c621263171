// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/traces/trace.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "sequences/content/traces/trace_readers.h"
#include "sequences/content/value_type.h"
#include "sequences/files/how_many.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

/// Options that the format gives no meaning.
void require_options(const TraceOptions& options, TraceFormat format) {
  const auto fail = [&](const std::string& what) {
    throw InputError(what, options.sequence_file, options.line);
  };
  const bool may_have_fps = format == TraceFormat::Colmap || format == TraceFormat::Bvh;
  if (options.fps && !may_have_fps)
    fail(std::string("trace has fps, and ") + word_of(format) +
         " has stamps, rule: fps of colmap and bvh alone");
  if (!options.fps && format == TraceFormat::Colmap)
    fail("trace has no fps, rule: images of colmap have no times, fps gives them");
}

/// The poses of a range, and at most two on each side.
class PoseKeeper {
 public:
  PoseKeeper(const TraceOptions& options, double last_s) : options_(options), last_s_(last_s) {}

  bool take(const TracePose& pose) {
    const double t_s = pose.t_s - options_.start_s;
    if (t_s <= 0 && times_.size() == 2) drop_first();
    if (times_.size() == kMostPoses)
      throw InputError("has more than " + std::to_string(kMostPoses) + " poses in the " + shown(last_s_) +
                           " s that the sequence lasts, rule: at most as many",
                       options_.file);
    times_.push_back(t_s), positions_.push_back(pose.position), rotations_.push_back(pose.rotation);
    behind_ += t_s > last_s_;
    return behind_ < 2;
  }

  Trace trace() && {
    Trace trace;
    trace.positions.times_s = times_;
    trace.rotations.times_s = std::move(times_);
    trace.positions.values = std::move(positions_);
    trace.rotations.values = std::move(rotations_);
    return trace;
  }

 private:
  void drop_first() {
    times_.erase(times_.begin()), positions_.erase(positions_.begin()), rotations_.erase(rotations_.begin());
  }

  const TraceOptions& options_;
  double last_s_;
  int behind_ = 0;
  std::vector<double> times_;
  std::vector<layers::dvec3> positions_;
  std::vector<glm::dquat> rotations_;
};

void say_gaps(const TraceOptions& options, double last_s, Trace& trace) {
  std::vector<TraceGap> gaps = trace.findings.gaps();
  std::erase_if(gaps, [&](const TraceGap& gap) {
    const double from_s = gap.at_s - options.start_s;
    return from_s >= last_s || from_s + gap.length_s <= 0;
  });
  if (gaps.empty()) return;
  trace.warnings.push_back(
      formatted("%s:%d: %s of more than three periods of %.4g s, the longest of %.4g s here; "
                "poses in between are interpolated",
                options.file.c_str(), gaps.front().line, how_many(gaps.size(), "gap").c_str(),
                trace.findings.period_s(), gaps.front().length_s));
}

void say_jumps(const TraceOptions& options, double last_s, Trace& trace) {
  std::vector<TraceJump> jumps = trace.findings.jumps;
  std::erase_if(jumps, [&](const TraceJump& jump) {
    return jump.at_s < options.start_s || jump.at_s - options.start_s > last_s;
  });
  if (jumps.empty()) return;
  const auto worst = std::max_element(jumps.begin(), jumps.end(), [](const TraceJump& a, const TraceJump& b) {
    return a.turned_deg != b.turned_deg ? a.turned_deg < b.turned_deg : a.moved_m < b.moved_m;
  });
  const bool clips = options.jumps == Jumps::Clip;
  (clips ? trace.notes : trace.warnings)
      .push_back(formatted("%s:%d: %s, the largest here, by %.4g° and %.4g m in one step; %s",
                           options.file.c_str(), worst->line, how_many(jumps.size(), "jump").c_str(),
                           worst->turned_deg, worst->moved_m,
                           clips ? "taken out" : "kept, `jumps: clip` takes them out"));
}

void say_ends(const TraceOptions& options, double last_s, Trace& trace) {
  const TraceFindings& findings = trace.findings;
  const std::vector<double>& times = trace.positions.times_s;
  if (options.start_s > findings.length_s)
    throw InputError("lasts " + shown(findings.length_s) + " s and begins " + shown(options.start_s) +
                         " s after its first pose, rule: start_s below that",
                     options.file);
  if (times.back() < last_s)
    trace.warnings.push_back(formatted("%s: ends %.4g s before the sequence does, its last pose holds",
                                       options.file.c_str(), last_s - times.back()));
  if (last_s > 0 && findings.period_s() > last_s)
    trace.warnings.push_back(
        formatted("%s: a pose every %.4g s, and the sequence lasts %.4g s; are its stamps in the "
                  "unit of the format?",
                  options.file.c_str(), findings.period_s(), last_s));
}

/// The slope at each key of the parabola through it and its neighbours; at the ends that of the chord. Zero beside equal
/// keys would be a pause that nobody made, so nothing is limited.
template <typename T>
void add_slopes(layers::Keys<T>& keys) {
  const std::size_t n = keys.values.size();
  keys.interpolation = layers::Interpolation::CubicSpline;
  std::vector<T> chords;
  for (std::size_t i = 0; i + 1 < n; ++i)
    chords.push_back((keys.values[i + 1] - keys.values[i]) / (keys.times_s[i + 1] - keys.times_s[i]));
  for (std::size_t i = 0; i < n; ++i) {
    if (i == 0 || i + 1 == n) {
      keys.out_tangents.push_back(chords[i == 0 ? 0 : i - 1]);
      continue;
    }
    const double before_s = keys.times_s[i] - keys.times_s[i - 1],
                 after_s = keys.times_s[i + 1] - keys.times_s[i];
    keys.out_tangents.push_back((chords[i - 1] * after_s + chords[i] * before_s) / (before_s + after_s));
  }
  keys.in_tangents = keys.out_tangents;
}

}  // namespace

TraceFormat format_of_name(const std::string& file) {
  const std::filesystem::path path(file);
  std::string extension = path.extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 'a' - 'A') : c;
  if (extension == ".bvh") return TraceFormat::Bvh;
  if (extension == ".json") return TraceFormat::Iwer;
  if (extension == ".csv") return TraceFormat::Euroc;
  return path.filename() == "images.txt" ? TraceFormat::Colmap : TraceFormat::Tum;
}

const char* word_of(TraceFormat format) {
  switch (format) {
    case TraceFormat::Tum:
      return "tum";
    case TraceFormat::Euroc:
      return "euroc";
    case TraceFormat::Colmap:
      return "colmap";
    case TraceFormat::Iwer:
      return "iwer";
    case TraceFormat::Bvh:
      return "bvh";
  }
  return "";
}

std::string read_poses(const TraceOptions& options, const PoseSink& sink) {
  const TraceFormat format = options.format.value_or(format_of_name(options.file));
  require_options(options, format);
  TraceText text(options.file);
  switch (format) {
    case TraceFormat::Tum:
      read_tum(text, sink);
      break;
    case TraceFormat::Euroc:
      read_euroc(text, sink);
      break;
    case TraceFormat::Colmap:
      read_colmap(text, options.fps.value_or(1), sink);
      break;
    case TraceFormat::Iwer:
      read_iwer(text, sink);
      break;
    case TraceFormat::Bvh:
      return read_bvh(text, options.joint, options.fps, sink);
  }
  return {};
}

Trace read_trace(const TraceOptions& options, double last_s) {
  PoseKeeper keeper(options, last_s);
  PoseSieve sieve(options, [&](const TracePose& pose) { return keeper.take(pose); });
  const std::string remark = read_poses(options, [&](const RawPose& pose) { return sieve.add(pose); });
  sieve.finish();
  Trace trace = std::move(keeper).trace();
  trace.findings = sieve.findings();
  if (!remark.empty()) trace.warnings.push_back(options.file + ": " + remark);
  if (!options.missing.empty())
    trace.warnings.push_back(options.file + " stands in for a trace: " + options.missing);
  say_ends(options, last_s, trace);
  say_gaps(options, last_s, trace);
  say_jumps(options, last_s, trace);
  return trace;
}

TraceFindings look_through_trace(const TraceOptions& options) {
  PoseSieve sieve(options, [](const TracePose&) { return true; });
  const std::string remark = read_poses(options, [&](const RawPose& pose) { return sieve.add(pose); });
  sieve.finish();
  TraceFindings findings = sieve.findings();
  findings.remark = remark;
  return findings;
}

layers::TransformTrack track_of(Trace trace, Resampling resample) {
  layers::TransformTrack track;
  track.translation = std::move(trace.positions);
  track.rotation = std::move(trace.rotations);
  if (resample == Resampling::Cubic) add_slopes(track.translation), add_slopes(track.rotation);
  return track;
}

}  // namespace talisman::sequences
