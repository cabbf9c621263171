// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/reproduction/figures_15_16.h"

#include <algorithm>
#include <cmath>

#include "sequences/experiments/warps/objects.h"
#include "sequences/experiments/warps/quality.h"
#include "sequences/experiments/warps/report.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

using warp::Curve;

constexpr double kHighError_px = 8, kSlightly = 1.2;
constexpr double kNoWorseFlip = 1.05;

using CompareWithFigure = std::vector<Statement> (*)(const Ranking&);

struct TeapotFigure {
  const char* id;
  const char* object;
  const char* stand_in;
  CompareWithFigure compare;
};
constexpr TeapotFigure kFlatTeapot{"15", "flat-teapot", "flat-box", compare_with_figure_15};
constexpr TeapotFigure kRoundTeapot{"16", "teapot", "box", compare_with_figure_16};

/// The teapot is content that may not be there.
WarpObject teapot_or_box(const TeapotFigure& figure) {
  try {
    return load_warp_object(figure.object);
  } catch (const InputError&) {
    return load_warp_object(figure.stand_in);
  }
}

const WarpObject& object_on(PaperBench& bench, const TeapotFigure& figure) {
  return bench.once(std::string("object of ") + figure.id, [&] { return teapot_or_box(figure); });
}

const std::vector<UpdateCurve>& curves_on(PaperBench& bench, const TeapotFigure& figure, std::size_t motion) {
  const WarpMotion moved = warp_motions()[motion];
  return bench.once(std::string("curves of ") + figure.id + " in " + moved.name, [&] {
    const layers::Scene scene = stage(object_on(bench, figure), moved);
    return update_curves(capture_animation(scene, kMotion_frames, kMotion_fps, {}, layers::BoundKind::Box8),
                         figure_thresholds());
  });
}

/// The paper's motions are not published: in which of ours does a statement hold?
std::string in_other_motions(PaperBench& bench, const TeapotFigure& figure,
                             const std::function<Finding(const std::vector<UpdateCurve>&)>& test) {
  const std::vector<WarpMotion> motions = warp_motions();
  std::string yes;
  int holding = 0, telling = 0;
  for (std::size_t m = 1; m < motions.size(); ++m) {
    const std::vector<UpdateCurve>& curves = curves_on(bench, figure, m);
    if (rank(curves).thresholds_used == 0) continue;
    ++telling;
    if (!test(curves).same) continue;
    ++holding;
    yes += (yes.empty() ? ": " : ", ") + motions[m].name;
  }
  return "of " + std::to_string(telling) + " other motions that tell the curves apart it holds in " +
         std::to_string(holding) + yes;
}

Claim teapot_claim(const TeapotFigure& figure, const std::string& id, const std::string& paper,
                   const std::string& rule,
                   const std::function<Finding(const std::vector<UpdateCurve>&)>& test) {
  return {id, paper, rule, [&figure, test](PaperBench& bench) { return test(curves_on(bench, figure, 0)); },
          [&figure, test](PaperBench& bench) { return in_other_motions(bench, figure, test); }};
}

/// One row per statement of the ranking.
std::vector<Claim> claims_of(const TeapotFigure& figure) {
  std::vector<Claim> claims;
  const std::vector<Statement> statements = figure.compare(Ranking{});
  for (std::size_t k = 0; k < statements.size(); ++k)
    claims.push_back(
        teapot_claim(figure, std::to_string(k + 1), statements[k].paper,
                     "update rates relative to aff, in the mean over the thresholds; alike within 10 %",
                     [k, compare = figure.compare](const std::vector<UpdateCurve>& curves) {
                       return finding_of(compare(rank(curves))[k]);
                     }));
  return claims;
}

std::vector<PaperFigure> drawings_of(PaperBench& bench, const TeapotFigure& figure) {
  const WarpObject& object = object_on(bench, figure);
  const WarpMotion motion = warp_motions()[0];
  return {{std::string("LS97-") + figure.id, std::string("Fig. ") + figure.id + ": " + object.title,
           update_rate_plot(object.title + ", " + motion.title, figure_thresholds(),
                            curves_on(bench, figure, 0))}};
}

Item figure_of(const TeapotFigure& figure, const std::string& title, std::vector<Claim> claims) {
  return {figure.id, title, std::move(claims),
          [&figure](PaperBench& bench) { return drawings_of(bench, figure); }};
}

const std::vector<CurveQuality>& pictures_on(PaperBench& bench, const TeapotFigure& figure) {
  return bench.once(std::string("pictures of ") + figure.id,
                    [&] { return quality_at_rate(stage(object_on(bench, figure), warp_motions()[0])); });
}

Finding affine_pictures(const std::vector<CurveQuality>& curves) {
  const auto flip = [&](Curve curve) {
    for (const CurveQuality& each : curves)
      if (each.curve == curve) return each.mean.flip;
    return HUGE_VAL;
  };
  const double affine = flip(Curve::aff),
               less = std::min({flip(Curve::trn), flip(Curve::iso), flip(Curve::so)}),
               perspective = std::min(flip(Curve::per), flip(Curve::per2));
  return {"FLIP " + fixed(affine, 4) + "; less general " + fixed(less, 4) + ", perspective " +
              fixed(perspective, 4),
          affine < less && affine <= kNoWorseFlip * perspective,
          {{"affine", affine}, {"less_general", less}, {"perspective", perspective}}};
}

Claim picture_claim(const TeapotFigure& figure, const std::string& id, const std::string& what) {
  Claim claim{id, what + ": affine looks best at one update rate, perspective no better",
              "mean FLIP below trn, iso and so, at most 1.05 of per and per2",
              [&figure](PaperBench& bench) { return affine_pictures(pictures_on(bench, figure)); },
              [&figure](PaperBench& bench) {
                std::string text = "FLIP at 20 % renders";
                for (const CurveQuality& each : pictures_on(bench, figure))
                  text += ", " + std::string(warp::name(each.curve)) + " " + fixed(each.mean.flip, 4);
                return text;
              }};
  claim.pictures = true;
  return claim;
}

}  // namespace

Finding finding_of(const Statement& statement) {
  return {statement.ours + (statement.agreement == Agreement::OrderOnly ? " (closer than 10 %)" : ""),
          statement.agreement != Agreement::No,
          {}};
}

Finding homogeneous_is_worse_at_high_error(const std::vector<UpdateCurve>& curves,
                                           const std::vector<double>& thresholds_px) {
  const auto renders = [&](Curve curve) -> const std::vector<int>& {
    return std::find_if(curves.begin(), curves.end(), [&](auto& c) { return c.curve == curve; })->renders;
  };
  const int frames = curves.front().frames;
  Finding finding{"", true, {}};
  for (const auto& [curve, of] : {std::pair{Curve::per, Curve::aff}, std::pair{Curve::peri, Curve::affi}}) {
    const std::vector<int>& affine = renders(of);
    double sum = 0;
    int telling = 0;
    for (std::size_t t = 0; t < thresholds_px.size(); ++t) {
      if (thresholds_px[t] < kHighError_px || affine[t] <= 1 || affine[t] >= frames) continue;
      sum += std::log(renders(curve)[t] / double(affine[t]));
      ++telling;
    }
    const double ratio = telling > 0 ? std::exp(sum / telling) : 1;
    finding.same = finding.same && ratio > 1 && ratio <= kSlightly;
    const std::string name(warp::name(curve));
    finding.ours += (finding.ours.empty() ? "" : ", ") + name + " " + fixed(ratio, 3) + " of " +
                    std::string(warp::name(of));
    finding.numbers.emplace_back(name, ratio);
  }
  return finding;
}

Item figure_15() {
  return figure_of(kFlatTeapot, "Fig. 15: flat teapot, update rate against error", claims_of(kFlatTeapot));
}

Item figure_16() {
  std::vector<Claim> claims = claims_of(kRoundTeapot);
  claims.push_back(teapot_claim(
      kRoundTeapot, "high-error", "per and peri slightly worse than aff at high error",
      "at 8 px and more: above 1, at most 1.2 of aff and affi", [](const std::vector<UpdateCurve>& curves) {
        return homogeneous_is_worse_at_high_error(curves, figure_thresholds());
      }));
  return figure_of(kRoundTeapot, "Fig. 16: regular teapot, update rate against error", std::move(claims));
}

Item warp_pictures() {
  return {"4.2",
          "4.2, second series: pictures at one update rate",
          {picture_claim(kFlatTeapot, "flat", "flat teapot"),
           picture_claim(kRoundTeapot, "round", "regular teapot")}};
}

}  // namespace talisman::sequences
