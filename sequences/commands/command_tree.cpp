// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/command_tree.h"

#include <iostream>
#include <string>
#include <utility>

#include "sequences/commands/cache_options.h"
#include "sequences/commands/render.h"
#include "sequences/commands/version.h"
#include "sequences/commands/words.h"

namespace talisman::sequences {
namespace {

/// The options of a command that stand under one heading of its help.
class Options {
 public:
  Options(CLI::App& command, std::string heading) : command_(command), heading_(std::move(heading)) {}

  template <typename T>
  Options& option(const char* name, T& value, const std::string& meaning) {
    command_.add_option(name, value, meaning)->group(heading_);
    return *this;
  }
  Options& flag(const char* name, bool& value, const std::string& meaning) {
    command_.add_flag(name, value, meaning)->group(heading_);
    return *this;
  }

 private:
  CLI::App& command_;
  std::string heading_;
};

const std::string kProgressMeaning = alternatives(kProgressWords);
const std::string kBoundMeaning = "characteristic polyhedron: " + alternatives(kBoundWords);

void add_run(CLI::App& command, CommandLine& line) {
  command
      .add_option("sequence", line.sequence, "name of a sequence, path of its YAML file, or path of a model")
      ->required();
  Options(command, "Run")
      .option("--out", line.out, "result folder (out/<name>; plans: out/<name>-plan)")
      .option("--frames", line.frames, "A-B, inclusive; the frames are those of the full run")
      .option("--size", line.size, "display, WxH pixels")
      .option("--threads", line.threads, "worker threads; 0: all cores. The bytes do not depend on it")
      .option("--progress", line.progress, kProgressMeaning);
}

void add_policy(CLI::App& command, CommandLine& line) {
  Options(command, "Policy")
      .option("--policy", line.policy, alternatives(kPolicyWords))
      .option("--hold", line.hold, "N of the policies hold and interpolate")
      .option("--lookahead", line.lookahead,
              "N of the policy lookahead: frames ahead as of which a sprite may be drawn")
      .option("--predict", line.predict,
              "policy lookahead: frames ahead are known, or linear: extrapolated from the last two");
}

void add_thresholds(CLI::App& command, CommandLine& line) {
  Options(command, "Thresholds")
      .option("--geometric-px", line.geometric_px,
              "threshold of the geometric fiducial, pixels; 0: reuse only what is identical")
      .option("--photometric", line.photometric,
              "threshold of the photometric fiducial, linear light, 1 is white; 0: not regulated")
      .option("--light-angle-deg", line.light_angle_deg,
              "threshold of the angle by which a light moves about a layer; 0: not regulated")
      .option("--turned-px", line.turned_px,
              "threshold of the size of a side that has turned to the eye, pixels; 0: not regulated");
}

void add_budget(CLI::App& command, CommandLine& line) {
  Options(command, "Budget")
      .option("--budget-polygons", line.budget_polygons,
              "policy budget: triangles per frame; only first appearances may exceed it")
      .option("--budget-pixels", line.budget_pixels, "policy budget: sprite texels per frame, likewise")
      .option("--budget-chunks", line.budget_chunks,
              "policy budget: 32x32 chunks of sprites per frame, likewise")
      .option("--budget-ms", line.budget_ms,
              "policy budget: modelled render time per frame on talisman-1996, likewise")
      .option("--min-resolution", line.min_resolution,
              "policy budget: least resolution of sprites that must fit, (0, 1]; 1: never lowered")
      .option("--cutoff-px", line.cutoff_px,
              "policy budget: benefit up to which a layer is not drawn again, pixels")
      .flag("--budget-gap", line.budget_gap,
            "policy budget: also report the best choice of each frame, and what greedy misses");
}

void add_layers(CLI::App& command, CommandLine& line) {
  Options(command, "Layers")
      .option("--warp", line.warp,
              "warp curve: trn trni iso isoi so soi aff affi per peri per2 per2i pers pers2")
      .option("--color-warp", line.color_warp, "on, or off: as hardware without colour multipliers")
      .option("--bound", line.bound, kBoundMeaning)
      .option("--cycles", line.cycles,
              "layers that occlude each other in a cycle: merge (into one sprite) or keep (may be wrong)")
      .option("--compositor", line.compositor,
              "talisman: over only; extended: also out and plus with two image registers, so that layers "
              "that go round are not merged unless two of them meet")
      .option("--expected-reuse", line.expected_reuse, "frames for which clipped sprites are enlarged");
}

void add_pictures(CLI::App& command, CommandLine& line) {
  Options(command, "Pictures")
      .option("--format", line.format, alternatives(kFormatWords))
      .option("--shading", line.shading, alternatives(kShadingWords))
      .option("--resolution", line.resolution, "sprite texels per display pixel, each axis")
      .option("--compression", line.compression,
              "keep sprites compressed: quality 1 to 100 (about 10:1 at 85), 0: none")
      .flag("--video", line.video, "also write video.mp4")
      .flag("--separate", line.separate,
            "also write each shade sprite alone, and the sum with its base (DIR/separate)")
      .flag("--overlay", line.overlay, "draw each sprite's outline, coloured by age")
      .flag("--quality", line.quality,
            "PSNR, SSIM and FLIP of each frame against reference and direct (slow)")
      .flag("--resume", line.resume, "continue a run that was stopped");
}

void add_decisions(CLI::App& command, CommandLine& line) {
  add_policy(command, line);
  add_thresholds(command, line);
  add_budget(command, line);
  add_layers(command, line);
}

}  // namespace

CommandTree::CommandTree(const std::atomic<bool>& stop)
    : app_("talisman: a simulator of layered sprite rendering") {
  app_.name("talisman");
  app_.require_subcommand(1);
  app_.set_version_flag("--version", version_text, "version, commit, effects built, instruction set");
  add_runs(stop);
  add_inspect();
  add_diff();
  add_warps();
  add_accuracy();
  for (const char* command : {"render", "plan", "inspect", "warps", "accuracy"})
    add_cache_options(*app_.get_subcommand(command), cache_);
}

void CommandTree::add_runs(const std::atomic<bool>& stop) {
  CLI::App* render = app_.add_subcommand("render", "draw a sequence or a model");
  add_run(*render, line_);
  add_decisions(*render, line_);
  add_pictures(*render, line_);
  render->callback([this, &stop] { exit_code_ = run_sequence(line_, false, stop, std::cout); });

  CLI::App* plan = app_.add_subcommand("plan", "the same decisions and costs, without pixels");
  add_run(*plan, line_);
  add_decisions(*plan, line_);
  plan->callback([this, &stop] { exit_code_ = run_sequence(line_, true, stop, std::cout); });
}

void CommandTree::add_inspect() {
  CLI::App* command =
      app_.add_subcommand("inspect", "layers, polygons, memory and the effects called for, with reasons");
  Options(*command, "Options")
      .option("sequence", inspect_.sequence, "name of a sequence, path of its YAML file, or path of a model")
      .flag("--json", inspect_.json, "print JSON")
      .flag("--profile", inspect_.profile, "print the hardware profile with the source of each number")
      .flag("--order", inspect_.order,
            "the visibility order over time, what was merged and why, and what the sort cost")
      .option("--cycles", inspect_.cycles, "with --order: " + alternatives(kCyclesWords))
      .option("--compositor", inspect_.compositor, "with --order: " + alternatives(kCompositorWords));
  command->callback([this] { exit_code_ = run_inspect(inspect_, std::cout); });
}

void CommandTree::add_diff() {
  CLI::App* command = app_.add_subcommand("diff", "image error of two frames or folders of frames");
  command->add_option("a", diff_.a, "frame or folder under test")->required();
  command->add_option("b", diff_.b, "frame or folder of the truth")->required();
  command->add_flag("--json", diff_.json, "print JSON");
  command->add_option("--map", diff_.map_dir, "write FLIP error maps into this folder");
  command->callback([this] { exit_code_ = run_diff(diff_, std::cout); });
}

void CommandTree::add_warps() {
  CLI::App* command = app_.add_subcommand(
      "warps", "update rate against error of every warp, and picture quality at one rate");
  Options(*command, "Options")
      .option("--object", warps_.object, "name or file of one object (all)")
      .option("--bound", warps_.bound, kBoundMeaning)
      .option("--out", warps_.out, "result folder (out/warps)")
      .option("--progress", warps_.progress, kProgressMeaning);
  command->callback([this] { exit_code_ = run_warps(warps_, std::cout); });
}

void CommandTree::add_accuracy() {
  CLI::App* command = app_.add_subcommand("accuracy", "what accuracy costs in time");
  Options(*command, "What is measured, one of")
      .flag("--solvers", accuracy_.solvers, "every solver of warps: time, error, stability")
      .option("--regulator", accuracy_.regulator.sequence,
              "SEQUENCE or MODEL: every policy, cost and time against error and popping; fiducials against "
              "image error")
      .option("--renderer", accuracy_.renderer,
              "SEQUENCE or MODEL: every knob and every effect of the renderer, time and counters against "
              "picture error")
      .option("--factoring", accuracy_.factoring,
              "SEQUENCE: what it costs that the compositor has only over, predicted and measured, and what "
              "factoring saves");
  Options(*command, "Options")
      .option("--inputs", accuracy_.inputs, "solvers: boxes per number of points")
      .option("--frames", accuracy_.regulator.frames, "regulator, renderer, factoring: A-B, inclusive (all)")
      .option("--size", accuracy_.regulator.size,
              "regulator, renderer, factoring: display, WxH (the sequence's, at most " +
                  std::to_string(kLargestDefault_px) + " in either direction)")
      .option("--quality-every", accuracy_.regulator.quality_every,
              "one frame of N is drawn and compared; 0: about 20 (regulator, factoring), 2 (renderer) in all")
      .option("--out", accuracy_.out, "result folder (out/accuracy)")
      .option("--progress", accuracy_.progress, kProgressMeaning);
  command->callback([this] { exit_code_ = run_accuracy(accuracy_, std::cout); });
}

}  // namespace talisman::sequences
