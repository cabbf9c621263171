// SPDX-License-Identifier: Apache-2.0
// The tool: one program, a few commands. Everything it does is in the libraries; here are only the words.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include <oneapi/tbb/global_control.h>
#include <CLI/CLI.hpp>

#include "sequences/commands/accuracy.h"
#include "sequences/commands/inspect.h"
#include "sequences/commands/inspect_order.h"
#include "sequences/commands/options.h"
#include "sequences/commands/warps.h"
#include "sequences/pictures/diff.h"

namespace {

using namespace talisman::sequences;

std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

extern "C" void on_stop_signal(int) { stop_requested = true; }

void add_run_options(CLI::App& command, CommandLine& line) {
  command
      .add_option("sequence", line.sequence, "name of a sequence, path of its YAML file, or path of a model")
      ->required();
  command.add_option("--out", line.out, "result folder (out/<name>; plans: out/<name>-plan)");
  command.add_option("--frames", line.frames, "A-B, inclusive; the frames are those of the full run");
  command.add_option("--policy", line.policy,
                     "direct, reference, hold, interpolate, threshold, budget, lookahead or oracle");
  command.add_option("--geometric-px", line.geometric_px,
                     "threshold of the geometric fiducial, pixels; 0: reuse only what is identical");
  command.add_option("--photometric", line.photometric,
                     "threshold of the photometric fiducial, linear light, 1 is white; 0: not regulated");
  command.add_option("--light-angle-deg", line.light_angle_deg,
                     "threshold of the angle by which a light moves about a layer; 0: not regulated");
  command.add_option("--turned-px", line.turned_px,
                     "threshold of the size of a side that has turned to the eye, pixels; 0: not regulated");
  command.add_option("--color-warp", line.color_warp, "on, or off: as hardware without colour multipliers");
  command.add_option("--hold", line.hold, "N of the policies hold and interpolate");
  command.add_option("--lookahead", line.lookahead,
                     "N of the policy lookahead: frames ahead as of which a sprite may be drawn");
  command.add_option("--budget-polygons", line.budget_polygons,
                     "policy budget: triangles per frame; only first appearances may exceed it");
  command.add_option("--budget-pixels", line.budget_pixels,
                     "policy budget: sprite texels per frame, likewise");
  command.add_option("--budget-chunks", line.budget_chunks,
                     "policy budget: 32x32 chunks of sprites per frame, likewise");
  command.add_option("--budget-ms", line.budget_ms,
                     "policy budget: modelled render time per frame on talisman-1996, likewise");
  command.add_option("--min-resolution", line.min_resolution,
                     "policy budget: least resolution of sprites that must fit, (0, 1]; 1: never lowered");
  command.add_flag("--budget-gap", line.budget_gap,
                   "policy budget: also report the best choice of each frame, and what greedy misses");
  command.add_option("--predict", line.predict,
                     "policy lookahead: frames ahead are known, or linear: extrapolated from the last two");
  command.add_option("--cutoff-px", line.cutoff_px,
                     "policy budget: benefit up to which a layer is not drawn again, pixels");
  command.add_option("--warp", line.warp,
                     "warp curve: trn trni iso isoi so soi aff affi per peri per2 per2i pers pers2");
  command.add_option("--size", line.size, "display, WxH pixels");
  command.add_option("--bound", line.bound, "characteristic polyhedron: box8, dop14 or dop26");
  command.add_option(
      "--cycles", line.cycles,
      "layers that occlude each other in a cycle: merge (into one sprite) or keep (may be wrong)");
  command.add_option(
      "--compositor", line.compositor,
      "talisman: over only; extended: also out and plus with two image registers, so that layers "
      "that go round are not merged unless two of them meet");
  command.add_option("--expected-reuse", line.expected_reuse,
                     "frames for which clipped sprites are enlarged");
  command.add_option("--threads", line.threads,
                     "worker threads; 0: all cores. The bytes do not depend on it");
  command.add_option("--progress", line.progress, "auto, bar, plain or none");
  command.add_flag("--strict", line.strict, "what the content has and the picture lacks is an error");
}

void add_picture_options(CLI::App& command, CommandLine& line) {
  command.add_option("--format", line.format, "png, exr or none");
  command.add_option("--shading", line.shading, "flat, gouraud or phong");
  command.add_option("--resolution", line.resolution, "sprite texels per display pixel, each axis");
  command.add_option("--compression", line.compression,
                     "keep sprites compressed: quality 1 to 100 (about 10:1 at 85), 0: none");
  command.add_flag("--video", line.video, "also write video.mp4");
  command.add_flag("--separate", line.separate,
                   "also write each shade sprite alone, and the sum with its base (DIR/separate)");
  command.add_flag("--overlay", line.overlay, "draw each sprite's outline, coloured by age");
  command.add_flag("--quality", line.quality,
                   "PSNR, SSIM and FLIP of each frame against reference and direct (slow)");
  command.add_flag("--resume", line.resume, "continue a run that was stopped");
}

/// What the content has and the picture will lack, and what was decided about it.
void say_what_lacks(const Sequence& sequence, bool strict) {
  for (const std::string& warning : sequence.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  for (const std::string& note : sequence.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  if (strict && !sequence.warnings.empty())
    throw InputError(std::to_string(sequence.warnings.size()) + " warnings, rule with --strict: none",
                     sequence.file);
}

int run_sequence(const CommandLine& line, bool plan_only) {
  const Sequence sequence = load_sequence(line.sequence);
  say_what_lacks(sequence, line.strict);
  const ResolvedRun resolved = resolve(line, sequence, plan_only);
  std::unique_ptr<oneapi::tbb::global_control> threads;
  if (line.threads > 0)
    threads = std::make_unique<oneapi::tbb::global_control>(
        oneapi::tbb::global_control::max_allowed_parallelism, line.threads);
  const RunOutcome outcome = run(sequence, resolved.settings, resolved.options, stop_requested);
  if (!outcome.complete) {
    std::fprintf(stderr, "error: stopped after %zu frames; the same command with --resume continues\n",
                 outcome.summary.frames.size());
    return kPartialResult;
  }
  if (outcome.frames_kept > 0)
    std::printf("kept %d complete frames of an earlier run\n", outcome.frames_kept);
  std::printf("%s\nresults in %s\n", table_of(outcome.summary).c_str(), resolved.options.out.c_str());
  return kSuccess;
}

/// The visibility order as a run with the sequence's own settings has it.
std::string order_of(const Sequence& sequence, const CommandLine& line, bool json) {
  const ResolvedRun resolved = resolve(line, sequence, true);
  const OrderOverTime order = order_over_time(sequence, resolved.settings);
  return json ? order_json(sequence, order) : order_text(sequence, order);
}

int inspect_sequence(const CommandLine& line, const std::string& name, bool json, bool profile, bool order) {
  if (profile) std::fputs(profile_text().c_str(), stdout);
  if (name.empty()) {
    if (profile) return kSuccess;
    throw InputError("inspect needs a SEQUENCE, a MODEL or --profile");
  }
  const Sequence sequence = load_sequence(name);
  say_what_lacks(sequence, line.strict);
  const std::string text = order  ? order_of(sequence, line, json)
                           : json ? inspection_json(sequence)
                                  : inspection_text(sequence);
  std::fputs(text.c_str(), stdout);
  return kSuccess;
}

struct Commands {
  CLI::App app{"talisman: a simulator of layered sprite rendering"};
  CommandLine line;
  std::string inspected;
  bool json = false, profile = false, order = false;
  DiffOptions diff;
  WarpsOptions warps;
  AccuracyOptions accuracy;
  int exit_code = kSuccess;

  Commands() {
    app.require_subcommand(1);
    CLI::App* render = app.add_subcommand("render", "draw a sequence or a model");
    add_run_options(*render, line);
    add_picture_options(*render, line);
    render->callback([this] { exit_code = run_sequence(line, false); });

    CLI::App* plan = app.add_subcommand("plan", "the same decisions and costs, without pixels");
    add_run_options(*plan, line);
    plan->callback([this] { exit_code = run_sequence(line, true); });

    CLI::App* inspect =
        app.add_subcommand("inspect", "layers, polygons, memory and the effects called for, with reasons");
    inspect->add_option("sequence", inspected,
                        "name of a sequence, path of its YAML file, or path of a model");
    inspect->add_flag("--json", json, "print JSON");
    inspect->add_flag("--strict", line.strict, "what the content has and the picture lacks is an error");
    inspect->add_flag("--profile", profile, "print the hardware profile with the source of each number");
    inspect->add_flag("--order", order,
                      "the visibility order over time, what was merged and why, and what the sort cost");
    inspect->add_option("--cycles", line.cycles, "with --order: merge or keep");
    inspect->add_option("--compositor", line.compositor, "with --order: talisman or extended");
    inspect->callback([this] { exit_code = inspect_sequence(line, inspected, json, profile, order); });

    CLI::App* diff_command = app.add_subcommand("diff", "image error of two frames or folders of frames");
    diff_command->add_option("a", diff.a, "frame or folder under test")->required();
    diff_command->add_option("b", diff.b, "frame or folder of the truth")->required();
    diff_command->add_flag("--json", diff.json, "print JSON");
    diff_command->add_option("--map", diff.map_dir, "write FLIP error maps into this folder");
    diff_command->callback([this] { exit_code = run_diff(diff, std::cout); });
    add_experiments();
  }

  void add_experiments() {
    CLI::App* warps_command = app.add_subcommand(
        "warps", "update rate against error of every warp, and picture quality at one rate");
    warps_command->add_option("--object", warps.object, "name or file of one object (all)");
    warps_command->add_option("--bound", warps.bound, "characteristic polyhedron: box8, dop14 or dop26");
    warps_command->add_option("--out", warps.out, "result folder (out/warps)");
    warps_command->add_option("--progress", warps.progress, "auto, bar, plain or none");
    warps_command->callback([this] { exit_code = run_warps(warps, std::cout); });

    CLI::App* accuracy_command = app.add_subcommand("accuracy", "what accuracy costs in time");
    accuracy_command->add_flag("--solvers", accuracy.solvers,
                               "every solver of warps: time, error, stability");
    accuracy_command->add_option("--regulator", accuracy.regulator.sequence,
                                 "SEQUENCE or MODEL: every policy, cost and time against error and popping; "
                                 "fiducials against image error");
    accuracy_command->add_option("--renderer", accuracy.renderer,
                                 "SEQUENCE or MODEL: every knob and every effect of the renderer, time and "
                                 "counters against picture error");
    accuracy_command->add_option("--factoring", accuracy.factoring,
                                 "SEQUENCE: what it costs that the compositor has only over, predicted and "
                                 "measured, and what factoring saves");
    accuracy_command->add_option("--inputs", accuracy.inputs, "solvers: boxes per number of points");
    accuracy_command->add_option("--frames", accuracy.regulator.frames,
                                 "regulator, renderer, factoring: A-B, inclusive (all)");
    accuracy_command->add_option("--size", accuracy.regulator.size,
                                 "regulator, renderer, factoring: display, WxH (the sequence's, at most 512 "
                                 "in either direction)");
    accuracy_command->add_option(
        "--quality-every", accuracy.regulator.quality_every,
        "one frame of N is drawn and compared; 0: about 20 (regulator, factoring), 2 "
        "(renderer) in all");
    accuracy_command->add_option("--out", accuracy.out, "result folder (out/accuracy)");
    accuracy_command->add_option("--progress", accuracy.progress, "auto, bar, plain or none");
    accuracy_command->callback([this] { exit_code = run_accuracy(accuracy, std::cout); });
  }
};

int fail(const std::exception& error, int code) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return code;
}

}  // namespace

int main(int argc, char** argv) try {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGINT, on_stop_signal);
  std::signal(SIGTERM, on_stop_signal);
  Commands commands;
  try {
    commands.app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return commands.app.exit(help);
  } catch (const CLI::ParseError& error) {
    return fail(error, kBadInput);
  }
  return commands.exit_code;
} catch (const InputError& error) {
  return fail(error, kBadInput);
} catch (const PartialResult& error) {
  return fail(error, kPartialResult);
} catch (const std::exception& error) {
  return fail(error, kFailed);
}
