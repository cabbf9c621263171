// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/warps/ranking.h"

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

const Group kTranslation{"trn", {Curve::trn}}, kTranslationMax{"trni", {Curve::trni}};
const Group kXyScale{"so", {Curve::so}}, kXyScaleMax{"soi", {Curve::soi}};
const Group kShade{"pers", {Curve::pers}};
const Group kAffine{"aff", {Curve::aff}}, kAffineMax{"affi", {Curve::affi}};
const Group kPerspective{"per, per2, pers2", {Curve::per, Curve::per2, Curve::pers2}};
const Group kPerspectiveMax{"peri", {Curve::peri}};
const Group kOthers{"aff, per, per2, pers, pers2",
                    {Curve::aff, Curve::per, Curve::per2, Curve::pers, Curve::pers2}};
const Group kOthersMax{"affi, peri", {Curve::affi, Curve::peri}};

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

Agreement agreement(bool yes) { return yes ? Agreement::Yes : Agreement::No; }

/// Every curve of `worse` renders more than every curve of `better`, by more than the tolerance.
Statement apart(const Group& worse, const Group& better, const Ranking& ranking) {
  const double least = range_of(worse, ranking)[0], most = range_of(better, ranking)[1];
  return {worse.name + " clearly worse than " + better.name,
          range_text(worse, ranking) + "; " + range_text(better, ranking),
          least > most * (1 + kAlike) ? Agreement::Yes
          : least > most              ? Agreement::OrderOnly
                                      : Agreement::No};
}

Statement one_cluster(const Group& group, const Ranking& ranking) {
  const auto [lo, hi] = range_of(group, ranking);
  return {group.name + " in one cluster", range_text(group, ranking), agreement(hi <= lo * (1 + kAlike))};
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
          "at most a factor of " + two_digits(largest) + " (" + std::string(warp::name(which)) + ")",
          agreement(largest <= 1 + kAlike)};
}

}  // namespace

double Ranking::ratio(Curve curve) const {
  for (const CurveMerit& merit : merits)
    if (merit.curve == curve) return merit.ratio;
  return 1;
}

Ranking rank(const std::vector<UpdateCurve>& curves, double tolerance) {
  const auto aff = std::find_if(curves.begin(), curves.end(), [](auto& c) { return c.curve == Curve::aff; });
  TALISMAN_CHECK(aff != curves.end());
  Ranking ranking;
  std::vector<std::size_t> telling;
  for (std::size_t t = 0; t < aff->renders.size(); ++t)
    if (aff->renders[t] > 1 && aff->renders[t] < aff->frames) telling.push_back(t);
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
    for (const Curve curve : cluster) text += (text.empty() ? "" : " ") + std::string(warp::name(curve));
  }
  return text;
}

std::string_view name(Agreement agreement) {
  switch (agreement) {
    case Agreement::Yes:
      return "agrees";
    case Agreement::OrderOnly:
      return "order agrees, closer than the tolerance";
    case Agreement::No:
      return "differs";
  }
  TALISMAN_CHECK(false && "no such agreement");
}

std::vector<Statement> compare_with_figure_15(const Ranking& ranking) {
  return {apart(kTranslation, kXyScale, ranking),
          apart(kTranslationMax, kXyScaleMax, ranking),
          apart(kXyScale, kShade, ranking),
          apart(kShade, kAffine, ranking),
          apart(kXyScaleMax, kAffineMax, ranking),
          apart(kAffine, kPerspective, ranking),
          apart(kAffineMax, kPerspectiveMax, ranking),
          one_cluster(kPerspective, ranking),
          norms_alike(ranking)};
}

std::vector<Statement> compare_with_figure_16(const Ranking& ranking) {
  const double shade = ranking.ratio(Curve::pers);
  const Statement same = one_cluster({"aff, per, per2", {Curve::aff, Curve::per, Curve::per2}}, ranking);
  return {apart(kTranslation, kXyScale, ranking),
          apart(kTranslationMax, kXyScaleMax, ranking),
          apart(kXyScale, kOthers, ranking),
          apart(kXyScaleMax, kOthersMax, ranking),
          one_cluster(kOthers, ranking),
          one_cluster(kOthersMax, ranking),
          {"pers slightly worse than aff", "pers " + two_digits(shade), agreement(shade > 1 && shade <= 1.2)},
          {"perspective yields virtually no advantage over affine", same.ours, same.agreement},
          norms_alike(ranking)};
}

}  // namespace talisman::sequences
