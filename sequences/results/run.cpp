// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/run.h"

#include <cstdio>
#include <map>
#include <memory>
#include <span>

#include <nlohmann/json.hpp>

#include "sequences/files/atomic_file.h"
#include "sequences/files/folder_lock.h"
#include "sequences/files/frame_writer.h"
#include "sequences/files/line_file.h"
#include "sequences/files/video.h"
#include "sequences/pictures/outlined_frame.h"
#include "sequences/pipeline/aggregates.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/open_seams.h"
#include "sequences/pipeline/step.h"
#include "sequences/pipeline/stopwatch.h"
#include "sequences/results/audit.h"
#include "sequences/results/column_tables.h"
#include "sequences/results/decision_lines.h"
#include "sequences/results/exports/sprite_channels.h"
#include "sequences/results/kept_pictures.h"
#include "sequences/results/memory/memory_need.h"
#include "sequences/results/report/changes.h"
#include "sequences/results/run_folder.h"
#include "sequences/results/run_identity.h"
#include "sequences/results/separate_pictures.h"
#include "sequences/results/timing.h"

namespace talisman::sequences {

namespace {

FrameQuality judge(const Pipeline& pipeline, const FrameReport& report,
                   const chunker::PreparedScene& prepared) {
  const Image8 shown = to_image8(report.picture);
  const Image8 reference = to_image8(draw_reference(pipeline, report.frame, prepared));
  const Image8 direct = to_image8(draw_direct(pipeline, report.frame, prepared));
  return {compare(shown, direct), compare(shown, reference), compare(reference, direct)};
}

/// A frame's picture, ready for the disk.
struct FramePicture {
  std::optional<EncodedPicture> encoded;  ///< none: frames are not written
  double ms = 0;                          ///< it took
};

FramePicture encoded_picture(const FrameReport& report, const RunOptions& options,
                             const std::shared_ptr<const SpriteChannels>& channels) {
  const Stopwatch watch;
  FramePicture picture;
  switch (options.format) {
    case FrameFormat::Png:
      picture.encoded = encoded_png(options.overlay ? with_outlines(report) : to_image8(report.picture));
      break;
    case FrameFormat::Exr:
      picture.encoded = encoded_exr(report.picture);
      break;
    case FrameFormat::ExrLayers:
      picture.encoded = encoded_exr(report.picture, *channels);
      break;
    case FrameFormat::None:
      break;
  }
  picture.ms = watch.ms();
  return picture;
}

std::optional<ContentHash> hash_of_picture(const FramePicture& picture) {
  return picture.encoded ? std::optional(hash_of(std::span<const std::uint8_t>(picture.encoded->bytes)))
                         : std::nullopt;
}

/// The frames of one run, in order.
class Runner {
 public:
  Runner(const Sequence& sequence, const Settings& settings, const RunOptions& options)
      : options_(options),
        lock_(checked(options).out),
        pipeline_(make_pipeline(*sequence.scene, sequence.layers, settings)),
        state_(pipeline_) {
    KeptRun kept = begin_run(options, run_json(sequence, settings, options));
    if (options.progress != ProgressKind::None && !kept.news.empty())
      std::fprintf(stderr, "%s\n", kept.news.c_str());
    kept_ = std::move(kept.frames);
    if (options.decisions != DecisionLines::None)
      decisions_ = std::make_unique<LineFile>(options.out + "/decisions.jsonl");
    frames_ = std::make_unique<LineFile>(options.out + "/frames.jsonl", lines_of(kept_));
    timing_ = std::make_unique<LineFile>(options.out + "/timing.jsonl", kept.timing);
    if (options.changes) changes_ = std::make_unique<LineFile>(options.out + "/changes.jsonl");
    timing_->write(process_json());
    summary_ = start_summary(pipeline_, sequence.name);
    summary_.planned_only = options.plan_only;
    if (options.audit_every > 0) auditor_.emplace(options.audit_every, options.out + "/audit");
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
    if (changes_) write_changes(report, in_range);
    if (!in_range && frame < options_.first_frame && options_.part_of_run_from &&
        frame >= *options_.part_of_run_from)
      note_decisions(report);
    if (!in_range) return;
    add_decisions(summary_, report, state_);
    write_decisions(report);
    if (kept != kept_.end())
      writer_.submit([this, line = kept->second] { add_line(line); });
    else
      hand_over(std::move(report));
  }

  /// Waits until every frame that was drawn is complete. Before that the summary has no frames.
  void complete_frames_at_work() {
    writer_.finish();
    summary_.earlier = sums_;
  }

  int frames_complete() const { return complete_; }

  void finish() {
    if (auditor_) summary_.audit = auditor_->finish();
    if (decisions_) decisions_->finish();
    if (changes_) changes_->finish();
    finish_frame_lines();
    timing_->write(total_timing_json(summary_));
    timing_->finish();
    write_text_atomically(options_.out + "/summary.json", json_of(summary_));
  }

  /// Why there is none; empty: there is one.
  std::string make_video(double fps) const try {
    write_video(options_.out, fps, options_.format, options_.first_frame, options_.last_frame);
    return {};
  } catch (const OutputError& error) {
    return error.what();
  }

 private:
  void write_decisions(const FrameReport& report) {
    if (!decisions_) return;
    filter_.begin_frame();
    for (const DecisionRow& row : decision_rows(state_, report))
      if (filter_.has_line(row)) decisions_->write(json_of(row));
  }

  /// Of a frame whose lines another part of the run has: whether those of the next one have changed is seen by them.
  void note_decisions(const FrameReport& report) {
    if (!decisions_) return;
    filter_.begin_frame();
    for (const DecisionRow& row : decision_rows(state_, report)) filter_.has_line(row);
  }

  /// What cannot succeed ends before the folder is touched.
  static const RunOptions& checked(const RunOptions& options) {
    if (options.video) require_video_encoder();
    require_places(options);
    return options;
  }

  void write_changes(const FrameReport& report, bool in_range) {
    if (in_range)
      for (const Change& change : changes_in(pipeline_, report, renders_)) changes_->write(json_of(change));
    renders_.note(report);
  }

  static std::vector<std::string> lines_of(const std::map<int, FrameLine>& frames) {
    std::vector<std::string> lines;
    for (const auto& [frame, line] : frames) lines.push_back(json_of(line));
    return lines;
  }

  /// Frames that were drawn later than others behind them, because their picture was missing, get their place.
  void finish_frame_lines() {
    if (!kept_.empty()) {
      const std::string path = options_.out + "/frames.jsonl";
      std::map<int, FrameLine> in_order;
      for (const std::string& text : lines_written(path))
        if (const auto line = frame_line_from_json(text)) in_order[line->frame] = *line;
      frames_ = std::make_unique<LineFile>(path, lines_of(in_order));
    }
    frames_->finish();
  }

  /// The frame is finished by the writer while the next ones are drawn and encoded. Jobs are copied, pictures are not.
  void hand_over(FrameReport report) {
    std::optional<FrameQuality> quality;
    std::optional<std::int64_t> open_seam_pixels;
    if (prepared_ && options_.quality) {
      quality = judge(pipeline_, report, *prepared_);
      if (!seams_) seams_.emplace(pipeline_);
      open_seam_pixels = seams_->open_in(state_, report, *prepared_);
    }
    std::vector<std::string> separate;
    if (prepared_ && options_.separate)
      separate = write_separate(pipeline_, state_, report, options_.out + "/separate");
    if (prepared_ && auditor_) auditor_->look(pipeline_, state_, report, *prepared_);
    std::shared_ptr<const SpriteChannels> channels;
    if (prepared_ && options_.format == FrameFormat::ExrLayers)
      channels = std::make_shared<const SpriteChannels>(sprite_channels(pipeline_, state_, report));
    const auto shared = std::make_shared<const FrameReport>(std::move(report));
    if (!prepared_) return writer_.submit([this, shared] { finish_frame(line_of(*shared)); });
    writer_.submit_prepared([this, shared, quality, open_seam_pixels, channels,
                             separate]() -> FrameWriter::Job {
      FrameLine line = line_of(*shared);
      line.quality = quality;
      line.open_seam_pixels = open_seam_pixels;
      const auto picture = std::make_shared<const FramePicture>(encoded_picture(*shared, options_, channels));
      if (picture->encoded || !separate.empty())
        line.picture_hash = picture_hash(options_, hash_of_picture(*picture), separate);
      return [this, line, picture] { finish_frame(line, *picture); };
    });
  }

  void finish_frame(FrameLine line, const FramePicture& picture = {}) {
    const Stopwatch watch;
    if (picture.encoded) write_encoded(frame_path(options_, line.frame), *picture.encoded);
    if (prepared_) line.times.io_ms = picture.ms + watch.ms();
    timing_->write(timing_json(line));
    frames_->write(json_of(line));  // last: with it the frame is complete
    add_line(line);
  }

  void add_line(const FrameLine& line) {
    sums_.add(line);
    ++complete_;
  }

  const RunOptions& options_;
  DecisionFilter filter_{options_.decisions};
  FolderLock lock_;
  Pipeline pipeline_;
  PipelineState state_;
  std::optional<SeamCounter> seams_;
  std::map<int, FrameLine> kept_;
  std::unique_ptr<LineFile> decisions_, frames_, timing_,
      changes_;          ///< the first and the last only where asked for
  LastRenders renders_;  ///< likewise
  std::unique_ptr<chunker::PreparedScene> prepared_;
  std::optional<Auditor> auditor_;
  Summary summary_;
  FrameTotals sums_;               ///< of the frames complete; the writer's alone until it has finished
  std::atomic<int> complete_ = 0;  ///< how many those are
  FrameWriter writer_;             ///< last: its jobs use all the others
};

}  // namespace

RunOutcome run(const Sequence& sequence, const Settings& settings, const RunOptions& options,
               const std::atomic<bool>& stop) {
  if (const std::string words = memory_words(sequence, settings, options); !words.empty())
    std::fprintf(stderr, "warning: %s\n", words.c_str());
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
    outcome.complete = !stop;
    if (outcome.complete) runner.finish();
  } catch (const OutputError& error) {
    const int complete = runner.frames_complete();
    if (complete == 0 || options.plan_only) throw;
    throw PartialResult(std::string(error.what()) + "; " + std::to_string(complete) +
                        (complete == 1 ? " frame is" : " frames are") +
                        " complete, the same command with --resume continues");
  }
  if (outcome.complete && options.video) outcome.without_video = runner.make_video(settings.fps);
  outcome.summary = std::move(runner.summary());
  return outcome;
}

}  // namespace talisman::sequences
