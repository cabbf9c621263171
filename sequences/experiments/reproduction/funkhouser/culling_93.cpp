// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/funkhouser/culling_93.h"

#include <algorithm>

#include "layers/cells.h"
#include "sequences/files/number_text.h"
#include "sequences/pipeline/culling/culling.h"
#include "sequences/pipeline/make_pipeline.h"

namespace talisman::sequences {

namespace {

constexpr const char* kWalked93[] = {"hall/block", "hall"};
constexpr int kSampledFrames93 = 120;

/// Of all polygons, left by the triple, on average over frames of the walk.
double share_left(const OpenSequence& open, const char* triple) {
  Settings settings = open.settings;
  settings.visibility = *visibility_from(triple);
  settings.cells = open.sequence.cells;
  const layers::Scene& scene = *open.sequence.scene;
  const Pipeline pipeline = make_pipeline(scene, open.sequence.layers, settings);
  PipelineState state(pipeline);
  double all = 0, left = 0;
  for (const layers::Part& part : scene.parts) all += scene.meshes[part.mesh].triangle_count();
  const int every = std::max(1, open.sequence.frames / kSampledFrames93);
  int frames = 0;
  for (int frame = 0; frame < open.sequence.frames; frame += every, ++frames)
    left += double(seen_at(pipeline, state, frame)->polygons);
  return left / (all * frames);
}

const SharesLeft& shares_93(PaperBench& bench, const std::string& name) {
  return bench.once("Fu93 shares " + name, [&bench, &name] {
    const OpenSequence& open = bench.sequence(name);
    return SharesLeft{share_left(open, "none,none,frustum"), share_left(open, "cto,none,none"),
                      share_left(open, "cto,frustum,frustum"), share_left(open, "cto,eye,eye")};
  });
}

/// A share in a building of the paper's size, and beside it where it says no: the same in a small one.
Claim share_claim(const std::string& id, const std::string& paper, const std::string& rule,
                  double SharesLeft::*share, bool (*keeps)(double)) {
  const auto measured = [share](PaperBench& bench, const char* name) {
    return shares_93(bench, name).*share;
  };
  Claim claim{id, paper, rule, [=](PaperBench& bench) {
                const double ours = measured(bench, kWalked93[0]);
                return Finding{formatted("%.2f %%", 100 * ours), keeps(ours), {{"share", ours}}};
              }};
  claim.why = [=](PaperBench& bench) {
    const OpenSequence &large = bench.sequence(kWalked93[0]), &small = bench.sequence(kWalked93[1]);
    const double there = measured(bench, kWalked93[1]);
    return formatted("in its %zu cells; %.2f %% in the %zu of %s", large.sequence.cells->cells.size(),
                     100 * there, small.sequence.cells->cells.size(), kWalked93[1]) +
           (keeps(there) ? ", which keeps the rule" : "");
  };
  claim.sequence = kWalked93[0];
  return claim;
}

}  // namespace

Finding order_finding_93(const SharesLeft& s) {
  return {formatted("%.1f %% by the frustum, %.1f %% CTO, %.2f %% both, %.2f %% CTO and lines of sight",
                    100 * s.frustum, 100 * s.cto, 100 * s.cto_frustum, 100 * s.cto_eye),
          s.frustum > s.cto_frustum && s.cto > s.cto_frustum && s.cto_frustum > s.cto_eye && s.cto_eye > 0,
          {{"frustum", s.frustum}, {"cto", s.cto}, {"cto_frustum", s.cto_frustum}, {"cto_eye", s.cto_eye}}};
}

Item visibility_93() {
  Claim order{"order",
              "1,418,807 polygons: 221,537 by the frustum, 46,510 CTO, 15,048 both, 7,823 CTO and eye",
              "each leaves less than those that it refines",
              [](PaperBench& bench) { return order_finding_93(shares_93(bench, kWalked93[0])); }};
  order.sequence = kWalked93[0];
  order.must = true;
  return {"4.1",
          "Table 4.1: polygons left by each way of finding what can be seen",
          {order,
           share_claim("frustum", "15.6 % are in the frustum", "at least 10 %", &SharesLeft::frustum,
                       [](double s) { return s >= 0.1; }),
           share_claim("cto", "3.28 % are in what some eye in the cell can see", "at most 5 %",
                       &SharesLeft::cto, [](double s) { return s <= 0.05; }),
           share_claim("both", "1.06 % are in both", "at most 2 %", &SharesLeft::cto_frustum,
                       [](double s) { return s <= 0.02; }),
           share_claim("eye", "0.55 % are seen through the portals", "at most 1 %", &SharesLeft::cto_eye,
                       [](double s) { return s <= 0.01; })}};
}

}  // namespace talisman::sequences
