// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What there is to draw, and where it is at one time.
///
/// A `Scene` is plain data: meshes, materials, textures, nodes, animation, lights, cameras and the parts that
/// join them. `Scene::at(t)` is a pure function of time: it evaluates every node, camera and light and
/// returns a `SceneFrame`. Nothing here is changed by rendering.
///
/// Conventions: metres, right-handed, y up; cameras look along their own -z; times in seconds; angles in
/// radians; colours are linear light, RGB, without alpha unless it is named. Texture bytes are sRGB with
/// straight alpha, row 0 at v = 0 (v grows downwards, as in glTF). Triangles are counter-clockwise seen from
/// their front.
///
/// Parts and layers: [LS97 2.4]. Parts are the smallest renderable units.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "layers/geometry2.h"

namespace talisman::layers {

/// What one morph target adds to the vertices of a mesh at weight 1; each array is empty or as long as
/// `positions`.
struct MorphTarget {
  std::vector<vec3> positions;  ///< metres, added
  std::vector<vec3> normals;    ///< added; the sum is of unit length again
  std::vector<vec3> tangents;   ///< added to their first three components
};

/// Indexed triangles. Every vertex array but `positions` is either empty or as long as `positions`.
struct Mesh {
  std::string name;
  std::vector<vec3> positions;     ///< metres, in the space of the part's node
  std::vector<vec3> normals;       ///< unit length
  std::vector<vec2> uvs;           ///< texture coordinates, 1 = one repeat
  std::vector<vec2> emissive_uvs;  ///< of the emissive texture, where they are not `uvs`
  std::vector<vec2> normal_uvs;    ///< of the normal texture, where they are not `uvs`
  /// Where u grows, of unit length, and a sign: the bitangent is sign · (normal × tangent), which is where v
  /// shrinks. (0, 0, 0, 0): there is none, and no normal map there (layers/tangents.h). Only with `normals`.
  std::vector<vec4> tangents;
  std::vector<vec3> colors;            ///< linear, multiplied with the base colour
  std::vector<float> alphas;           ///< 0 … 1, multiplied with the opacity; only with `colors`
  std::vector<std::uint32_t> indices;  ///< three per triangle
  std::vector<glm::uvec4> joints;      ///< skinning: indices into Skin::joints
  std::vector<vec4> weights;           ///< skinning: ≥ 0; divided by their sum where they are used
  std::vector<MorphTarget> morphs;     ///< weighted by Node::morph_weights
  int triangle_count() const { return static_cast<int>(indices.size() / 3); }
};

/// Where a texture is looked up outside 0 … 1.
enum class Wrap { Repeat, Clamp, Mirror };

/// sRGB bytes, straight alpha, 4 per texel. Of a normal texture the bytes are no light: n = 2 · byte / 255 - 1.
struct Texture {
  std::string name;
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
  bool has_alpha = false;  ///< some texel has alpha < 255
  Wrap wrap_u = Wrap::Repeat, wrap_v = Wrap::Repeat;
  bool nearest = false;           ///< magnified: the nearest texel alone instead of four
  bool nearest_minified = false;  ///< minified: likewise, in each level
  bool finest = false;            ///< minified: never a coarser level
  bool one_level = false;         ///< minified: the nearest level alone instead of a mix of two
};

/// A texture that changes over time: an image sequence or a video [LS97 1]. Where a material names `texture`, the
/// frame of the time is looked up in its place (layers/moving_picture.h).
struct MovingPicture {
  std::string name;
  int texture = -1;     ///< index into Scene::textures: its first frame; that of one moving picture only
  double fps = 24;      ///< > 0; frames per second, where they have no times of their own
  double start_s = 0;   ///< when its first frame begins, which is shown before, too
  int frame_count = 1;  ///< ≥ 1; of the source
  bool loop = false;    ///< begins again at its end; else its last frame holds
  /// Of a variable rate: when each frame begins, seconds after start_s, from 0, strictly increasing; else empty.
  std::vector<double> starts_s{};
  double length_s = 0;          ///< of a variable rate: when the last frame ends, above its start
  std::vector<int> frames{};    ///< numbers of the frames that are held, ascending
  std::vector<int> textures{};  ///< as many: their indices into Scene::textures
};

struct Material {
  std::string name;
  vec3 base_color{0.8f, 0.8f, 0.8f};
  float opacity = 1;  ///< 0 … 1
  int texture = -1;   ///< index into Scene::textures, multiplied with the base colour; -1: none
  /// T₂ of [LS97 2.3], added to `texture` (T₁) under the same coordinates: base · (k₁ T₁ + k₂ T₂); -1: none.
  int texture2 = -1;
  vec2 texture_blend{1, 1};  ///< k₁ and k₂, 0 … 1; used only where there is a texture2
  vec3 specular{0, 0, 0};
  float shininess = 0;  ///< Blinn-Phong exponent, ≥ 0
  vec3 emissive{0, 0, 0};
  int emissive_texture = -1;  ///< index into Scene::textures, multiplied with `emissive`; -1: none
  /// Index into Scene::textures: normals in the frame of tangent, bitangent and normal; -1: none. Seen only
  /// where the mesh has tangents and is shaded per pixel.
  int normal_texture = -1;
  float normal_scale =
      1;  ///< of their first two components; 0: the map changes nothing; < 0: hollows for bumps
  /// 0 … 1; above 0: where the alpha of texture and vertices is at least this the surface is opaque,
  /// elsewhere it is not there.
  float alpha_cutoff = 0;
  float reflectivity = 0;  ///< 0 … 1: share of the looked-up planar reflection that is added
  bool two_sided = false;  ///< otherwise back faces are culled
  bool unlit = false;      ///< base colour as it is (sky, backdrops)
};

/// The joints that a skinned mesh follows.
struct Skin {
  std::string name;
  std::vector<int> joints;             ///< node indices
  std::vector<dmat4> joint_from_mesh;  ///< inverse bind matrices, as many
};

/// How the shadow map of a light is drawn and looked up (chunker/shadow_map.h).
struct ShadowMapOptions {
  /// Texels on each side of a map, 0 … 8192; 0: no map, no shadow. Time and memory (4 bytes per texel) grow
  /// with the square; the blocks of a shadow's edge shrink.
  int resolution_px = 1024;
  /// Constant bias in texels of the map, 0 … 100. Too little: surfaces shadow themselves in stripes; too
  /// much: shadows come loose from what casts them.
  float bias_texels = 1;
  /// Bias in multiples of the depth that a slanted caster gains over the filter's reach, 0 … 16.
  float slope_bias = 1;
  /// Radius of the percentage-closer filter in texels, 0 … 8: (2r + 1)² depths are compared per look-up, 0 is
  /// one comparison. More is softer, and slower with the square.
  int pcf_radius = 1;
  bool operator==(const ShadowMapOptions&) const = default;
};

/// The most lights of a scene that may cast shadows.
inline constexpr int kMaxShadowLights = 4;

struct Light {
  enum class Kind { Ambient, Directional, Point, Spot };
  std::string name;
  Kind kind = Kind::Directional;
  int node = -1;            ///< -1: fixed in the world
  dvec3 position{0, 0, 0};  ///< in the node's space (Point, Spot)
  dvec3 direction{0, -1,
                  0};   ///< the way the light travels, in the node's space (Directional; Spot: its axis)
  vec3 color{1, 1, 1};  ///< linear, intensity included
  /// Spot: angles from the axis, 0 ≤ inner ≤ outer ≤ π/2. Full light inside the inner cone, none outside the
  /// outer one, smooth between.
  double inner_cone_rad = 0.4, outer_cone_rad = 0.6;
  /// Point, Spot, with d the distance in metres: the colour is scaled by 1 / (x + y d + z d²), and by
  /// max(0, 1 - (d / range)⁴) where there is a range.
  dvec3 attenuation{1, 0, 0};  ///< ≥ 0, not all 0
  double range_m = 0;          ///< ≥ 0; 0: without end
  bool casts_shadow = false;   ///< of at most kMaxShadowLights lights; not of an ambient one
  ShadowMapOptions shadow;
};

struct Camera {
  std::string name;
  int node = -1;                     ///< the camera looks along the node's -z; -1: at the origin
  double fov_y_rad = 0.9;            ///< (0, π)
  double near_m = 0.1, far_m = 1e4;  ///< 0 < near < far
};

/// Translation, rotation, scale: local = T · R · S.
struct Transform {
  dvec3 translation{0, 0, 0};
  glm::dquat rotation{1, 0, 0, 0};  ///< w, x, y, z
  dvec3 scale{1, 1, 1};
  dmat4 matrix() const;
};

struct Node {
  std::string name;
  int parent = -1;                      ///< parents come before their children
  Transform local;                      ///< where no track moves it
  std::vector<double> morph_weights{};  ///< of the morph targets of its meshes, where no track moves them
};

enum class Interpolation { Step, Linear, CatmullRom, CubicSpline };

template <typename T>
struct Keys {
  std::vector<double> times_s;  ///< strictly increasing
  std::vector<T> values;
  Interpolation interpolation = Interpolation::Linear;
  std::vector<T> in_tangents{}, out_tangents{};  ///< CubicSpline: slopes per second, one per key
};

/// Keyframes of a node's translation, rotation and scale; an empty channel keeps the node's own value.
/// Before the first and after the last key the end value holds, unless `loop`.
struct TransformTrack {
  Keys<dvec3> translation;
  Keys<glm::dquat> rotation;
  Keys<dvec3> scale;
  bool loop = false;
  /// Looped: what is repeated lasts from 0 to this time; 0: from the earliest to the latest key.
  double loop_end_s = 0;
};

/// Keyframes of a node's morph weights, one list per target; an empty list keeps the node's own weight.
struct MorphTrack {
  std::vector<Keys<double>> weights;
  bool loop = false;
  double loop_end_s = 0;  ///< as above
};

/// A flight along a spline (centripetal Catmull-Rom through the positions). The node's -z looks along the
/// tangent, or at `target` where that is given; positive bank rolls to the right. Positions and targets are
/// in the space of the node's parent. Where the direction is lost (standing still, at the target, straight up
/// or down) see layers/animation.h.
struct FlightTrack {
  Keys<dvec3> position;
  Keys<dvec3> target;     ///< empty: look along the path
  Keys<double> bank_rad;  ///< empty: level
};

/// The node turns with constant rate about an axis through its own origin, given in its own space.
struct SpinTrack {
  dvec3 axis{0, 1, 0};
  double rate_rad_per_s = 1;
};

struct Track {
  int node = -1;
  std::variant<TransformTrack, FlightTrack, SpinTrack, MorphTrack> motion;
};

/// A mesh instance with its material: the smallest renderable unit [LS97 2.4].
struct Part {
  std::string name;  ///< path of its node, "/" between names, plus "#k" for the k-th mesh of a node
  int node = -1;
  int mesh = -1;
  int material = -1;
  int skin = -1;  ///< index into Scene::skins; -1: rigid
  /// A copy of what lies behind a shared edge in another layer, so that no crack opens there (layers/seam.h).
  bool is_seam = false;
  /// A coarser level of another part, drawn in its place (layers/lod/levels.h); no layer takes it.
  bool is_level = false;
};

struct CameraState {
  dmat4 world_from_camera{1};
  double fov_y_rad = 0.9, near_m = 0.1, far_m = 1e4;
  bool operator==(const CameraState&) const = default;
};

struct LightState {
  Light::Kind kind = Light::Kind::Directional;
  dvec3 position{0, 0, 0};    ///< world
  dvec3 direction{0, -1, 0};  ///< world, unit length
  vec3 color{1, 1, 1};
  double inner_cone_rad = 0.4, outer_cone_rad = 0.6;
  bool casts_shadow = false;
  ShadowMapOptions shadow;
  dvec3 attenuation{1, 0, 0};
  double range_m = 0;
  bool falls_off() const { return attenuation != dvec3{1, 0, 0} || range_m > 0; }
  bool operator==(const LightState&) const = default;
};

struct Scene;

/// Everything that moves, at one time. Holds a pointer to its scene, which must outlive it.
struct SceneFrame {
  const Scene* scene = nullptr;
  double time_s = 0;
  std::vector<dmat4> world_from_node;  ///< one per node
  CameraState camera;
  std::vector<LightState> lights;  ///< one per light
  /// One per node; without any where no mesh of the scene has morph targets.
  std::vector<std::vector<double>> morph_weights;
  /// Of each moving picture the number of the frame that is shown; without any where the scene has none.
  std::vector<int> picture_frames;
};

struct LevelSet;  // layers/lod/levels.h

struct Scene {
  std::vector<Mesh> meshes;
  std::vector<Texture> textures;
  std::vector<MovingPicture> moving_pictures;
  std::vector<Material> materials;
  std::vector<Skin> skins;
  std::vector<Node> nodes;
  std::vector<Track> tracks;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  std::vector<Part> parts;
  vec3 background{0, 0, 0};  ///< linear, behind all layers
  int active_camera = 0;
  /// Coarser meshes and parts, which lie behind all others (layers/lod/levels.h); null: there are none.
  std::shared_ptr<const LevelSet> levels;

  /// The scene at time `t_s` (any finite value; tracks hold or loop outside their keys). Pure, and finite for
  /// a scene without defects (a product of matrices that overflows leaves the node with its parent). Tracks
  /// of one node apply in their order. The camera's matrix is rigid: a scale above its node does not scale
  /// its near plane. Cost: O(nodes + tracks · log keys).
  SceneFrame at(double t_s) const;

  /// The end of the last track, seconds; 0 when nothing moves by keys.
  double duration_s() const;
};

/// What a light's colour is scaled by at a distance, apart from its cone.
double falloff(const LightState& light, double distance_m);

/// Does the part change its shape: has it a skin, or morph targets?
bool deforms(const Scene& scene, const Part& part);

/// Positions and normals of the part's mesh at `frame`, in its own space, morph targets added: p + Σ wₖ Δpₖ.
/// Cost: O(vertices · targets).
std::vector<dvec3> morphed_positions(const SceneFrame& frame, const Part& part);
std::vector<dvec3> morphed_normals(const SceneFrame& frame, const Part& part);
/// Likewise, without the signs. The mesh has tangents.
std::vector<dvec3> morphed_tangents(const SceneFrame& frame, const Part& part);

/// World positions of a part's vertices at `frame`: morph targets, then node transform, or linear-blend
/// skinning where the part has a skin: p' = Σ wₖ Mₖ p / Σ wₖ; a vertex whose weights are all 0 follows the first joint it names.
/// Cost: O(vertices).
std::vector<dvec3> world_positions(const SceneFrame& frame, const Part& part);
/// The same of these vertices alone, in their order. Cost: O(vertices asked for + joints).
std::vector<dvec3> world_positions(const SceneFrame& frame, const Part& part,
                                   std::span<const std::uint32_t> vertices);

/// World-from-vertex matrix of each joint of a skinned part: world_from_joint · joint_from_mesh.
std::vector<dmat4> joint_palette(const SceneFrame& frame, const Part& part);

/// Morph weights of a part's mesh at `frame`, one per target; a weight that no node gives is 0.
std::vector<double> morph_weights(const SceneFrame& frame, const Part& part);

/// Does `node` or an ancestor move by a track? A track whose keys are all equal moves nothing. (A skinned
/// part moves with its joints whatever its node does.) Cost: O(depth · tracks).
bool is_animated(const Scene& scene, int node);

/// First broken rule of the scene in words ("mesh 'hull': index 812 of triangle 270, rule: below 811
/// vertices"), or an empty string. Checks indices, array lengths, finite numbers, parent order, key order.
/// Parts need a node, a mesh and a material. Readers call it on whatever they read.
std::string first_defect(const Scene& scene);

}  // namespace talisman::layers
