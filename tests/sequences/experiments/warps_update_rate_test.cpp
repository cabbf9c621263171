// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/warps/update_rate.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "sequences/experiments/warps/objects.h"
#include "sequences/experiments/warps/quality.h"
#include "sequences/experiments/warps/ranking.h"
#include "tests/sequences/temporary_folder.h"
#include "warp/quadrilateral.h"

namespace talisman::sequences {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using warp::Curve;

constexpr int kAnimationFrames = 60;

const WarpObject& object(const std::string& name) {
  static std::map<std::string, WarpObject> loaded;
  if (!loaded.contains(name)) loaded.emplace(name, load_warp_object(name));
  return loaded.at(name);
}

CapturedAnimation animation_of(const std::string& name, const WarpMotion& motion,
                               int frames = kAnimationFrames) {
  // Six seconds apart in all: the object turns and travels far enough to be drawn again at every threshold.
  return capture_animation(stage(object(name), motion), frames, 10, {}, layers::BoundKind::Box8);
}

WarpMotion motion_named(const std::string& name) {
  for (WarpMotion& motion : warp_motions())
    if (motion.name == name) return motion;
  ADD_FAILURE() << "no motion " << name;
  return {};
}

/// Moves the object along a straight line for ten seconds.
WarpMotion along(layers::dvec3 from, layers::dvec3 to) {
  layers::TransformTrack track;
  track.translation = {{0, 10}, {from, to}, layers::Interpolation::Linear};
  return {"along", "along a line", {{kObjectNode, track}}};
}

/// The pseudocode of Figure 14, written a second time and without sharing anything but fit and points.
int figure_14(const CapturedAnimation& animation, Curve curve, double error_threshold) {
  int re_renderings = 0;
  const layers::LayerState* cached = nullptr;
  for (const layers::LayerState& current : animation.states) {
    if (!current.touches_display) continue;
    double error = HUGE_VAL;
    if (cached) {
      const layers::Correspondences matched = layers::correspond(*cached, current, animation.hull);
      const warp::FitResult transform = warp::fit(*cached, current, matched, curve);
      error = matched.overlap ? 0 : HUGE_VAL;
      for (std::size_t i = 0; i < matched.then_px.size(); ++i)
        error = std::fmax(error, glm::distance(transform.warp(matched.then_px[i]), matched.now_px[i]));
    }
    if (error > error_threshold) {
      ++re_renderings;
      cached = &current;
    }
  }
  return re_renderings;
}

TEST(UpdateCounter, CountsWhatThePseudocodeCounts) {
  // Thresholds in falling, then rising order: what is remembered from one must not disturb the next.
  const std::vector<double> thresholds{16, 4, 1, 0.25, 2, 8, 64};
  for (const char* name : {"box", "flat-box", "vase"})
    for (const Curve curve : all_curves()) {
      const CapturedAnimation animation = animation_of(name, warp_motions()[0], 40);
      UpdateCounter counter(animation, curve);
      for (const double threshold : thresholds) {
        const int renders = counter.renders(threshold);
        EXPECT_EQ(renders, figure_14(animation, curve, threshold))
            << name << " " << warp::name(curve) << " " << threshold;
        EXPECT_EQ(renders, simulate(animation, curve, threshold)) << name << " " << warp::name(curve);
      }
    }
}

TEST(UpdateCounter, RemembersInsteadOfFittingAgain) {
  const CapturedAnimation animation = animation_of("box", warp_motions()[0]);
  UpdateCounter counter(animation, Curve::affi);
  counter.renders(2);
  const std::int64_t fits = counter.fits();
  EXPECT_GT(fits, 0);
  counter.renders(2);
  EXPECT_EQ(counter.fits(), fits);
}

TEST(UpdateCounter, ThresholdZeroRendersEveryFrameThatMoves) {
  for (const Curve curve : all_curves()) {
    const CapturedAnimation animation = animation_of("box", warp_motions()[0], 20);
    EXPECT_EQ(UpdateCounter(animation, curve).renders(0), 20) << warp::name(curve);
  }
}

TEST(UpdateCounter, AnimationAtRestIsRenderedOnce) {
  const CapturedAnimation animation = animation_of("box", {"rest", "at rest", {}}, 20);
  for (const Curve curve : all_curves())
    for (const double threshold : {0.0, 1e-12, 1.0})
      EXPECT_EQ(UpdateCounter(animation, curve).renders(threshold), 1) << warp::name(curve);
}

TEST(UpdateCounter, OneFrameIsRenderedOnce) {
  const CapturedAnimation animation = animation_of("box", warp_motions()[0], 1);
  for (const double threshold : {0.0, 4.0})
    EXPECT_EQ(UpdateCounter(animation, Curve::aff).renders(threshold), 1);
}

TEST(UpdateCounter, ObjectBehindTheCameraIsNeverRendered) {
  const CapturedAnimation animation = animation_of("box", along({0, 0, 5}, {1, 0, 8}), 20);
  for (const Curve curve : all_curves()) EXPECT_EQ(UpdateCounter(animation, curve).renders(0), 0);
}

TEST(UpdateCounter, ObjectFlyingThroughTheCameraEndsBehindIt) {
  // Crosses the near plane: points with w ≤ near never enter a fit, and nothing is counted once it is gone.
  const CapturedAnimation animation = animation_of("box", along({0.2, 0.1, -6}, {0.2, 0.1, 12}), 80);
  int seen = 0;
  for (const layers::LayerState& state : animation.states) seen += state.touches_display;
  ASSERT_GT(seen, 10);
  ASSERT_LT(seen, 79);
  for (const Curve curve : all_curves()) {
    UpdateCounter counter(animation, curve);
    EXPECT_EQ(counter.renders(0), seen) << warp::name(curve);
    EXPECT_EQ(counter.renders(4), figure_14(animation, curve, 4)) << warp::name(curve);
  }
}

TEST(UpdateCounter, HeadTurnNeedsOneRenderWithPerspective) {
  // A head turn moves the whole picture by one homography, whatever the object: perspective is exact.
  const CapturedAnimation animation = animation_of("box", motion_named("head-turn"));
  for (const Curve curve : {Curve::per, Curve::peri, Curve::per2, Curve::per2i, Curve::pers2})
    EXPECT_EQ(UpdateCounter(animation, curve).renders(1e-3), 1) << warp::name(curve);
  EXPECT_GT(UpdateCounter(animation, Curve::aff).renders(0.5), 1);
}

TEST(UpdateCounter, RotationInTheDisplayPlaneNeedsOneRenderWithAffine) {
  // The object turns about the view axis: an affine map is exact only for points of one depth, so the flat
  // one.
  const CapturedAnimation animation = animation_of("flat-box", motion_named("spin-z-20"));
  EXPECT_LE(UpdateCounter(animation, Curve::aff).renders(8), 2);
  EXPECT_GT(UpdateCounter(animation, Curve::so).renders(8), 5);
}

TEST(UpdateCounter, RatesFallWithTheThresholdUpToOneRenderInTen) {
  // Greedy re-rendering is not strictly monotone: a later render may fall on a worse instant. The slack is
  // one render, or a tenth of them.
  for (const char* name : {"box", "flat-box"})
    for (const WarpMotion& motion : {warp_motions()[0], motion_named("spin-y-20")})
      for (const UpdateCurve& curve : update_curves(animation_of(name, motion), figure_thresholds()))
        for (std::size_t t = 1; t < curve.renders.size(); ++t)
          EXPECT_LE(curve.renders[t], std::max(curve.renders[t - 1] + 1, curve.renders[t - 1] * 11 / 10))
              << name << " " << motion.name << " " << warp::name(curve.curve) << " threshold " << t;
}

TEST(FigureThresholds, RunFromAnEighthTo64Pixels) {
  const std::vector<double> thresholds = figure_thresholds();
  ASSERT_EQ(thresholds.size(), 19u);
  EXPECT_EQ(thresholds.front(), 0.125);
  EXPECT_EQ(thresholds[6], 1);
  EXPECT_EQ(thresholds.back(), 64);
}

TEST(ThresholdForRate, IsTheSmallestThatKeepsTheRate) {
  const CapturedAnimation animation = animation_of("box", warp_motions()[0]);
  for (const Curve curve : {Curve::trn, Curve::aff, Curve::per2i})
    for (const double rate : {0.5, 0.2, 0.05}) {
      UpdateCounter counter(animation, curve);
      const double threshold = threshold_for_rate(counter, rate);
      EXPECT_LE(counter.rate(threshold), rate) << warp::name(curve);
      EXPECT_GT(counter.rate(threshold * (1 - 1e-5)), rate) << warp::name(curve);
    }
}

TEST(ThresholdForRate, WhatCannotBeReachedGivesTheEndsOfTheRange) {
  const CapturedAnimation animation = animation_of("box", warp_motions()[0], 10);
  UpdateCounter counter(animation, Curve::aff);
  EXPECT_NEAR(threshold_for_rate(counter, 0.05), 1e5, 1);  // one frame in ten is always rendered
  EXPECT_EQ(threshold_for_rate(counter, 1), 1e-4);
}

// --- The second series

TEST(QualityAtRate, ThePipelineRendersAsOftenAsTheSimulation) {
  // Two independent paths to one number: step() with its regulator, and the counter.
  RateOptions options;
  options.frames = 12;
  options.display_px = {64, 64};
  const layers::Scene scene = stage(object("box"), warp_motions()[0]);
  layers::View view;
  view.display_px = options.display_px;
  const CapturedAnimation animation =
      capture_animation(scene, options.frames, options.fps, view, options.bound);
  for (const CurveQuality& q : quality_at_rate(scene, options)) {
    UpdateCounter counter(animation, q.curve);
    EXPECT_EQ(q.renders, counter.renders(q.threshold_px)) << warp::name(q.curve);
    EXPECT_LE(q.renders, 2) << warp::name(q.curve);  // 20 % of 12
    EXPECT_GT(q.mean.psnr_db, 15);
    EXPECT_GT(q.worst.flip, 0) << "a warped picture is never quite the reference";
  }
}

TEST(QualityAtRate, EveryFrameRenderedIsTheReference) {
  RateOptions options;
  options.frames = 4;
  options.display_px = {48, 48};
  options.update_rate = 1;
  options.fps = 3;  // far enough apart for every curve to render at 1e-4 px
  for (const CurveQuality& q : quality_at_rate(stage(object("box"), warp_motions()[0]), options)) {
    EXPECT_EQ(q.renders, 4) << warp::name(q.curve);
    EXPECT_TRUE(std::isinf(q.mean.psnr_db)) << warp::name(q.curve);
    EXPECT_EQ(q.mean.flip, 0);
  }
}

// --- The ranking

std::vector<UpdateCurve> made_up(const std::map<Curve, std::vector<int>>& renders) {
  std::vector<UpdateCurve> curves;
  for (const auto& [curve, counts] : renders) curves.push_back({curve, counts});
  return curves;
}

TEST(Rank, OrdersByGeometricMeanAndSplitsAtTheTolerance) {
  const Ranking ranking = rank(made_up({{Curve::trn, {100, 40, 20}},
                                        {Curve::so, {100, 20, 10}},
                                        {Curve::aff, {100, 10, 5}},
                                        {Curve::affi, {100, 10, 5}},
                                        {Curve::per, {100, 5, 5}}}));
  // The first threshold tells nothing apart and does not count: √(1/2 · 1) for per.
  EXPECT_EQ(ranking.thresholds_used, 2);
  EXPECT_DOUBLE_EQ(ranking.ratio(Curve::trn), 4);
  EXPECT_DOUBLE_EQ(ranking.ratio(Curve::per), std::sqrt(0.5));
  EXPECT_THAT(ranking.clusters, ElementsAre(ElementsAre(Curve::trn), ElementsAre(Curve::so),
                                            ElementsAre(Curve::aff, Curve::affi), ElementsAre(Curve::per)));
  EXPECT_EQ(in_words(ranking), "trn | so | aff affi | per");
}

TEST(Rank, CurvesThatAreAllAlikeAreOneCluster) {
  const Ranking ranking = rank(made_up({{Curve::trn, {9, 1}}, {Curve::aff, {9, 1}}}));
  EXPECT_EQ(ranking.thresholds_used, 0);
  EXPECT_EQ(ranking.ratio(Curve::trn), 1);
  EXPECT_EQ(ranking.clusters.size(), 1u);
}

/// The published clusters of figure 15, as counts.
std::map<Curve, std::vector<int>> published_figure_15() {
  return {{Curve::trn, {80}},  {Curve::trni, {80}}, {Curve::so, {60}},   {Curve::soi, {60}},
          {Curve::pers, {45}}, {Curve::aff, {30}},  {Curve::affi, {30}}, {Curve::per, {20}},
          {Curve::peri, {20}}, {Curve::per2, {20}}, {Curve::pers2, {20}}};
}

TEST(CompareWithFigure15, AgreesWithThePublishedClusters) {
  for (const Statement& s : compare_with_figure_15(rank(made_up(published_figure_15()))))
    EXPECT_EQ(s.agreement, Agreement::Yes) << s.paper << ": " << s.ours;
}

TEST(CompareWithFigure15, SaysWhatDiffers) {
  // Shade is made better than affine, and translation nearly as good as x/y scale.
  auto renders = published_figure_15();
  renders[Curve::pers] = {28};
  renders[Curve::trn] = {62};
  std::map<std::string, Agreement> said;
  for (const Statement& s : compare_with_figure_15(rank(made_up(renders)))) said[s.paper] = s.agreement;
  EXPECT_EQ(said.at("pers clearly worse than aff"), Agreement::No);
  EXPECT_EQ(said.at("trn clearly worse than so"), Agreement::OrderOnly);
  EXPECT_EQ(said.at("aff clearly worse than per, per2, pers2"), Agreement::Yes);
}

TEST(CompareWithFigure15, FlatBoxHasThePublishedOrder) {
  // A flat rigid body that turns and travels: the paper's order, computed, without any content.
  const Ranking ranking =
      rank(update_curves(animation_of("flat-box", warp_motions()[0], 100), figure_thresholds()));
  EXPECT_GT(ranking.ratio(Curve::trn), ranking.ratio(Curve::so));
  EXPECT_GT(ranking.ratio(Curve::so), ranking.ratio(Curve::pers));
  EXPECT_GT(ranking.ratio(Curve::pers), 1);
  EXPECT_LT(ranking.ratio(Curve::per), 1);
}

// --- Objects

TEST(WarpObjects, BuiltInObjectsNeedNoContent) {
  for (const char* name : {"vase", "box", "flat-box"}) {
    const WarpObject& built = object(name);
    double farthest = 0, depth = 0;
    for (const layers::vec3& p : built.mesh.positions) {
      farthest = std::fmax(farthest, glm::length(layers::dvec3(p)));
      depth = std::fmax(depth, std::fabs(p.z));
    }
    EXPECT_EQ(layers::first_defect(stage(built, warp_motions()[0])), "") << name;
    EXPECT_LE(farthest, 1 + 1e-6) << name;
    if (built.name == "flat-box") {
      EXPECT_LT(depth, 0.05) << "5 % of its depth";
    }
  }
}

TEST(WarpObjects, FacesPointOutwards) {
  // Signed volume of the closed box: positive when all triangles are counter-clockwise from outside.
  double volume = 0;
  const layers::Mesh& mesh = object("box").mesh;
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const layers::dvec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]],
                        c = mesh.positions[mesh.indices[t + 2]];
    volume += glm::dot(a, glm::cross(b, c)) / 6;
  }
  EXPECT_NEAR(volume, 8 * 0.75 * 0.6 / std::pow(1 + 0.75 * 0.75 + 0.6 * 0.6, 1.5), 1e-5);
}

TEST(WarpObjects, EveryMotionIsASoundScene) {
  for (const WarpMotion& motion : warp_motions())
    EXPECT_EQ(layers::first_defect(stage(object("box"), motion)), "") << motion.name;
}

/// Sixteen points of a square in the plane z = 0.
std::string flat_patch() {
  std::string text;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) text += std::to_string(i) + " " + std::to_string(j) + " 0\n";
  return text;
}

TEST(ReadBezierPatches, EvenlySpacedControlPointsGiveAPlane) {
  const tests::TemporaryFolder folder;
  const layers::Mesh mesh =
      read_bezier_patches(folder.write("a.bez", "BBP\n" + flat_patch() + flat_patch()), 3);
  EXPECT_EQ(mesh.positions.size(), 32u);
  EXPECT_EQ(mesh.triangle_count(), 36);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    // x along u, and what was y is now -z; degree elevation of a linear patch is exact.
    EXPECT_NEAR(mesh.positions[i].x, 3 * mesh.uvs[i].x, 1e-6);
    EXPECT_NEAR(mesh.positions[i].z, -3 * mesh.uvs[i].y, 1e-6);
    EXPECT_NEAR(mesh.positions[i].y, 0, 1e-6);
    EXPECT_NEAR(mesh.normals[i].y, 1, 1e-6);
  }
}

TEST(ReadBezierPatches, BadFilesAreRefusedInWords) {
  const tests::TemporaryFolder folder;
  const std::pair<std::string, std::string> cases[] = {{"", "cannot be read"},
                                                       {"BBBB\n" + flat_patch(), "BBBB"},
                                                       {"BBP\n", "0 coordinates"},
                                                       {"BBP\n" + flat_patch() + "1 2", "50 coordinates"},
                                                       {"BBP\n" + flat_patch() + "x", "number 49"},
                                                       {"BBP\n" + flat_patch() + "nan 1 2", "number 49"}};
  for (const auto& [text, what] : cases) {
    const std::string file = folder.write("bad.bez", text);
    try {
      read_bezier_patches(file);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(what));
      EXPECT_THAT(error.what(), HasSubstr("bad.bez"));
    }
  }
}

/// TALISMAN_ASSETS for the time of one test.
class AssetsFolder {
 public:
  explicit AssetsFolder(const std::string& path) {
    if (const char* before = std::getenv("TALISMAN_ASSETS")) before_ = before;
    ::setenv("TALISMAN_ASSETS", path.c_str(), 1);
  }
  ~AssetsFolder() {
    before_ ? ::setenv("TALISMAN_ASSETS", before_->c_str(), 1) : ::unsetenv("TALISMAN_ASSETS");
  }

 private:
  std::optional<std::string> before_;
};

TEST(LoadWarpObject, MissingContentNamesTheCommandAndTheRestIsThere) {
  const tests::TemporaryFolder folder;
  const AssetsFolder assets(folder.path());
  std::vector<MissingObject> missing;
  std::vector<std::string> names;
  for (const WarpObject& there : load_warp_objects(missing)) names.push_back(there.name);
  EXPECT_THAT(names, ElementsAre("vase", "box", "flat-box"));
  ASSERT_EQ(missing.size(), 5u);
  EXPECT_EQ(missing[0].name, "teapot");
  for (const MissingObject& object : missing)
    EXPECT_THAT(object.why, HasSubstr("sequences/fetch-assets warps"));
}

TEST(LoadWarpObject, EveryPackageIsInTheListThatIsFetched) {
  const std::string listed = tests::content(TALISMAN_SOURCE_DIR "/sequences/warps/packages");
  const tests::TemporaryFolder empty;
  const AssetsFolder assets(empty.path());
  std::vector<MissingObject> missing;
  load_warp_objects(missing);
  ASSERT_FALSE(missing.empty());
  for (const MissingObject& object : missing) {
    const std::size_t from = object.why.find("': ") + 3;
    EXPECT_THAT(listed, HasSubstr(object.why.substr(from, object.why.find(":/") - from))) << object.why;
  }
}

TEST(LoadWarpObject, UnknownNameListsTheKnownOnes) {
  try {
    load_warp_object("kettle");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("kettle"));
    EXPECT_THAT(error.what(), HasSubstr("flat-teapot"));
  }
}

}  // namespace
}  // namespace talisman::sequences
