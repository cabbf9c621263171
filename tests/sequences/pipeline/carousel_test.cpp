// SPDX-License-Identifier: Apache-2.0
// The sequence `carousel` against z-buffers: layers in a visibility order, merged where there is none, must
// show what one pass over the whole scene shows, but for pixels that a layer covers in part.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "sequences/commands/options.h"
#include "sequences/files/image_io.h"
#include "sequences/pipeline/step.h"
#include "sequences/results/frame_lines.h"

namespace talisman::sequences {
namespace {

using layers::dvec2;
using layers::dvec3;
using regulator::Policy;

Settings carousel_settings(const Sequence& sequence, Policy policy) {
  Settings settings = resolve({}, sequence, true).settings;
  settings.regulator.policy = policy;
  settings.view.display_px = {160, 120};
  settings.placement.min_rotation_gain = 1;  // every sprite on the lattice of the pixels: no resampling
  return settings;
}

/// The alpha of a shown sprite at a pixel, 0 … 255; sprites lie on the lattice of the pixels.
int texel_alpha(const ShownSprite& shown, const chunker::SpriteStore& sprites, int x, int y) {
  const chunker::Sprite* sprite = sprites.find(shown.layer);
  const int column = x - static_cast<int>(std::lround(shown.screen_from_sprite[2].x));
  const int row = y - static_cast<int>(std::lround(shown.screen_from_sprite[2].y));
  return sprite->texel(column, row).a;
}

bool is_partly_covered(const FrameReport& report, const chunker::SpriteStore& sprites, int x, int y) {
  for (const ShownSprite& shown : report.shown) {
    const int alpha = texel_alpha(shown, sprites, x, y);
    if (alpha > 0 && alpha < 255) return true;
  }
  return false;
}

/// The shown layer that hides all others at a pixel covered in full; -1: background.
int front_layer(const FrameReport& report, const chunker::SpriteStore& sprites, int x, int y) {
  for (auto shown = report.shown.rbegin(); shown != report.shown.rend(); ++shown)
    if (texel_alpha(*shown, sprites, x, y) == 255) return shown->layer;
  return -1;
}

/// Back to front, the layers that cover the pixel.
std::string layers_at(const FrameReport& report, const PipelineState& state, int x, int y) {
  std::string text;
  for (const ShownSprite& shown : report.shown)
    if (texel_alpha(shown, state.sprites, x, y) > 0) text += report.layers[shown.layer].name + ", ";
  return text;
}

int difference(const Image8& a, const Image8& b, std::size_t pixel) {
  int largest = 0;
  for (std::size_t c = 0; c < 3; ++c)
    largest = std::max(largest, std::abs(a.rgb[3 * pixel + c] - b.rgb[3 * pixel + c]));
  return largest;
}

struct AgainstOnePass {
  long in_part = 0, in_part_differ = 0, in_full = 0, off_by_one = 0, wrong = 0;
  int largest_in_part = 0, merged_frames = 0, resolved_frames = 0;
};

/// Every `stride`-th frame against the picture of one pass.
AgainstOnePass against_one_pass(const Sequence& s, const Settings& settings, int stride) {
  const Pipeline pipeline = make_pipeline(*s.scene, s.layers, settings);
  const chunker::PreparedScene prepared(*s.scene);
  PipelineState state(pipeline);
  AgainstOnePass result;
  auto& [in_part, in_part_differ, in_full, off_by_one, wrong, largest_in_part, merged_frames,
         resolved_frames] = result;
  for (int frame = 0; frame < s.frames; ++frame) {
    const bool look = frame % stride == 0;
    const FrameReport report = step(pipeline, state, frame, look ? &prepared : nullptr);
    if (!look) continue;
    const Image8 shown = to_image8(report.picture),
                 direct = to_image8(draw_direct(pipeline, frame, prepared));
    merged_frames += !report.order.mergers.empty();
    resolved_frames += !report.order.resolved.empty();
    for (int y = 0; y < shown.height; ++y)
      for (int x = 0; x < shown.width; ++x) {
        const int d = difference(shown, direct, static_cast<std::size_t>(y) * shown.width + x);
        if (is_partly_covered(report, state.sprites, x, y)) {
          ++in_part;
          in_part_differ += d > 1;
          largest_in_part = std::max(largest_in_part, d);
        } else {
          ++in_full;
          off_by_one += d == 1;
          wrong += d > 1;
          if (d > 1)
            std::printf("  frame %d, pixel %d, %d: %s\n", frame, x, y,
                        layers_at(report, state, x, y).c_str());
        }
      }
  }
  std::printf(
      "  %ld pixels covered in full: %ld off by one code value, %ld wrong; %ld in part: %ld differ by more "
      "than one,"
      " at most by %d; merged in %d frames of %d, resolved in %d\n",
      in_full, off_by_one, wrong, in_part, in_part_differ, largest_in_part, merged_frames, s.frames / stride,
      resolved_frames);
  return result;
}

TEST(Carousel, LayersEqualOnePassExceptWherePixelsAreCoveredInPart) {
  const Sequence s = load_sequence("carousel");
  const AgainstOnePass result = against_one_pass(s, carousel_settings(s, Policy::Reference), 1);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_GT(result.in_full, 10 * result.in_part);
  EXPECT_GT(result.merged_frames, 20);
  EXPECT_LT(result.merged_frames, s.frames);
  EXPECT_EQ(result.resolved_frames, 0);
}

TEST(Carousel, ExpressionsEqualOnePassAsMergingDoes) {
  // The planks go round in most frames and are never merged; ball and wall, which meet, are.
  const Sequence s = load_sequence("carousel");
  Settings settings = carousel_settings(s, Policy::Reference);
  settings.compositor = Compositor::Extended;
  const AgainstOnePass result = against_one_pass(s, settings, 3);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_GT(result.in_full, 10 * result.in_part);
  EXPECT_GT(result.resolved_frames, 15);
  EXPECT_LT(result.resolved_frames, s.frames / 3);
  EXPECT_GT(result.merged_frames, 5);
  EXPECT_LT(result.merged_frames, 16);
}

TEST(Carousel, ExpressionsSavePolygonsThatMergingDraws) {
  const Sequence s = load_sequence("carousel");
  const auto polygons = [&](Compositor compositor) {
    Settings settings = carousel_settings(s, Policy::Threshold);
    settings.compositor = compositor;
    const Pipeline pipeline = make_pipeline(*s.scene, s.layers, settings);
    PipelineState state(pipeline);
    long sum = 0;
    for (int frame = 0; frame < s.frames; ++frame)
      for (const regulator::LayerDecision& d : step(pipeline, state, frame, nullptr).plan.decisions)
        sum += d.cost.polygons;
    return sum;
  };
  const long merged = polygons(Compositor::Talisman), resolved = polygons(Compositor::Extended);
  std::printf("  polygons: %ld merged, %ld with expressions\n", merged, resolved);
  EXPECT_LT(resolved, merged);
}

// --- A z-buffer of its own: one ray for each pixel, all triangles, double precision, no rasteriser ---

struct Body {
  int part = -1;
  std::vector<std::array<dvec3, 3>> triangles;
  dvec3 center{0, 0, 0};
  double radius = 0;
};

std::vector<Body> bodies_of(const layers::SceneFrame& frame) {
  std::vector<Body> bodies;
  const layers::Scene& scene = *frame.scene;
  for (std::size_t part = 0; part < scene.parts.size(); ++part) {
    const std::vector<dvec3> points = layers::world_positions(frame, scene.parts[part]);
    const auto& indices = scene.meshes[scene.parts[part].mesh].indices;
    Body body;
    body.part = static_cast<int>(part);
    for (std::size_t i = 0; i < indices.size(); i += 3)
      body.triangles.push_back({points[indices[i]], points[indices[i + 1]], points[indices[i + 2]]});
    for (const dvec3& p : points) body.center += p / static_cast<double>(points.size());
    for (const dvec3& p : points) body.radius = std::max(body.radius, glm::distance(p, body.center));
    bodies.push_back(std::move(body));
  }
  return bodies;
}

/// Distance along the ray, or infinity; fronts only.
double hit(const dvec3& eye, const dvec3& ray, const std::array<dvec3, 3>& t) {
  const dvec3 u = t[1] - t[0], v = t[2] - t[0], n = glm::cross(u, v);
  const double facing = glm::dot(n, ray);
  if (!(facing < 0)) return HUGE_VAL;
  const double distance = glm::dot(n, t[0] - eye) / facing;
  const dvec3 p = eye + distance * ray - t[0];
  const double a = glm::dot(glm::cross(p, v), n), b = glm::dot(glm::cross(u, p), n);
  const bool inside = a >= 0 && b >= 0 && a + b <= glm::dot(n, n);
  return inside && distance > 0 ? distance : HUGE_VAL;
}

int nearest_part(const std::vector<Body>& bodies, const dvec3& eye, const dvec3& ray) {
  int part = -1;
  double nearest = HUGE_VAL;
  for (const Body& body : bodies) {
    const dvec3 to = body.center - eye;
    if (glm::length(glm::cross(to, ray)) > body.radius * glm::length(ray)) continue;
    for (const auto& triangle : body.triangles) {
      const double distance = hit(eye, ray, triangle);
      if (distance < nearest) nearest = distance, part = body.part;
    }
  }
  return part;
}

dvec3 ray_through(const layers::CameraState& camera, layers::ivec2 display_px, double x, double y) {
  const double half = std::tan(camera.fov_y_rad / 2);
  const dvec3 in_camera((2 * x / display_px.x - 1) * half * display_px.x / display_px.y,
                        (1 - 2 * y / display_px.y) * half, -1);
  return layers::dmat3(camera.world_from_camera) * in_camera;
}

TEST(Carousel, RaysThroughPixelsMeetTheLayerThatIsInFront) {
  // Independent of renderer and compositor: which part does the eye meet first? It must be drawn by the layer
  // that is shown in front, at every pixel that no layer covers in part.
  const Sequence s = load_sequence("carousel");
  const Pipeline pipeline = make_pipeline(*s.scene, s.layers, carousel_settings(s, Policy::Reference));
  const chunker::PreparedScene prepared(*s.scene);
  PipelineState state(pipeline);
  long checked = 0, wrong = 0;
  for (int frame = 0; frame < s.frames; ++frame) {
    const bool look = frame % 6 == 2;
    const FrameReport report = step(pipeline, state, frame, look ? &prepared : nullptr);
    if (!look) continue;
    const layers::SceneFrame now = s.scene->at(frame / s.fps);
    const std::vector<Body> bodies = bodies_of(now);
    const layers::ivec2 size = pipeline.settings.view.display_px;
    const dvec3 eye(now.camera.world_from_camera[3]);
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        if (is_partly_covered(report, state.sprites, x, y)) continue;
        ++checked;
        const int layer = front_layer(report, state.sprites, x, y);
        const int part = nearest_part(bodies, eye, ray_through(now.camera, size, x + 0.5, y + 0.5));
        const bool right = layer < 0 ? part < 0
                                     : std::count(report.layers[layer].parts.begin(),
                                                  report.layers[layer].parts.end(), part) == 1;
        wrong += !right;
        if (!right && wrong <= 5)
          ADD_FAILURE() << "frame " << frame << " pixel " << x << ", " << y << ": layer " << layer
                        << ", part " << part;
      }
  }
  std::printf("  %ld pixels checked, %ld wrong\n", checked, wrong);
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(checked, 16L * 160 * 120 / 2);
}

TEST(Carousel, ThresholdShowsTheOrderOfTheReferenceWithinItsBound) {
  const Sequence s = load_sequence("carousel");
  const Pipeline exact = make_pipeline(*s.scene, s.layers, carousel_settings(s, Policy::Reference));
  const Pipeline thrifty = make_pipeline(*s.scene, s.layers, carousel_settings(s, Policy::Threshold));
  PipelineState exact_state(exact), thrifty_state(thrifty);
  int renders = 0, renders_of_reference = 0;
  for (int frame = 0; frame < s.frames; ++frame) {
    const FrameReport a = step(exact, exact_state, frame, nullptr),
                      b = step(thrifty, thrifty_state, frame, nullptr);
    ASSERT_EQ(a.order.back_to_front, b.order.back_to_front) << frame;
    ASSERT_EQ(a.shown.size(), b.shown.size());
    for (const regulator::LayerDecision& d : b.plan.decisions) {
      EXPECT_LE(d.shown_geometric_px, thrifty.settings.regulator.thresholds.geometric_px);
      renders += d.action == regulator::Action::Rerender;
    }
    for (const regulator::LayerDecision& d : a.plan.decisions)
      renders_of_reference += d.action == regulator::Action::Rerender;
  }
  EXPECT_LT(renders, renders_of_reference / 2);
}

TEST(Carousel, PlanksGoRoundUntilOneLeavesAndAgainWhenItIsBack) {
  const Sequence s = load_sequence("carousel");
  const Pipeline pipeline = make_pipeline(*s.scene, s.layers, carousel_settings(s, Policy::Reference));
  PipelineState state(pipeline);
  std::string history;  // one letter for each frame: are the planks merged?
  for (int frame = 0; frame < s.frames; ++frame) {
    const FrameReport report = step(pipeline, state, frame, nullptr);
    bool planks = false;
    for (const Merger& merger : report.order.mergers)
      planks |= report.layers[merger.layer].name == "plank a+plank b+plank c";
    history += planks ? 'm' : '.';
  }
  EXPECT_EQ(history.front(), 'm');
  EXPECT_EQ(history[s.frames / 2], '.');
  EXPECT_EQ(history.back(), 'm');
  std::string changes;
  for (const char c : history)
    if (changes.empty() || changes.back() != c) changes += c;
  EXPECT_EQ(changes, "m.m");  // no flicker
}

}  // namespace
}  // namespace talisman::sequences
