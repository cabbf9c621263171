// SPDX-License-Identifier: Apache-2.0
// A recorded motion that a glTF file carries as the animation of its camera is the camera of the trace in text.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sequences/content/sequence.h"
#include "tests/sequences/content/trace_files.h"
#include "tests/sequences/import/gltf_builder.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using layers::dmat4;
using layers::dvec3;
using tests::Json;
using tests::TemporaryFolder;
using tests::WrittenTrace;

/// Keys at the times of the poses: glTF's axes are ours, its quaternions x, y, z, w, all in float (glTF 2.0, 3.11).
std::string gltf_of(const WrittenTrace& written) {
  tests::Gltf gltf;
  std::vector<float> times, places, turns;
  for (int k = 0; k < written.poses; ++k) {
    const tests::KnownPose pose = tests::known_pose(written.t_of(k));
    times.push_back(static_cast<float>(written.t_of(k)));
    for (int axis = 0; axis < 3; ++axis) places.push_back(static_cast<float>(pose.position[axis]));
    for (const double q : {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w})
      turns.push_back(static_cast<float>(k % 2 == 0 ? q : -q));  // the same rotation
  }
  const int input = gltf.add(times, 5126, "SCALAR");
  const int place = gltf.add(places, 5126, "VEC3"), turn = gltf.add(turns, 5126, "VEC4");
  gltf.json["accessors"][static_cast<std::size_t>(input)]["min"] = {times.front()};
  gltf.json["accessors"][static_cast<std::size_t>(input)]["max"] = {times.back()};
  gltf.json["cameras"] = Json::array(
      {{{"type", "perspective"}, {"perspective", {{"yfov", 0.9}, {"znear", 0.1}, {"zfar", 50}}}}});
  gltf.json["nodes"].push_back({{"name", "eye"}, {"camera", 0}});
  gltf.json["scenes"][0]["nodes"] = {0, 1};
  const auto channel = [](int sampler, const char* path) {
    return Json{{"sampler", sampler}, {"target", {{"node", 1}, {"path", path}}}};
  };
  gltf.json["animations"] = Json::array(
      {{{"samplers",
         Json::array({{{"input", input}, {"output", place}}, {{"input", input}, {"output", turn}}})},
        {"channels", Json::array({channel(0, "translation"), channel(1, "rotation")})}}});
  return gltf.text();
}

TEST(Traces, OfAGltfCameraAreThoseOfTheText) {
  const TemporaryFolder folder;
  const WrittenTrace written;
  folder.write("head.tum", written.tum());
  folder.write("head.gltf", gltf_of(written));
  const std::string before = "frames: 36\nfps: 30\n";
  const Sequence text = load_sequence(
      folder.write("text.yaml", before + "shapes: [{id: box, box: [1, 1, 1]}]\n"
                                         "camera: {near_m: 0.1, far_m: 50, trace: {file: head.tum}}\n"));
  const Sequence model = load_sequence(
      folder.write("model.yaml", before + "models: [{id: head, file: head.gltf}]\ncamera: {model: head}\n"));
  for (int frame = 0; frame < 36; ++frame) {
    const dmat4 a = text.scene->at(frame / 30.0).camera.world_from_camera;
    const dmat4 b = model.scene->at(frame / 30.0).camera.world_from_camera;
    const double size = std::max(1.0, glm::length(dvec3(a[3])));
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row)
        EXPECT_NEAR(a[column][row], b[column][row], 1e-5 * (column == 3 ? size : 1)) << frame;
  }
}

}  // namespace
}  // namespace talisman::sequences
