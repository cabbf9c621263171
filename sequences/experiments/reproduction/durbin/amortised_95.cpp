// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/durbin/amortised_95.h"

#include <optional>

#include "regulator/regroup.h"
#include "sequences/experiments/amortised/groupings.h"
#include "sequences/experiments/amortised/measured.h"
#include "sequences/files/errors.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

using regulator::Policy;
using regulator::Regroup;
using regulator::RegroupPrices;

constexpr double kGain95 = 29.0 / 12.0;  // frames a second after and before
constexpr double kSpeedUp95 = 2.5;

/// From how many frames on are two layers of so many polygons merged? 0: in no run of up to 1,000 frames.
int first_merge(std::int64_t polygons) {
  regulator::RegroupOptions options;
  options.prices = RegroupPrices::Durbin1995;
  for (int frames = 1; frames <= 1000; ++frames)
    if (regulator::weigh_merge({}, {}, {0, 0, double(frames), polygons}, options, options.ceiling_ms)
            .is_made())
      return frames;
  return 0;
}

struct ParkCosts {
  double direct_ms = 0, parts_ms = 0, regrouped_ms = 0;  ///< mean of a frame
};

double mean_ms(const Sequence& sequence, Settings settings, Policy policy, Regroup by) {
  settings.regulator.policy = policy;
  settings.regulator.regroup.by = by;
  settings.explicit_order = sequence.explicit_order;
  const Pipeline pipeline = make_pipeline(*sequence.scene, sequence.layers, settings);
  PipelineState state(pipeline);
  double sum_ms = 0;
  for (int frame = 0; frame < sequence.frames; ++frame) {
    const PlannedCost cost = planned_cost(step(pipeline, state, frame, nullptr), policy);
    sum_ms += cost.render_ms + cost.composite_ms;
  }
  return sum_ms / sequence.frames;
}

const ParkCosts& park_costs(PaperBench& bench) {
  return bench.once("D95 park", [&bench] {
    const OpenSequence& park = bench.sequence("park");
    const std::optional<Sequence> parts = one_layer_per_part(park.sequence, park.settings);
    if (!parts) throw InputError("park: a part cannot be named alone");
    return ParkCosts{mean_ms(*parts, park.settings, Policy::Direct, Regroup::None),
                     mean_ms(*parts, park.settings, Policy::Threshold, Regroup::None),
                     mean_ms(*parts, park.settings, Policy::Threshold, Regroup::Amortised)};
  });
}

}  // namespace

Finding break_even_finding(int first_yes, double formula_frames) {
  Finding finding{formatted("yes from %d frames on; OT / (TTRU - TTRO) = %.2f", first_yes, formula_frames),
                  first_yes > formula_frames && first_yes - 1 <= formula_frames,
                  {{"first_frames", double(first_yes)}, {"break_even_frames", formula_frames}}};
  if (first_yes == 0) finding.ours = "never, in runs of up to 1,000 frames";
  return finding;
}

Finding park_finding(double direct_ms, double parts_ms, double regrouped_ms) {
  const double gain = regrouped_ms > 0 ? direct_ms / regrouped_ms : 0;
  return {formatted("%.1f to %.1f frames a second, %.2f-fold (one sprite for each part: %.1f), modelled",
                    1e3 / direct_ms, 1e3 / regrouped_ms, gain, 1e3 / parts_ms),
          gain >= 2.4 && regrouped_ms <= parts_ms * (1 + 1e-9),
          {{"direct_ms", direct_ms}, {"parts_ms", parts_ms}, {"regrouped_ms", regrouped_ms}, {"gain", gain}}};
}

Item utility_test_95() {
  Claim when{"break-even", "TTRU 12.7, TTRO 3.8, OT 87.9 us a polygon: pays where TTRO AUT + OT < TTRU AUT",
             "yes from the first whole number of frames above OT / (TTRU - TTRO) on", [](PaperBench&) {
               return break_even_finding(first_merge(1000),
                                         regulator::break_even_frames(regulator::durbin_1995(1000)));
             }};
  when.derived = when.must = true;
  Claim size{"size", "all three grow with the polygons",
             "the answer is the same for 10 and a million polygons", [](PaperBench&) {
               const int few = first_merge(10), many = first_merge(1'000'000);
               return Finding{formatted("%d and %d frames", few, many),
                              few == many && few > 0,
                              {{"few", double(few)}, {"many", double(many)}}};
             }};
  size.derived = size.must = true;
  Claim ratio{"ratio", "AUT: frames unaltered over all frames, a running average",
              "the test says yes for some such ratio, which is at most 1",
              [](PaperBench&) {
                const bool ever = regulator::pays(regulator::durbin_1995(1000), 1);
                return Finding{ever ? "yes" : "no: 87.9 + 3.8 > 12.7 for AUT = 1", ever, {}};
              },
              [](PaperBench&) {
                return formatted("AUT has to be a number of frames: then yes from %d on", first_merge(1000));
              }};
  return {"utility", "The utility function", {when, size, ratio}};
}

Item amusement_park_95() {
  Claim frames{"frames", "12 frames a second without optimisation, 29 with",
               formatted("at least 2.4-fold (%.2f), and no slower than one sprite for each part", kGain95),
               [](PaperBench& bench) {
                 const ParkCosts& costs = park_costs(bench);
                 return park_finding(costs.direct_ms, costs.parts_ms, costs.regrouped_ms);
               }};
  frames.sequence = "park";
  Claim typical{"typical", "day-to-day use: some 2.5 times as fast", "at least 2.5-fold",
                [](PaperBench& bench) {
                  const ParkCosts& costs = park_costs(bench);
                  const double gain = costs.direct_ms / costs.regrouped_ms;
                  return Finding{formatted("%.2f-fold", gain), gain >= kSpeedUp95, {{"gain", gain}}};
                }};
  typical.sequence = "park";
  return {"park", "The amusement park", {frames, typical}};
}

}  // namespace talisman::sequences
