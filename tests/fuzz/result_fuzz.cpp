// SPDX-License-Identifier: Apache-2.0
// Any bytes in the place of a file of a run's folder, which is then read as report, diff, explain and merge do. The first byte
// says which file; the others are those of the run in $TALISMAN_FUZZ_RUN, a folder of `talisman plan`, or are not there. Only
// what the tool has words for may come out.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>

#include "sequences/files/errors.h"
#include "sequences/results/explained_frame.h"
#include "sequences/results/report/report.h"
#include "sequences/results/run_difference.h"
#include "sequences/results/shards/shard_file.h"
#include "tests/fuzz/file_of_bytes.h"

namespace {

constexpr const char* kFiles[] = {"run.json",     "decisions.jsonl", "frames.jsonl",
                                  "summary.json", "shard.json",      "timing.jsonl"};

template <typename Question>
void ask(const Question& question) {
  try {
    question();
  } catch (const talisman::sequences::InputError&) {
  } catch (const talisman::sequences::OutputError&) {
  }
}

/// The run as it was made.
const std::filesystem::path& made() {
  static const std::filesystem::path folder = [] {
    const char* given = std::getenv("TALISMAN_FUZZ_RUN");
    return std::filesystem::path(given ? given : "");
  }();
  return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace talisman::sequences;
  if (size == 0) return 0;
  const char* name = kFiles[data[0] % std::size(kFiles)];
  const std::filesystem::path file = talisman::fuzz::file_of_bytes(name, data + 1, size - 1);
  const std::string folder = file.parent_path();
  std::error_code ignored;
  if (!made().empty())
    for (const char* other : kFiles)
      if (other != name)
        std::filesystem::copy_file(made() / other, file.parent_path() / other,
                                   std::filesystem::copy_options::overwrite_existing, ignored);
  ask([&] {
    std::vector<ReportRun> runs;
    runs.push_back(read_report_run(folder, false));
    report_html(runs);
  });
  ask([&] { json_of(run_difference(folder, made().empty() ? folder : made().string())).dump(); });
  ask([&] {
    nlohmann::ordered_json settings;
    explained_folder(folder, data[0] / 8, settings);
  });
  ask([&] {
    if (const auto shard = read_shard_file(folder)) first_damaged(folder, *shard);
  });
  std::filesystem::remove(file);
  return 0;
}
