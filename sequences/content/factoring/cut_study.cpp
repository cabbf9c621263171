// SPDX-License-Identifier: Apache-2.0
// Which parts are worth cutting: planned whole and cut, and then with all cuts at once.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "layers/cut.h"
#include "layers/glob.h"
#include "sequences/content/factoring/cuts.h"
#include "sequences/content/factoring/planned_factoring.h"
#include "sequences/content/seams.h"

namespace talisman::sequences {

namespace {

using layers::LayerSpec;
using layers::Scene;

/// What plans need: all but the texels.
Scene without_texels(const Scene& scene) {
  Scene copy = scene;
  for (layers::Texture& texture : copy.textures) texture.rgba = {};
  return copy;
}

LayerSpec layer_of_part(const std::string& name) {
  LayerSpec spec;
  spec.name = name;
  spec.part_globs = {layers::glob_of_name(name)};
  return spec;
}

double size_of(const Scene& scene, int part) {
  layers::dvec3 lo(HUGE_VAL), hi(-HUGE_VAL);
  for (const layers::dvec3& p : layers::world_positions(scene.at(0), scene.parts[part]))
    lo = glm::min(lo, p), hi = glm::max(hi, p);
  return glm::length(hi - lo);
}

class Cutting {
 public:
  Cutting(Unfactored unfactored, const FactoringStudy& study)
      : unfactored_(std::move(unfactored)), study_(study), frames_(study.chosen.plan.frames) {}

  std::vector<CutEntry> worth_making() const {
    std::vector<CutEntry> cuts;
    const std::vector<int> parts = parts_to_try();
    if (parts.empty()) return cuts;
    const Scene planned = without_texels(unfactored_.scene);
    for (const int part : parts)
      if (const int into = best_number(planned, part); into > 1)
        cuts.push_back({layers::glob_of_name(unfactored_.scene.parts[part].name), into, "", 0});
    return cuts;
  }

 private:
  /// The largest rigid parts of layers that are dear and often drawn.
  std::vector<int> parts_to_try() const {
    const Factoring& f = study_.chosen;
    const std::vector<PlannedFactoring> plans =
        plans_apart(unfactored_.scene, f.specs, unfactored_.settings, frames_);
    const double dear_ms =
        kDearShare * std::accumulate(plans.begin(), plans.end(), 0.0,
                                     [](double ms, const PlannedFactoring& p) { return ms + p.work_ms(); });
    std::vector<int> found;
    for (std::size_t i = unfactored_.kept.size(); i < plans.size(); ++i) {
      if (plans[i].work_ms() < dear_ms || static_cast<double>(plans[i].renders) < kOftenShare * frames_)
        continue;
      const std::vector<int> parts = largest_parts(f.pieces[i]);
      found.insert(found.end(), parts.begin(), parts.end());
    }
    return found;
  }

  std::vector<int> largest_parts(const std::vector<int>& pieces) const {
    const Scene& scene = unfactored_.scene;
    std::vector<std::pair<double, int>> by_size;
    for (const int piece : pieces)
      for (const int part : study_.pieces.layers[piece].parts)
        if (can_be_cut(part)) by_size.emplace_back(-size_of(scene, part), part);
    std::sort(by_size.begin(), by_size.end());
    by_size.resize(std::min<std::size_t>(by_size.size(), kMostPartsTried));
    std::vector<int> parts;
    for (const auto& [size, part] : by_size) parts.push_back(part);
    return parts;
  }

  /// Names of parts may be double: a cut takes all of a name.
  bool can_be_cut(int part) const {
    const Scene& scene = unfactored_.scene;
    const auto same = [&](const layers::Part& other) { return other.name == scene.parts[part].name; };
    return layers::cut_defect(scene, part).empty() &&
           scene.meshes[scene.parts[part].mesh].triangle_count() >= kLeastCutTriangles &&
           std::count_if(scene.parts.begin(), scene.parts.end(), same) == 1;
  }

  /// Into how many pieces a part that is alone costs least; 1: as it is.
  int best_number(const Scene& uncut, int part) const {
    const std::string name = uncut.parts[part].name;
    const LayerSpec whole = layer_of_part(name);
    double least_ms =
        (1 - kCutMustSave) *
        plans_apart(uncut, std::span(&whole, 1), unfactored_.settings, frames_).front().work_ms();
    int best = 1;
    for (const int pieces : kTriedPieces) {
      Scene scene = uncut;
      const int made = layers::cut_part(scene, part, pieces);
      std::vector<LayerSpec> specs;
      for (int k = 1; k <= made; ++k) specs.push_back(layer_of_part(layers::cut_piece_name(name, k)));
      double ms = 0;
      for (const PlannedFactoring& plan : plans_apart(scene, specs, unfactored_.settings, frames_))
        ms += plan.work_ms();
      if (made == pieces && ms < least_ms) {
        least_ms = ms;
        best = pieces;
      }
    }
    return best;
  }

  Unfactored unfactored_;
  const FactoringStudy& study_;
  int frames_;
};

double ms_a_frame(const PlannedFactoring& plan) { return plan.work_ms() / plan.frames; }

/// With what its layers draw beyond the edges that they share, without which cracks would open between pieces.
double ms_with_seams(const Settings& settings, const Scene& cut, const Factoring& chosen) {
  Scene seamed = cut;
  std::vector<LayerSpec> specs = chosen.specs;
  add_seams(
      seamed,
      {settings.regulator.thresholds.geometric_px, settings.fps, settings.frames, settings.view.display_px},
      specs);
  return ms_a_frame(
      plan_of(seamed, layers::factor(seamed, specs), chosen.pairs(), settings, chosen.plan.frames));
}

}  // namespace

CutStudy study_with_cuts(const Unfactored& scene, const AutoLayers& options) {
  CutStudy best{study(scene, options)};
  if (options.way != FactoringWay::Velocity || best.study.chosen.plan.frames < 2) return best;
  double least_ms = ms_a_frame(best.study.chosen.plan);
  std::optional<Scene> best_scene;  // without texels; none: as it was given
  for (int round = 0; round < kCutRounds; ++round) {
    if (scene.begins) scene.begins("planning parts whole and cut");
    const Scene& now = best_scene ? *best_scene : scene.scene;
    const std::vector<CutEntry> cuts =
        Cutting({now, scene.kept, scene.nodes, scene.settings}, best.study).worth_making();
    if (cuts.empty()) break;
    Scene cut_scene = without_texels(now);
    apply_cuts(cuts, cut_scene);
    FactoringStudy cut_study =
        study({cut_scene, scene.kept, scene.nodes, scene.settings, scene.begins}, options);
    const double ms = ms_with_seams(scene.settings, cut_scene, cut_study.chosen);
    if (!(ms < (1 - kCutsMustSave) * least_ms)) break;
    least_ms = ms;
    best.study = std::move(cut_study);
    best.cuts.insert(best.cuts.end(), cuts.begin(), cuts.end());
    best_scene = std::move(cut_scene);
  }
  return best;
}

}  // namespace talisman::sequences
