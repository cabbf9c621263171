// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/shards/shard.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

#include "sequences/files/line_file.h"
#include "sequences/results/finished_run.h"
#include "sequences/results/frame_lines.h"
#include "sequences/results/json_text.h"
#include "sequences/results/run_identity.h"

namespace talisman::sequences {

namespace {

std::optional<int> count_from(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_whole = error == std::errc() && end == text.data() + text.size() && !text.empty();
  // No leading zeros: a folder has one name.
  return is_whole && value >= 0 && std::to_string(value) == text ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<Shard> shard_from(const std::string& text, const std::string& between) {
  const std::size_t at = text.find(between);
  if (at == std::string::npos) return std::nullopt;
  const auto index = count_from(std::string_view(text).substr(0, at));
  const auto of = count_from(std::string_view(text).substr(at + between.size()));
  if (!index || !of || *of < 1 || *of > kMostShards || *index >= *of) return std::nullopt;
  return Shard{*index, *of};
}

std::string shard_folder(const std::string& out, const Shard& shard) {
  return out + "/" + kShardsFolder + "/" + shard.name();
}

FrameRange part_of(const FrameRange& whole, const Shard& shard, const std::vector<double>& costs) {
  const std::int64_t frames = whole.last - whole.first + 1;
  double all = 0, before = 0;
  for (const double cost : costs) all += cost;
  FrameRange part{whole.last + 1, whole.last};
  bool is_found = false;
  for (std::int64_t k = 0; k < frames; ++k) {
    std::int64_t owner = k * shard.of / frames;
    if (all > 0) {
      const double middle = before + costs[static_cast<std::size_t>(k)] / 2;
      owner = std::min<std::int64_t>(std::llround(std::floor(middle / all * shard.of)), shard.of - 1);
      before += costs[static_cast<std::size_t>(k)];
    }
    if (owner < shard.index) continue;
    if (!is_found) part = {whole.first + static_cast<int>(k), whole.first + static_cast<int>(k) - 1};
    is_found = true;
    if (owner > shard.index) break;
    part.last = whole.first + static_cast<int>(k);
  }
  return part;
}

std::vector<double> costs_in_plan(const std::string& folder, const FrameRange& whole,
                                  const nlohmann::ordered_json& run) {
  const nlohmann::ordered_json plan = finished_run(folder);
  if (text_in(plan, "kind") != "plan" || text_in(plan, "identity") != text_in(run, "identity")) {
    nlohmann::ordered_json same_kind = plan;
    for (const char* key : {"kind", "frames", "format", "overlay", "separate", "quality", "decisions"})
      if (run.contains(key)) same_kind[key] = run[key];
    const std::string why = first_difference(same_kind, run);
    throw InputError("holds another run" + (why.empty() ? "" : ": " + why.substr(0, why.find(", --resume"))) +
                         ", rule: a plan with the same options as its shards",
                     folder);
  }
  std::vector<double> costs;
  for (const std::string& text : lines_written(folder + "/frames.jsonl"))
    if (const auto line = frame_line_from_json(text);
        line && line->frame >= whole.first && line->frame <= whole.last)
      costs.push_back(line->modelled_drawing_ms);
  if (costs.size() != static_cast<std::size_t>(whole.last - whole.first) + 1)
    throw InputError("has " + std::to_string(costs.size()) + " of the frames " + std::to_string(whole.first) +
                         "-" + std::to_string(whole.last) + ", rule: a plan of all frames of the run",
                     folder);
  return costs;
}

}  // namespace talisman::sequences
