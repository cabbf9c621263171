// SPDX-License-Identifier: Apache-2.0
#include "chunker/draw_list.h"

#include <algorithm>
#include <array>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <glm/geometric.hpp>

#include "chunker/job_order.h"
#include "chunker/prepared.h"
#include "chunker/tangent_frames.h"
#include "chunker/transform.h"
#include "layers/check.h"

namespace talisman::chunker {
namespace {

using layers::dvec3;

constexpr int kVerticesPerJob = 4096;
constexpr int kTrianglesPerJob = 8192;

/// Triangles of one job. Vertices made here (by cutting, or one per corner for flat shading) are numbered
/// after the part's own.
struct Block {
  std::vector<Triangle> triangles;
  std::vector<Float4> made;
};

/// Everything that the triangles of one part share.
class PartAssembly {
 public:
  PartAssembly(const layers::SceneFrame& frame, const layers::Part& part, const SpriteView& view,
               const Shader& shader, bool flat)
      : view_(view), shader_(shader), vertices_(frame, part, view, shader), flat_(flat) {
    two_sided_ = part.material >= 0 && frame.scene->materials[part.material].two_sided;
    front_is_positive_ = view.mirrored != vertices_.mirrored();
    backs_ = two_sided_ && shader.lit && !flat_;
    projected_.resize(vertices_.size());
    if (!flat_ && shader.layout.count > 0)
      attributes_.resize(static_cast<std::size_t>(vertices_.size()) * (backs_ ? 2 : 1) * shader.layout.count);
  }

  void run_vertices() {
    const bool cut = layers::is_built(layers::Effect::ReflectionMap) && view_.region.kept;
    if (vertices_.skinned())
      cut ? run_vertices<true, true>() : run_vertices<true, false>();
    else
      cut ? run_vertices<false, true>() : run_vertices<false, false>();
  }

  /// Behind run_vertices().
  void run_tangent_frames(const layers::SceneFrame& frame, const layers::Part& part) {
    write_tangent_frames(frame, part, shader_.layout, backs_, attributes_);
  }

  std::vector<Block> run_triangles() const {
    const int count = vertices_.mesh().triangle_count();
    std::vector<Block> blocks((count + kTrianglesPerJob - 1) / kTrianglesPerJob);
    const JobOrder order(blocks.size());
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t job) {
      const std::size_t b = order[job];
      const int first = static_cast<int>(b) * kTrianglesPerJob,
                end = std::min(count, first + kTrianglesPerJob);
      blocks[b].triangles.reserve((end - first) / 2 + 1);  // of a closed surface half faces away
      for (int t = first; t < end; ++t) run_triangle(t, blocks[b]);
    });
    return blocks;
  }

  /// Number of the first vertex that a block made.
  std::uint32_t own_vertices() const {
    return flat_ ? 0 : static_cast<std::uint32_t>(vertices_.size()) * (backs_ ? 2 : 1);
  }
  std::vector<Float4> take_attributes() { return std::move(attributes_); }

 private:
  using Corners = std::array<std::uint32_t, 3>;

  template <bool kSkinned, bool kCut>
  void run_vertices() {
    tbb::parallel_for(tbb::blocked_range<int>(0, vertices_.size(), kVerticesPerJob),
                      [this](const auto& range) {
                        for (int i = range.begin(); i != range.end(); ++i) run_vertex<kSkinned, kCut>(i);
                      });
  }

  template <bool kSkinned, bool kCut>
  void run_vertex(int i) {
    const dvec3 place = vertices_.sprite_point<kSkinned>(i);
    projected_[i] = project(view_, place);
    if constexpr (kCut)
      if (view_.region.kept->height(place) < 0) projected_[i].flags |= kCutAway;
    const int count = shader_.layout.count;
    if (flat_ || count == 0) return;
    ShadePoint point = vertices_.shade_point<kSkinned>(i);
    write_attributes(shader_, point, &attributes_[static_cast<std::size_t>(i) * count]);
    if (!backs_) return;
    point.normal = -point.normal;
    write_attributes(shader_, point, &attributes_[(static_cast<std::size_t>(i) + vertices_.size()) * count]);
  }

  void run_triangle(int t, Block& block) const {
    const std::uint32_t* index = &vertices_.mesh().indices[static_cast<std::size_t>(t) * 3];
    const Corners corner{index[0], index[1], index[2]};
    const ProjectedVertex &a = projected_[corner[0]], &b = projected_[corner[1]], &c = projected_[corner[2]];
    if (a.flags & b.flags & c.flags & kOutsideFlags) return;
    const int any = a.flags | b.flags | c.flags;
    if (any & kNotFinite) return;
    if (any & kClipFlags)
      cut_and_emit(corner, block);
    else
      emit(corner, {a, b, c}, nullptr, block);
  }

  void cut_and_emit(const Corners& corner, Block& block) const {
    std::array<dvec3, 3> points;
    for (int k = 0; k < 3; ++k) points[k] = vertices_.sprite_point(static_cast<int>(corner[k]));
    const ClippedPolygon polygon = clip_triangle(points, view_.region);
    for (int k = 2; k < polygon.count; ++k) {
      const std::array<const ClipVertex*, 3> fan{&polygon.vertices[0], &polygon.vertices[k - 1],
                                                 &polygon.vertices[k]};
      std::array<ProjectedVertex, 3> projected;
      std::array<dvec3, 3> weights;
      for (int j = 0; j < 3; ++j) {
        projected[j] = project_cut(view_, fan[j]->point);
        weights[j] = fan[j]->weights;
      }
      emit(corner, projected, &weights, block);
    }
  }

  /// `weights`: the corners of a cut piece, as weights of the whole triangle's; null for a whole triangle.
  void emit(const Corners& corner, const std::array<ProjectedVertex, 3>& v,
            const std::array<dvec3, 3>* weights, Block& block) const {
    if ((v[0].flags | v[1].flags | v[2].flags) & kNotFinite) return;
    Triangle t;
    for (int k = 0; k < 3; ++k) {
      t.x[k] = v[k].x;
      t.y[k] = v[k].y;
      t.depth[k] = v[k].depth;
    }
    const std::int64_t area = doubled_area(t);
    if (area == 0) return;
    const bool front = (area > 0) == front_is_positive_;
    if (!front && !two_sided_) return;
    const LatticeBox sprite{0, 0, view_.size_px.x * 4 - 1, view_.size_px.y * 4 - 1};
    if (intersection(sample_box(t), sprite).empty()) return;
    t.vertex = attribute_numbers(corner, front, weights, block);
    if (area < 0) {
      std::swap(t.x[1], t.x[2]);
      std::swap(t.y[1], t.y[2]);
      std::swap(t.depth[1], t.depth[2]);
      std::swap(t.vertex[1], t.vertex[2]);
    }
    block.triangles.push_back(t);
  }

  Corners attribute_numbers(const Corners& corner, bool front, const std::array<dvec3, 3>* weights,
                            Block& block) const {
    if (shader_.layout.count == 0) return {0, 0, 0};
    const auto shift = static_cast<std::uint32_t>(backs_ && !front ? vertices_.size() : 0);
    if (!flat_ && weights == nullptr) return {corner[0] + shift, corner[1] + shift, corner[2] + shift};
    std::array<std::array<Float4, kMaxAttributes>, 3> own;
    if (flat_)
      write_flat(corner, front, own);
    else
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < shader_.layout.count; ++i)
          own[k][i] = attributes_[static_cast<std::size_t>(corner[k] + shift) * shader_.layout.count + i];
    return make_vertices(own, weights, block);
  }

  Corners make_vertices(const std::array<std::array<Float4, kMaxAttributes>, 3>& own,
                        const std::array<dvec3, 3>* weights, Block& block) const {
    const int count = shader_.layout.count;
    const auto first = own_vertices() + static_cast<std::uint32_t>(block.made.size() / count);
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < count; ++i)
        block.made.push_back(weights == nullptr ? own[k][i] : blend(own, (*weights)[k], i));
    return {first, first + 1, first + 2};
  }

  static Float4 blend(const std::array<std::array<Float4, kMaxAttributes>, 3>& own, const dvec3& w, int i) {
    return own[0][i] * splat(static_cast<float>(w.x)) + own[1][i] * splat(static_cast<float>(w.y)) +
           own[2][i] * splat(static_cast<float>(w.z));
  }

  /// All three corners are lit as the triangle's centre with the triangle's own normal.
  void write_flat(const Corners& corner, bool front,
                  std::array<std::array<Float4, kMaxAttributes>, 3>& own) const {
    std::array<dvec3, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = vertices_.eye_position(static_cast<int>(corner[k]));
    dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double length = glm::length(normal);
    normal = length > 0 ? normal / length : dvec3(0);
    if (front == vertices_.mirrored()) normal = -normal;
    for (int k = 0; k < 3; ++k) {
      ShadePoint point = vertices_.shade_point(static_cast<int>(corner[k]));
      point.normal = float4(layers::vec3(normal));
      point.lit_at = float4(layers::vec3((p[0] + p[1] + p[2]) / 3.0));
      write_attributes(shader_, point, own[k].data());
    }
  }

  const SpriteView& view_;
  const Shader& shader_;
  PartVertices vertices_;
  bool flat_ = false, two_sided_ = false;
  bool backs_ = false;  ///< a second copy of the attributes, with turned normals, follows the first
  bool front_is_positive_ = false;  ///< sign of the doubled area of triangles seen from their front
  std::vector<ProjectedVertex> projected_;
  std::vector<Float4> attributes_;
};

/// Lights are not looked at for surfaces that show none.
bool any_lit(const layers::Scene& scene, std::span<const int> parts) {
  return std::any_of(parts.begin(), parts.end(), [&](int part) {
    const int material = scene.parts[part].material;
    return material < 0 || !scene.materials[material].unlit;
  });
}

void append(PartAssembly& assembly, std::vector<Block> blocks, std::uint32_t batch, DrawList& list) {
  std::vector<Float4>& attributes = list.batches[batch].attributes;
  const int count = list.batches[batch].shader.layout.count;
  const std::uint32_t own = assembly.own_vertices();
  attributes = assembly.take_attributes();
  std::uint32_t shift = 0;
  for (Block& block : blocks) {
    for (Triangle& t : block.triangles) {
      t.batch = batch;
      for (std::uint32_t& v : t.vertex)
        if (v >= own) v += shift;
    }
    list.triangles.insert(list.triangles.end(), block.triangles.begin(), block.triangles.end());
    attributes.insert(attributes.end(), block.made.begin(), block.made.end());
    if (count > 0) shift += static_cast<std::uint32_t>(block.made.size() / count);
  }
}

/// The first of `choices` that names the part, or null.
template <typename Choice>
const Choice* choice_of(std::span<const Choice> choices, int part) {
  const auto names = [part](const Choice& choice) {
    return choice.parts.empty() || std::binary_search(choice.parts.begin(), choice.parts.end(), part);
  };
  const auto found = std::find_if(choices.begin(), choices.end(), names);
  return found == choices.end() ? nullptr : &*found;
}

PartInputs own_inputs(const layers::SceneFrame& frame, const ShadeInputs& inputs, int part,
                      const DrawList& list) {
  PartInputs own;
  if (layers::is_built(layers::Effect::MovingPicture) && !frame.picture_frames.empty()) own.frame = &frame;
  if (const Reflection* reflection = choice_of(inputs.reflections, part))
    own.reflection = &list.reflections[reflection - inputs.reflections.data()];
  if (const TextureBlend* blend = choice_of(inputs.texture_blends, part)) own.texture_blend = blend->factors;
  return own;
}

/// Is the part wholly outside of what the sprite shows?
bool is_out_of_sight(const PreparedScene& prepared, const layers::SceneFrame& frame, const layers::Part& part,
                     const layers::Region& region) {
  const layers::Box3 box = part_box(frame, part, prepared.impl().boxes[part.mesh]);
  return layers::RegionTest(region, layers::reach_of({&box, 1})).misses(box);
}

}  // namespace

void build_draw_list(const PreparedScene& prepared, const layers::SceneFrame& frame,
                     std::span<const int> parts, layers::ivec2 display_px,
                     const layers::SpritePlacement& placement, const RenderOptions& options,
                     const ShadeInputs& inputs, DrawList& list) {
  TALISMAN_CHECK(frame.scene == &prepared.scene());
  const layers::Scene& scene = *frame.scene;
  list.size_px = placement.empty() ? layers::ivec2{0, 0} : placement.size_px;
  if (any_lit(scene, parts)) list.lights = light_set(frame, inputs);
  list.term = inputs.term;
  list.adds = inputs.lights == LightsHeld::One;
  for (const Reflection& r : inputs.reflections)
    list.reflections.push_back({r.picture, r.picture_from_screen * placement.screen_from_sprite});
  list.batches.reserve(parts.size());
  const auto view = sprite_view(frame, display_px, placement, inputs.kept);
  const layers::Region region = view ? sprite_region(*view) : layers::Region{};
  for (const int index : parts) {
    const layers::Part& part = scene.parts[index];
    const layers::Mesh& mesh = scene.meshes[part.mesh];
    list.polygons_in += mesh.triangle_count();
    if (!view) continue;
    const Shader shader =
        make_shader(prepared, part, list.lights, options, inputs, own_inputs(frame, inputs, index, list));
    if (shader.opacity == 0) continue;
    list.batches.push_back({shader, {}});
    if (is_out_of_sight(prepared, frame, part, region)) continue;
    const bool flat = shader.lit && (options.shading == Shading::Flat || mesh.normals.empty());
    PartAssembly assembly(frame, part, *view, list.batches.back().shader, flat);
    assembly.run_vertices();
    if (shader.normal_map != nullptr) assembly.run_tangent_frames(frame, part);
    append(assembly, assembly.run_triangles(), static_cast<std::uint32_t>(list.batches.size() - 1), list);
  }
}

}  // namespace talisman::chunker
