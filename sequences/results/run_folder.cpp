// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/run_folder.h"

#include <cstdio>
#include <filesystem>
#include <set>

#include <nlohmann/json.hpp>

#include "sequences/files/atomic_file.h"
#include "sequences/files/file_text.h"
#include "sequences/files/folders.h"
#include "sequences/files/line_file.h"
#include "sequences/files/temporary_files.h"
#include "sequences/results/json_text.h"
#include "sequences/results/kept_pictures.h"
#include "sequences/results/run_identity.h"
#include "sequences/results/shards/shard.h"
#include "sequences/results/timing.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const char* extension_of(FrameFormat format) {
  switch (format) {
    case FrameFormat::Png:
      return ".png";
    case FrameFormat::Exr:
    case FrameFormat::ExrLayers:
      return ".exr";
    case FrameFormat::None:
      return "";
  }
  return "";
}

/// run.json of an earlier run; null if there is none. Throws InputError if it is nothing of ours.
Json earlier_run(const RunOptions& options) {
  const std::optional<std::string> text = text_of_file(options.out + "/run.json");
  if (!text) return nullptr;
  Json run = Json::parse(*text, nullptr, false);
  return run.is_object() ? run : Json("damaged");
}

/// Is it called like a picture of ours?
bool is_numbered(const fs::path& file) {
  const std::string stem = file.stem().string(), extension = file.extension().string();
  const bool numbered = !stem.empty() && stem.find_first_not_of("0123456789") == std::string::npos;
  return numbered && (extension == ".png" || extension == ".exr");
}

/// Of a run that wrote pictures of its frames.
bool has_pictures(const Json& run) {
  return run.is_object() && text_in(run, "kind") == "render" && text_in(run, "format", "none") != "none";
}

bool is_plan(const Json& run) { return run.is_object() && text_in(run, "kind") == "plan"; }

/// Is there anything in the folder, and nothing that says it is a run's? What a killed run left before it could say
/// so does not count.
bool holds_others_files(const std::string& out, const Json& earlier) {
  if (earlier.is_object() && text_in(earlier, "schema").rfind("talisman.run/", 0) == 0) return false;
  const std::set<std::string> ours = {".lock", "frames",
                                      "separate"};  // and the parts that are merged into it
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(out, error)) {
    const std::string name = entry.path().filename().string();
    const bool is_left_over =
        name.rfind(".tmp-", 0) == 0 || (ours.contains(name) && fs::is_empty(entry, error));
    if (name != ".lock" && name != kShardsFolder && !is_left_over) return true;
  }
  return false;
}

/// Frames that an earlier run completed: their line is there, and their picture as it was written.
KeptRun complete_frames(const RunOptions& options) {
  KeptRun kept;
  SeparateNames separate = separate_names(options);
  for (const std::string& text : lines_written(options.out + "/frames.jsonl")) {
    const std::optional<FrameLine> line = frame_line_from_json(text);
    if (!line || !line->is_drawn()) continue;
    const bool has_picture = options.format != FrameFormat::None;
    const auto picture = has_picture ? hash_of_file(frame_path(options, line->frame)) : std::nullopt;
    if (has_picture == picture.has_value() &&
        picture_hash(options, picture, separate[line->frame]) == line->picture_hash)
      kept.frames[line->frame] = *line;
  }
  for (const std::string& text : lines_written(options.out + "/timing.jsonl")) {
    const std::optional<FrameTiming> timing = timing_from_json(text);
    const auto frame = timing ? kept.frames.find(timing->frame) : kept.frames.end();
    if (frame != kept.frames.end()) frame->second.times = timing->times;
    if (frame != kept.frames.end() || is_process_line(text)) kept.timing.push_back(text);
  }
  return kept;
}

/// What an earlier run left behind must not be taken for a result of this one. Pictures are removed only where
/// run.json says that they are ours, and only those with our names.
void remove_old_results(const RunOptions& options, bool pictures_are_ours) {
  for (const std::string name : {"decisions.jsonl", "frames.jsonl", "timing.jsonl", "changes.jsonl"})
    for (const char* state : {"", ".partial"}) fs::remove(options.out + "/" + name + state);
  for (const char* name : {"summary.json", "what-if.json", "report.html"})
    fs::remove(options.out + "/" + name);
  if (options.plan_only || !pictures_are_ours) return;
  fs::remove(options.out + "/video.mp4");
  for (const fs::directory_entry& entry : fs::directory_iterator(options.out + "/frames"))
    if (is_numbered(entry.path())) fs::remove(entry.path());
}

/// How many frames an earlier run finished, whether it came to its end or not.
std::size_t frames_written(const std::string& out) { return count_lines_written(out + "/frames.jsonl"); }

/// "replaces the run of 16 frames in DIR; --resume would continue it".
std::string news_of(const RunOptions& options, const Json& earlier, const Json& run) {
  const bool is_render = earlier.is_object() && !is_plan(earlier);
  if (options.resume) return is_render ? "" : "nothing to continue in " + options.out + ": begins anew";
  const std::size_t frames = earlier.is_object() ? frames_written(options.out) : 0;
  if (frames == 0) return {};
  const std::string text = std::string("replaces the ") + (is_render ? "run" : "plan") + " of " +
                           std::to_string(frames) + (frames == 1 ? " frame" : " frames") + " in " +
                           options.out;
  const bool is_same = is_render && !options.plan_only && first_difference(earlier, run).empty();
  return is_same ? text + "; --resume would continue it" : text;
}

}  // namespace

std::string frame_path(const RunOptions& options, int frame) {
  char name[32];
  std::snprintf(name, sizeof name, "%04d%s", frame, extension_of(options.format));
  return options.out + "/frames/" + name;
}

void require_places(const RunOptions& options) {
  require_folder_or_nothing(options.out);
  const std::string in = options.out + "/";
  for (const char* folder : {"frames", "separate", "audit"}) require_folder_or_nothing(in + folder);
  for (const char* file : {"run.json", "summary.json", "what-if.json", "report.html", "video.mp4", ".lock"})
    require_file_or_nothing(in + file);
  for (const char* file : {"decisions.jsonl", "frames.jsonl", "timing.jsonl", "changes.jsonl"})
    for (const char* state : {"", ".partial", ".partial.new"}) require_file_or_nothing(in + file + state);
  std::error_code error;
  for (fs::directory_iterator it(in + "frames", error), end; !error && it != end; it.increment(error))
    if (is_numbered(it->path())) require_file_or_nothing(it->path().string());
}

KeptRun begin_run(const RunOptions& options, const Json& run) {
  const std::string run_file = options.out + "/run.json";
  const Json earlier = earlier_run(options);
  const bool is_render = !earlier.is_null() && !is_plan(earlier);
  if (options.plan_only && is_render)
    throw InputError("says that the folder holds pictures, a plan must go into a folder of its own",
                     run_file);
  if (!options.force && options.format == FrameFormat::None && has_pictures(earlier))
    throw InputError(
        "says that the folder holds pictures, and this run draws none; rule: another folder, or --force",
        run_file);
  if (!options.force && holds_others_files(options.out, earlier))
    throw InputError("holds files that are not of a run, rule: an empty folder, one of a run, or --force",
                     options.out);
  KeptRun kept;
  kept.news = news_of(options, earlier, run);
  create_folder(options.out);
  if (!options.plan_only) create_folder(options.out + "/frames");
  if (options.separate) create_folder(options.out + "/separate");
  if (options.resume && is_render) {
    if (!earlier.is_object()) throw InputError("not a run file, must be written by talisman", run_file);
    if (const std::string difference = first_difference(earlier, run); !difference.empty())
      throw InputError(difference, run_file);
    kept = complete_frames(options);
    if (kept.frames.empty()) kept.news = "no complete frame to continue in " + options.out + ": begins anew";
  }
  for (const char* folder : {"", "/frames", "/separate"}) remove_abandoned_files(options.out + folder);
  if (kept.frames.empty()) {
    kept = {{}, {}, kept.news};
    remove_old_results(options, is_render);
  }
  write_text_atomically(run_file, run.dump(2) + "\n");
  return kept;
}

}  // namespace talisman::sequences
