// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/reproduce.h"

#include <cstdio>
#include <ostream>

#include "sequences/commands/option_group.h"
#include "sequences/commands/options.h"
#include "sequences/commands/words.h"
#include "sequences/experiments/reproduction/papers.h"
#include "sequences/experiments/reproduction/report.h"
#include "sequences/files/folders.h"
#include "sequences/pictures/plot.h"

namespace talisman::sequences {

namespace {

constexpr const char* kReproductionMark = "reproduce.json";

/// A sequence as `plan NAME` takes it. What it warns of is said by whoever looks at it alone.
OpenSequence opened(const std::string& name) {
  Sequence sequence = load_sequence(name);
  CommandLine line;
  line.sequence = name;
  const Settings settings = resolve(line, sequence, true).settings;
  return {std::move(sequence), settings};
}

int exit_code_of(const Reproduction& reproduction) {
  if (const int failed = reproduction.failed(); failed > 0) {
    std::fprintf(stderr, "error: %d rows say no and must say yes\n", failed);
    return kFailed;
  }
  return reproduction.count(Shape::NotMeasured) > 0 ? kPartialResult : kSuccess;
}

}  // namespace

void add_reproduce_options(CLI::App& command, ReproduceOptions& options) {
  OptionGroup(command, "Options")
      .flag("--quick", options.quick, "leave out the rows that draw pictures")
      .option("--only", options.only, "a paper or one of its figures, tables, sections: LS97, LS97:22", "all")
      .option("--out", options.out, "result folder", options.out)
      .option("--progress", options.progress, alternatives(kProgressWords), options.progress);
}

int run_reproduce(const ReproduceOptions& options, std::ostream& out) {
  const ProgressKind progress = choice("--progress", options.progress, kProgressWords);
  const std::vector<Paper> papers = chosen_papers(all_papers(), options.only);
  require_plotter();
  begin_report_folder(options.out, kReproductionMark, "a reproduction");
  PaperBench bench(opened);
  const Reproduction reproduction = reproduce(papers, bench, options.quick, progress);
  write_report(reproduction, options.out);
  finish_report_folder(options.out, kReproductionMark);
  print_report(reproduction, out);
  out << "\nresults in " << options.out << "\n";
  return exit_code_of(reproduction);
}

}  // namespace talisman::sequences
