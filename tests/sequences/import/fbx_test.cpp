// SPDX-License-Identifier: Apache-2.0
// FBX as text: axes and units of GlobalSettings on a plane of known size.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "sequences/import/model_import.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;
using tests::TemporaryFolder;

/// The axes of a file: number and sign of what is up, in front and to the right, and centimetres per unit.
struct FbxFrame {
  int up, up_sign, front, front_sign, right, right_sign;
  double unit_cm;
};

std::string setting(const std::string& name, int value) {
  return "\t\tP: \"" + name + "\", \"int\", \"Integer\", \"\"," + std::to_string(value) + "\n";
}

/// A quadrilateral of these twelve numbers.
std::string fbx(const FbxFrame& frame, const std::string& places) {
  return "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7300\n}\n"
         "GlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n" +
         setting("UpAxis", frame.up) + setting("UpAxisSign", frame.up_sign) +
         setting("FrontAxis", frame.front) + setting("FrontAxisSign", frame.front_sign) +
         setting("CoordAxis", frame.right) + setting("CoordAxisSign", frame.right_sign) +
         "\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\"," + std::to_string(frame.unit_cm) +
         "\n\t}\n}\nObjects:  {\n\tGeometry: 1000, \"Geometry::g\", \"Mesh\" {\n\t\tVertices: *12 "
         "{\n\t\t\ta: " +
         places +
         "\n\t\t}\n\t\tPolygonVertexIndex: *4 {\n\t\t\ta: 0,1,2,-4\n\t\t}\n\t\tGeometryVersion: 124\n\t}\n"
         "\tModel: 2000, \"Model::m\", \"Mesh\" {\n\t\tVersion: 232\n\t}\n}\nConnections:  {\n\tC: "
         "\"OO\",2000,0\n\tC: \"OO\",1000,2000\n}\n";
}

/// The corners in the world, whatever their order: their bounds.
void expect_bounds(const ImportedModel& model, const dvec3& lo, const dvec3& hi) {
  dvec3 least(1e9), most(-1e9);
  for (const dvec3& p : layers::world_positions(model.scene.at(0), model.scene.parts.at(0)))
    least = glm::min(least, p), most = glm::max(most, p);
  EXPECT_LT(glm::distance(least, lo), 1e-5) << least.x << " " << least.y << " " << least.z;
  EXPECT_LT(glm::distance(most, hi), 1e-5) << most.x << " " << most.y << " " << most.z;
}

TEST(Fbx, AxesAndUnitsAreOurs) {
  const TemporaryFolder folder;
  const auto read = [&](const FbxFrame& frame, const std::string& places) {
    return import_model(folder.write("plane.fbx", fbx(frame, places)));
  };
  // y up, centimetres: 200 x 100 stands on y = 0 at z = 50.
  expect_bounds(read({1, 1, 2, 1, 0, 1, 1}, "-100,0,50,100,0,50,100,100,50,-100,100,50"), {-1, 0, 0.5},
                {1, 1, 0.5});
  // z up, -y in front, metres: 2 x 1 stands on z = 0 at y = -3, which is 3 in front.
  expect_bounds(read({2, 1, 1, -1, 0, 1, 100}, "-1,-3,0,1,-3,0,1,-3,1,-1,-3,1"), {-1, 0, 3}, {1, 1, 3});
  // z up, inches: 100 x 50 inches are 2.54 x 1.27 m.
  expect_bounds(read({2, 1, 1, -1, 0, 1, 2.54}, "0,0,0,100,0,0,100,0,50,0,0,50"), {0, 0, 0}, {2.54, 1.27, 0});
}

}  // namespace
}  // namespace talisman::sequences
