// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/command_tree.h"

#include <array>
#include <iostream>
#include <string>
#include <utility>

#include "sequences/commands/audit.h"
#include "sequences/commands/cache_options.h"
#include "sequences/commands/option_group.h"
#include "sequences/commands/render.h"
#include "sequences/commands/reproduce.h"
#include "sequences/commands/run_words.h"
#include "sequences/commands/split.h"
#include "sequences/commands/version.h"
#include "sequences/commands/words.h"
#include "sequences/pictures/page_assets.h"

namespace talisman::sequences {
namespace {

const std::string kProgressMeaning = alternatives(kProgressWords);
const std::string kBoundMeaning = "characteristic polyhedron: " + alternatives(kBoundWords);

struct Examples {
  const char* command;
  const char* first;
  const char* second;
};

constexpr std::array kExamples{
    Examples{"render", "talisman render carousel --frames 0-47 --size 640x480 --video",
             "talisman render model.glb --geometric-px 2 --overlay --out out/try"},
    Examples{"plan", "talisman plan carousel --geometric-px 2",
             "talisman plan carousel --policy budget --budget-ms 8"},
    Examples{"audit", "talisman audit carousel --frames 0-23",
             "talisman audit carousel --policy interpolate --hold 4 --every 1"},
    Examples{"explain", "talisman explain carousel --frame 17",
             "talisman explain out/carousel --frame 17 --layer 'horse 1'"},
    Examples{"view", "talisman view carousel", "talisman view model.glb --geometric-px 2 --port 8080"},
    Examples{"tune", "talisman tune carousel --flip 0.02 --frames 0-23 --size 160x120",
             "talisman tune carousel --budget-ms 8"},
    Examples{"inspect", "talisman inspect carousel --order", "talisman inspect model.glb --parts"},
    Examples{"motion", "talisman motion carousel --lookahead 16", "talisman motion model.glb --yaml"},
    Examples{"init", "talisman init model.glb > my.yaml", "talisman init model.glb --turntable 10 > my.yaml"},
    Examples{"diff", "talisman diff out/a/frames out/b/frames", "talisman diff a.png b.png --map out/map"},
    Examples{"export", "talisman export out/carousel --csv",
             "talisman export out/carousel --sqlite --trace --no-timing"},
    Examples{"merge", "talisman merge out/carousel", "talisman merge out/carousel --allow-partial"},
    Examples{"farm", "talisman farm slurm carousel --shards 4 --size 64x48 > submit",
             "talisman farm table --sweep sweep.yaml"},
    Examples{"report", "talisman report out/carousel", "talisman report out/a out/b --out compared.html"},
    Examples{"warps", "talisman warps --object vase", "talisman warps --bound dop14 --out out/warps-dop14"},
    Examples{"reproduce", "talisman reproduce --quick", "talisman reproduce --only LS97:22 LS97:23"},
    Examples{"accuracy", "talisman accuracy --solvers", "talisman accuracy --regulator carousel"},
};

/// At the foot of the help of each command.
void add_examples(CLI::App& app) {
  for (const Examples& examples : kExamples) {
    std::string text =
        "Behind the sign =: what holds where neither the option nor the sequence says it.\n\nExamples:\n";
    for (const char* example : {examples.first, examples.second})
      if (*example) text += std::string("  ") + example + "\n";
    app.get_subcommand(examples.command)->footer(text);
  }
}

}  // namespace

CommandTree::CommandTree(const std::atomic<bool>& stop)
    : app_("talisman: a simulator of layered sprite rendering") {
  app_.name("talisman");
  app_.require_subcommand(1);
  app_.set_version_flag("--version", version_text, "version, commit, effects built, instruction set");
  app_.add_flag_callback(
      "--licenses",
      [] {
        std::cout << "dygraphs, which draws the curves of reports:\n\n" << page_asset("dygraph.licence");
        throw CLI::Success();
      },
      "licences of what others wrote and this tool holds");
  add_runs(stop);
  add_explain();
  add_view(stop);
  add_tune(stop);
  add_compare(stop);
  add_inspect();
  add_motion();
  add_init();
  add_diff();
  add_exports();
  add_merge();
  add_farm(stop);
  add_warps();
  add_reproduce();
  add_accuracy();
  for (const char* command : {"render", "plan", "audit", "explain", "view", "tune", "compare", "inspect",
                              "motion", "init", "farm", "warps", "reproduce", "accuracy"})
    add_cache_options(*app_.get_subcommand(command), cache_);
  add_examples(app_);
}

void CommandTree::add_runs(const std::atomic<bool>& stop) {
  CLI::App* render = app_.add_subcommand("render", "draw a sequence or a model");
  add_run_options(*render, line_);
  add_picture_options(*render, line_);
  add_shard_options(*render, line_, false);
  render->callback([this, &stop] { exit_code_ = run_sequence(line_, false, stop, std::cout); });

  CLI::App* plan = app_.add_subcommand("plan", "the same decisions and costs, without pixels");
  add_run_options(*plan, line_);
  add_shard_options(*plan, line_, true);
  OptionGroup(*plan, "What if")
      .option("--split", split_,
              "name of a layer: plan again with each of its parts as a layer of its own, and print both");
  plan->callback([this, &stop] {
    exit_code_ =
        split_.empty() ? run_sequence(line_, true, stop, std::cout) : run_split(line_, split_, std::cout);
  });

  CLI::App* audit =
      app_.add_subcommand("audit", "were the fiducials right? Reused sprites are drawn fresh beside them");
  add_run_options(*audit, line_);
  add_audit_options(*audit, line_);
  audit->callback([this, &stop] { exit_code_ = run_audit(line_, stop, std::cout); });
}

void CommandTree::add_explain() {
  CLI::App* command = app_.add_subcommand(
      "explain", "why a layer was drawn in a frame, or was not: every fiducial against its limit");
  OptionGroup(*command, "Which")
      .option("--frame", explain_.frame, "number of the frame, from 0; required")
      .option(
          "--layer", explain_.layer,
          "name of a layer, of a merged one, or of a shadow map: all that is known of it, with a picture");
  add_decision_options(*command, explain_.line, "the pictures", "out/NAME-explain");
  command->callback([this, command] {
    for (const CLI::Option* option : command->get_options())
      if (option->count() > 0 && option->get_positional() == false && option->get_name() != "--frame" &&
          option->get_name() != "--layer")
        explain_.others.push_back(option->get_name());
    exit_code_ = run_explain(explain_, std::cout);
  });
}

void CommandTree::add_view(const std::atomic<bool>& stop) {
  CLI::App* command = app_.add_subcommand(
      "view", "plans and pictures in the browser, live: move a slider and watch; on 127.0.0.1 alone");
  OptionGroup(*command, "Server").option("--port", view_.port, "of 127.0.0.1; 0: any that is free", "0");
  add_decision_options(*command, view_.line, "flights that are saved", "out/NAME-view");
  add_drawing_options(*command, view_.line);
  command->callback([this, command, &stop] {
    view_.given = given_settings(*command);
    view_.controls = view_controls(*command);
    exit_code_ = run_view(view_, stop, std::cout);
  });
}

void CommandTree::add_tune(const std::atomic<bool>& stop) {
  CLI::App* command = app_.add_subcommand(
      "tune", "the cheapest thresholds that hold a quality, or the finest ones within a time");
  add_tune_options(*command, tune_);
  command->callback([this, &stop] { exit_code_ = run_tune(tune_, stop, std::cout); });
}

void CommandTree::add_compare(const std::atomic<bool>& stop) {
  CLI::App* command = app_.add_subcommand(
      "compare", "policies on the same frames: cost, time, error and popping, with a video side by side");
  add_compare_options(*command, compare_);
  command->callback([this, &stop] { exit_code_ = run_compare(compare_, stop, std::cout); });
}

void CommandTree::add_inspect() {
  CLI::App* command =
      app_.add_subcommand("inspect", "layers, polygons, memory and the effects called for, with reasons");
  OptionGroup(*command, "Options")
      .option("sequence", inspect_.sequence, "name of a sequence, path of its YAML file, or path of a model")
      .flag("--json", inspect_.json, "print JSON")
      .flag("--profile", inspect_.profile, "print the hardware profile with the source of each number")
      .flag(
          "--parts", inspect_.parts,
          "the tree of nodes: names of parts, polygons, sizes in metres, textures, what is not drawn, and a "
          "picture with the axes")
      .flag("--cells", inspect_.cells,
            "cells and portals: what lies in a cell, what can be seen from it; and a plan of what is seen in "
            "a frame")
      .option("--frame", inspect_.frame, "with --cells: of the plan", "0")
      .option("--out", inspect_.out, "with --parts or --cells: the picture",
              "out/NAME-parts.png, NAME-cells.svg")
      .flag("--order", inspect_.order,
            "the visibility order over time, what was merged and why, and what the sort cost")
      .flag("--factoring", inspect_.factoring,
            "which layers would cost least: what each split or merge would save, beside one layer per node "
            "and one "
            "for all; the layers as YAML to paste")
      .option("--max-layers", inspect_.max_layers, "with --factoring: propose no more than so many", "40")
      .flag("--motion", inspect_.motion,
            "SEQUENCE is the file of a trace of poses: its rate, length, speeds, gaps and jumps")
      .option("--format", inspect_.trace.format, "with --motion: tum, euroc, colmap, iwer or bvh",
              "by the name")
      .option("--joint", inspect_.trace.joint, "with --motion: of bvh, whose pose it is", "Head")
      .option("--fps", inspect_.trace.fps, "with --motion: of colmap, which has no times, and of bvh")
      .option("--scale", inspect_.trace.scale, "with --motion: metres per unit of the file", "1")
      .option("--cycles", inspect_.cycles, "with --order: " + alternatives(kCyclesWords))
      .option("--compositor", inspect_.compositor, "with --order: " + alternatives(kCompositorWords));
  add_content_options(*command, inspect_.content);
  command->callback([this] { exit_code_ = run_inspect(inspect_, std::cout); });
}

void CommandTree::add_motion() {
  CLI::App* command = app_.add_subcommand(
      "motion", "what moves when: parts that move as one, their changes, what a plan would draw");
  OptionGroup(*command, "Options")
      .option("sequence", motion_.sequence, "name of a sequence, path of its YAML file, or path of a model")
      .option("--geometric-px", motion_.geometric_px, "what moves by more has changed", "the sequence's")
      .option("--motion-norm", motion_.norm, "euclid, or axis: along x and along y", "euclid")
      .option("--lookahead", motion_.lookahead, "frames of a slice, a power of --tree-k", "32")
      .option("--tree-k", motion_.tree_k, "children of a node of the plan, at least 2", "2")
      .option("--size", motion_.size, "display, WxH", "the sequence's")
      .flag("--all", motion_.all, "all groups, however many")
      .flag("--json", motion_.json, "print JSON, with the words of every part")
      .flag("--csv", motion_.csv, "print CSV, a row for each part and slice")
      .flag("--yaml", motion_.yaml, "print the groups as layers to paste");
  add_content_options(*command, motion_.content);
  command->callback([this] { exit_code_ = run_motion(motion_, std::cout); });
}

void CommandTree::add_init() {
  CLI::App* command =
      app_.add_subcommand("init", "a sequence file to begin with, made from a model, on standard output");
  command->add_option("model", init_.model, "path of a model")->required();
  add_content_options(*command, init_.content);
  command->callback([this] { exit_code_ = run_init(init_, std::cout); });
}

void CommandTree::add_diff() {
  CLI::App* command = app_.add_subcommand("diff", "image error of two frames or folders of frames");
  command->add_option("a", diff_.a, "frame or folder under test")->required();
  command->add_option("b", diff_.b, "frame or folder of the truth")->required();
  command->add_flag("--json", diff_.json, "print JSON");
  command->add_option("--map", diff_.map_dir, "write FLIP error maps into this folder");
  command->callback([this] { exit_code_ = run_diff(diff_, std::cout); });
}

void CommandTree::add_exports() {
  CLI::App* command = app_.add_subcommand("export", "the results of a run in other forms");
  command->add_option("folder", export_.folder, "result folder of a render or plan")->required();
  command->add_flag("--csv", export_.csv, "flat tables: decisions, frames, timing, layers, effects, run");
  command->add_flag("--sqlite", export_.sqlite, "the same tables as one SQLite file, results.sqlite");
  command->add_flag("--trace", export_.trace,
                    "trace.json for Perfetto, chrome://tracing, speedscope: a track per layer, a slice per "
                    "sprite's life");
  command->add_flag("--no-timing", export_.no_timing,
                    "leave out what was measured: the same bytes on every machine");
  command->callback([this] { exit_code_ = run_export(export_, std::cout); });

  CLI::App* report = app_.add_subcommand("report", "a run as a page, or two beside each other");
  report->add_option("folder", report_.folders, "result folder of a render or plan; a second one to compare")
      ->required()
      ->expected(1, 2);
  report->add_option("--out", report_.out, "file of the page =report.html in the first folder");
  report->add_flag("--no-thumbnails", report_.no_thumbnails, "no pictures of frames");
  report->callback([this] { exit_code_ = run_report(report_, std::cout); });

  CLI::App* columns = app_.add_subcommand("columns", "make the column tables of a Markdown file anew");
  columns->group("");  // for those who change a column; not in --help
  columns->add_option("file", documented_)->required();
  columns->callback([this] { exit_code_ = update_column_tables(documented_); });
}

void CommandTree::add_merge() {
  CLI::App* command =
      app_.add_subcommand("merge", "the parts that render or plan --shard made become one run");
  command->add_option("folder", merge_.out, "the --out of the parts: they lie in DIR/shards")->required();
  command->add_flag(
      "--allow-partial", merge_.allow_partial,
      "leave out what is missing, unfinished or damaged: DIR is then as an interrupted run left it");
  command->add_flag("--force", merge_.force, "write into DIR though it holds files that are not of a run");
  command->add_flag("--quiet", merge_.quiet, "no table; warnings and errors alone");
  command->callback([this] { exit_code_ = run_merge(merge_, std::cout); });
}

void CommandTree::add_farm(const std::atomic<bool>& stop) {
  CLI::App* command = app_.add_subcommand(
      "farm", "scripts for a cluster's queue, and sweeps of settings; submits nothing itself");
  command
      ->add_option(
          "action", farm_.action,
          "slurm: print a script that submits; list: the tasks of a sweep; run: one of them; table: collect")
      ->required();
  command->add_option("sequence", farm_.sequence,
                      "slurm: what is drawn; options of render or plan go with it");
  command->allow_extras();
  OptionGroup(*command, "Options")
      .option("--shards", farm_.shards, "ranges into which the frames of a run are cut", "1")
      .option("--sweep", farm_.sweep, "YAML file: sequences and settings (docs/scale.md)")
      .option("--out", farm_.out, "slurm SEQUENCE: result folder", "out/NAME")
      .option("--command", farm_.command, "slurm SEQUENCE: render or plan", farm_.command)
      .option("--at-most", farm_.at_most, "tasks at once; 0: as many as there is room for", "0")
      .option("--cpus", farm_.cpus, "of a task: its threads", "1")
      .flag("--by-cost", farm_.by_cost,
            "slurm SEQUENCE: first a job that plans; shards are then ranges that cost the same")
      .option("--task", farm_.task, "run: number of the task, from 0");
  command->callback([this, command, &stop] {
    farm_.options = command->remaining();
    exit_code_ = run_farm(farm_, stop, std::cout);
  });
}

void CommandTree::add_warps() {
  CLI::App* command = app_.add_subcommand(
      "warps", "update rate against error of every warp, and picture quality at one rate");
  OptionGroup(*command, "Options")
      .option("--object", warps_.object, "name or file of one object", "all")
      .option("--bound", warps_.bound, kBoundMeaning, warps_.bound)
      .option("--out", warps_.out, "result folder", warps_.out)
      .option("--progress", warps_.progress, kProgressMeaning, warps_.progress);
  command->callback([this] { exit_code_ = run_warps(warps_, std::cout); });
}

void CommandTree::add_reproduce() {
  CLI::App* command = app_.add_subcommand(
      "reproduce", "what papers say beside what comes out here, with a rule for each row");
  add_reproduce_options(*command, reproduce_);
  command->callback([this] { exit_code_ = run_reproduce(reproduce_, std::cout); });
}

namespace {

void add_experiments(CLI::App& command, AccuracyOptions& options) {
  OptionGroup(command, "What is measured, one of")
      .flag("--solvers", options.solvers, "every solver of warps: time, error, stability")
      .option("--regulator", options.regulator,
              "SEQUENCE or MODEL: every policy, cost and time against error and popping; fiducials against "
              "image error")
      .option("--renderer", options.renderer,
              "SEQUENCE or MODEL: every knob and every effect of the renderer, time and counters against "
              "picture error")
      .option("--factoring", options.factoring,
              "SEQUENCE: what it costs that the compositor has only over, predicted and measured, and what "
              "factoring saves")
      .option("--predictive", options.predictive,
              "SEQUENCE: buffers that parts share by their motion, beside sprites: cost, bytes and time "
              "against error")
      .option("--amortised", options.amortised,
              "SEQUENCE: layers that share sprites while it runs, beside the author's, one per part and one "
              "for all")
      .option("--latency", options.latency,
              "SEQUENCE: how far points are off by the age of the camera's pose, held, linear, kalman; and "
              "what a last warp saves")
      .option(
          "--lod", options.lod,
          "SEQUENCE: selectors of levels of detail: how even the times of frames are, against the picture")
      .option("--culling", options.culling,
              "SEQUENCE: trees, octrees and a flat scan that find what is in view: time, nodes, tests")
      .option("--visibility", options.visibility,
              "SEQUENCE: what each way of finding what can be seen leaves and costs")
      .option("--memory", options.memory,
              "SEQUENCE: levels skipped and bytes read, over frames looked ahead, culls and memory")
      .flag("--hard", options.hard,
            "cases of every stage that a careless one gets wrong, each with its rule; exit code 1 if one is "
            "broken");
}

void add_experiment_options(CLI::App& command, AccuracyOptions& options) {
  OptionGroup(command, "Options")
      .option("--memory-mb", options.of_sequence.memory_mb, "memory: room for descriptions, MB", "12")
      .option("--io-mb-per-s", options.of_sequence.io_mb_per_s, "memory: what can be read, MB/s", "0.45")
      .option("--warp-ms", options.of_sequence.warp_ms, "latency: age of the pose of the last warp, ms", "0")
      .option("--inputs", options.inputs, "solvers: boxes per number of points",
              std::to_string(options.inputs))
      .option("--frames", options.of_sequence.frames, "regulator, renderer, factoring: A-B, inclusive", "all")
      .option("--size", options.of_sequence.size,
              "regulator, renderer, factoring: display, WxH (the sequence's, at most " +
                  std::to_string(kLargestDefault_px) + " in either direction; memory: 1280x1024)")
      .option("--quality-every", options.of_sequence.quality_every,
              "one frame of N is drawn and compared; 0: about 20 (regulator, factoring), 2 (renderer) in all")
      .flag("--no-report", options.of_sequence.no_report,
            "regulator: no page for each run that was measured; the points of its plots open nothing")
      .option("--out", options.out, "result folder", options.out)
      .option("--progress", options.progress, kProgressMeaning, options.progress);
}

}  // namespace

void CommandTree::add_accuracy() {
  CLI::App* command = app_.add_subcommand("accuracy", "what accuracy costs in time");
  add_experiments(*command, accuracy_);
  add_experiment_options(*command, accuracy_);
  command->callback([this] { exit_code_ = run_accuracy(accuracy_, std::cout); });
}

}  // namespace talisman::sequences
