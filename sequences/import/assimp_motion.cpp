// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fstream>
#include <istream>
#include <iterator>
#include <memory>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "sequences/import/assimp_scene.h"
#include "sequences/import/collada_cameras.h"
#include "sequences/import/exposure.h"
#include "sequences/import/far_plane.h"
#include "sequences/import/limits.h"
#include "sequences/import/lower_case.h"
#include "sequences/import/studio_cameras.h"
#include "sequences/import/wide_text.h"

namespace talisman::sequences {

namespace {

constexpr double kDefaultTicksPerSecond = 25;  // assimp's word for "the file does not say"
constexpr double kDefaultFov_rad = 0.9;

/// Keys in seconds with strictly increasing times; of equal times the first is kept. Keys that are no numbers
/// are left out.
template <typename Value, typename Key, typename Convert>
layers::Keys<Value> to_keys(const Key* keys, unsigned count, double seconds_per_tick, Convert convert) {
  layers::Keys<Value> result;
  for (unsigned i = 0; keys && i < count; ++i) {
    const double time = keys[i].mTime * seconds_per_tick;
    const Value value = convert(keys[i].mValue);
    bool usable = std::isfinite(time);
    for (int k = 0; k < value.length(); ++k) usable = usable && std::isfinite(value[k]);
    if (!usable || (!result.times_s.empty() && time <= result.times_s.back())) continue;
    result.times_s.push_back(time);
    result.values.push_back(value);
  }
  return result;
}

glm::dquat to_unit(const aiQuaternion& q) {
  const glm::dquat raw = to_quaternion(q);
  const double length = glm::length(raw);
  return length > 1e-12 ? raw / length : glm::dquat(1, 0, 0, 0);
}

void import_channel(Import& import, const aiNodeAnim& channel, double seconds_per_tick) {
  const auto node = import.node_named.find(channel.mNodeName.C_Str());
  if (node == import.node_named.end()) return;
  layers::TransformTrack track;
  track.loop = true;
  track.translation =
      to_keys<layers::dvec3>(channel.mPositionKeys, channel.mNumPositionKeys, seconds_per_tick, to_vector);
  track.rotation =
      to_keys<glm::dquat>(channel.mRotationKeys, channel.mNumRotationKeys, seconds_per_tick, to_unit);
  track.scale =
      to_keys<layers::dvec3>(channel.mScalingKeys, channel.mNumScalingKeys, seconds_per_tick, to_vector);
  import.model.scene.tracks.push_back({node->second, std::move(track)});
}

int node_or_none(const Import& import, const aiString& name) {
  const auto node = import.node_named.find(name.C_Str());
  return node == import.node_named.end() ? -1 : node->second;
}

bool is_finite(const layers::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Half the opening angle: the formats give the whole cone, and assimp hands on what the file says.
double cone_angle_rad(float angle_rad) {
  const double half = angle_rad / 2.0;
  return std::isfinite(half) ? std::clamp(half, 0.0, kWidestCone_rad) : kWidestCone_rad;
}

void import_cone(Import& import, const aiLight& from, layers::Light& to) {
  to.outer_cone_rad = cone_angle_rad(from.mAngleOuterCone);
  to.inner_cone_rad = std::min(cone_angle_rad(from.mAngleInnerCone), to.outer_cone_rad);
  if (to.outer_cone_rad > 0) return;
  import.warn("light '" + to.name + "' is a spot without an angle; it shines into a half-space");
  to.outer_cone_rad = to.inner_cone_rad = kWidestCone_rad;
}

/// assimp says 0, 1, 0 where the file says nothing.
void import_attenuation(const aiLight& from, layers::Light& to) {
  const layers::dvec3 given(from.mAttenuationConstant, from.mAttenuationLinear, from.mAttenuationQuadratic);
  const bool usable =
      given.x >= 0 && given.y >= 0 && given.z >= 0 && given.x + given.y + given.z > 0 && is_finite(given);
  if (usable && given != layers::dvec3(0, 1, 0)) to.attenuation = given;
}

/// The light, or nothing when its kind cannot be kept.
bool import_light(Import& import, const aiLight& from, layers::Light& to) {
  to.name = from.mName.C_Str();
  to.node = node_or_none(import, from.mName);
  to.position = to_vector(from.mPosition);
  to.direction = to_vector(from.mDirection);
  to.color = {from.mColorDiffuse.r, from.mColorDiffuse.g, from.mColorDiffuse.b};
  switch (from.mType) {
    case aiLightSource_DIRECTIONAL:
      to.kind = layers::Light::Kind::Directional;
      break;
    case aiLightSource_SPOT:
      to.kind = layers::Light::Kind::Spot;
      import_attenuation(from, to);
      import_cone(import, from, to);
      break;
    case aiLightSource_POINT:
      to.kind = layers::Light::Kind::Point;
      import_attenuation(from, to);
      break;
    case aiLightSource_AMBIENT:
      to.kind = layers::Light::Kind::Ambient;
      to.color = {from.mColorAmbient.r, from.mColorAmbient.g, from.mColorAmbient.b};
      break;
    default:
      import.warn("light '" + to.name + "' is of a kind that is not simulated");
      return false;
  }
  const bool has_direction =
      to.kind == layers::Light::Kind::Directional || to.kind == layers::Light::Kind::Spot;
  if (has_direction && !(glm::length(to.direction) > 0)) to.direction = {0, 0, -1};
  for (int k = 0; k < 3; ++k)
    if (!(to.color[k] >= 0 && std::isfinite(to.color[k]))) to.color[k] = 0;
  if (to.color == layers::vec3(0)) {
    import.warn("light '" + to.name + "' gives no light");
    return false;
  }
  return is_finite(to.position) && is_finite(to.direction);
}

/// A node that looks along its own -z.
int add_view_node(Import& import, const std::string& camera, int parent, const layers::dvec3& eye,
                  const layers::dvec3& ahead, const layers::dvec3& up) {
  layers::Node view;
  view.name = camera + "#view";
  view.parent = parent;
  view.local.translation = eye;
  const layers::dvec3 right = glm::cross(ahead, up);
  if (glm::length(right) > 1e-9 && is_finite(right)) {
    const layers::dvec3 x = glm::normalize(right), z = -glm::normalize(ahead);
    view.local.rotation = glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
  }
  import.model.scene.nodes.push_back(view);
  return static_cast<int>(import.model.scene.nodes.size()) - 1;
}

/// assimp says 0, 0, 1 where its reader of the format says nothing: ASE, OpenGEX, LightWave. Those look along -z
/// (LightWave along +z of a left-handed space, which assimp turns over).
layers::dvec3 ahead_of(const aiCamera& from) {
  const layers::dvec3 ahead = to_vector(from.mLookAt);
  const bool says_nothing = to_vector(from.mPosition) == layers::dvec3(0) &&
                            ahead == layers::dvec3(0, 0, 1) && to_vector(from.mUp) == layers::dvec3(0, 1, 0);
  return says_nothing ? -ahead : ahead;
}

double fov_y(const aiCamera& from) {
  const double aspect = from.mAspect > 0 ? from.mAspect : 1.0;
  const double fov = 2 * std::atan(std::tan(from.mHorizontalFOV / 2.0) / aspect);
  return std::isfinite(fov) && fov > 0.01 && fov < 3 ? fov : kDefaultFov_rad;
}

bool is_studio(const std::string& path) { return lower_extension(path) == ".3ds"; }

bool is_moved(const Import& import, const std::string& node) {
  for (const layers::Track& track : import.model.scene.tracks) {
    if (import.model.scene.nodes[static_cast<std::size_t>(track.node)].name != node) continue;
    const auto* keys = std::get_if<layers::TransformTrack>(&track.motion);
    if (keys && std::max(keys->translation.times_s.size(), keys->rotation.times_s.size()) > 1) return true;
  }
  return false;
}

/// z is up in the file, and its tree's root turns it over.
void import_studio_cameras(Import& import) {
  std::ifstream in(import.place.path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const auto root = import.node_of.find(import.from.mRootNode);
  for (const StudioCamera& from : studio_cameras(bytes)) {
    const layers::dvec3 ahead = from.target - from.eye;
    if (!(glm::length(ahead) > 0)) continue;
    const layers::dvec3 up = glm::angleAxis(from.bank_rad, glm::normalize(ahead)) * layers::dvec3(0, 0, 1);
    layers::Camera camera;
    camera.name = from.name;
    camera.node = add_view_node(import, from.name, root == import.node_of.end() ? -1 : root->second, from.eye,
                                ahead, up);
    camera.fov_y_rad = from.fov_rad;
    import.model.scene.cameras.push_back(camera);
    if (is_moved(import, from.name))
      import.warn("camera '" + from.name + "' moves in the file, and stands here");
  }
}

}  // namespace

void import_motion(Import& import) {
  if (import.from.mNumAnimations == 0 || !import.from.mAnimations || !import.from.mAnimations[0]) return;
  if (import.from.mNumAnimations > 1)
    import.warn(std::to_string(import.from.mNumAnimations) + " animations; only the first is played");
  const aiAnimation& animation = *import.from.mAnimations[0];
  const double ticks = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : kDefaultTicksPerSecond;
  for (unsigned c = 0; c < animation.mNumChannels; ++c)
    if (animation.mChannels[c]) import_channel(import, *animation.mChannels[c], 1 / ticks);
}

void import_lights(Import& import) {
  auto& lights = import.model.scene.lights;
  for (unsigned i = 0; i < import.from.mNumLights; ++i) {
    layers::Light light;
    if (import.from.mLights[i] && import_light(import, *import.from.mLights[i], light))
      lights.push_back(light);
  }
  if (std::any_of(lights.begin(), lights.end(),
                  [](const layers::Light& l) { return l.attenuation != layers::dvec3(1, 0, 0); }))
    return expose_lights(import.model);
  float brightest = 1;
  for (const layers::Light& light : lights)
    for (int k = 0; k < 3; ++k) brightest = std::max(brightest, light.color[k]);
  for (layers::Light& light : lights) light.color /= brightest;
  import.model.exposure_lx = brightest;
}

/// Metres per unit of what hangs below a node: files in centimetres have a node that scales.
double scale_below(const layers::Scene& scene, int node) {
  double scale = 1;
  for (; node >= 0; node = scene.nodes[static_cast<std::size_t>(node)].parent) {
    const layers::dvec3& s = scene.nodes[static_cast<std::size_t>(node)].local.scale;
    scale *= std::cbrt(std::abs(s.x * s.y * s.z));
  }
  return scale;
}

/// Of COLLADA, what assimp does not hand on.
void apply_collada(Import& import, const ColladaCamera& from, layers::Camera& camera) {
  if (from.is_orthographic)
    import.warn("camera '" + camera.name + "' is orthographic, and is drawn in perspective");
  camera.fov_y_rad = from.fov_y_rad > 0 ? from.fov_y_rad : kDefaultFov_rad;
  const double scale = scale_below(import.model.scene, camera.node);
  if (from.near_m && from.far_m && *from.near_m > 0 && *from.far_m > *from.near_m)
    camera.near_m = scale * *from.near_m, camera.far_m = scale * *from.far_m;
}

std::vector<ColladaCamera> collada_cameras_of(const Import& import) {
  if (lower_extension(import.place.path) != ".dae" || import.from.mNumCameras == 0) return {};
  const std::unique_ptr<std::istream> in = open_text(import.place.path);
  return collada_cameras(std::string{std::istreambuf_iterator<char>(*in), {}});
}

void import_cameras(Import& import) {
  if (is_studio(import.place.path)) return import_studio_cameras(import);
  const std::vector<ColladaCamera> of_collada = collada_cameras_of(import);
  for (unsigned i = 0; i < import.from.mNumCameras; ++i) {
    const aiCamera* from = import.from.mCameras[i];
    if (!from) continue;
    layers::Camera camera;
    camera.name = from->mName.C_Str();
    camera.node = add_view_node(import, camera.name, node_or_none(import, from->mName),
                                to_vector(from->mPosition), ahead_of(*from), to_vector(from->mUp));
    camera.fov_y_rad = fov_y(*from);
    const double scale = scale_below(import.model.scene, camera.node);
    const double near_m = scale * from->mClipPlaneNear, far_m = scale * from->mClipPlaneFar;
    const bool says_nothing =
        from->mClipPlaneNear == 0.1f && from->mClipPlaneFar == 1000.0f;  // assimp's defaults
    if (!says_nothing && near_m > 0 && far_m > near_m && std::isfinite(far_m))
      camera.near_m = near_m, camera.far_m = far_m;
    for (const ColladaCamera& of_file : of_collada)
      if (of_file.node == camera.name || of_collada.size() == 1) {
        apply_collada(import, of_file, camera);
        break;
      }
    if (camera.far_m != layers::Camera{}.far_m)
      if (const std::string cut = beyond_far_plane(import.model.scene, camera); !cut.empty())
        import.warn(cut);
    import.model.scene.cameras.push_back(camera);
  }
}

}  // namespace talisman::sequences
