// SPDX-License-Identifier: Apache-2.0
#include "sequences/warp_ranking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

using warp::Curve;

struct Group {
  std::string name;
  std::vector<Curve> curves;
};

const Group kTranslation{"translation", {Curve::trn, Curve::trni}};
const Group kXyScale{"x/y scale", {Curve::so, Curve::soi}};
const Group kShade{"Shade", {Curve::pers}};
const Group kAffine{"affine", {Curve::aff, Curve::affi}};
const Group kPerspective{"perspective", {Curve::per, Curve::peri, Curve::per2, Curve::pers2}};
const Group kOthers{
    "all others", {Curve::aff, Curve::affi, Curve::per, Curve::peri, Curve::per2, Curve::pers, Curve::pers2}};

std::string two_digits(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", v);
  return text;
}

/// Smallest and largest ratio in a group.
std::array<double, 2> range_of(const Group& group, const Ranking& ranking) {
  std::array<double, 2> range{HUGE_VAL, 0};
  for (const Curve curve : group.curves) {
    const double ratio = ranking.ratio(curve);
    range = {std::fmin(range[0], ratio), std::fmax(range[1], ratio)};
  }
  return range;
}

std::string range_text(const Group& group, const Ranking& ranking) {
  const auto [lo, hi] = range_of(group, ranking);
  return group.name + " " + two_digits(lo) + (lo < hi ? "–" + two_digits(hi) : "");
}

/// Every curve of `worse` renders more than every curve of `better`, by more than the tolerance.
Statement apart(const Group& worse, const Group& better, const Ranking& ranking) {
  const bool apart = range_of(worse, ranking)[0] > range_of(better, ranking)[1] * (1 + kAlike);
  return {worse.name + " needs more renders than " + better.name + ", and is a cluster of its own",
          range_text(worse, ranking) + " against " + range_text(better, ranking), apart};
}

Statement one_cluster(const Group& group, const Ranking& ranking) {
  const auto [lo, hi] = range_of(group, ranking);
  return {group.name + " is one cluster", range_text(group, ranking), hi <= lo * (1 + kAlike)};
}

Statement norms_alike(const Ranking& ranking) {
  double largest = 1;
  Curve which = Curve::trni;
  for (const auto& [sum, maximum] :
       {std::pair{Curve::trn, Curve::trni}, std::pair{Curve::so, Curve::soi},
        std::pair{Curve::aff, Curve::affi}, std::pair{Curve::per, Curve::peri}}) {
    const double quotient = ranking.ratio(sum) / ranking.ratio(maximum);
    const double difference = std::fmax(quotient, 1 / quotient);
    if (difference > largest) largest = difference, which = maximum;
  }
  return {"sum of squares is not much different from maximum for any warp",
          "at most a factor of " + two_digits(largest) + " (" + std::string(name(which)) + ")",
          largest <= 1 + 2 * kAlike};
}

}  // namespace

double Ranking::ratio(Curve curve) const {
  for (const CurveMerit& merit : merits)
    if (merit.curve == curve) return merit.ratio;
  return 1;
}

Ranking rank(const std::vector<UpdateCurve>& curves, int frames, double tolerance) {
  const auto aff = std::find_if(curves.begin(), curves.end(), [](auto& c) { return c.curve == Curve::aff; });
  TALISMAN_CHECK(aff != curves.end());
  Ranking ranking;
  std::vector<std::size_t> telling;
  for (std::size_t t = 0; t < aff->renders.size(); ++t)
    if (aff->renders[t] > 1 && aff->renders[t] < frames) telling.push_back(t);
  ranking.thresholds_used = static_cast<int>(telling.size());
  for (const UpdateCurve& curve : curves) {
    double sum = 0;
    for (const std::size_t t : telling) sum += std::log(curve.renders[t] / double(aff->renders[t]));
    ranking.merits.push_back({curve.curve, telling.empty() ? 1 : std::exp(sum / double(telling.size()))});
  }
  std::stable_sort(ranking.merits.begin(), ranking.merits.end(),
                   [](const CurveMerit& a, const CurveMerit& b) { return a.ratio > b.ratio; });
  double last = HUGE_VAL;
  for (const auto& [curve, ratio] : ranking.merits) {
    if (ranking.clusters.empty() || last > ratio * (1 + tolerance)) ranking.clusters.emplace_back();
    ranking.clusters.back().push_back(curve);
    last = ratio;
  }
  return ranking;
}

std::string in_words(const Ranking& ranking) {
  std::string text;
  for (const auto& cluster : ranking.clusters) {
    if (!text.empty()) text += " |";
    for (const Curve curve : cluster) text += (text.empty() ? "" : " ") + std::string(name(curve));
  }
  return text;
}

std::vector<Statement> compare_with_figure_15(const Ranking& ranking) {
  return {apart(kTranslation, kXyScale, ranking), apart(kXyScale, kShade, ranking),
          apart(kShade, kAffine, ranking),        apart(kAffine, kPerspective, ranking),
          one_cluster(kPerspective, ranking),     norms_alike(ranking)};
}

std::vector<Statement> compare_with_figure_16(const Ranking& ranking) {
  const double shade = ranking.ratio(Curve::pers);
  const auto [best_perspective, worst_perspective] =
      range_of({"", {Curve::per, Curve::peri, Curve::per2}}, ranking);
  return {apart(kTranslation, kXyScale, ranking),
          apart(kXyScale, kOthers, ranking),
          one_cluster(kOthers, ranking),
          {"Shade is slightly worse than affine", "ratio " + two_digits(shade),
           shade > 1 && shade <= 1 + 2 * kAlike},
          {"perspective yields virtually no advantage over affine",
           "ratio " + two_digits(best_perspective) + "–" + two_digits(worst_perspective),
           best_perspective >= 1 / (1 + kAlike)},
          norms_alike(ranking)};
}

}  // namespace talisman::sequences
