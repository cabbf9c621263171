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
#include "sequences/commands/export_command.h"
#include "sequences/commands/inspect.h"
#include "sequences/commands/inspect_order.h"
#include "sequences/commands/options.h"
#include "sequences/commands/run_words.h"
#include "sequences/commands/warps.h"
#include "sequences/pictures/diff.h"

namespace {

using namespace talisman::sequences;

std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

extern "C" void on_stop_signal(int) { stop_requested = true; }

int run_sequence(const CommandLine& line, bool plan_only) {
  const Sequence sequence = load_sequence(line.sequence);
  for (const std::string& warning : sequence.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
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
  for (const std::string& warning : sequence.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
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
  ExportOptions exported;
  std::string documented;
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
    add_exports();
    add_experiments();
  }

  void add_exports() {
    CLI::App* command = app.add_subcommand("export", "the results of a run in other forms");
    command->add_option("folder", exported.folder, "result folder of a render or plan")->required();
    command->add_flag("--csv", exported.csv, "flat tables: decisions, frames, timing, layers, effects, run");
    command->callback([this] { exit_code = run_export(exported, std::cout); });

    CLI::App* columns = app.add_subcommand("columns", "make the column tables of a Markdown file anew");
    columns->group("");  // for those who change a column; not in --help
    columns->add_option("file", documented)->required();
    columns->callback([this] { exit_code = update_column_tables(documented); });
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
