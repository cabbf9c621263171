// SPDX-License-Identifier: Apache-2.0
// Scripts for a queue, and sweeps: what is printed can be run by a shell, what fails is a row, what is done is not done
// again. That Slurm takes it is seen by tests/slurm.
#include <algorithm>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::HasSubstr;

class Farm : public Tool {
 protected:
  void SetUp() override {
    Tool::SetUp();
    write("passing.yaml", kPassing);
    write("sweep.yaml",
          "out: sweep\nsequences: [passing.yaml]\noptions: {size: 96x72, frames: 0-5}\n"
          "settings: [{policy: hold, hold: 2}, {policy: budget}]\ngrid: {geometric-px: [1, 4], warp: [aff, "
          "trn]}\n");
  }
  std::vector<std::string> cells_of(const std::string& row) const {
    std::vector<std::string> cells;
    std::istringstream in(row);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    return cells;
  }
};

TEST_F(Farm, ManifestHasALinePerRunInTheOrderOfTheFile) {
  const Outcome outcome = run("farm list --sweep sweep.yaml");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(
      outcome.output,
      "0\ttalisman plan passing.yaml --frames 0-5 --size 96x72 --hold 2 --policy hold --out sweep/jobs/0000\n"
      "1\ttalisman plan passing.yaml --frames 0-5 --size 96x72 --policy budget --out sweep/jobs/0001\n"
      "2\ttalisman plan passing.yaml --frames 0-5 --size 96x72 --geometric-px 1 --warp aff --out "
      "sweep/jobs/0002\n"
      "3\ttalisman plan passing.yaml --frames 0-5 --size 96x72 --geometric-px 1 --warp trn --out "
      "sweep/jobs/0003\n"
      "4\ttalisman plan passing.yaml --frames 0-5 --size 96x72 --geometric-px 4 --warp aff --out "
      "sweep/jobs/0004\n"
      "5\ttalisman plan passing.yaml --frames 0-5 --size 96x72 --geometric-px 4 --warp trn --out "
      "sweep/jobs/0005\n");
}

TEST_F(Farm, SweepWithARunThatCannotBeMadeSaysSoInItsRow) {
  const Outcome early = run("farm table --sweep sweep.yaml");
  EXPECT_EQ(early.exit_code, 3);
  EXPECT_THAT(early.output, HasSubstr("0 done, 0 failed, 6 missing"));
  for (int task = 0; task < 6; ++task) {
    const Outcome outcome = run("farm run --sweep sweep.yaml --task " + std::to_string(task));
    EXPECT_EQ(outcome.exit_code, task == 1 ? 2 : 0) << outcome.output;
  }
  const Outcome table = run("farm table --sweep sweep.yaml");
  EXPECT_EQ(table.exit_code, 3);
  EXPECT_THAT(table.output, HasSubstr("5 done, 1 failed, 0 missing; sweep/sweep.csv, pareto.svg"));
  EXPECT_TRUE(std::filesystem::exists(path("sweep/pareto.svg")));
  const std::vector<std::string> rows = lines("sweep/sweep.csv");
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_THAT(rows[2],
              HasSubstr("0001,passing.yaml,--policy budget,failed,\"--policy is 'budget', must come with"));
  // The numbers are those of a plan by itself.
  run("plan passing.yaml --size 96x72 --frames 0-5 --geometric-px 4 --out alone --quiet --no-report");
  run("export alone --csv");
  const std::vector<std::string> header = cells_of(rows[0]), cells = cells_of(rows[5]);
  const std::vector<std::string> alone = cells_of(lines("alone/run.csv")[1]),
                                 names = cells_of(lines("alone/run.csv")[0]);
  for (const char* column : {"mean_update_rate", "polygons_rendered", "modelled_drawing_ms"}) {
    const auto here = std::find(header.begin(), header.end(), column) - header.begin();
    const auto there = std::find(names.begin(), names.end(), column) - names.begin();
    EXPECT_EQ(cells[static_cast<std::size_t>(here)], alone[static_cast<std::size_t>(there)]) << column;
  }
}

TEST_F(Farm, RerunDoesOnlyWhatIsMissing) {
  for (const char* task : {"2", "3"}) run(std::string("farm run --sweep sweep.yaml --task ") + task);
  const auto before = std::filesystem::last_write_time(path("sweep/jobs/0002/summary.json"));
  std::filesystem::remove(path("sweep/jobs/0003/summary.json"));
  EXPECT_THAT(run("farm run --sweep sweep.yaml --task 2").output, HasSubstr("job 0002: complete already"));
  EXPECT_EQ(run("farm run --sweep sweep.yaml --task 3").output, "");
  EXPECT_EQ(before, std::filesystem::last_write_time(path("sweep/jobs/0002/summary.json")));
  EXPECT_TRUE(std::filesystem::exists(path("sweep/jobs/0003/summary.json")));
  // Another setting in the same place is another run.
  std::string sweep = read("sweep.yaml");
  sweep.replace(sweep.find("[1, 4]"), 6, "[2, 4]");
  write("sweep.yaml", sweep);
  EXPECT_EQ(run("farm run --sweep sweep.yaml --task 2").output, "");
  EXPECT_NE(before, std::filesystem::last_write_time(path("sweep/jobs/0002/summary.json")));
}

TEST_F(Farm, SweepInShardsIsMergedForItsTable) {
  write("sweep.yaml",
        "out: sweep\nsequences: [passing.yaml]\noptions: {size: 96x72, frames: 0-5}\n"
        "settings: [{policy: hold}, {geometric-px: 2}]\ncommand: render\n");
  for (int task = 0; task < 6; ++task)
    EXPECT_EQ(run("farm run --sweep sweep.yaml --shards 3 --task " + std::to_string(task)).exit_code, 0);
  const Outcome table = run("farm table --sweep sweep.yaml");
  EXPECT_EQ(table.exit_code, 0) << table.output;
  EXPECT_EQ(frame_hashes("sweep/jobs/0001").size(), 6u);
}

/// What sbatch would be given, by a sbatch that writes it down: two jobs, the second after the first however it ends.
TEST_F(Farm, SlurmScriptSubmitsAnArrayAndItsMerge) {
  const Outcome script =
      run("farm slurm passing.yaml --shards 16 --at-most 4 --out 'o ut' --size 96x72 --geometric-px 2");
  ASSERT_EQ(script.exit_code, 0) << script.output;
  write("submit", script.output);
  std::filesystem::create_directory(path("bin"));
  write("bin/sbatch", "#!/bin/sh\necho \"$@\" >> calls\ncat >> calls\necho 7\n");
  const Outcome outcome = run_shell("chmod +x bin/sbatch; PATH=\"$PWD/bin:$PATH\" bash submit --wait");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(outcome.output, "array 7 merge 7\n");
  EXPECT_EQ(
      read("calls"),
      "--parsable --job-name=talisman-passing --array=0-15%4 --requeue --cpus-per-task=1 --open-mode=append "
      "--output=o ut-slurm/shard-%a.log\n#!/bin/bash\nexec \"${TALISMAN:-talisman}\" render passing.yaml "
      "--out "
      "'o ut' --size 96x72 --geometric-px 2 --shard \"$SLURM_ARRAY_TASK_ID/16\" --resume --quiet --threads "
      "1\n"
      "--parsable --job-name=merge-passing --dependency=afterany:7 --requeue --cpus-per-task=1 "
      "--open-mode=append --output=o ut-slurm/merge.log --wait\n#!/bin/bash\nexec \"${TALISMAN:-talisman}\" "
      "merge "
      "'o ut'\n");
}

/// As maps of a sweep file, in an order that the test knows.
std::string twenty_four_settings() {
  std::string settings = "{policy: reference}";
  for (const char* policy : {"hold", "interpolate"})
    for (const char* frames : {"2", "3", "5", "8"})
      settings += std::string(", {policy: ") + policy + ", hold: " + frames + "}";
  for (const char* policy : {"threshold", "oracle"})
    for (const char* px : {"0.25", "0.5", "1", "2", "4", "8"})
      settings += std::string(", {policy: ") + policy + ", geometric-px: " + px + "}";
  for (const char* frames : {"1", "2", "4"})
    settings += std::string(", {policy: threshold, blend: ") + frames + "}";
  return settings;
}

/// 24 settings on four tasks that go on beside each other: the same numbers as the experiment that runs them one by one.
TEST_F(Farm, SweepOfTwentyFourSettingsIsTheTableOfTheExperiment) {
  write("sweep.yaml", "out: sweep\nsequences: [passing.yaml]\noptions: {size: 96x72}\nsettings: [" +
                          twenty_four_settings() + "]\n");
  write("task.sh", "for k in $(seq $1 4 23); do '" + tool() +
                       "' farm run --sweep sweep.yaml --task $k || exit 1; done\n");
  const Outcome tasks = run_shell(
      "for t in 0 1 2 3; do bash task.sh $t & pids=\"$pids $!\"; done; for p in $pids; do wait $p || exit 1; "
      "done");
  EXPECT_EQ(tasks.exit_code, 0) << tasks.output;
  const Outcome table = run("farm table --sweep sweep.yaml");
  EXPECT_EQ(table.exit_code, 0) << table.output;
  const Outcome experiment = run(
      "accuracy --regulator passing.yaml --size 96x72 --quality-every 20 --out experiment --progress none");
  ASSERT_EQ(experiment.exit_code, 0) << experiment.output;
  const std::vector<std::string> rows = lines("sweep/sweep.csv"), header = cells_of(rows[0]);
  ASSERT_EQ(rows.size(), 25u);
  const auto cell = [&](std::size_t row, const char* column) {
    const auto at = std::find(header.begin(), header.end(), column) - header.begin();
    return std::stod(cells_of(rows[row])[static_cast<std::size_t>(at)]);
  };
  // In the order of the sweep; what the experiment has beside them is passed by.
  const auto same_series = [](std::size_t row) -> std::pair<std::string, double> {
    static const double kFrames[] = {2, 3, 5, 8}, kPx[] = {0.25, 0.5, 1, 2, 4, 8}, kBlends[] = {1, 2, 4};
    if (row == 0) return {"reference", 0};
    if (row <= 8) return {row <= 4 ? "hold" : "interpolate", kFrames[(row - 1) % 4]};
    if (row <= 20) return {row <= 14 ? "threshold" : "oracle", kPx[(row - 9) % 6]};
    return {"threshold blended", kBlends[row - 21]};
  };
  int compared = 0;
  const auto report = nlohmann::json::parse(read("experiment/regulator.json"));
  for (const auto& setting : report["settings"])
    for (std::size_t row = 0; row < 24; ++row) {
      const auto [series, knob] = same_series(row);
      if (setting["policy"] != series || (row > 0 && setting["knob"] != knob)) continue;
      ++compared;
      for (const auto& [ours, theirs] : {std::pair{"mean_update_rate", "mean_update_rate"},
                                         {"polygons_rendered", "polygons"},
                                         {"max_geometric_px", "max_geometric_px"}})
        EXPECT_DOUBLE_EQ(cell(row + 1, ours), setting[theirs].get<double>())
            << series << " " << knob << " " << ours;
    }
  EXPECT_EQ(compared, 24);
}

/// Three jobs, run here one after the other as a queue would: the shards are cut by the costs of the plan.
TEST_F(Farm, SlurmScriptByCostPlansFirst) {
  const Outcome script =
      run("farm slurm passing.yaml --shards 3 --by-cost --size 96x72 --frames 0-11 --out run");
  ASSERT_EQ(script.exit_code, 0) << script.output;
  EXPECT_THAT(script.output, HasSubstr("# passing in 3 shards that cost the same, and their merge."));
  EXPECT_THAT(script.output, HasSubstr("--dependency=afterany:$plan"));
  write("submit", script.output);
  std::filesystem::create_directory(path("bin"));
  // A queue that runs each task at once.
  write(
      "bin/sbatch",
      "#!/bin/bash\njob=$(cat)\ntasks=0\nfor word in \"$@\"; do case $word in --array=*) tasks=${word##*-};; "
      "esac; done\nfor i in $(seq 0 $tasks); do SLURM_ARRAY_TASK_ID=$i bash -c \"$job\" >> log 2>&1; "
      "done\necho "
      "7\n");
  const Outcome outcome =
      run_shell("chmod +x bin/sbatch; export TALISMAN='" + tool() + "'; PATH=\"$PWD/bin:$PATH\" bash submit");
  EXPECT_EQ(outcome.output, "plan 7 array 7 merge 7\n") << read("log");
  EXPECT_EQ(frame_hashes("run").size(), 12u) << read("log");
  EXPECT_THAT(script.output, HasSubstr("--plan run-costs"));
  EXPECT_EQ(lines("run-costs/frames.jsonl").size(), 12u);
  expect_bad_input("farm slurm passing.yaml --shards 3 --by-cost --video", {"video"});
  expect_bad_input("farm slurm --sweep sweep.yaml --by-cost", {"--by-cost plans one sequence"});
}

TEST_F(Farm, WhatIsAskedInAWrongWayIsRefused) {
  expect_bad_input("farm paint", {"farm is asked for 'paint', rule: one of slurm, list, run, table"});
  expect_bad_input("farm slurm", {"farm slurm needs a SEQUENCE, or --sweep FILE"});
  expect_bad_input("farm list", {"farm list needs --sweep FILE"});
  expect_bad_input("farm slurm passing.yaml --shards 0", {"--shards is 0, rule: from 1 to 100000"});
  expect_bad_input("farm slurm passing.yaml --shards 4 --geometric-pxx 4", {"geometric_pxx"});
  expect_bad_input("farm slurm passing.yaml --shards 4 --geometric-px -4", {"geometric_px is -4"});
  expect_bad_input("farm run --sweep sweep.yaml --task 6", {"--task is 6, rule: from 0 to 5"});
  write("bad.yaml", "out: o\nsequences: [passing.yaml]\nsettings: [{out: elsewhere}]\n");
  expect_bad_input("farm list --sweep bad.yaml", {"bad.yaml:3", "has the key out"});
  write("bad.yaml", "out: o\nsequences: [passing.yaml]\n");
  expect_bad_input("farm list --sweep bad.yaml", {"bad.yaml:1", "it runs nothing"});
}

}  // namespace
}  // namespace talisman
