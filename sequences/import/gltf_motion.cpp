// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "sequences/import/gltf_scene.h"

namespace talisman::sequences {

namespace {

using layers::Interpolation;

Interpolation interpolation_of(const Json& sampler) {
  const std::string name = text_of(sampler, "interpolation", "LINEAR");
  if (name == "LINEAR") return Interpolation::Linear;
  if (name == "STEP") return Interpolation::Step;
  if (name == "CUBICSPLINE") return Interpolation::CubicSpline;
  throw InputError("glTF: interpolation is " + name + ", rule: LINEAR, STEP or CUBICSPLINE");
}

/// One channel's numbers: `width` of them per key and (CUBICSPLINE) tangent.
struct Curve {
  std::vector<double> times_s;
  Accessed output;
  Interpolation interpolation = Interpolation::Linear;
  int width = 1;

  /// Number `component` of key `key`; `part`: 0 in-tangent, 1 value, 2 out-tangent.
  double at(std::size_t key, int component, int part = 1) const {
    const bool spline = interpolation == Interpolation::CubicSpline;
    const std::size_t element = spline ? 3 * key + static_cast<std::size_t>(part) : key;
    return output.values[element * static_cast<std::size_t>(width) + static_cast<std::size_t>(component)];
  }
};

Curve read_curve(GltfImport& import, const Json& sampler, int width) {
  Curve curve;
  curve.interpolation = interpolation_of(sampler);
  curve.width = width;
  curve.times_s = read_accessor(import.file, index_of(sampler, "input"), "animation input", 1).values;
  curve.output = read_accessor(import.file, index_of(sampler, "output"));
  const std::size_t per_key =
      static_cast<std::size_t>(width) * (curve.interpolation == Interpolation::CubicSpline ? 3 : 1);
  if (curve.output.values.size() < curve.times_s.size() * per_key)
    throw InputError("glTF: an animation has " + std::to_string(curve.output.values.size()) + " values for " +
                     std::to_string(curve.times_s.size()) + " keys, rule: " + std::to_string(per_key) +
                     " per key");
  return curve;
}

/// `value(key, part)`: as Curve::at, all components together. Keys that do not come later than the one before
/// them, or are no numbers, are left out.
template <typename T, typename Value>
layers::Keys<T> to_keys(const Curve& curve, const Value& value) {
  layers::Keys<T> keys;
  keys.interpolation = curve.interpolation;
  for (std::size_t k = 0; k < curve.times_s.size(); ++k) {
    const double time = curve.times_s[k];
    if (!std::isfinite(time) || (!keys.times_s.empty() && time <= keys.times_s.back())) continue;
    keys.times_s.push_back(time);
    keys.values.push_back(value(k, 1));
    if (curve.interpolation != Interpolation::CubicSpline) continue;
    keys.in_tangents.push_back(value(k, 0));
    keys.out_tangents.push_back(value(k, 2));
  }
  return keys;
}

layers::Keys<layers::dvec3> vector_keys(const Curve& curve) {
  return to_keys<layers::dvec3>(curve, [&](std::size_t k, int part) {
    return layers::dvec3(curve.at(k, 0, part), curve.at(k, 1, part), curve.at(k, 2, part));
  });
}

layers::Keys<glm::dquat> rotation_keys(const Curve& curve) {
  return to_keys<glm::dquat>(curve, [&](std::size_t k, int part) {
    glm::dquat q(curve.at(k, 3, part), curve.at(k, 0, part), curve.at(k, 1, part), curve.at(k, 2, part));
    const bool none = q.w == 0 && q.x == 0 && q.y == 0 && q.z == 0;
    return part == 1 && none ? glm::dquat(1, 0, 0, 0) : q;
  });
}

layers::MorphTrack weight_track(const Curve& curve) {
  layers::MorphTrack track;
  for (int target = 0; target < curve.width; ++target)
    track.weights.push_back(
        to_keys<double>(curve, [&](std::size_t k, int part) { return curve.at(k, target, part); }));
  return track;
}

/// How many morph targets the mesh of a node has.
int targets_of(const GltfImport& import, int node) {
  const int mesh = index_of(item_of(import.file, "nodes", node), "mesh");
  if (mesh < 0) return 0;
  for (const Json& primitive : list_of(item_of(import.file, "meshes", mesh), "primitives"))
    return static_cast<int>(list_of(primitive, "targets").size());
  return 0;
}

/// The tracks of one animation while its channels are read: those of one node come together.
struct Tracks {
  std::map<int, layers::TransformTrack> transforms;  ///< by node of the scene
  std::map<int, layers::MorphTrack> morphs;
};

void read_channel(GltfImport& import, const Json& animation, const Json& channel, Tracks& tracks) {
  const Json& target = object_of(channel, "target");
  const std::string path = text_of(target, "path");
  const int node = index_of(target, "node"), sampler = index_of(channel, "sampler");
  const Json& samplers = list_of(animation, "samplers");
  if (sampler < 0 || static_cast<std::size_t>(sampler) >= samplers.size())
    throw InputError("glTF: sampler " + std::to_string(sampler) + " of an animation, rule: below " +
                     std::to_string(samplers.size()));
  if (path == "pointer") return import.lacks("animations of anything but nodes are not played");
  const auto place = import.nodes.find(node);
  if (node < 0 || place == import.nodes.end()) return;
  const Json& from = samplers[static_cast<std::size_t>(sampler)];
  if (path == "translation")
    tracks.transforms[place->second.outer].translation = vector_keys(read_curve(import, from, 3));
  else if (path == "rotation")
    tracks.transforms[place->second.outer].rotation = rotation_keys(read_curve(import, from, 4));
  else if (path == "scale")
    tracks.transforms[place->second.outer].scale = vector_keys(read_curve(import, from, 3));
  else if (const int count = targets_of(import, node); path == "weights" && count > 0)
    tracks.morphs[place->second.inner] = weight_track(read_curve(import, from, count));
}

template <typename T>
void extend(const layers::Keys<T>& keys, double& end_s) {
  if (!keys.times_s.empty()) end_s = std::max(end_s, keys.times_s.back());
}

/// The last key of all channels: they repeat together.
double end_of(const Tracks& tracks) {
  double end_s = 0;
  for (const auto& [node, track] : tracks.transforms) {
    extend(track.translation, end_s);
    extend(track.rotation, end_s);
    extend(track.scale, end_s);
  }
  for (const auto& [node, track] : tracks.morphs)
    for (const layers::Keys<double>& keys : track.weights) extend(keys, end_s);
  return end_s;
}

const Json* first_animation(const GltfImport& import) {
  const Json& animations = list_of(import.file.json, "animations");
  return animations.empty() ? nullptr : &item_of(import.file, "animations", 0);
}

}  // namespace

void find_animated_morphs(GltfImport& import) {
  const Json* animation = first_animation(import);
  if (!animation) return;
  for (const Json& channel : list_of(*animation, "channels")) {
    const Json& target = object_of(channel, "target");
    if (text_of(target, "path") == "weights") import.morph_animated.insert(index_of(target, "node"));
  }
}

void import_gltf_motion(GltfImport& import) {
  const Json* animation = first_animation(import);
  if (!animation) return;
  const std::size_t count = list_of(import.file.json, "animations").size();
  if (count > 1) {
    const std::string name = text_of(*animation, "name");
    import.warn(std::to_string(count) + " animations; only the first" +
                (name.empty() ? "" : ", '" + name + "',") + " is played");
  }
  Tracks tracks;
  for (const Json& channel : list_of(*animation, "channels"))
    read_channel(import, *animation, channel, tracks);
  const double end_s = end_of(tracks);
  for (auto& [node, track] : tracks.transforms) {
    track.loop = true;
    track.loop_end_s = end_s;
    import.model.scene.tracks.push_back({node, std::move(track)});
  }
  for (auto& [node, track] : tracks.morphs) {
    track.loop = true;
    track.loop_end_s = end_s;
    import.model.scene.tracks.push_back({node, std::move(track)});
  }
}

}  // namespace talisman::sequences
