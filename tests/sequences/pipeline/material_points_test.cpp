// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include <gtest/gtest.h>

#include "layers/state.h"
#include "sequences/content/sequence.h"
#include "tests/sequences/small_run.h"
#include "tests/support/scenes.h"
#include "warp/fit.h"

namespace talisman::sequences {
namespace {

using layers::LayerState;

/// The largest error of the fitted affine warp at the matched points, and at all vertices on the display.
struct Errors {
  double said = 0, true_px = 0;
};

Errors errors_of(const layers::Scene& scene, const layers::Layer& layer, const layers::LayerBound& bound,
                 const layers::View& view, double then_s, double now_s) {
  const layers::SceneFrame before = scene.at(then_s), after = scene.at(now_s);
  const LayerState then = layers::capture(before, layer, bound, view),
                   now = layers::capture(after, layer, bound, view);
  const layers::Correspondences matched = layers::correspond(then, now, bound.hull, 1);
  const warp::FitResult fitted = warp::fit(matched.then_px, matched.now_px, warp::Curve::aff);
  Errors errors{fitted.max_px};
  const layers::dmat4 then_clip = layers::clip_from_world(before.camera, view.display_px),
                      now_clip = layers::clip_from_world(after.camera, view.display_px);
  for (const int part : layer.parts) {
    const auto from = layers::world_positions(before, scene.parts[part]),
               to = layers::world_positions(after, scene.parts[part]);
    for (std::size_t i = 0; i < from.size(); ++i) {
      const layers::dvec4 a = then_clip * layers::dvec4(from[i], 1), b = now_clip * layers::dvec4(to[i], 1);
      if (!(a.w > before.camera.near_m && b.w > after.camera.near_m)) continue;
      const layers::dvec2 p = layers::screen_from_clip(a, view.display_px),
                          q = layers::screen_from_clip(b, view.display_px);
      if (q.x < 0 || q.y < 0 || q.x > view.display_px.x || q.y > view.display_px.y) continue;
      errors.true_px = std::max(errors.true_px, glm::distance(fitted.warp(p), q));
    }
  }
  return errors;
}

/// Shares of the true error that the points miss, over the layers that deform and some pairs of instants.
std::vector<double> misses_of(const layers::Scene& scene, const layers::LayerSet& set, int material_points,
                              double length_s) {
  layers::View view;
  view.display_px = {640, 480};
  std::vector<double> misses;
  for (const layers::Layer& layer : set.layers) {
    const layers::LayerBound bound =
        layers::make_layer_bound(scene, layer, layers::BoundKind::Box8, material_points);
    bool deforms = false;
    layers::for_each_body(bound, [&](const layers::LayerBound& body) { deforms |= !body.fixed(); });
    if (!deforms) continue;
    for (int k = 0; k < 12; ++k) {
      const double then_s = length_s * k / 12;
      const Errors errors = errors_of(scene, layer, bound, view, then_s, then_s + 4.0 / 24);
      if (errors.true_px > 0.5) misses.push_back(std::max(0.0, 1 - errors.said / errors.true_px));
    }
  }
  return misses;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

TEST(MaterialPoints, MissLessTheMoreThereAre) {
  const layers::Scene scene = tests::skinned_bar_scene();
  const layers::LayerSet set = layers::factor(scene, tests::one_layer_per_part(scene));
  const double none = mean_of(misses_of(scene, set, 0, 2)), some = mean_of(misses_of(scene, set, 16, 2));
  EXPECT_GT(none, 0.2);
  EXPECT_LT(some, 0.1);
}

/// TALISMAN_MISS="a.glb b.gltf …": prints the miss of the densities in docs/bound.md.
TEST(MaterialPoints, MissOfModels) {
  const char* models = std::getenv("TALISMAN_MISS");
  if (!models) GTEST_SKIP() << "measured by hand: TALISMAN_MISS names models";
  for (const int points : {0, 8, 16, 32, 64, 256}) {
    std::vector<double> all;
    std::istringstream names(models);
    for (std::string name; names >> name;) {
      const Sequence sequence = load_sequence(name);
      const std::vector<double> own =
          misses_of(*sequence.scene, sequence.layers, points, sequence.frames / sequence.fps);
      all.insert(all.end(), own.begin(), own.end());
    }
    std::sort(all.begin(), all.end());
    const double p95 =
        all.empty() ? 0 : all[static_cast<std::size_t>(0.95 * static_cast<double>(all.size() - 1))];
    std::printf("%4d points: %zu pairs, miss mean %.1f %%, p95 %.1f %%, most %.1f %%\n", points, all.size(),
                100 * mean_of(all), 100 * p95, all.empty() ? 0 : 100 * all.back());
  }
}

}  // namespace
}  // namespace talisman::sequences
