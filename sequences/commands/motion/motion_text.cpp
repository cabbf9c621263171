// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <nlohmann/json.hpp>

#include "sequences/commands/motion/motion_command.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

/// Frames of a word that fit a line.
constexpr int kStrip_frames = 64;
constexpr std::size_t kUsualGroups = 24;

const std::string& part_name(const Sequence& sequence, const MotionStudy& study, int i) {
  return sequence.scene->parts[study.followed.parts[i].part].name;
}

MotionCounts counts_of_group(const MotionStudy& study, const std::vector<int>& group) {
  MotionCounts sum;
  for (const int i : group) sum += study.by_part[i];
  return sum;
}

/// A '#' where any of its parts changes, over the first slices; '|' between two of them.
std::string strip_of(const MotionStudy& study, const std::vector<int>& group) {
  std::string strip;
  for (const MotionSlice& slice : study.slices) {
    if (static_cast<int>(strip.size()) >= kStrip_frames) break;
    if (!strip.empty()) strip += '|';
    const int shown = std::min(slice.frames, study.options.frames - slice.first);
    for (int frame = 0; frame < shown; ++frame) {
      const bool changes =
          std::any_of(group.begin(), group.end(), [&](int i) { return slice.words[i].changes_at(frame); });
      strip += changes ? '#' : '.';
    }
  }
  return strip.substr(0, kStrip_frames);
}

std::string percent(double share) { return formatted("%.1f%%", 100 * share); }

double ratio(std::int64_t a, std::int64_t b) {
  return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : 1;
}

std::string plan_lines(const MotionStudy& study) {
  const MotionCounts& all = study.all;
  const regulator::PlanShape& plan = study.options.plan;
  return formatted("\n  at rest           %s of parts and frames\n", percent(all.rest()).c_str()) +
         formatted("  a buffer a part   %lld drawings of %lld (%s)\n", static_cast<long long>(all.runs),
                   static_cast<long long>(all.shown), percent(ratio(all.runs, all.shown)).c_str()) +
         formatted("  %d shared buffers  %lld drawings (%s), %.2f times as many\n", plan.levels(),
                   static_cast<long long>(all.draws), percent(ratio(all.draws, all.shown)).c_str(),
                   ratio(all.draws, all.runs)) +
         formatted("  polygons          %lld of %lld (%s), %lld prediction vertices projected\n",
                   static_cast<long long>(all.polygons), static_cast<long long>(all.polygons_direct),
                   percent(ratio(all.polygons, all.polygons_direct)).c_str(),
                   static_cast<long long>(study.vertices)) +
         formatted("  joins a slice     %lld each frame, %lld by copies, %lld in place\n",
                   static_cast<long long>(joins_of_slice(plan, regulator::Joining::EachFrame)),
                   static_cast<long long>(joins_of_slice(plan, regulator::Joining::Copy)),
                   static_cast<long long>(joins_of_slice(plan, regulator::Joining::InPlace)));
}

Json json_of(const MotionCounts& counts) {
  return {{"part_frames", counts.shown},
          {"changes", counts.changes},
          {"rest_share", counts.rest()},
          {"runs", counts.runs},
          {"draws", counts.draws},
          {"polygons", counts.polygons},
          {"polygons_direct", counts.polygons_direct}};
}

Json json_of_part(const Sequence& sequence, const MotionStudy& study, int i) {
  Json words = Json::array();
  for (const MotionSlice& slice : study.slices)
    words.push_back(
        slice.words[i].marks().substr(0, std::min(slice.frames, study.options.frames - slice.first)));
  Json part = {{"part", part_name(sequence, study, i)},
               {"primitive", std::string(layers::name(study.followed.parts[i].kind))},
               {"words", std::move(words)}};
  part.update(json_of(study.by_part[i]));
  return part;
}

}  // namespace

std::string motion_text(const Sequence& sequence, const MotionStudy& study, bool all_groups) {
  const MotionStudyOptions& options = study.options;
  std::string text = formatted(
      "%s: %d frames of %dx%d px in slices of %d (tree-k %d), delta %g px, %zu parts in %zu groups\n\n",
      sequence.name.c_str(), options.frames, options.display_px.x, options.display_px.y, options.plan.frames,
      options.plan.children, options.motion.delta_px, study.followed.parts.size(), study.groups.size());
  text += formatted("  %-20s %6s %9s %8s %7s %7s  changes, frame by frame\n", "group, by a part", "parts",
                    "polygons", "at rest", "runs", "draws");
  const std::size_t shown = all_groups ? study.groups.size() : std::min(study.groups.size(), kUsualGroups);
  for (std::size_t g = 0; g < shown; ++g) {
    const std::vector<int>& group = study.groups[g];
    const MotionCounts counts = counts_of_group(study, group);
    text += formatted("  %-20s %6zu %9lld %8s %7lld %7lld  %s\n",
                      part_name(sequence, study, group.front()).c_str(), group.size(),
                      static_cast<long long>(counts.polygons_direct / options.frames),
                      percent(counts.rest()).c_str(), static_cast<long long>(counts.runs),
                      static_cast<long long>(counts.draws), strip_of(study, group).c_str());
  }
  if (shown < study.groups.size())
    text += formatted("  ... %zu more groups; --all shows them\n", study.groups.size() - shown);
  return text + plan_lines(study);
}

std::string motion_json(const Sequence& sequence, const MotionStudy& study) {
  Json groups = Json::array();
  for (const std::vector<int>& group : study.groups) {
    Json parts = Json::array();
    for (const int i : group) parts.push_back(json_of_part(sequence, study, i));
    groups.push_back({{"parts", std::move(parts)}});
  }
  const MotionStudyOptions& options = study.options;
  const Json root = {{"schema", "talisman.motion/1"},
                     {"sequence", sequence.name},
                     {"frames", options.frames},
                     {"display_px", {options.display_px.x, options.display_px.y}},
                     {"delta_px", options.motion.delta_px},
                     {"lookahead", options.plan.frames},
                     {"tree_k", options.plan.children},
                     {"buffers", options.plan.levels()},
                     {"all", json_of(study.all)},
                     {"prediction_vertices", study.vertices},
                     {"groups", std::move(groups)}};
  return root.dump(1) + "\n";
}

std::string motion_csv(const Sequence& sequence, const MotionStudy& study) {
  std::string text = "part,group,primitive,first_frame,word,runs,draws\n";
  for (std::size_t g = 0; g < study.groups.size(); ++g)
    for (const int i : study.groups[g])
      for (const MotionSlice& slice : study.slices) {
        const int shown = std::min(slice.frames, study.options.frames - slice.first);
        const MotionCounts counts =
            counts_of(slice.words[i], slice.first, study.options.frames, study.options.plan, 0);
        std::string name = part_name(sequence, study, i);
        for (std::size_t at = 0; (at = name.find('"', at)) != std::string::npos; at += 2)
          name.insert(at, "\"");
        text += '"' + name + "\"," + std::to_string(g) + ',' +
                std::string(layers::name(study.followed.parts[i].kind)) + ',' + std::to_string(slice.first) +
                ',' + slice.words[i].marks().substr(0, shown) + ',' + std::to_string(counts.runs) + ',' +
                std::to_string(counts.draws) + '\n';
      }
  return text;
}

}  // namespace talisman::sequences
