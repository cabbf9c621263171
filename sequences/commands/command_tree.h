// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The words of the tool: its commands and their options, what they mean, and what each command runs.

#include <atomic>

#include <CLI/CLI.hpp>

#include "sequences/commands/accuracy.h"
#include "sequences/commands/cache_options.h"
#include "sequences/commands/compare.h"
#include "sequences/commands/diff_command.h"
#include "sequences/commands/explain.h"
#include "sequences/commands/export_command.h"
#include "sequences/commands/fan_out/farm_command.h"
#include "sequences/commands/fan_out/shard_command.h"
#include "sequences/commands/init.h"
#include "sequences/commands/inspect.h"
#include "sequences/commands/motion/motion_command.h"
#include "sequences/commands/options.h"
#include "sequences/commands/report_command.h"
#include "sequences/commands/reproduce.h"
#include "sequences/commands/tune.h"
#include "sequences/commands/view.h"
#include "sequences/commands/warps.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {

class CommandTree {
 public:
  /// A run stops between two frames once `stop` is true.
  explicit CommandTree(const std::atomic<bool>& stop);
  CommandTree(const CommandTree&) = delete;
  CommandTree& operator=(const CommandTree&) = delete;

  /// Its parse() runs the command.
  CLI::App& app() { return app_; }
  /// Of the command that was run.
  int exit_code() const { return exit_code_; }

 private:
  void add_runs(const std::atomic<bool>& stop);
  void add_explain();
  void add_view(const std::atomic<bool>& stop);
  void add_tune(const std::atomic<bool>& stop);
  void add_compare(const std::atomic<bool>& stop);
  void add_inspect();
  void add_motion();
  void add_init();
  void add_diff();
  void add_exports();
  void add_merge();
  void add_farm(const std::atomic<bool>& stop);
  void add_warps();
  void add_reproduce();
  void add_accuracy();

  CLI::App app_;
  CommandLine line_;
  std::string split_;
  ExplainOptions explain_;
  ViewOptions view_;
  TuneOptions tune_;
  CompareOptions compare_;
  InspectOptions inspect_;
  MotionCommand motion_;
  InitOptions init_;
  DiffOptions diff_;
  ExportOptions export_;
  MergeOptions merge_;
  FarmOptions farm_;
  ReportOptions report_;
  std::string documented_;
  WarpsOptions warps_;
  ReproduceOptions reproduce_;
  AccuracyOptions accuracy_;
  CacheWords cache_;
  int exit_code_ = kSuccess;
};

}  // namespace talisman::sequences
