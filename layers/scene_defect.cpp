// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <type_traits>

#include <glm/gtc/quaternion.hpp>

#include "layers/scene.h"

namespace talisman::layers {

namespace {

// Each check returns the first broken rule of one item, without the item's name ("position 7 is nan, rule:
// finite"), or an empty string. `first_defect` puts the name in front.

template <typename... Pieces>
std::string text(const Pieces&... pieces) {
  std::ostringstream out;
  (out << ... << pieces);
  return out.str();
}

template <typename... Pieces>
std::string broken(const std::string& rule, const Pieces&... what) {
  return text(what..., ", rule: ", rule);
}

/// The first component that is not finite, or nothing wrong.
template <typename V>
std::string finite(const std::string& what, const V& v) {
  if constexpr (std::is_arithmetic_v<V>) {
    if (!std::isfinite(v)) return broken("finite", what, " is ", v);
  } else {
    for (int i = 0; i < v.length(); ++i)
      if (!std::isfinite(v[i])) return broken("finite", what, " has component ", v[i]);
  }
  return {};
}

template <typename V>
std::string finite_array(const char* what, const std::vector<V>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    for (int k = 0; k < values[i].length(); ++k)
      if (!std::isfinite(values[i][k]))
        return broken("finite", what, " ", i, " has component ", values[i][k]);
  return {};
}

/// The renderer lights points in float, relative to the eye, with the squares of distances: beyond this they are no longer
/// finite, and nearer than that they vanish.
constexpr double kFarthestPlace_m = 5e18, kNearestNear_m = 1e-20;

template <typename V>
std::string place_defect(const std::string& what, const V& place) {
  if (auto defect = finite(what, place); !defect.empty()) return defect;
  for (int k = 0; k < place.length(); ++k)
    if (std::fabs(place[k]) > kFarthestPlace_m)
      return broken(text("within ", kFarthestPlace_m, " m of the origin"), what, " has component ", place[k]);
  return {};
}

std::string places_defect(const char* what, const std::vector<vec3>& places) {
  const auto lies_near = [](float x) { return std::fabs(x) <= kFarthestPlace_m; };  // no if it is nan
  for (std::size_t i = 0; i < places.size(); ++i)
    if (const vec3& p = places[i]; !(lies_near(p.x) && lies_near(p.y) && lies_near(p.z)))
      return place_defect(text(what, " ", i), p);
  return {};
}

template <typename Size>
std::string index_in(const char* what, int index, Size size, bool or_none) {
  const int lowest = or_none ? -1 : 0;
  if (index >= lowest && index < static_cast<int>(size)) return {};
  return broken(text("from ", lowest, " to below ", size), what, " ", index);
}

std::string color_defect(const char* what, const vec3& color) {
  if (auto defect = finite(what, color); !defect.empty()) return defect;
  for (int k = 0; k < 3; ++k)
    if (color[k] < 0) return broken("at least 0", what, " has component ", color[k]);
  return {};
}

/// The first of several findings.
std::string first_of(std::initializer_list<std::string> findings) {
  for (const std::string& finding : findings)
    if (!finding.empty()) return finding;
  return {};
}

// --- Meshes ---

std::string optional_length(const char* what, std::size_t length, std::size_t positions) {
  if (length == 0 || length == positions) return {};
  return broken(text("none or as many as positions, ", positions), length, " ", what);
}

std::string index_array_defect(const Mesh& mesh) {
  if (mesh.indices.size() % 3 != 0) return broken("three per triangle", mesh.indices.size(), " indices");
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    if (mesh.indices[i] >= mesh.positions.size())
      return broken(text("below ", mesh.positions.size(), " vertices"), "index ", mesh.indices[i],
                    " of triangle ", i / 3);
  return {};
}

std::string weight_defect(const Mesh& mesh) {
  if (mesh.joints.size() != mesh.weights.size())
    return broken("as many joints as weights", mesh.joints.size(), " joints and ", mesh.weights.size(),
                  " weights");
  for (std::size_t i = 0; i < mesh.weights.size(); ++i)
    for (int k = 0; k < 4; ++k)
      if (mesh.weights[i][k] < 0)
        return broken("at least 0", "weight of vertex ", i, " is ", mesh.weights[i][k]);
  return {};
}

std::string alpha_defect(const Mesh& mesh) {
  if (!mesh.alphas.empty() && mesh.colors.empty())
    return broken("only with colors", mesh.alphas.size(), " alphas");
  for (std::size_t i = 0; i < mesh.alphas.size(); ++i)
    if (!(mesh.alphas[i] >= 0 && mesh.alphas[i] <= 1))
      return broken("from 0 to 1", "alpha of vertex ", i, " is ", mesh.alphas[i]);
  return {};
}

std::string morph_defect(const Mesh& mesh) {
  const std::size_t n = mesh.positions.size();
  for (const MorphTarget& morph : mesh.morphs) {
    std::string defect = first_of(
        {optional_length("morph positions", morph.positions.size(), n),
         optional_length("morph normals", morph.normals.size(), mesh.normals.size()),
         optional_length("morph tangents", morph.tangents.size(), mesh.tangents.size()),
         finite_array("morph position", morph.positions), finite_array("morph normal", morph.normals),
         finite_array("morph tangent", morph.tangents)});
    if (!defect.empty()) return defect;
  }
  return {};
}

/// Frames of normal maps: a sign where there is a tangent, and neither where there is none.
std::string normal_map_defect(const Mesh& mesh) {
  const std::size_t n = mesh.positions.size();
  if (auto defect =
          first_of({optional_length("normal uvs", mesh.normal_uvs.size(), n),
                    optional_length("tangents", mesh.tangents.size(), n),
                    finite_array("normal uv", mesh.normal_uvs), finite_array("tangent", mesh.tangents)});
      !defect.empty())
    return defect;
  if (!mesh.tangents.empty() && mesh.normals.empty())
    return broken("only with normals", mesh.tangents.size(), " tangents");
  for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
    const vec4& t = mesh.tangents[i];
    if (vec3(t) == vec3(0) ? t.w != 0 : t.w != 1 && t.w != -1)
      return broken("1 or -1, of a tangent that is zero 0", "sign of tangent ", i, " is ", t.w);
  }
  return {};
}

std::string defect_of(const Scene&, const Mesh& mesh) {
  const std::size_t n = mesh.positions.size();
  return first_of(
      {optional_length("normals", mesh.normals.size(), n), optional_length("uvs", mesh.uvs.size(), n),
       optional_length("colors", mesh.colors.size(), n), optional_length("joints", mesh.joints.size(), n),
       optional_length("weights", mesh.weights.size(), n),
       optional_length("emissive uvs", mesh.emissive_uvs.size(), n),
       optional_length("alphas", mesh.alphas.size(), n), finite_array("emissive uv", mesh.emissive_uvs),
       alpha_defect(mesh), morph_defect(mesh), normal_map_defect(mesh),
       places_defect("position", mesh.positions), finite_array("normal", mesh.normals),
       finite_array("uv", mesh.uvs), finite_array("color", mesh.colors), finite_array("weight", mesh.weights),
       index_array_defect(mesh), weight_defect(mesh)});
}

// --- Surfaces ---

std::string defect_of(const Scene&, const Texture& texture) {
  if (texture.width < 1 || texture.height < 1)
    return broken("at least 1 × 1", "size ", texture.width, " × ", texture.height);
  const std::size_t bytes = 4 * static_cast<std::size_t>(texture.width) * texture.height;
  if (texture.rgba.size() == bytes) return {};
  return broken(text("4 · width · height = ", bytes), texture.rgba.size(), " bytes");
}

bool strictly_grows(const auto& values) {
  return std::adjacent_find(values.begin(), values.end(), [](auto a, auto b) { return !(a < b); }) ==
         values.end();
}

std::string held_frames_defect(const Scene& scene, const MovingPicture& picture) {
  const std::size_t held = picture.frames.size();
  if (held == 0 || held != picture.textures.size())
    return broken("at least 1, and as many", held, " frames and ", picture.textures.size(), " textures");
  if (!strictly_grows(picture.frames)) return broken("numbers of frames grow", "frames");
  for (const int texture : picture.textures)
    if (std::string defect = index_in("texture", texture, scene.textures.size(), false); !defect.empty())
      return defect;
  if (picture.texture == picture.textures.front()) return {};
  return broken(text("that of its first frame, ", picture.textures.front()), "texture ", picture.texture);
}

std::string defect_of(const Scene& scene, const MovingPicture& picture) {
  if (!(picture.fps > 0) || !std::isfinite(picture.fps))
    return broken("finite, above 0", "fps ", picture.fps);
  if (!std::isfinite(picture.start_s)) return finite("start", picture.start_s);
  if (picture.frame_count < 1) return broken("at least 1", "frame count ", picture.frame_count);
  if (std::string defect = held_frames_defect(scene, picture); !defect.empty()) return defect;
  const std::vector<double>& starts = picture.starts_s;
  if (starts.empty()) return {};
  if (starts.size() != static_cast<std::size_t>(picture.frame_count))
    return broken(text("as many as frames, ", picture.frame_count), starts.size(), " starts");
  if (starts.front() == 0 && strictly_grows(starts) && picture.length_s > starts.back() &&
      std::isfinite(picture.length_s))
    return {};
  return broken("starts of frames grow from 0 to below the finite length", "starts");
}

std::string range_defect(const char* what, double value, double low, double high) {
  if (value >= low && value <= high) return {};
  return broken(text("from ", low, " to ", high), what, " ", value);
}

std::string defect_of(const Scene& scene, const Material& material) {
  return first_of(
      {color_defect("base color", material.base_color), color_defect("specular color", material.specular),
       color_defect("emissive color", material.emissive), range_defect("opacity", material.opacity, 0, 1),
       finite("shininess", material.shininess), range_defect("shininess", material.shininess, 0, HUGE_VAL),
       index_in("texture", material.texture, scene.textures.size(), true),
       index_in("emissive texture", material.emissive_texture, scene.textures.size(), true),
       index_in("normal texture", material.normal_texture, scene.textures.size(), true),
       finite("normal scale", material.normal_scale),
       range_defect("alpha cutoff", material.alpha_cutoff, 0, 1),
       index_in("second texture", material.texture2, scene.textures.size(), true),
       range_defect("texture blend 1", material.texture_blend.x, 0, 1),
       range_defect("texture blend 2", material.texture_blend.y, 0, 1),
       range_defect("reflectivity", material.reflectivity, 0, 1)});
}

// --- Nodes and their motion ---

std::string rotation_defect(const std::string& what, const glm::dquat& q) {
  if (auto defect = finite(what, q); !defect.empty()) return defect;
  if (q.w == 0 && q.x == 0 && q.y == 0 && q.z == 0) return broken("not zero", what, " is zero");
  return {};
}

std::string defect_of(const Scene& scene, const Skin& skin) {
  if (skin.joints.size() != skin.joint_from_mesh.size())
    return broken("as many", skin.joints.size(), " joints and ", skin.joint_from_mesh.size(), " matrices");
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    if (auto d = index_in("joint node", skin.joints[i], scene.nodes.size(), false); !d.empty()) return d;
    for (int column = 0; column < 4; ++column)
      if (auto d = finite(text("matrix of joint ", i), skin.joint_from_mesh[i][column]); !d.empty()) return d;
  }
  return {};
}

std::string defect_of(const Scene& scene, const Node& node) {
  const auto own_index = &node - scene.nodes.data();
  if (node.parent < -1 || node.parent >= own_index)
    return broken(text("-1 or a node before it, below ", own_index), "parent ", node.parent);
  for (const double weight : node.morph_weights)
    if (auto d = finite("morph weight", weight); !d.empty()) return d;
  return first_of({place_defect("translation", node.local.translation),
                   rotation_defect("rotation", node.local.rotation), finite("scale", node.local.scale)});
}

template <typename T>
std::string value_defect(const std::string& what, const T& value) {
  if constexpr (std::is_same_v<T, glm::dquat>)
    return rotation_defect(what, value);
  else
    return finite(what, value);
}

template <typename T>
std::string tangent_defect(const std::string& channel, const Keys<T>& keys) {
  if (keys.in_tangents.size() != keys.values.size() || keys.out_tangents.size() != keys.values.size())
    return broken("two per key", channel, " has ", keys.in_tangents.size(), " and ", keys.out_tangents.size(),
                  " tangents");
  for (std::size_t i = 0; i < keys.values.size(); ++i) {
    if (auto d = finite(text(channel, " tangent into key ", i), keys.in_tangents[i]); !d.empty()) return d;
    if (auto d = finite(text(channel, " tangent out of key ", i), keys.out_tangents[i]); !d.empty()) return d;
  }
  return {};
}

std::string loop_end_defect(double loop_end_s) {
  if (std::isfinite(loop_end_s) && loop_end_s >= 0) return {};
  return broken("finite, at least 0", "the loop ends at ", loop_end_s);
}

template <typename T>
std::string keys_defect(const std::string& channel, const Keys<T>& keys) {
  const auto& times = keys.times_s;
  if (times.size() != keys.values.size())
    return broken("as many", channel, " has ", times.size(), " times and ", keys.values.size(), " values");
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (auto d = finite(text(channel, " time ", i), times[i]); !d.empty()) return d;
    if (i > 0 && !(times[i - 1] < times[i]))
      return broken(text("above the one before, ", times[i - 1]), channel, " time ", i, " is ", times[i]);
    if (auto d = value_defect(text(channel, " key ", i), keys.values[i]); !d.empty()) return d;
  }
  return keys.interpolation == Interpolation::CubicSpline ? tangent_defect(channel, keys) : "";
}

std::string path_defect(const char* channel, const Keys<dvec3>& keys) {
  if (auto defect = keys_defect(channel, keys); !defect.empty()) return defect;
  for (std::size_t i = 0; i < keys.values.size(); ++i)
    if (auto defect = place_defect(text(channel, " key ", i), keys.values[i]); !defect.empty()) return defect;
  return {};
}

std::string motion_defect(const TransformTrack& track) {
  return first_of({path_defect("translation", track.translation), keys_defect("rotation", track.rotation),
                   keys_defect("scale", track.scale), loop_end_defect(track.loop_end_s)});
}

std::string motion_defect(const MorphTrack& track) {
  for (const Keys<double>& keys : track.weights)
    if (auto d = keys_defect("weight", keys); !d.empty()) return d;
  return loop_end_defect(track.loop_end_s);
}

std::string motion_defect(const FlightTrack& track) {
  if (track.position.values.empty()) return broken("at least 1", "flight with 0 positions");
  return first_of({path_defect("position", track.position), path_defect("target", track.target),
                   keys_defect("bank", track.bank_rad)});
}

std::string motion_defect(const SpinTrack& track) {
  if (track.axis == dvec3{0, 0, 0}) return broken("not zero", "spin axis is zero");
  return first_of({finite("spin axis", track.axis), finite("spin rate", track.rate_rad_per_s)});
}

std::string defect_of(const Scene& scene, const Track& track) {
  if (auto d = index_in("node", track.node, scene.nodes.size(), false); !d.empty()) return d;
  return std::visit([](const auto& motion) { return motion_defect(motion); }, track.motion);
}

// --- What shows the scene ---

std::string cone_defect(const Light& light) {
  constexpr double kHalfPi = 1.5707963267948966;
  return first_of({range_defect("outer cone angle", light.outer_cone_rad, 0, kHalfPi),
                   range_defect("inner cone angle", light.inner_cone_rad, 0, light.outer_cone_rad)});
}

std::string attenuation_defect(const Light& light) {
  const dvec3& a = light.attenuation;
  if (!(a.x >= 0 && a.y >= 0 && a.z >= 0 && a.x + a.y + a.z > 0 && std::isfinite(a.x + a.y + a.z)))
    return broken("finite, at least 0 and not all 0", "attenuation ", a.x, " ", a.y, " ", a.z);
  if (!(light.range_m >= 0 && std::isfinite(light.range_m)))
    return broken("finite, at least 0", "range ", light.range_m);
  return {};
}

std::string shadow_defect(const Light& light) {
  if (light.casts_shadow && light.kind == Light::Kind::Ambient)
    return broken("of a light with a place or direction", "an ambient light casts a shadow");
  const ShadowMapOptions& shadow = light.shadow;
  return first_of({range_defect("shadow resolution", shadow.resolution_px, 0, 8192),
                   range_defect("shadow bias", shadow.bias_texels, 0, 100),
                   range_defect("shadow slope bias", shadow.slope_bias, 0, 16),
                   range_defect("shadow filter radius", shadow.pcf_radius, 0, 8)});
}

std::string defect_of(const Scene& scene, const Light& light) {
  const bool aimed = light.kind == Light::Kind::Directional || light.kind == Light::Kind::Spot;
  if (aimed && light.direction == dvec3{0, 0, 0}) return broken("not zero", "direction is zero");
  return first_of({index_in("node", light.node, scene.nodes.size(), true),
                   place_defect("position", light.position), finite("direction", light.direction),
                   color_defect("color", light.color), cone_defect(light), attenuation_defect(light),
                   shadow_defect(light)});
}

std::string defect_of(const Scene& scene, const Camera& camera) {
  if (!(camera.fov_y_rad > 0 && camera.fov_y_rad < 3.14159265358979))
    return broken("above 0 and below pi", "fov_y_rad ", camera.fov_y_rad);
  if (!(camera.near_m > 0 && camera.near_m < camera.far_m && std::isfinite(camera.far_m)))
    return broken("0 < near < far, finite", "near_m ", camera.near_m, " and far_m ", camera.far_m);
  if (camera.near_m < kNearestNear_m)
    return broken(text("at least ", kNearestNear_m), "near_m ", camera.near_m);
  return index_in("node", camera.node, scene.nodes.size(), true);
}

std::string skinned_part_defect(const Scene& scene, const Part& part) {
  const Mesh& mesh = scene.meshes[part.mesh];
  const std::size_t joints = scene.skins[part.skin].joints.size();
  if (mesh.joints.size() != mesh.positions.size())
    return broken("a skinned part's mesh has joints", "mesh ", part.mesh, " has ", mesh.joints.size(),
                  " joints");
  for (std::size_t i = 0; i < mesh.joints.size(); ++i)
    for (int k = 0; k < 4; ++k)
      if (mesh.joints[i][k] >= joints)
        return broken(text("below ", joints, " of its skin"), "joint ", mesh.joints[i][k], " of vertex ", i);
  return {};
}

std::string defect_of(const Scene& scene, const Part& part) {
  const std::string defect = first_of({index_in("node", part.node, scene.nodes.size(), false),
                                       index_in("mesh", part.mesh, scene.meshes.size(), false),
                                       index_in("material", part.material, scene.materials.size(), false),
                                       index_in("skin", part.skin, scene.skins.size(), true)});
  return defect.empty() && part.skin >= 0 ? skinned_part_defect(scene, part) : defect;
}

const std::string& name_of(const Scene& scene, const Track& track) {
  static const std::string kNone;
  const bool known = track.node >= 0 && track.node < static_cast<int>(scene.nodes.size());
  return known ? scene.nodes[track.node].name : kNone;
}
template <typename Item>
const std::string& name_of(const Scene&, const Item& item) {
  return item.name;
}

template <typename Item>
std::string first_in(const Scene& scene, const char* kind, const std::vector<Item>& items) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string defect = defect_of(scene, items[i]);
    if (defect.empty()) continue;
    const std::string& name = name_of(scene, items[i]);
    return name.empty() ? text(kind, " ", i, ": ", defect) : text(kind, " '", name, "': ", defect);
  }
  return {};
}

std::string scene_defect(const Scene& scene) {
  const std::string background = color_defect("background", scene.background);
  if (!background.empty()) return "scene: " + background;
  const auto casting = std::count_if(scene.lights.begin(), scene.lights.end(),
                                     [](const Light& light) { return light.casts_shadow; });
  if (casting > kMaxShadowLights)
    return "scene: " + broken(text("at most ", kMaxShadowLights), casting, " lights cast shadows");
  if (scene.cameras.empty()) return {};  // seen from the origin
  const std::string camera = index_in("active camera", scene.active_camera, scene.cameras.size(), false);
  return camera.empty() ? camera : "scene: " + camera;
}

}  // namespace

std::string first_defect(const Scene& scene) {
  // All are looked at, so each check guards its own indices and may not rely on the ones before it.
  return first_of({first_in(scene, "mesh", scene.meshes), first_in(scene, "texture", scene.textures),
                   first_in(scene, "moving picture", scene.moving_pictures),
                   first_in(scene, "material", scene.materials), first_in(scene, "node", scene.nodes),
                   first_in(scene, "skin", scene.skins), first_in(scene, "track of node", scene.tracks),
                   first_in(scene, "light", scene.lights), first_in(scene, "camera", scene.cameras),
                   first_in(scene, "part", scene.parts), scene_defect(scene)});
}

}  // namespace talisman::layers
