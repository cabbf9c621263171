// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/finished_run.h"

#include <filesystem>
#include <fstream>

#include "sequences/files/file_text.h"
#include "sequences/results/json_text.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

/// Discarded where it is no JSON.
Json parsed_file(const std::string& path) {
  return Json::parse(text_of_file(path).value_or(""), nullptr, false);
}

}  // namespace

bool holds_run(const std::string& folder) {
  std::error_code error;
  return std::filesystem::exists(folder + "/run.json", error);
}

Json finished_run(const std::string& folder) {
  Json run = parsed_file(folder + "/run.json");
  std::error_code error;
  for (const char* file : {"/decisions.jsonl.partial", "/frames.jsonl.partial"})
    if (std::filesystem::exists(folder + file, error))
      throw InputError("holds a run that is not complete, the same command with --resume continues it",
                       folder);
  if (!run.is_object() || !run.contains("settings") || !run["settings"].is_object())
    throw InputError("holds no run (no run.json of ours), must be the folder of a render or a plan", folder);
  const std::string version =
      run.contains("version") && run["version"].is_string() ? run["version"].get<std::string>() : "";
  if (version != TALISMAN_VERSION)
    throw InputError("holds a run of version " + version + ", must be of " TALISMAN_VERSION, folder);
  return run;
}

std::string decisions_kept(const Json& run) { return text_in(run, "decisions", "all"); }

void require_all_decisions(const Json& run, const std::string& folder, const std::string& what) {
  if (const std::string kept = decisions_kept(run); kept != "all")
    throw InputError(
        "holds a run with --decisions " + kept + ", and " + what + " needs all, rule: --decisions all",
        folder);
}

std::vector<Json> finished_decisions(const std::string& folder) {
  const std::string file = folder + "/decisions.jsonl";
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError("is not there, must be as the run wrote it", file);
  std::vector<Json> decisions;
  for (std::string line; std::getline(in, line);) {
    decisions.push_back(Json::parse(line, nullptr, false));
    const Json& json = decisions.back();
    if (!json.is_object() || !json.contains("frame") || !json.contains("layer") || !json.contains("decision"))
      throw InputError(
          "line " + std::to_string(decisions.size()) + " is no decision, must be as the run wrote it", file);
  }
  return decisions;
}

Json finished_summary(const std::string& folder) {
  const std::string file = folder + "/summary.json";
  Json summary = parsed_file(file);
  if (!summary.is_object() || !summary.contains("layers") || !summary["layers"].is_array())
    throw InputError("is no summary, must be as the run wrote it", file);
  return summary;
}

}  // namespace talisman::sequences
