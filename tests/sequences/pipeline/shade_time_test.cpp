// SPDX-License-Identifier: Apache-2.0
// Shade layers over time, and in places where their geometry degenerates: sprites of a base and of its shade
// layers that were drawn at different instants, receivers edge-on, lights inside of things, terms that come
// and go. Nothing that is decided or shown may be no number, and what is factored must stay within what
// factoring is predicted to cost.
#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/commands/accuracy_factoring.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/step.h"
#include "tests/sequences/room_sequence.h"

namespace talisman::sequences {
namespace {

using layers::dvec2;
using layers::dvec3;
using layers::FlightTrack;
using layers::Interpolation;
using layers::LayerPreferences;
using regulator::Action;
using regulator::Policy;
using tests::difference;
using tests::Room;
using tests::run;
using tests::Show;
using tests::with_flying_ball;

constexpr int kEyeNode = 2, kLampNode = 3;

Room full_room() { return Room().casting().mirroring().shining().factored(); }

void expect_finite(const FrameReport& report) {
  for (const regulator::LayerDecision& decision : report.plan.decisions) {
    EXPECT_TRUE(std::isfinite(decision.shown_geometric_px)) << "layer " << decision.layer;
    for (int column = 0; column < 3; ++column)
      for (int row = 0; row < 3; ++row)
        EXPECT_TRUE(std::isfinite(decision.shown_warp.now_from_then[column][row]))
            << "layer " << decision.layer;
    EXPECT_EQ(decision.reason.find("nan"), std::string::npos) << decision.reason;
  }
  for (const ShownSprite& sprite : report.shown) {
    EXPECT_TRUE(std::isfinite(sprite.multipliers.alpha));
    EXPECT_LT(sprite.size_px.x, 4097);
  }
}

/// Decides and draws eight frames under several policies, and measures what factoring costs.
void expect_sound(const Room& room) {
  for (const Policy policy : {Policy::Threshold, Policy::Lookahead, Policy::Budget}) {
    const Show show = run(room, policy, 8, true);
    for (const FrameReport& report : show.reports) expect_finite(report);
  }
  ExperimentOptions options;
  options.quality_every = 4;
  options.progress = "none";
  const PredictionCheck frame = measure_factoring_report(tests::sequence_of(room, 8), options).result.frame;
  EXPECT_EQ(frame.beyond_bound, 0);
  EXPECT_LE(frame.elsewhere.largest, frame.largest_bound);
  EXPECT_GT(frame.measured.count, 0);
}

TEST(HardShading, ReceiverEdgeOn) {
  Room room = with_flying_ball(full_room());
  for (const double height : {0.0, 1e-12, 1e-3}) {
    SCOPED_TRACE(height);
    room.scene.nodes[kEyeNode].local.translation = {0, height, 6};
    room.scene.nodes[kEyeNode].local.rotation = {1, 0, 0, 0};
    expect_sound(room);
  }
}

TEST(HardShading, LightInsideACasterInTheReceiverAndInTheEye) {
  for (const dvec3 place : {dvec3(0, 1, 0), dvec3(0, 0, 0), dvec3(0, 2, 6)}) {
    SCOPED_TRACE(place.y);
    Room room = full_room();
    room.scene.nodes[kLampNode].local.translation = place;
    expect_sound(room);
  }
}

/// A second mirror behind the ball, upright, that faces the camera.
Room hall_of_mirrors() {
  Room room = full_room();
  layers::Node wall;
  wall.name = "wall";
  wall.local.translation = {0, 2, -4.5};
  wall.local.scale = dvec3(0.5);
  room.scene.nodes.push_back(wall);
  room.scene.parts.push_back({"wall", static_cast<int>(room.scene.nodes.size()) - 1, 0, 0, -1});
  room.specs = tests::one_layer_per_part(room.scene);
  for (const int mirror : {0, 2}) room.specs[mirror].shading = full_room().specs[0].shading;
  return room;
}

TEST(HardShading, ReflectionOfAReflectionIsOneBounce) {
  const Room room = hall_of_mirrors();
  expect_sound(with_flying_ball(room));
  // Each mirror is drawn once for each of its renders: mirrors in a mirror ask for nothing.
  EXPECT_EQ(run(room, Policy::Reference, 1, true).passes().reflections_drawn, 2);
}

TEST(HardShading, ExponentsOfZeroAndTenThousand) {
  for (const float exponent : {0.0f, 1.0f, 1e4f}) {
    SCOPED_TRACE(exponent);
    Room room = with_flying_ball(full_room());
    room.scene.materials[0].shininess = exponent;
    expect_sound(room);
  }
}

TEST(HardShading, ScenesOfAnySize) {
  for (const double size : {1e-4, 1e6}) {
    SCOPED_TRACE(size);
    Room room = full_room();
    room.scene = tests::scaled(room.scene, size);
    expect_sound(room);
  }
}

// --- Fades

layers::Keys<double> constant(double value) { return {{0}, {value}, Interpolation::Step}; }

void expect_same_pictures(const Show& a, const Show& b) {
  ASSERT_EQ(a.reports.size(), b.reports.size());
  for (std::size_t i = 0; i < a.reports.size(); ++i)
    EXPECT_EQ(difference(a.reports[i].picture, b.reports[i].picture).max, 0) << "frame " << i;
}

TEST(Fade, OfOneIsNone) {
  const Room room = with_flying_ball(full_room());
  Room faded = room;
  faded.specs[0].fade = constant(1);
  expect_same_pictures(run(faded, Policy::Threshold, 4, true), run(room, Policy::Threshold, 4, true));
}

TEST(Fade, OfZeroShowsWhatIsBehindAndNoShadow) {
  Room faded = with_flying_ball(full_room());
  faded.specs[0].casts_shadows = false;  // so that the ball looks the same without it
  Room gone = faded;
  faded.specs[0].fade = constant(0);
  gone.specs.erase(gone.specs.begin());
  expect_same_pictures(run(faded, Policy::Threshold, 4, true), run(gone, Policy::Threshold, 4, true));
  expect_sound(faded);
}

TEST(Fade, InAndOutDrawsNothingAgain) {
  Room room = full_room();
  room.specs[0].fade = {{0, 0.15, 0.3}, {0, 1, 0}, Interpolation::Linear};
  const Show show = run(room, Policy::Threshold, 8, true);
  for (const char* layer : {"floor", "floor/shadow of lamp", "floor/specular", "floor/reflection"})
    EXPECT_EQ(show.renders(layer), 1) << layer;
  expect_sound(room);
}

// --- Light that comes and goes

/// The lamp is below the floor, which does not answer to it there, except in frames 6 to 11. The floor is so
/// small that all of it is lit then: the photometric fiducial sees light at the characteristic points only.
Room blinking() {
  Room room = tests::small_floor(full_room());
  FlightTrack lamp;
  const dvec3 on{1, 4, 1}, off{1, -4, 1};
  lamp.position = {{0, 0.25, 0.5}, {off, on, off}, Interpolation::Step};
  lamp.target = {{0}, {{0, 0, 0}}, Interpolation::Step};
  room.scene.tracks.push_back({kLampNode, lamp});
  room.scene.lights[0].direction = {0, 0, -1};  // the way that flights look
  return room;
}

TEST(HardShading, LightIsSwitchedOnAndOff) {
  const Show shown = run(blinking(), Policy::Threshold, 18, true);
  const Show reference = run(blinking(), Policy::Reference, 18, true);
  for (int frame = 0; frame < 18; ++frame) {
    expect_finite(shown.reports[frame]);
    EXPECT_LT(difference(shown.reports[frame].picture, reference.reports[frame].picture).mean, 0.5) << frame;
  }
  const double change = difference(reference.reports[5].picture, reference.reports[6].picture).mean;
  EXPECT_GT(change, 1) << "the light must matter here";
  EXPECT_EQ(difference(reference.reports[5].picture, reference.reports[12].picture).max, 0);
  expect_sound(blinking());
}

// --- Bases that leave the view

/// The eye looks at the small floor, away from it in the middle of 16 frames, and back.
Room looking_away() {
  Room room = tests::small_floor(full_room());
  FlightTrack eye;
  eye.position = {{0}, {{0, 2, 6}}, Interpolation::Linear};
  eye.target = {{0, 0.1, 0.3, 0.5, 0.6},
                {{0, 0.5, 0}, {0, 0.5, 0}, {40, 0.5, 0}, {0, 0.5, 0}, {0, 0.5, 0}},
                Interpolation::Linear};
  room.scene.tracks.push_back({kEyeNode, eye});
  return room;
}

TEST(HardShading, BaseLeavesTheViewAndComesBack) {
  const Show shown = run(looking_away(), Policy::Threshold, 16, true, 0.5);
  const Show reference = run(looking_away(), Policy::Reference, 16, true);
  int away = 0;
  for (int frame = 0; frame < 16; ++frame) {
    expect_finite(shown.reports[frame]);
    const auto& decisions = shown.reports[frame].plan.decisions;
    away += decisions[0].action == Action::Drop;
    for (std::size_t shade = 1; shade < decisions.size(); ++shade) {  // they go and come with their base
      if (shown.layers.layers[shade].base != 0) continue;
      EXPECT_EQ(decisions[shade].action == Action::Drop, decisions[0].action == Action::Drop) << frame;
    }
    EXPECT_LT(difference(shown.reports[frame].picture, reference.reports[frame].picture).mean, 1.5) << frame;
  }
  EXPECT_GT(away, 2);
  EXPECT_LT(away, 14);
  expect_same_pictures(run(looking_away(), Policy::Threshold, 16, true, 0), reference);
}

// --- Base and shade layer of different instants

/// The eye goes by; base and shadow are drawn as often as is said.
Room passing_by(double base_at_least, double base_at_most, double shade_at_least, double shade_at_most) {
  Room room = tests::small_floor(Room().casting());
  FlightTrack eye;
  eye.position = {{0, 1}, {{-1, 2, 6}, {1.5, 2.2, 5}}, Interpolation::Linear};
  eye.target = {{0}, {{0, 0.5, 0}}, Interpolation::Linear};
  room.scene.tracks.push_back({kEyeNode, eye});
  LayerPreferences base, shade;
  base.min_update_rate = base_at_least;
  base.max_update_rate = base_at_most;
  shade.min_update_rate = shade_at_least;
  shade.max_update_rate = shade_at_most;
  room.specs[0].preferences = base;
  room.specs[0].shading.shadows = shade;
  room.specs[1].preferences.min_update_rate = 1;  // the ball is not what this is about
  return room;
}

struct Displacement {
  double largest_px = 0, largest_bound_px = 0;  ///< between base and shadow, and what their fiducials allow
  int base_older = 0, shade_older = 0;          ///< frames in which one sprite is older than the other
};

/// Where do base and shadow show the corners of the floor, in each frame, and what do their fiducials
/// promise?
Displacement displacement(const Room& room, double geometric_px, int frames) {
  const layers::LayerSet set = room.layers();
  Settings settings;
  settings.view.display_px = {160, 120};
  settings.regulator.thresholds.geometric_px = geometric_px;
  settings.frames = frames;
  const Pipeline pipeline = make_pipeline(room.scene, set, settings);
  PipelineState state(pipeline);
  Displacement result;
  for (int frame = 0; frame < frames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    expect_finite(report);
    const auto shown_at = [&](int layer, const dvec3& corner) {
      const layers::CameraState& then = state.memory[layer].then->camera;
      const layers::dmat4 clip = layers::clip_from_world(then, settings.view.display_px);
      const dvec2 p = layers::screen_from_clip(clip * layers::dvec4(corner, 1), settings.view.display_px);
      const layers::dvec3 q = report.plan.decisions[layer].shown_warp.now_from_then * dvec3(p, 1);
      return dvec2(q.x / q.z, q.y / q.z);
    };
    const auto& decisions = report.plan.decisions;
    const double bound = decisions[0].shown_geometric_px + decisions[1].shown_geometric_px;
    for (const dvec3 corner :
         {dvec3(-0.48, 0, -0.48), dvec3(0.48, 0, -0.48), dvec3(0.48, 0, 0.48), dvec3(-0.48, 0, 0.48)}) {
      const double apart = glm::distance(shown_at(0, corner), shown_at(1, corner));
      EXPECT_LE(apart, bound + 1e-6) << "frame " << frame;
      result.largest_px = std::max(result.largest_px, apart);
    }
    result.largest_bound_px = std::max(result.largest_bound_px, bound);
    result.base_older += state.memory[0].depicts_frame < state.memory[1].depicts_frame;
    result.shade_older += state.memory[0].depicts_frame > state.memory[1].depicts_frame;
  }
  return result;
}

TEST(ShadeInstants, BaseAndShadowOfOneInstantLieOnEachOther) {
  const Displacement same = displacement(passing_by(1, 1, 1, 1), 4, 12);
  EXPECT_EQ(same.base_older + same.shade_older, 0);
  EXPECT_EQ(same.largest_px, 0);
}

TEST(ShadeInstants, OldShadowOnANewBaseStaysWithinBothFiducials) {
  const Displacement late = displacement(passing_by(1, 1, 0, 0.25), 4, 16);
  EXPECT_GT(late.shade_older, 8);
  EXPECT_GT(late.largest_px, 0) << "warped, they are not quite where the base is";
  EXPECT_LE(late.largest_px, late.largest_bound_px + 1e-6);
}

TEST(ShadeInstants, NewShadowOnAnOldBaseStaysWithinBothFiducials) {
  const Displacement early = displacement(passing_by(0, 0.25, 1, 1), 4, 16);
  EXPECT_GT(early.base_older, 8);
  EXPECT_GT(early.largest_px, 0);
  EXPECT_LE(early.largest_px, early.largest_bound_px + 1e-6);
}

TEST(ShadeInstants, PicturesOfMixedInstantsAreNearTheReference) {
  const Show reference = run(passing_by(0, 1, 0, 1), Policy::Reference, 12, true);
  for (const Room& room : {passing_by(1, 1, 0, 0.5), passing_by(0, 0.5, 1, 1)}) {
    const Show mixed = run(room, Policy::Threshold, 12, true, 4);
    double fine = 0, coarse = 0;
    for (int frame = 0; frame < 12; ++frame)
      coarse += difference(mixed.reports[frame].picture, reference.reports[frame].picture).mean;
    const Show exact = run(room, Policy::Threshold, 12, true, 0.05);
    for (int frame = 0; frame < 12; ++frame)
      fine += difference(exact.reports[frame].picture, reference.reports[frame].picture).mean;
    EXPECT_LT(coarse / 12, 1.5);
    EXPECT_LE(fine, coarse);
  }
  expect_same_pictures(run(passing_by(1, 1, 1, 1), Policy::Threshold, 12, true, 4), reference);
}

}  // namespace
}  // namespace talisman::sequences
