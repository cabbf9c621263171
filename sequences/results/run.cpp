// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/run.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include <nlohmann/json.hpp>

#include "sequences/files/atomic_file.h"
#include "sequences/files/frame_writer.h"
#include "sequences/files/line_file.h"
#include "sequences/files/video.h"
#include "sequences/pictures/overlay.h"
#include "sequences/results/separate_pictures.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const char* extension_of(FrameFormat format) {
  switch (format) {
    case FrameFormat::Png:
      return ".png";
    case FrameFormat::Exr:
      return ".exr";
    case FrameFormat::None:
      return "";
  }
  return "";
}

std::string frame_path(const RunOptions& options, int frame) {
  char name[32];
  std::snprintf(name, sizeof name, "%04d%s", frame, extension_of(options.format));
  return options.out + "/frames/" + name;
}

/// Everything that the bytes of the results depend on. A run can be resumed only with the same.
Json identity_of(const Sequence& sequence, const Settings& s, const RunOptions& o) {
  const regulator::RegulatorOptions& r = s.regulator;
  return {{"schema", "talisman.run/1"},
          {"sequence", sequence.name},
          {"frames", {o.first_frame, o.last_frame}},
          {"display_px", {s.view.display_px.x, s.view.display_px.y}},
          {"policy", regulator::name(r.policy)},
          {"geometric_px", r.geometric_px},
          {"hold_frames", r.hold_frames},
          {"lookahead", {r.lookahead_frames, s.frames}},
          {"predict", regulator::name(r.predict)},
          {"budget",
           {r.budget_polygons, r.budget_pixels, r.budget_chunks,
            std::isfinite(r.budget_ms) ? Json(r.budget_ms) : Json(nullptr), r.cutoff_px, r.min_resolution}},
          {"budget_gap", s.budget_gap},
          {"sampling", {r.magnification, r.minification, r.anisotropy}},
          {"uncovered_px", r.uncovered_px},
          {"warp", warp::name(s.curve)},
          {"bound", static_cast<int>(s.bound)},
          {"cycles", s.cycles == Cycles::Merge ? "merge" : "keep"},
          {"compositor", s.compositor == Compositor::Talisman ? "talisman" : "extended"},
          {"extents", {s.extents.expected_reuse_frames, s.extents.max_growth, s.view.clip_margin}},
          {"placement",
           {s.placement.slab_directions, s.placement.min_rotation_gain, s.placement.resolution_scale}},
          {"shading", static_cast<int>(s.render.shading)},
          {"compression", s.compression ? s.compression->quality : 0},
          {"format", static_cast<int>(o.format)},
          {"overlay", o.overlay},
          {"quality", o.quality}};
}

/// First entry in which two identities differ, as "geometric_px was 4, is 8"; empty if they are the same.
std::string first_difference(const Json& before, const Json& now) {
  for (const auto& [key, value] : now.items())
    if (!before.contains(key) || before[key] != value)
      return key + " was " + (before.contains(key) ? before[key].dump() : "absent") + ", is " + value.dump();
  return {};
}

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw OutputError(path + ": folder cannot be made: " + error.message());
}

/// Lines of frames that an earlier run completed, by frame.
std::map<int, FrameLine> complete_frames(const RunOptions& options, const Json& identity) {
  std::map<int, FrameLine> kept;
  const std::string run_file = options.out + "/run.json";
  const std::vector<std::string> identity_lines = lines_written(run_file);
  if (identity_lines.empty()) return kept;  // nothing was begun: start from the beginning
  const Json before = Json::parse(identity_lines.front(), nullptr, false);
  if (before.is_discarded()) throw InputError("not a run file, must be written by talisman", run_file);
  if (const std::string difference = first_difference(before, identity); !difference.empty())
    throw InputError(difference + ", --resume must continue with the same options", run_file);
  for (const std::string& text : lines_written(options.out + "/frames.jsonl")) {
    const std::optional<FrameLine> line = frame_line_from_json(text);
    if (!line || line->frame_hash.empty()) continue;
    if (options.format == FrameFormat::None || fs::exists(frame_path(options, line->frame)))
      kept[line->frame] = *line;
  }
  return kept;
}

/// What an earlier run left behind must not be taken for a result of this one. Pictures are removed only
/// where run.json says that the folder is ours, and only those with our names.
void remove_old_results(const RunOptions& options) {
  const bool ours = fs::exists(options.out + "/run.json");
  for (const char* name : {"summary.json", "frames.jsonl", "frames.jsonl.partial", "decisions.jsonl"})
    fs::remove(options.out + "/" + name);
  if (options.plan_only || !ours) return;
  fs::remove(options.out + "/video.mp4");
  for (const fs::directory_entry& entry : fs::directory_iterator(options.out + "/frames")) {
    const std::string stem = entry.path().stem().string(), extension = entry.path().extension().string();
    const bool numbered = !stem.empty() && stem.find_first_not_of("0123456789") == std::string::npos;
    if (numbered && (extension == ".png" || extension == ".exr")) fs::remove(entry.path());
  }
}

FrameQuality judge(const Pipeline& pipeline, const FrameReport& report,
                   const chunker::PreparedScene& prepared) {
  const Image8 shown = to_image8(report.picture);
  const Image8 reference = to_image8(draw_reference(pipeline, report.frame, prepared));
  const Image8 direct = to_image8(draw_direct(pipeline, report.frame, prepared));
  return {compare(shown, direct), compare(shown, reference), compare(reference, direct)};
}

Image8 with_outlines(const Pipeline& pipeline, const FrameReport& report) {
  std::vector<Outline> outlines;
  for (const ShownSprite& sprite : report.shown)
    outlines.push_back({sprite.screen_from_sprite, sprite.size_px, sprite.age_frames,
                        pipeline.layers.layers[sprite.layer].name + " " + std::to_string(sprite.age_frames)});
  Image8 image = to_image8(report.picture);
  draw_outlines(image, outlines);
  return image;
}

void write_picture(const Pipeline& pipeline, const FrameReport& report, const RunOptions& options) {
  const std::string path = frame_path(options, report.frame);
  switch (options.format) {
    case FrameFormat::Png:
      write_png(path, options.overlay ? with_outlines(pipeline, report) : to_image8(report.picture));
      break;
    case FrameFormat::Exr:
      write_exr(path, report.picture);
      break;
    case FrameFormat::None:
      break;
  }
}

/// The frames of one run, in order.
class Runner {
 public:
  Runner(const Sequence& sequence, const Settings& settings, const RunOptions& options)
      : options_(options), pipeline_(*sequence.scene, sequence.layers, settings), state_(pipeline_) {
    make_folder(options.out);
    if (!options.plan_only) make_folder(options.out + "/frames");
    if (options.separate) make_folder(options.out + "/separate");
    const Json identity = identity_of(sequence, settings, options);
    if (options.resume) kept_ = complete_frames(options, identity);
    if (kept_.empty()) remove_old_results(options);
    if (!options.plan_only) write_text_atomically(options.out + "/run.json", identity.dump() + "\n");
    std::vector<std::string> kept_lines;
    for (const auto& [frame, line] : kept_) kept_lines.push_back(json_of(line));
    decisions_ = std::make_unique<LineFile>(options.out + "/decisions.jsonl");
    frames_ = std::make_unique<LineFile>(options.out + "/frames.jsonl", kept_lines);
    summary_ = start_summary(pipeline_, sequence.name);
    summary_.planned_only = options.plan_only;
    if (!options.plan_only)
      prepared_ = std::make_unique<chunker::PreparedScene>(*sequence.scene, settings.render);
  }

  int frames_kept() const { return static_cast<int>(kept_.size()); }
  bool was_kept(int frame) const { return kept_.count(frame) > 0; }
  Summary& summary() { return summary_; }

  /// Plans frame `frame`; draws it where it is asked for and not there yet, and hands it over to be written.
  void advance(int frame) {
    const bool in_range = frame >= options_.first_frame && frame <= options_.last_frame;
    const auto kept = kept_.find(frame);
    const bool draw = in_range && kept == kept_.end() && prepared_;
    FrameReport report = step(pipeline_, state_, frame, draw ? prepared_.get() : nullptr);
    if (!in_range) return;
    const Pipeline& pipeline = with_aggregates(pipeline_, state_);
    add_decisions(summary_, pipeline, report, state_);
    for (const int layer : layers_with_lines(state_, report))
      decisions_->write(json_of(pipeline, report, report.plan.decisions[layer]));
    if (kept != kept_.end())
      writer_.submit([this, line = kept->second] { add_line(line); });
    else
      hand_over(std::move(report));
  }

  /// Waits until every frame that was drawn is complete. Before that the summary has no frames.
  void complete_frames_at_work() {
    writer_.finish();
    summary_.frames = lines_;
  }

  int frames_complete() const { return complete_; }

  void finish(double fps) {
    decisions_->finish();
    frames_->finish();
    if (options_.video)
      write_video(options_.out, fps, options_.format, options_.first_frame, options_.last_frame);
    write_text_atomically(options_.out + "/summary.json", json_of(summary_));
  }

 private:
  /// The frame is finished by the writer while the next one is drawn. Jobs are copied, pictures are not.
  void hand_over(FrameReport report) {
    std::optional<FrameQuality> quality;
    if (prepared_ && options_.quality) quality = judge(pipeline_, report, *prepared_);
    if (prepared_ && options_.separate)
      write_separate(with_aggregates(pipeline_, state_), state_, report, options_.out + "/separate");
    const auto shared = std::make_shared<const FrameReport>(std::move(report));
    // The aggregates may grow meanwhile; those of this frame stay as they are as long as they are held.
    writer_.submit([this, shared, quality, grown = state_.order.grown] {
      finish_frame(with_aggregates(pipeline_, grown.get()), *shared, quality);
    });
  }

  void finish_frame(const Pipeline& pipeline, const FrameReport& report,
                    const std::optional<FrameQuality>& quality) {
    FrameLine line = line_of(pipeline, report);
    line.quality = quality;
    if (prepared_) {
      const auto start = std::chrono::steady_clock::now();
      write_picture(pipeline, report, options_);
      line.io_ms =
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    }
    frames_->write(json_of(line));
    add_line(line);
  }

  void add_line(const FrameLine& line) {
    lines_.push_back(line);
    ++complete_;
  }

  const RunOptions& options_;
  Pipeline pipeline_;
  PipelineState state_;
  std::map<int, FrameLine> kept_;
  std::unique_ptr<LineFile> decisions_, frames_;
  std::unique_ptr<chunker::PreparedScene> prepared_;
  Summary summary_;
  std::vector<FrameLine> lines_;   ///< the writer's alone until it has finished
  std::atomic<int> complete_ = 0;  ///< how many those are
  FrameWriter writer_;             ///< last: its jobs use all the others
};

}  // namespace

RunOutcome run(const Sequence& sequence, const Settings& settings, const RunOptions& options,
               const std::atomic<bool>& stop) {
  Runner runner(sequence, settings, options);
  Progress progress(options.progress, options.plan_only ? "planned" : "rendered",
                    options.last_frame - options.first_frame + 1, runner.frames_kept());
  RunOutcome outcome;
  outcome.frames_kept = runner.frames_kept();
  try {
    for (int frame = 0; frame <= options.last_frame && !stop; ++frame) {
      runner.advance(frame);
      if (frame >= options.first_frame && !runner.was_kept(frame)) progress.advance();
    }
    runner.complete_frames_at_work();
  } catch (const OutputError& error) {
    const int complete = runner.frames_complete();
    if (complete == 0 || options.plan_only) throw;
    throw PartialResult(std::string(error.what()) + "; " + std::to_string(complete) +
                        (complete == 1 ? " frame is" : " frames are") +
                        " complete, the same command with --resume continues");
  }
  outcome.complete = !stop;
  if (outcome.complete) runner.finish(settings.fps);
  outcome.summary = std::move(runner.summary());
  return outcome;
}

}  // namespace talisman::sequences
