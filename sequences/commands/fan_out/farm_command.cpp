// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/fan_out/farm_command.h"

#include <filesystem>
#include <optional>
#include <ostream>

#include "sequences/commands/fan_out/shard_command.h"
#include "sequences/commands/fan_out/sweep_table.h"
#include "sequences/commands/render.h"
#include "sequences/commands/run_words.h"
#include "sequences/content/value_type.h"
#include "sequences/files/atomic_file.h"
#include "sequences/files/file_text.h"
#include "sequences/files/folders.h"
#include "sequences/files/number_text.h"
#include "sequences/results/finished_run.h"
#include "sequences/results/run_identity.h"
#include "sequences/results/shards/shard.h"

#include <nlohmann/json.hpp>

namespace talisman::sequences {

namespace {

/// One script of a job, as sbatch reads it from its standard input.
struct SlurmJob {
  std::string variable;               ///< of the shell: its number
  std::string name, log, dependency;  ///< of another job's variable; empty: none
  std::string array;                  ///< "0-15%4"; empty: one task
  int cpus = 1;
  std::string command;           ///< behind "exec "
  bool takes_arguments = false;  ///< of the whole script: --wait
};

std::string submission(const SlurmJob& job) {
  std::string text = job.variable + "=$(sbatch --parsable --job-name=" + in_shell({job.name});
  if (!job.array.empty()) text += " --array=" + job.array;
  if (!job.dependency.empty()) text += " --dependency=afterany:$" + job.dependency;
  text += " --requeue --cpus-per-task=" + std::to_string(job.cpus) +
          " --open-mode=append --output=" + in_shell({job.log}) + (job.takes_arguments ? " \"$@\"" : "") +
          " <<'JOB'\n";
  return text + "#!/bin/bash\nexec \"${TALISMAN:-talisman}\" " + job.command + "\nJOB\n)\n";
}

std::string script(const std::string& what, const std::string& logs, const std::vector<SlurmJob>& jobs) {
  std::string text =
      "#!/bin/bash\n# " + what +
      ".\n# Submits when it is run: bash THIS_FILE; with --wait it ends when all is done, with the exit "
      "code of the last job.\nset -euo pipefail\nmkdir -p " +
      in_shell({logs}) + "\n";
  for (const SlurmJob& job : jobs) text += submission(job);
  text += "echo";
  for (const SlurmJob& job : jobs) text += " \"" + job.variable + " $" + job.variable + "\"";
  return text + "\n";
}

std::string array_of(std::size_t tasks, int at_most) {
  return "0-" + std::to_string(tasks - 1) + (at_most > 0 ? "%" + std::to_string(at_most) : "");
}

void require_range(const char* option, int value, int low, int high) {
  if (value < low || value > high)
    throw InputError(std::string(option) + " is " + std::to_string(value) + ", rule: from " +
                     std::to_string(low) + " to " + std::to_string(high));
}

void require_meaning(const FarmOptions& o) {
  const bool is_of_sweep = o.action != "slurm";
  if (o.action != "slurm" && o.action != "list" && o.action != "run" && o.action != "table")
    throw InputError("farm is asked for '" + o.action + "', rule: one of slurm, list, run, table");
  if (is_of_sweep && o.sweep.empty()) throw InputError("farm " + o.action + " needs --sweep FILE");
  if (!o.sweep.empty() && !(o.sequence.empty() && o.options.empty()))
    throw InputError("'" + (o.sequence.empty() ? o.options.front() : o.sequence) +
                     "' and --sweep are two questions, rule: a SEQUENCE with its options, or a sweep");
  if (!o.sweep.empty() && !o.out.empty())
    throw InputError("--out is '" + o.out + "', and a sweep has its own, rule: without --sweep alone");
  if (o.sweep.empty() && o.sequence.empty()) throw InputError("farm slurm needs a SEQUENCE, or --sweep FILE");
  if ((o.action == "run") != (o.task >= 0)) throw InputError("--task is one of farm run, must come with it");
  if (o.by_cost && !o.sweep.empty())
    throw InputError("--by-cost plans one sequence, must be given without --sweep");
  if (o.command != "render" && o.command != "plan")
    throw InputError("--command is '" + o.command + "', rule: render or plan");
  require_range("--shards", o.shards, 1, kMostShards);
  require_range("--at-most", o.at_most, 0, kMostShards);
  require_range("--cpus", o.cpus, 1, 1024);
}

/// The plan by whose costs the shards are cut. Where it fails they say so, each, and the merge that they are missing.
SlurmJob plan_of_costs(const FarmOptions& o, const std::string& sequence, const std::string& out,
                       const std::string& logs) {
  command_line_from(o.sequence, o.options, true);  // it has the options of a plan alone
  std::string command = "plan " + in_shell({o.sequence}) + " --out " + in_shell({out + "-costs"});
  if (!o.options.empty()) command += " " + in_shell(o.options);
  return {"plan", "plan-" + sequence, logs + "/plan.log", "", "", o.cpus, command + " --quiet --no-report",
          false};
}

/// The options are read as the shards will read them: what is wrong with them is said now, not by N tasks.
std::string slurm_of_sequence(const FarmOptions& o) {
  const bool plan_only = o.command == "plan";
  CommandLine line = command_line_from(o.sequence, o.options, plan_only);
  line.out = o.out;
  const Sequence sequence = load_with_warnings(line);
  const std::string out = resolve(line, sequence, plan_only).options.out;
  std::string command = o.command + " " + in_shell({o.sequence}) + " --out " + in_shell({out});
  if (!o.options.empty()) command += " " + in_shell(o.options);
  command += " --shard \"$SLURM_ARRAY_TASK_ID/" + std::to_string(o.shards) +
             "\" --resume --quiet --threads " + std::to_string(o.cpus);
  const std::string logs = out + "-slurm";  // beside it: the folder of a run holds nothing else
  if (o.by_cost) command += " --plan " + in_shell({out + "-costs"});
  const SlurmJob array{"array",
                       "talisman-" + sequence.name,
                       logs + "/shard-%a.log",
                       o.by_cost ? "plan" : "",
                       array_of(static_cast<std::size_t>(o.shards), o.at_most),
                       o.cpus,
                       command,
                       false};
  const SlurmJob merge{
      "merge", "merge-" + sequence.name, logs + "/merge.log", "array", "", 1, "merge " + in_shell({out}),
      true};
  std::vector<SlurmJob> jobs = {array, merge};
  if (o.by_cost) jobs.insert(jobs.begin(), plan_of_costs(o, sequence.name, out, logs));
  return script(sequence.name + " in " + std::to_string(o.shards) + " shards" +
                    (o.by_cost ? " that cost the same" : "") + ", and their merge",
                logs, jobs);
}

std::string slurm_of_sweep(const FarmOptions& o) {
  const Sweep sweep = read_sweep(o.sweep);
  const std::size_t tasks = sweep.jobs.size() * static_cast<std::size_t>(o.shards);
  const std::string of_sweep = "--sweep " + in_shell({o.sweep}) +
                               (o.shards > 1 ? " --shards " + std::to_string(o.shards) : std::string());
  const std::string logs = sweep.out + "/slurm";
  const SlurmJob array{
      "array",
      "talisman-sweep",
      logs + "/task-%a.log",
      "",
      array_of(tasks, o.at_most),
      o.cpus,
      "farm run " + of_sweep + " --cpus " + std::to_string(o.cpus) + " --task \"$SLURM_ARRAY_TASK_ID\"",
      false};
  const SlurmJob table{"table",
                       "sweep-table",
                       logs + "/table.log",
                       "array",
                       "",
                       1,
                       "farm table --sweep " + in_shell({o.sweep}),
                       true};
  return script(std::to_string(sweep.jobs.size()) + " runs of " + o.sweep + ", and their table", logs,
                {array, table});
}

std::string manifest(const FarmOptions& o) {
  const Sweep sweep = read_sweep(o.sweep);
  std::string text;
  std::size_t task = 0;
  for (const SweepJob& job : sweep.jobs)
    for (int shard = 0; shard < o.shards; ++shard) {
      std::vector<std::string> words = {"talisman", sweep.render ? "render" : "plan", job.sequence};
      words.insert(words.end(), job.words.begin(), job.words.end());
      words.insert(words.end(), {"--out", sweep.folder(job)});
      if (o.shards > 1)
        words.insert(words.end(), {"--shard", std::to_string(shard) + "/" + std::to_string(o.shards)});
      text += std::to_string(task++) + "\t" + in_shell(words) + "\n";
    }
  return text;
}

/// Is the folder the run of this command line, complete?
bool is_done(const CommandLine& line, bool plan_only) {
  if (!holds_run(line.out)) return false;
  try {
    const nlohmann::ordered_json before = finished_run(line.out);
    finished_summary(line.out);
    const Sequence sequence = load_sequence(line.sequence, content_options(line));
    const ResolvedRun run = resolve(line, sequence, plan_only);
    return before == run_json(sequence, run.settings, run.options);
  } catch (const InputError&) {
    return false;
  }
}

int run_task(const FarmOptions& o, const std::atomic<bool>& stop, std::ostream& out) {
  const Sweep sweep = read_sweep(o.sweep);
  const std::size_t tasks = sweep.jobs.size() * static_cast<std::size_t>(o.shards);
  require_range("--task", o.task, 0, static_cast<int>(tasks) - 1);
  const SweepJob& job = sweep.jobs[static_cast<std::size_t>(o.task / o.shards)];
  const std::string failed = sweep.folder(job) + ".failed";
  create_folder(sweep.out + "/jobs");
  const auto mark = [&](const std::string& why) { write_text_atomically(failed, why + "\n"); };
  try {
    CommandLine line = command_line_of(sweep, job, o.task % o.shards, o.shards);
    line.threads = o.cpus;
    if (o.shards == 1 && is_done(line, !sweep.render)) {
      out << "job " << job.name << ": complete already, in " << line.out << "\n";
      return kSuccess;
    }
    const int code = run_sequence(line, !sweep.render, stop, out);
    std::error_code error;
    if (code == kSuccess) std::filesystem::remove(failed, error);
    return code;
  } catch (const InputError& error) {
    mark(error.what());
    throw;
  } catch (const OutputError& error) {
    mark(error.what());
    throw;
  }
}

int collect(const FarmOptions& o, std::ostream& out) {
  const Sweep sweep = read_sweep(o.sweep);
  create_folder(sweep.out);
  const SweepOutcome outcome = write_sweep_table(sweep);
  out << outcome.done << " done, " << outcome.failed << " failed, " << outcome.missing << " missing; "
      << sweep.out << "/sweep.csv" << (outcome.done > 0 && outcome.without_plot.empty() ? ", pareto.svg" : "")
      << "\n";
  if (outcome.failed + outcome.missing > 0)
    throw PartialResult(sweep.out + "/sweep.csv: " + std::to_string(outcome.failed) + " failed and " +
                        std::to_string(outcome.missing) + " missing of " + std::to_string(sweep.jobs.size()) +
                        "; the same tasks again do these alone");
  if (!outcome.without_plot.empty()) throw PartialResult(outcome.without_plot + "; the table is there");
  return kSuccess;
}

}  // namespace

int run_farm(const FarmOptions& options, const std::atomic<bool>& stop, std::ostream& out) {
  require_meaning(options);
  if (options.action == "run") return run_task(options, stop, out);
  if (options.action == "table") return collect(options, out);
  if (options.action == "list")
    out << manifest(options);
  else
    out << (options.sweep.empty() ? slurm_of_sequence(options) : slurm_of_sweep(options));
  return kSuccess;
}

}  // namespace talisman::sequences
