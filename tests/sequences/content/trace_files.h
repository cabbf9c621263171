// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A motion that is known in closed form, and its poses written in every format that sequences read.

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "layers/scene.h"
#include "sequences/files/number_text.h"

namespace talisman::tests {

using layers::dvec3;

/// Body→world, the body as in glTF: x right, y up, looks along −z.
struct KnownPose {
  dvec3 position;
  glm::dquat rotation;
};

inline KnownPose known_pose(double t_s) {
  KnownPose pose;
  pose.position = {0.4 * std::sin(1.3 * t_s), 1.6 + 0.05 * std::cos(5 * t_s), 2 - 0.7 * t_s};
  pose.rotation = glm::angleAxis(0.8 * std::sin(2 * t_s), dvec3{0, 1, 0}) *
                  glm::angleAxis(0.3 * std::cos(3 * t_s), dvec3{1, 0, 0}) *
                  glm::angleAxis(0.2 * std::sin(7 * t_s), dvec3{0, 0, 1});
  return pose;
}

/// The same camera in an optical frame, y down and z forward: columns x, −y, −z.
inline glm::dquat optical(const glm::dquat& gl) {
  const glm::dmat3 m = glm::mat3_cast(gl);
  return glm::quat_cast(glm::dmat3(m[0], -m[1], -m[2]));
}

inline std::string numbers(const std::vector<double>& values, const char* between) {
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "" : between) + sequences::formatted("%.17g", value);
  return text;
}

/// The motion as a TUM file, a pose each millisecond from 0 to `last_ms`.
inline std::string tum_each_ms(const std::function<KnownPose(double)>& pose_at, int last_ms) {
  std::string text;
  for (int ms = 0; ms <= last_ms; ++ms) {
    const double t_s = 0.001 * ms;
    const KnownPose pose = pose_at(t_s);
    const dvec3& p = pose.position;
    const glm::dquat& q = pose.rotation;
    text += numbers({t_s, p.x, p.y, p.z, q.x, q.y, q.z, q.w}, " ") + "\n";
  }
  return text;
}

struct WrittenTrace {
  int poses = 61;
  double fps = 50;
  double t_of(int k) const { return k / fps; }

  /// The stamps of a clock that counts from 1970.
  std::string tum() const {
    std::string text = "# timestamp tx ty tz qx qy qz qw\n";
    for (int k = 0; k < poses; ++k) {
      const KnownPose pose = known_pose(t_of(k));
      const glm::dquat q = optical(pose.rotation);
      // Every other one with the other sign: the same rotation.
      const double sign = k % 2 == 0 ? 1 : -1;
      text += std::to_string(1305031102 + k * 20 / 1000) + sequences::formatted(".%03d", k * 20 % 1000) +
              " " +
              numbers({pose.position.x, pose.position.y, pose.position.z, sign * q.x, sign * q.y, sign * q.z,
                       sign * q.w},
                      " ") +
              "\n";
    }
    return text;
  }
  std::string euroc() const {
    std::string text = "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], …\r\n";
    for (int k = 0; k < poses; ++k) {
      const KnownPose pose = known_pose(t_of(k));
      const glm::dquat q = optical(pose.rotation);
      text += std::to_string(1403636579758555392 + 20'000'000LL * k) + "," +
              numbers({pose.position.x, pose.position.y, pose.position.z, q.w, q.x, q.y, q.z}, ",") +
              ",0.1,0.2,0.3,0,0,0,0,0,0\r\n";
    }
    return text;
  }
  /// World→camera: Rᵀ and −Rᵀp by matrices. Images in the wrong order, one without points.
  std::string colmap() const {
    std::string text = "# Image list with two lines of data per image:\n";
    for (int i = 0; i < poses; ++i) {
      const int k = i * 7 % poses;
      const KnownPose pose = known_pose(t_of(k));
      const glm::dmat3 to_camera = glm::transpose(glm::mat3_cast(optical(pose.rotation)));
      const glm::dquat q = glm::quat_cast(to_camera);
      const dvec3 t = -(to_camera * pose.position);
      text += std::to_string(i + 1) + " " + numbers({q.w, q.x, q.y, q.z, t.x, t.y, t.z}, " ") + " 1 " +
              sequences::formatted("set 1/frame_%05d.png", 100 + 5 * k) + "\n" +
              (i == 3 ? "" : "10.5 20.5 -1 30 40 17") + "\n";
    }
    return text;
  }
  std::string iwer() const {
    std::string text =
        R"({"schema":[[0,{"handedness":"left","targetRayMode":"tracked-pointer","profiles":["a [\"b\"]"],"hasGrip":true}]],"frames":[)";
    for (int k = 0; k < poses; ++k) {
      const KnownPose pose = known_pose(t_of(k));
      const glm::dquat& q = pose.rotation;
      text +=
          (k == 0 ? "[" : ",[") +
          numbers({1234 + 20.0 * k, pose.position.x, pose.position.y, pose.position.z, q.x, q.y, q.z, q.w},
                  ",") +
          ",[0,1,2,3,0,0,0,1,[0.1,0.2,0.3,0,0,0,1]]]";
    }
    return text + "]}";
  }
  /// In centimetres: hips that turn and move, and a head on them that looks where the pose does. R = Rz(a) Rx(b) Ry(c):
  /// its third row is (−cos b sin c, sin b, cos b cos c), its second column (−sin a cos b, cos a cos b, sin b).
  std::string bvh() const {
    const dvec3 offset{3, 55, -8};
    std::string text =
        "HIERARCHY\nROOT Hips\n{\n  OFFSET 0 0 0\n  CHANNELS 6 Xposition Yposition Zposition Zrotation "
        "Xrotation "
        "Yrotation\n  JOINT Head\n  {\n    OFFSET 3 55 -8\n    CHANNELS 3 Zrotation Xrotation Yrotation\n    "
        "End "
        "Site\n    {\n      OFFSET 0 10 0\n    }\n  }\n  JOINT Leg\n  {\n    OFFSET 1 -1 0\n    CHANNELS 1 "
        "Xrotation\n"
        "    End Site\n    {\n      OFFSET 0 -9 0\n    }\n  }\n}\nMOTION\nFrames: " +
        std::to_string(poses) + "\nFrame Time: 0.02\n";
    for (int k = 0; k < poses; ++k) {
      const KnownPose pose = known_pose(t_of(k));
      const glm::dquat hips = glm::angleAxis(0.4 * std::sin(3.0 * k), glm::normalize(dvec3{1, 2, -1}));
      const dvec3 place = 100.0 * pose.position - hips * offset;
      std::vector<double> values = {place.x, place.y, place.z};
      for (const glm::dquat& turn : {hips, glm::conjugate(hips) * pose.rotation}) {
        const glm::dmat3 m = glm::mat3_cast(turn);  // m[column][row]
        values.push_back(glm::degrees(std::atan2(-m[1][0], m[1][1])));
        values.push_back(glm::degrees(std::asin(m[1][2])));
        values.push_back(glm::degrees(std::atan2(-m[0][2], m[2][2])));
      }
      values.push_back(k);
      text += numbers(values, " ") + "\n";
    }
    return text;
  }
};

}  // namespace talisman::tests
