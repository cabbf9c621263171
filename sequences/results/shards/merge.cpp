// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/shards/merge.h"

#include <fcntl.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

#include "sequences/files/atomic_file.h"
#include "sequences/files/folder_lock.h"
#include "sequences/files/folders.h"
#include "sequences/files/line_file.h"
#include "sequences/files/output_file.h"
#include "sequences/files/video.h"
#include "sequences/pictures/page_assets.h"
#include "sequences/results/json_text.h"
#include "sequences/results/report/report.h"
#include "sequences/results/report/what_if.h"
#include "sequences/results/run_folder.h"
#include "sequences/results/run_identity.h"
#include "sequences/results/shards/shard_file.h"
#include "sequences/results/shards/summary_parts.h"
#include "sequences/results/timing.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kPartial = ".partial";

/// A folder of OUT/shards by its name.
struct FoundFolder {
  std::string name;
  std::optional<Shard> shard;  ///< empty: no name of a shard
  bool is_partial = false;
};

std::vector<FoundFolder> folders_in(const std::string& out) {
  std::vector<FoundFolder> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(out + "/" + kShardsFolder, error)) {
    FoundFolder folder{entry.path().filename().string(), {}, false};
    if (folder.name[0] == '.') continue;
    std::string name = folder.name;
    folder.is_partial = name.ends_with(kPartial);
    if (folder.is_partial) name.resize(name.size() - std::string(kPartial).size());
    if (entry.is_directory(error)) folder.shard = shard_from(name, "-of-");
    found.push_back(std::move(folder));
  }
  std::sort(found.begin(), found.end(),
            [](const FoundFolder& a, const FoundFolder& b) { return a.name < b.name; });
  return found;
}

/// "0-of-4 is missing, 2-of-4 is damaged (frames/0012.png)": at most ten, and how many more.
std::string listed_problems(const std::vector<std::string>& problems) {
  constexpr std::size_t kShown = 10;
  std::string text;
  for (std::size_t i = 0; i < problems.size() && i < kShown; ++i) text += (i == 0 ? "" : ", ") + problems[i];
  return problems.size() > kShown ? text + " and " + std::to_string(problems.size() - kShown) + " more"
                                  : text;
}

class ShardMerger {
 public:
  ShardMerger(std::string out, bool allow_partial, bool force)
      : out_(std::move(out)), allow_partial_(allow_partial), force_(force) {}

  Merged merge() {
    find_shards();
    check_order();
    if (!wrong_.empty()) refuse(wrong_);
    if (!absent_.empty() && (!allow_partial_ || shards_.empty())) refuse(absent_);
    const FolderLock lock(out_);
    begin();
    join();
    return std::move(merged_);
  }

 private:
  [[noreturn]] void refuse(const std::vector<std::string>& problems) const {
    throw PartialResult(out_ + ": " + listed_problems(problems) +
                        ", rule: all shards of one run, complete and as they were written");
  }

  void find_shards() {
    const std::vector<FoundFolder> folders = folders_in(out_);
    std::set<int> parts;
    for (const FoundFolder& folder : folders)
      if (folder.shard) parts.insert(folder.shard->of);
    if (parts.empty()) throw InputError("holds no shards, rule: the --out of render or plan --shard", out_);
    if (parts.size() > 1)
      wrong_.push_back("shards of " + std::to_string(*parts.begin()) + " and of " +
                       std::to_string(*parts.rbegin()));
    for (const FoundFolder& folder : folders)
      if (!folder.shard) wrong_.push_back(folder.name + " is no shard");
    if (!wrong_.empty()) return;
    const auto has = [&](const std::string& name) {
      return std::any_of(folders.begin(), folders.end(),
                         [&](const FoundFolder& f) { return f.name == name; });
    };
    const int of = *parts.begin();
    for (int index = 0; index < of; ++index) {
      const std::string name = Shard{index, of}.name();
      if (has(name))
        take({index, of});
      else
        absent_.push_back(name + (has(name + kPartial) ? " is unfinished" : " is missing"));
    }
  }

  void take(const Shard& shard) {
    const std::string folder = shard_folder(out_, shard), name = shard.name();
    std::optional<ShardFile> file = read_shard_file(folder);
    if (!file) {
      absent_.push_back(name + " is damaged (shard.json)");
      return;
    }
    if (file->version != TALISMAN_VERSION)
      wrong_.push_back(name + " is of version " + file->version + " and this is " TALISMAN_VERSION);
    else if (!(file->shard == shard))
      wrong_.push_back(name + " is foreign (it is " + file->shard.name() + ")");
    else if (!shards_.empty() && file->run != shards_.front().run)
      wrong_.push_back(name + " is foreign (" + difference(file->run) + ")");
    else if (const std::string damaged = first_damaged(folder, *file); !damaged.empty())
      absent_.push_back(name + " is damaged (" + damaged + ")");
    else
      shards_.push_back(std::move(*file));
  }

  std::string difference(const Json& run) const {
    const std::string what = first_difference(shards_.front().run, run);
    return what.empty() ? "another run" : what.substr(0, what.find(", --resume"));
  }

  FrameRange whole() const {
    return {shards_.front().run.at("frames").at(0), shards_.front().run.at("frames").at(1)};
  }

  /// Each frame in one shard, in order.
  void check_order() {
    if (shards_.empty() || !wrong_.empty()) return;
    const FrameRange all = whole();
    int next = all.first, behind = -1;
    for (const ShardFile& shard : shards_) {
      const bool gap_may_be = !absent_.empty() && shard.shard.index != behind + 1;
      behind = shard.shard.index;
      if (shard.range.last < shard.range.first) continue;
      if (shard.range.first < next)
        wrong_.push_back(shard.shard.name() + " has frame " + std::to_string(shard.range.first) +
                         ", which a shard before it has, too");
      else if (shard.range.first > next && !gap_may_be)
        wrong_.push_back("no shard has frame " + std::to_string(next));
      next = shard.range.last + 1;
    }
    if (next <= all.last && absent_.empty()) wrong_.push_back("no shard has frame " + std::to_string(next));
    if (next > all.last + 1) wrong_.push_back("frame " + std::to_string(all.last + 1) + " is beyond the run");
  }

  void begin() {
    const Json& run = shards_.front().run;
    RunOptions& options = merged_.options;
    options.out = out_;
    options.first_frame = whole().first, options.last_frame = whole().last;
    options.plan_only = text_in(run, "kind") == "plan";
    const std::string format = text_in(run, "format");
    options.format = format == "exr"          ? FrameFormat::Exr
                     : format == "exr-layers" ? FrameFormat::ExrLayers
                     : format == "none"       ? FrameFormat::None
                                              : FrameFormat::Png;
    options.separate = run.at("separate").get<bool>();
    options.force = force_;
    require_places(options);
    begin_run(options, run);
    for (const ShardFile& shard : shards_) merged_.summary = merged_summary(shard);
    merged_.shards = static_cast<int>(shards_.size());
    merged_.left_out = absent_;
  }

  Summary merged_summary(const ShardFile& shard) {
    if (is_first_) {
      is_first_ = false;
      return shard.summary;
    }
    Summary sum = std::move(merged_.summary);
    add_part(sum, shard.summary);
    return sum;
  }

  /// Lines last: with them the frames are complete.
  void join() {
    for (const ShardFile& shard : shards_) link_pictures(shard);
    const auto decisions = joined_lines("decisions.jsonl"), changes = joined_lines("changes.jsonl"),
               frames = joined_lines("frames.jsonl");
    LineFile timing(out_ + "/timing.jsonl", timing_lines());
    add_up_frames();
    if (absent_.empty()) {
      timing.write(total_timing_json(merged_.summary));
      timing.finish();
      write_what_if_of_run();
      write_text_atomically(out_ + "/summary.json", json_of(merged_.summary));
      for (const std::string& file : {decisions, changes, frames})
        if (!file.empty()) rename_file(file + kPartial, file, file);
    }
    make_page_and_video();
  }

  void link_pictures(const ShardFile& shard) const {
    const std::string from = shard_folder(out_, shard.shard);
    for (const auto& file : shard.files) {
      const std::string& name = file.first;
      const bool is_picture = name.rfind("frames/", 0) == 0 || name.rfind("separate/", 0) == 0;
      if (!is_picture || name.find("..") != std::string::npos) continue;
      const std::string to = out_ + "/" + name;
      std::error_code error;
      fs::remove(to, error);
      fs::create_hard_link(from + "/" + name, to, error);
      if (!error) continue;
      write_atomically(to, [&](const std::string& temporary) {
        fs::copy_file(from + "/" + name, temporary, fs::copy_options::overwrite_existing);
      });
    }
  }

  /// Writes NAME.partial out of those of the shards. The path of NAME; empty where none of them has it.
  std::string joined_lines(const std::string& name) const {
    std::unique_ptr<OutputFile> to;
    std::string path = out_ + "/" + name;
    for (const ShardFile& shard : shards_) {
      if (!shard.files.contains(name)) continue;
      if (!to) to = std::make_unique<OutputFile>(path + kPartial, path, O_WRONLY | O_CREAT | O_TRUNC);
      std::ifstream from(shard_folder(out_, shard.shard) + "/" + name, std::ios::binary);
      std::vector<char> block(std::size_t{1} << 20U);
      while (from.read(block.data(), static_cast<std::streamsize>(block.size())) || from.gcount() > 0)
        to->write({block.data(), static_cast<std::size_t>(from.gcount())});
      if (from.bad())
        throw OutputError(shard_folder(out_, shard.shard) + "/" + name + ": cannot be read again");
    }
    if (!to) return {};
    to->flush();
    to->close();
    return path;
  }

  /// Of the processes, then of the frames.
  std::vector<std::string> timing_lines() const {
    std::vector<std::string> processes, frames;
    for (const ShardFile& shard : shards_)
      for (const std::string& line : lines_written(shard_folder(out_, shard.shard) + "/timing.jsonl"))
        if (is_process_line(line))
          processes.push_back(line);
        else if (timing_from_json(line))
          frames.push_back(line);
    processes.insert(processes.end(), frames.begin(), frames.end());
    return processes;
  }

  /// As a run adds them: in their order.
  void add_up_frames() {
    FrameTotals totals;
    for (const ShardFile& shard : shards_) {
      const std::string folder = shard_folder(out_, shard.shard);
      std::map<int, FrameTimes> times;
      for (const std::string& text : lines_written(folder + "/timing.jsonl"))
        if (const auto timing = timing_from_json(text)) times[timing->frame] = timing->times;
      for (const std::string& text : lines_written(folder + "/frames.jsonl")) {
        std::optional<FrameLine> line = frame_line_from_json(text);
        if (!line) throw OutputError(folder + "/frames.jsonl: holds a line that is none of a frame");
        line->times = times[line->frame];
        totals.add(*line);
      }
    }
    merged_.summary.earlier = totals;
  }

  void write_what_if_of_run() const {
    for (const ShardFile& shard : shards_)
      if (!shard.wishes.what_if.is_null()) write_what_if(shard.wishes.what_if, merged_.summary, out_);
  }

  void make_page_and_video() {
    const ShardWishes& wishes = shards_.front().wishes;
    if (wishes.report && has_report()) write_report({out_}, {}, wishes.thumbnails);
    if (!wishes.video || !absent_.empty()) return;
    try {
      write_video(out_, wishes.fps, merged_.options.format, merged_.options.first_frame,
                  merged_.options.last_frame);
    } catch (const OutputError& error) {
      merged_.without_video = error.what();
    }
  }

  std::string out_;
  bool allow_partial_, force_, is_first_ = true;
  std::vector<ShardFile> shards_;    ///< good ones, by index
  std::vector<std::string> wrong_;   ///< must not be joined
  std::vector<std::string> absent_;  ///< may be left out
  Merged merged_;
};

}  // namespace

Merged merge_shards(const std::string& out, bool allow_partial, bool force) {
  return ShardMerger(out, allow_partial, force).merge();
}

}  // namespace talisman::sequences
