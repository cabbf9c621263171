// SPDX-License-Identifier: Apache-2.0
// The picture without sprites: several mirrors, fades of layers as a whole, blends of textures.
#include "sequences/pipeline/direct_picture.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/effects.h"
#include "sequences/pipeline/step.h"
#include "tests/support/room.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;
using layers::vec3;
using testing::ElementsAre;
using tests::Room;

constexpr layers::ivec2 kSmallDisplay{160, 120};

/// A room with its layers and pipeline, which keep references to each other.
struct ShownOnce {
  explicit ShownOnce(const Room& room_in, regulator::Policy policy = regulator::Policy::Direct)
      : room(room_in),
        layers(room.layers()),
        pipeline(make_pipeline(room.scene, layers, settings_for(policy))) {}
  ShownOnce(const ShownOnce&) = delete;

  static Settings settings_for(regulator::Policy policy) {
    Settings settings;
    settings.view.display_px = kSmallDisplay;
    settings.regulator.policy = policy;
    settings.frames = 48;
    return settings;
  }
  chunker::Frame direct(int frame = 0) const {
    return draw_direct(pipeline, frame, chunker::PreparedScene(room.scene));
  }
  chunker::Frame sprites(int frame = 0) const {
    return draw_reference(pipeline, frame, chunker::PreparedScene(room.scene));
  }
  const layers::Layer& layer(const std::string& name) const {
    return *std::find_if(layers.layers.begin(), layers.layers.end(),
                         [&](const layers::Layer& l) { return l.name == name; });
  }

  Room room;
  layers::LayerSet layers;
  Pipeline pipeline;
};

/// Adds a part with a layer of its own.
void add_part(Room& room, const std::string& name, int mesh, const layers::Transform& local,
              vec3 color = {1, 1, 1}) {
  layers::Node node;
  node.name = name;
  node.local = local;
  room.scene.nodes.push_back(node);
  layers::Material material;
  material.base_color = color;
  room.scene.materials.push_back(material);
  room.scene.parts.push_back({name, static_cast<int>(room.scene.nodes.size()) - 1, mesh,
                              static_cast<int>(room.scene.materials.size()) - 1, -1});
  layers::LayerSpec spec;
  spec.name = name;
  spec.part_globs = {name};
  room.specs.push_back(spec);
}

layers::Transform at(dvec3 place) {
  layers::Transform local;
  local.translation = place;
  return local;
}

layers::Keys<double> constantly(double value) { return {{0}, {value}, layers::Interpolation::Step}; }

/// A mirroring floor, and behind the ball a wall that faces the eye and mirrors as well.
Room room_with_two_mirrors(float of_floor, float of_wall) {
  Room room;
  room.scene.lights[0].kind = layers::Light::Kind::Point;
  room.scene.nodes[3].local.translation = {1, 4, 5};
  add_part(room, "wall", 0, at({0, 0, -2.5}), {0.2f, 0.3f, 0.5f});
  room.scene.materials[0].reflectivity = of_floor;
  room.scene.materials[2].reflectivity = of_wall;
  return room;
}

double mean_difference(const chunker::Frame& a, const chunker::Frame& b) {
  const auto x = chunker::srgb_bytes(a), y = chunker::srgb_bytes(b);
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += std::abs(int{x[i]} - int{y[i]});
  return sum / static_cast<double>(x.size());
}

// --- Mirrors

// Two mirrors in one pass: each shows what its own sprite shows, and both do show something.
TEST(Direct, ShowsEveryMirror) {
  const ShownOnce both(room_with_two_mirrors(0.5f, 0.5f)), floor(room_with_two_mirrors(0.5f, 0)),
      wall(room_with_two_mirrors(0, 0.5f));
  EXPECT_LT(mean_difference(both.direct(), both.sprites()), 0.6);
  EXPECT_GT(mean_difference(both.direct(), floor.direct()), 1);
  EXPECT_GT(mean_difference(both.direct(), wall.direct()), 1);
}

/// The picture in one mirror alone.
chunker::Sprite mirrored_in(const ShownOnce& show, const std::string& name) {
  layers::SpritePlacement placement;
  placement.size_px = kSmallDisplay;
  ShadowMapStore maps;
  const chunker::PreparedScene prepared(show.room.scene);
  return draw_layer({show.pipeline, show.pipeline.authored, maps, prepared, show.room.scene.at(0)},
                    show.layer(name), placement)
      .sprite;
}

// One bounce: the wall as it is seen in the floor is the same whether the wall mirrors or not.
TEST(Direct, MirrorInAMirrorShowsItsOwnColour) {
  Room dull = room_with_two_mirrors(0.5f, 0), bright = room_with_two_mirrors(0.5f, 1);
  for (Room* room : {&dull, &bright}) room->specs[0].shading.reflection = layers::LayerPreferences{};
  const ShownOnce without(dull), with(bright);
  const chunker::Sprite a = mirrored_in(without, "floor/reflection"),
                        b = mirrored_in(with, "floor/reflection");
  int shown = 0;
  for (int y = 0; y < kSmallDisplay.y; ++y)
    for (int x = 0; x < kSmallDisplay.x; ++x) {
      ASSERT_EQ(a.texel(x, y), b.texel(x, y)) << x << " " << y;
      shown += a.texel(x, y).b > 20 ? 1 : 0;
    }
  EXPECT_GT(shown, 500);  // the wall is in it
}

// … and `talisman inspect` says so, where it matters.
TEST(Direct, InspectNamesTheMirrorThatReflectsNothingInAnother) {
  const auto why = [](const Room& room) {
    const ShownOnce show(room);
    for (const layers::EffectCall& call :
         layers::effects_called_for(show.room.scene, show.layers.layers, layers::RunEffects{}))
      if (call.effect == layers::Effect::ReflectionMap) return call.why;
    return std::string();
  };
  EXPECT_EQ(why(room_with_two_mirrors(0.5f, 0.5f)),
            "layer 'floor' mirrors 2 layers; one bounce: layer 'wall' reflects nothing in it");
  EXPECT_EQ(why(room_with_two_mirrors(0.5f, 0)), "layer 'floor' mirrors 2 layers");
}

// A ball that is sunk into the mirror by half: nothing of its lower half appears beside its upper one. The
// oracle is a hemisphere's worth of ball: the same room with a floor that hides, seen from below.
TEST(Direct, MirrorsOnlyWhatIsBeforeTheMirror) {
  Room sunken = Room().mirroring();
  sunken.scene.nodes[1].local.translation = {0, -0.2, 0};
  sunken.specs[0].shading.reflection = layers::LayerPreferences{};
  Room buried = sunken;
  buried.scene.nodes[1].local.translation = {0, -0.5001, 0};  // wholly behind the mirror
  const auto reflecting = [](const Room& room) {
    const ShownOnce show(room);
    const chunker::Sprite sprite = mirrored_in(show, "floor/reflection");
    layers::ivec2 lo{kSmallDisplay}, hi{-1, -1};
    for (int y = 0; y < kSmallDisplay.y; ++y)
      for (int x = 0; x < kSmallDisplay.x; ++x)
        if (sprite.texel(x, y).r > 0) {
          lo = glm::min(lo, layers::ivec2(x, y));
          hi = glm::max(hi, layers::ivec2(x, y));
        }
    return std::pair{lo, hi};
  };
  EXPECT_EQ(reflecting(buried).second.x, -1);
  // What is left of the sphere is a cap of radius √(0.5² - 0.2²) = 0.458 at the mirror and 0.3 m deep; the
  // place of its lowest mirrored point and of its border follow from the camera.
  const auto [lo, hi] = reflecting(sunken);
  const ShownOnce show(sunken);
  const auto camera = show.room.scene.at(0).camera;
  const auto project = [&](dvec3 p) {
    const glm::dvec4 c = layers::clip_from_world(camera, kSmallDisplay) * glm::dvec4(p, 1);
    return layers::dvec2((c.x / c.w + 1) * kSmallDisplay.x / 2, (1 - c.y / c.w) * kSmallDisplay.y / 2);
  };
  EXPECT_NEAR(lo.x, project({-0.458, 0, 0}).x, 1.5);
  EXPECT_NEAR(hi.x + 1, project({0.458, 0, 0}).x, 1.5);
  EXPECT_GE(lo.y, project({0, 0, -0.46}).y - 1.5);  // nothing beyond the far border of the cap
  EXPECT_LE(hi.y + 1, std::max(project({0, 0, 0.46}).y, project({0, -0.3, 0}).y) + 1.5);
}

// --- Fades

/// The floor and two balls in one layer, the second behind the first where the eye looks, no shadow.
Room room_with_pair(double fade, bool second) {
  Room room;
  if (second) {
    add_part(room, "second", 1, at({0, 0.72, -1.5}), {0, 1, 0});
    room.specs.pop_back();
    room.specs[1].part_globs.push_back("second");
  }
  room.specs[1].fade = constantly(fade);
  return room;
}

// What a faded layer hides of itself stays hidden: the picture over the first ball is the same whether the
// second one is behind it or not.
TEST(Direct, FadedLayerIsOneGroup) {
  const ShownOnce alone(room_with_pair(0.4, false)), pair(room_with_pair(0.4, true)),
      front(room_with_pair(1, false));
  const chunker::Frame a = alone.direct(), b = pair.direct(), opaque = front.direct();
  // Where the first ball covers whole pixels: where the unfaded picture differs from the floor alone, less a
  // border. Its centre is at (80, 46), its radius eight pixels.
  const auto centre = [](const chunker::Frame& f, int dx) {
    return f.pixels[static_cast<std::size_t>(46) * kSmallDisplay.x + 80 + dx];
  };
  for (int dx = -4; dx <= 4; ++dx) EXPECT_EQ(centre(a, dx), centre(b, dx)) << dx;
  EXPECT_FALSE(centre(a, 0) == centre(opaque, 0));
}

// C ← f S + (1 - f α) C in every pixel, from pictures that know of no fade: the ball over black is S, and its
// cover is what it lets through of a white background.
TEST(Direct, FadeFollowsTheClosedForm) {
  const double f = 0.4;
  Room faded = Room(), floor_only = Room(), ball_only = Room();
  faded.specs[1].fade = constantly(f);
  floor_only.scene.parts.pop_back();
  floor_only.specs.pop_back();
  ball_only.specs.erase(ball_only.specs.begin());
  ball_only.scene.background = {0, 0, 0};
  Room over_white = ball_only;
  over_white.scene.background = {1, 1, 1};
  const chunker::Frame result = ShownOnce(faded).direct(), behind = ShownOnce(floor_only).direct(),
                       ball = ShownOnce(ball_only).direct(), white = ShownOnce(over_white).direct();
  constexpr double kOne = chunker::kOne;
  double most = 0;
  int shown = 0;
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    const double s = ball.pixels[i].r / kOne, cover = 1 - (white.pixels[i].r / kOne - s);
    const double expected = f * s + (1 - f * cover) * (behind.pixels[i].r / kOne);
    most = std::max(most, std::abs(result.pixels[i].r / kOne - expected));
    shown += cover > 0.5 ? 1 : 0;
  }
  EXPECT_GT(shown, 300);
  EXPECT_LT(most, 1.5 / 255);  // one code value of a sprite's alpha, and the rounding of the compositor
}

// No fade, and a fade that is 1 at this time: one pass, the same bytes, no order asked for.
TEST(Direct, WithoutFadesIsOnePass) {
  Room keyed = Room();
  keyed.specs[1].fade = {{0, 1}, {1, 0}, layers::Interpolation::Linear};
  const ShownOnce plain{Room()}, show(keyed);
  EXPECT_THAT(direct_groups(plain.pipeline, 0), ElementsAre(DirectGroup{{0, 1}, 1}));
  EXPECT_THAT(direct_groups(show.pipeline, 0), ElementsAre(DirectGroup{{0, 1}, 1}));
  EXPECT_EQ(show.direct(0), plain.direct(0));
  EXPECT_THAT(direct_groups(show.pipeline, 12), ElementsAre(DirectGroup{{0}, 1}, DirectGroup{{1}, 0.5f}));
  // At the end of its fade the layer is gone, and nothing of it is drawn.
  EXPECT_THAT(direct_groups(show.pipeline, 24), ElementsAre(DirectGroup{{0}, 1}));
}

// Unfaded layers before, between and behind faded ones join; faded ones stay alone; the order is that of the
// eye, not of the file.
TEST(Direct, GroupsFollowTheOrderOfTheEye) {
  Room room;
  room.specs[0].group = layers::OrderGroup::Background;
  for (const auto& [name, z] : std::vector<std::pair<std::string, double>>{
           {"nearest", 3.0}, {"far", -2.0}, {"near", 1.5}, {"farthest", -3.2}})
    add_part(room, name, 1, at({0, 1, z}));
  room.specs[1].fade = constantly(0.5);  // the ball at z = 0
  room.specs[4].fade = constantly(0.25);
  // Layers: 0 floor, 1 ball, 2 nearest, 3 far, 4 near, 5 farthest.
  const ShownOnce show(room);
  EXPECT_THAT(direct_groups(show.pipeline, 0), ElementsAre(DirectGroup{{0, 5, 3}, 1}, DirectGroup{{1}, 0.5f},
                                                           DirectGroup{{4}, 0.25f}, DirectGroup{{2}, 1}));
}

// The policy, the truth of --quality and the sprites agree on a scene with a fade.
TEST(Direct, PolicyTruthAndSpritesAgree) {
  Room room = Room().casting().mirroring().shining();
  room.specs[1].fade = constantly(0.6);
  const ShownOnce show(room);
  const chunker::PreparedScene prepared(show.room.scene);
  PipelineState state(show.pipeline);
  const FrameReport report = step(show.pipeline, state, 0, &prepared);
  EXPECT_EQ(report.picture, show.direct());
  EXPECT_GT(report.render.pixels_shaded, 0);
  EXPECT_LT(mean_difference(show.direct(), show.sprites()), 0.6);
  room.specs[1].fade = {};
  EXPECT_GT(mean_difference(show.direct(), ShownOnce(room).direct()), 0.2);
}

// --- Blends

// The blend of two textures over time, as the compositor applies it, is the material's own at that time.
TEST(Direct, TexturesAreBlendedAsOfTheFrame) {
  Room keyed = Room().textured_twice().factored(), fixed = Room().textured_twice().factored();
  keyed.specs[0].shading.first_blend = constantly(0.5);
  keyed.specs[0].shading.second_blend = {{0, 1}, {0, 1}, layers::Interpolation::Linear};
  fixed.scene.materials[0].texture_blend = {0.5f, 0.25f};
  const ShownOnce moving(keyed), still(fixed);
  EXPECT_EQ(moving.direct(6), still.direct(6));
  EXPECT_GT(mean_difference(moving.direct(18), moving.direct(6)), 0.01);
}

}  // namespace
}  // namespace talisman::sequences
