// SPDX-License-Identifier: Apache-2.0
#include "sequences/python/calls.h"

#include <optional>

#include <oneapi/tbb/global_control.h>

#include "sequences/commands/run_words.h"

namespace talisman::sequences {

namespace {

/// Words that mean nothing where no file is written, or say again what an argument says.
void refuse_others_words(const std::vector<std::string>& words, bool plan_only) {
  for (const std::string& word : words) {
    const std::string option = word.substr(0, word.find('='));
    for (const char* refused : {"--out", "--progress", "--format", "--video", "--separate", "--overlay",
                                "--quality", "--resume", "--force", "--help"})
      if (option == refused)
        throw InputError(option + " is about files or the terminal, must be said to the command talisman");
    if (option == "--frames" && !plan_only)
      throw InputError("--frames is a range, but one frame is drawn, must be frame");
  }
}

class Threads {
 public:
  explicit Threads(int threads) {
    using oneapi::tbb::global_control;
    if (threads > 0) limit_.emplace(global_control::max_allowed_parallelism, threads);
  }

 private:
  std::optional<oneapi::tbb::global_control> limit_;
};

}  // namespace

Call::Call(const std::string& sequence, const std::vector<std::string>& words, bool plan_only) {
  refuse_others_words(words, plan_only);
  const CommandLine line = command_line_from(sequence, words, plan_only);
  sequence_ = load_sequence(line.sequence, content_options(line));
  const ResolvedRun resolved = resolve(line, sequence_, plan_only);
  warnings_ = sequence_.warnings;
  require_none(warnings_, line.content.strict, sequence_.file);
  settings_ = resolved.settings;
  first_frame_ = resolved.options.first_frame;
  last_frame_ = resolved.options.last_frame;
  threads_ = line.threads;
}

void Call::plan(const BeforeFrame& before_frame, const Planned& planned) const {
  const Threads threads(threads_);
  const Pipeline pipeline = make_pipeline(*sequence_.scene, sequence_.layers, settings_);
  PipelineState state(pipeline);
  for (int frame = 0; frame <= last_frame_; ++frame) {
    before_frame();
    const FrameReport report = step(pipeline, state, frame, nullptr);
    if (frame >= first_frame_) planned(state, report);
  }
}

Image8 Call::draw(int frame, const BeforeFrame& before_frame) const {
  if (frame < 0 || frame >= sequence_.frames)
    throw InputError("frame is " + std::to_string(frame) + ", must be from 0 to " +
                     std::to_string(sequence_.frames - 1));
  const Threads threads(threads_);
  const Pipeline pipeline = make_pipeline(*sequence_.scene, sequence_.layers, settings_);
  const chunker::PreparedScene prepared(*sequence_.scene, settings_.render);
  PipelineState state(pipeline);
  for (int before = 0; before < frame; ++before) {
    before_frame();
    step(pipeline, state, before, nullptr);
  }
  before_frame();
  return to_image8(step(pipeline, state, frame, &prepared).picture);
}

}  // namespace talisman::sequences
