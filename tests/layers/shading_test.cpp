// SPDX-License-Identifier: Apache-2.0
// Which shade layers a scene calls for, what their states depend on, and the effects of exact small scenes.
#include "layers/shading.h"

#include <cmath>
#include <map>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layers/effects.h"
#include "layers/polyhedron.h"
#include "layers/shade_state.h"
#include "tests/support/room.h"

namespace talisman::layers {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using tests::Room;

std::vector<std::string> names(const LayerSet& set) {
  std::vector<std::string> names;
  for (const Layer& layer : set.layers) names.push_back(layer.name);
  return names;
}

// --- Which layers ---

/// The names of the room's layers where the sun, which casts too, travels that way.
std::vector<std::string> names_under_a_sun(const dvec3& direction) {
  Room room = Room().casting().factored();
  Light sun;
  sun.kind = Light::Kind::Directional;
  sun.name = "sun";
  sun.direction = direction;
  sun.casts_shadow = true;
  room.scene.lights.push_back(sun);
  return names(room.layers());
}

// The floor faces up: a sun that shines from below throws no shadow on it, whatever stands there.
TEST(ShadeLayers, LightThatNeverReachesTheReceiverMakesNone) {
  EXPECT_THAT(names_under_a_sun({0, -1, 0}),
              ElementsAre("floor", testing::HasSubstr("of lamp"), testing::HasSubstr("of sun"), "ball"));
  EXPECT_THAT(names_under_a_sun({0, 1, 0}), ElementsAre("floor", testing::HasSubstr("of lamp"), "ball"));
}

TEST(ShadeLayers, SceneThatCallsForNothingHasNone) {
  const LayerSet set = Room().factored().layers();
  EXPECT_THAT(names(set), ElementsAre("floor", "ball"));
  EXPECT_EQ(set.layers[0].holds, HeldTerms{});
  EXPECT_THAT(set.casting_parts, IsEmpty());
}

TEST(ShadeLayers, EachTermFollowsItsBaseInTheOrderOfTheCompositor) {
  const LayerSet set = Room().casting().mirroring().shining().textured_twice().factored().layers();
  EXPECT_EQ(set.defect, "");
  EXPECT_THAT(names(set), ElementsAre("floor", "floor/texture 2", "floor/shadow of lamp", "floor/specular",
                                      "floor/reflection", "ball"));
  for (int id = 0; id < 6; ++id) EXPECT_EQ(set.layers[id].id, id);
  for (int id = 1; id < 5; ++id) EXPECT_EQ(set.layers[id].base, 0);
  EXPECT_THAT(set.layers[2].casters, ElementsAre(5));  // the ball, by its new number; not the flat floor
  EXPECT_THAT(set.layers[4].reflected, ElementsAre(5));
  EXPECT_EQ(set.layers[0].holds, HeldTerms{});
  EXPECT_EQ(set.layers[2].light, 0);
}

TEST(ShadeLayers, UnfactoredTermsStayInTheSprite) {
  const LayerSet set = Room().casting().mirroring().shining().layers();
  EXPECT_THAT(names(set), ElementsAre("floor", "ball"));
  EXPECT_TRUE(set.layers[0].holds.shadows);
  EXPECT_TRUE(set.layers[0].holds.reflection);
  EXPECT_TRUE(set.layers[0].holds.specular);
  EXPECT_TRUE(set.layers[1].holds.shadows);  // a ball shadows itself
}

TEST(ShadeLayers, FactoredHighlightsTakeTheOtherTermsWithThem) {
  // No term of the renderer holds shadows without highlights: alone in the list, `specular` pulls both out.
  Room room = Room().casting().mirroring().shining();
  room.specs[0].shading.specular = LayerPreferences{};
  EXPECT_THAT(names(room.layers()),
              ElementsAre("floor", "floor/shadow of lamp", "floor/specular", "floor/reflection", "ball"));
}

TEST(ShadeLayers, LayerWithoutReceiverOrCasterMakesNoShadow) {
  Room unlit = Room().casting().factored();
  for (Material& material : unlit.scene.materials) material.unlit = true;
  EXPECT_THAT(names(unlit.layers()), ElementsAre("floor", "ball"));
  Room glass = Room().casting().factored();  // a depth map knows no half-transparent caster
  glass.scene.materials[1].opacity = 0.5f;
  EXPECT_THAT(names(glass.layers()), ElementsAre("floor", "ball"));
  Room excused = Room().casting().factored();
  excused.specs[1].casts_shadows = false;
  EXPECT_THAT(names(excused.layers()), ElementsAre("floor", "ball"));
}

TEST(ShadeLayers, CurvedMirrorIsRefusedWithItsReason) {
  Room room;
  room.scene.materials[1].reflectivity = 0.5f;
  room.specs[1].shading.reflection = LayerPreferences{};
  const LayerSet set = room.layers();
  EXPECT_THAT(names(set), ElementsAre("floor", "ball"));
  EXPECT_THAT(reflection_defect(room.scene, set.layers[1]), HasSubstr("not flat"));
}

TEST(ShadeLayers, ReflectionCountsWhatItDrawsAgain) {
  const LayerSet set = Room().mirroring().factored().layers();
  EXPECT_EQ(set.layers[1].polygons, set.layers[0].polygons + set.layers[2].polygons);
}

TEST(ShadeLayers, PreferenceOfATermOutOfRangeIsADefect) {
  Room room = Room().casting().factored();
  room.specs[0].shading.shadows->resolution_scale = 5;
  EXPECT_THAT(room.layers().defect, HasSubstr("resolution_scale"));
}

TEST(CommonPlane, FloorFacesUp) {
  const Room room;
  const auto plane = common_plane(room.scene, std::vector<int>{0}, 0);
  ASSERT_TRUE(plane.has_value());
  EXPECT_NEAR(plane->normal.z, 1, 1e-12);  // the square's own space: it faces its +z
}

TEST(CommonPlane, NothingWithoutAreaOrNode) {
  Room room;
  EXPECT_FALSE(common_plane(room.scene, std::vector<int>{1}, 1));  // a ball
  EXPECT_FALSE(common_plane(room.scene, std::vector<int>{0}, -1));
  EXPECT_FALSE(common_plane(room.scene, std::vector<int>{}, 0));
  room.scene.meshes[0].positions.assign(room.scene.meshes[0].positions.size(), vec3(1));  // all in one point
  EXPECT_FALSE(common_plane(room.scene, std::vector<int>{0}, 0));
}

TEST(WithShadeLayers, FollowTheirBasesWhateverTheGivenOrder) {
  const LayerSet set = Room().casting().shining().factored().layers();  // floor, shadow, specular, ball
  ASSERT_EQ(set.layers.size(), 4u);
  EXPECT_THAT(with_shade_layers(set.layers, std::vector<int>{2, 3, 0, 1}), ElementsAre(3, 0, 1, 2));
}

// --- Effects ---

std::map<std::string, std::string> called(const Room& room) {
  std::map<std::string, std::string> called;
  const LayerSet set = room.layers();
  for (const EffectCall& call : effects_called_for(room.scene, set.layers))
    if (call.called) called.emplace(name(call.effect), call.why);
  return called;
}

std::string why(const Room& room, Effect effect) {
  const LayerSet set = room.layers();
  for (const EffectCall& call : effects_called_for(room.scene, set.layers))
    if (call.effect == effect) return call.why;
  return "?";
}

// Two layers that can hide each other, and light: nothing else.
TEST(EffectsCalledFor, BareLitSceneCallsForLightingAndAnOrder) {
  EXPECT_THAT(called(Room()), ElementsAre(testing::Pair("lighting", HasSubstr("is lit")),
                                          testing::Pair("visibility_sort", HasSubstr("can overlap"))));
}

TEST(EffectsCalledFor, EveryShadeEffectSaysWhyNot) {
  const Room room;
  EXPECT_EQ(why(room, Effect::ShadowMap), "no light casts shadows");
  EXPECT_EQ(why(room, Effect::ShadowLayer), "no light casts shadows");
  EXPECT_EQ(why(room, Effect::SpecularLayer), "no lit material has specular > 0");
  EXPECT_EQ(why(room, Effect::ReflectionMap), "no material has reflectivity > 0");
  EXPECT_EQ(why(room, Effect::TextureLayers), "no material has a second texture");
  EXPECT_THAT(why(Room().casting(), Effect::ShadowLayer), HasSubstr("no layer factors"));
}

TEST(EffectsCalledFor, EveryShadeEffectOfAFactoredRoom) {
  const auto table = called(Room().casting().mirroring().shining().textured_twice().factored());
  std::vector<std::string> effects;
  for (const auto& [effect, reason] : table) effects.push_back(effect);
  EXPECT_THAT(effects, ElementsAre("lighting", "mip_filter", "reflection_layer", "reflection_map",
                                   "shadow_layer", "shadow_map", "specular_highlight", "specular_layer",
                                   "texture", "texture_layers", "visibility_sort"));
}

TEST(EffectsCalledFor, ShadowMapAtRestIsDrawnOnce) {
  EXPECT_EQ(why(Room().casting(), Effect::ShadowMap), "light 'lamp': static, drawn once");
  EXPECT_THAT(why(Room().casting().spinning(1), Effect::ShadowMap), HasSubstr("drawn again"));  // the caster
  EXPECT_THAT(why(Room().casting().spinning(3), Effect::ShadowMap), HasSubstr("drawn again"));  // the light
}

// --- States ---

/// The states of all layers of a room, with any node moved by hand.
std::vector<LayerState> states_of(const Room& room, int moved_node = -1, const dvec3& by = dvec3(0)) {
  const LayerSet set = room.layers();
  SceneFrame frame = room.scene.at(0);
  if (moved_node >= 0) {
    frame.world_from_node[moved_node][3] += dvec4(by, 0);
    if (moved_node == 2) frame.camera.world_from_camera[3] += dvec4(by, 0);
    if (moved_node == 3) frame.lights[0].position += by;
  }
  std::vector<LayerState> states;
  for (const Layer& layer : set.layers)
    states.push_back(layer.base >= 0 ? shade_state(states[layer.base], layer)
                                     : capture(frame, layer,
                                               make_layer_bound(room.scene, layer, BoundKind::Box8), View{}));
  capture_influences(frame, set, states);
  return states;
}

Room full_room() { return Room().casting().mirroring().shining().factored(); }
enum FullRoomLayer { kFloor, kShadow, kSpecular, kReflection, kBall };

/// A member of an aggregate with more textures and lights than a matrix has columns, or entries.
TEST(ShadeState, AllBlendsOfAnAggregateAreKept) {
  const Room room;
  for (const int shades : {3, 4, 5, 16, 17, 40}) {
    LayerSet set;
    set.layers.resize(static_cast<std::size_t>(shades) + 2);
    for (int id = 0; id <= shades + 1; ++id) set.layers[id].id = id;
    set.layers[0].factored.second_texture = true;
    for (int id = 1; id <= shades; ++id) {
      set.layers[id].base = 0;
      set.layers[id].gain = {{0}, {1.0 * id}};
    }
    set.layers.back().members = {0};
    set.layers.back().rigid_node = 0;
    std::vector<LayerState> states(set.layers.size());
    for (std::size_t id = 0; id < states.size(); ++id) states[id].layer = static_cast<int>(id);
    capture_influences(room.scene.at(0), set, states);
    std::vector<double> found;
    for (const dmat4& matrix : states.back().world_from_influence)
      for (int k = 0; k < 16; ++k) found.push_back(matrix[k / 4][k % 4]);
    ASSERT_EQ(found.size(), 16U * static_cast<std::size_t>((shades + 15) / 16)) << shades;
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_EQ(found[k], k < static_cast<std::size_t>(shades) ? k + 1.0 : 0.0) << shades;
  }
}

TEST(ShadeState, MovingCasterChangesTheShadesAndNotTheirBase) {
  const auto then = states_of(full_room()), now = states_of(full_room(), 1, {0.2, 0, 0});
  EXPECT_TRUE(now[kFloor].same_pixels(then[kFloor]));
  EXPECT_FALSE(now[kShadow].same_pixels(then[kShadow]));
  EXPECT_FALSE(now[kReflection].same_pixels(then[kReflection]));
  EXPECT_FALSE(now[kSpecular].same_pixels(then[kSpecular]));  // dimmed by the shadow
}

TEST(ShadeState, AnotherLampChangesTheShadow) {
  Room room = full_room();
  Light other;
  other.name = "other";
  other.kind = Light::Kind::Point;
  other.position = {0, 3, 0};
  room.scene.lights.push_back(other);
  room.specs[0].shading.shadows_as = ShadowsAs::Shade;
  const auto then = states_of(room);
  room.scene.lights.back().position = {0, 3, 1};
  const auto now = states_of(room);
  EXPECT_FALSE(now[kShadow].same_pixels(then[kShadow]));
}

TEST(ShadeState, AtRestAllPixelsAreTheSame) {
  const auto then = states_of(full_room()), now = states_of(full_room());
  for (std::size_t i = 0; i < then.size(); ++i) EXPECT_TRUE(now[i].same_pixels(then[i])) << i;
}

TEST(ShadeState, ShadowOfAPointIsWhereTheRayMeetsTheFloor) {
  const auto states = states_of(full_room());
  const LayerState& shadow = states[kShadow];
  ASSERT_EQ(shadow.traces.size(), 1u);
  EXPECT_TRUE(shadow.traces[0].on_receiver);
  ASSERT_EQ(shadow.traces[0].places.size(), states[kBall].world_points.size());
  const dvec3 lamp(1, 4, 1);
  for (std::size_t i = 0; i < shadow.traces[0].places.size(); ++i) {
    const dvec3 place = dvec3(shadow.world_from_receiver * dvec4(shadow.traces[0].places[i], 1));
    EXPECT_NEAR(place.y, 0, 1e-9);
    const dvec3 c = states[kBall].world_points[i];  // on one line with the lamp
    EXPECT_LT(glm::length(glm::cross(place - lamp, c - lamp)), 1e-9);
  }
}

TEST(ShadeState, HighlightAndReflectionObeyTheLawOfReflection) {
  const auto states = states_of(full_room());
  const dvec3 lamp(1, 4, 1), eye(0, 2, 6);
  const LayerState& specular = states[kSpecular];
  ASSERT_FALSE(specular.traces.empty());
  const ShadeTrace& highlight = specular.traces.back();
  ASSERT_EQ(highlight.kind, ShadeTrace::Kind::Highlight);
  const dvec3 place = dvec3(specular.world_from_receiver * dvec4(highlight.places[0], 1));
  const dvec3 in = glm::normalize(place - lamp), out = glm::normalize(eye - place);
  EXPECT_LT(glm::length(out - dvec3(in.x, -in.y, in.z)), 1e-9);  // the floor turns y around
}

TEST(ShadeState, LightBelowTheFloorOrInTheBallIsFinite) {
  // Below the floor rays meet it from behind; in the middle of the caster they leave in all directions.
  for (const dvec3& by : {dvec3(0, -6, 0), dvec3(-1, -3, -1), dvec3(-1, -4, -1)}) {
    const auto states = states_of(full_room(), 3, by);
    for (const LayerState& state : states)
      for (const ShadeTrace& trace : state.traces) {
        bool some_finite = false;
        for (const dvec3& place : trace.places) some_finite = some_finite || std::isfinite(place.x);
        if (trace.on_receiver && trace.kind == ShadeTrace::Kind::Shadow) {
          EXPECT_TRUE(some_finite);
        }
      }
    EXPECT_EQ(states[kShadow].traces.size(), 1u);
  }
}

/// The trace, as something that can be compared.
auto as_tuple(const ShadeTrace& trace) {
  std::vector<double> places;
  for (const dvec3& p : trace.places)
    for (int k = 0; k < 3; ++k) places.push_back(std::isnan(p[k]) ? 1e300 : p[k]);
  return std::tuple(trace.kind, trace.light, trace.source, trace.on_receiver, places);
}

// What moved between the frames is worked out anew, what did not is taken: the traces are those without knowledge.
TEST(ShadeState, KnowledgeOfAnotherFrameChangesNoTrace) {
  const Room room = full_room();
  const LayerSet set = room.layers();
  const SceneFrame at_rest = room.scene.at(0);
  const std::vector<LayerState> before = states_of(room);
  for (const int moved : {-1, 0, 1, 2, 3}) {  // nothing, floor, ball, eye, lamp
    const dvec3 by(0.25, 0.125, 0);
    const std::vector<LayerState> plain = states_of(room, moved, by);
    std::vector<LayerState> knowing = plain;
    SceneFrame frame = at_rest;
    if (moved >= 0) frame.world_from_node[moved][3] += dvec4(by, 0);
    if (moved == 2) frame.camera.world_from_camera[3] += dvec4(by, 0);
    if (moved == 3) frame.lights[0].position += by;
    for (LayerState& state : knowing) state.traces.clear();
    capture_influences(frame, set, knowing, {at_rest.lights, before});
    for (std::size_t i = 0; i < plain.size(); ++i) {
      ASSERT_EQ(knowing[i].traces.size(), plain[i].traces.size()) << moved;
      for (std::size_t k = 0; k < plain[i].traces.size(); ++k)
        EXPECT_EQ(as_tuple(knowing[i].traces[k]), as_tuple(plain[i].traces[k])) << moved << " " << i;
    }
  }
}

// A trace that is taken is taken as it is: one that was tampered with shows that it was.
TEST(ShadeState, ShadowOfWhatRestsIsTakenFromTheFrameThatKnowsIt) {
  const Room room = full_room();
  const LayerSet set = room.layers();
  const SceneFrame frame = room.scene.at(0);
  std::vector<LayerState> known = states_of(room), now = known;
  known[kShadow].traces[0].places[0] = dvec3(7, 7, 7);
  capture_influences(frame, set, now, {frame.lights, known});
  EXPECT_EQ(now[kShadow].traces[0].places[0], dvec3(7, 7, 7));
  known[kBall].world_points[0].x += 1e-12;  // the caster has moved
  capture_influences(frame, set, now, {frame.lights, known});
  EXPECT_NE(now[kShadow].traces[0].places[0], dvec3(7, 7, 7));
}

TEST(ShadeState, ShadowThatFallsBesideTheReceiverIsNotOnIt) {
  const auto states = states_of(full_room(), 1, {60, 0, 0});  // the ball far away from the floor
  EXPECT_FALSE(states[kShadow].traces[0].on_receiver);
}

}  // namespace
}  // namespace talisman::layers
