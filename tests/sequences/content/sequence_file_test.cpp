// SPDX-License-Identifier: Apache-2.0
// Sequence files: what is right is understood, and what is wrong is refused with its line. The last tests fly
// through the canyon, if its content was fetched.
#include <sys/wait.h>
#include <cmath>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/content/asset_paths.h"
#include "sequences/content/default_view.h"
#include "sequences/content/sequence_file.h"
#include "tests/sequences/sequence_lines.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using tests::message_of;
using tests::TemporaryFolder;
using tests::text_of;

/// Line 1 … of a file that is right; tests change one line.
const std::vector<std::string> kLines = {
    /*1*/ "name: test",
    /*2*/ "frames: 48",
    /*3*/ "fps: 24",
    /*4*/ "display: [640, 480]",
    /*5*/ "models:",
    /*6*/ "  - {id: still, file: box.obj, length_m: 4, centered: true, position: [0, 1, 0]}",
    /*7*/ "  - id: fleet",
    /*8*/ "    file: box.obj",
    /*9*/ "    scale: 2",
    /*10*/ "    instances:",
    /*11*/
    "      - {name: one, flight: [{t: 0, position: [0, 0, 0], bank_deg: 90}, {t: 2, position: [0, 0, -8]}]}",
    /*12*/ "      - {name: two, position: [5, 0, 0], spin: {axis: [0, 1, 0], deg_per_s: 90}}",
    /*13*/ "camera: {fov_deg: 60, near_m: 1, far_m: 100, position: [0, 0, 20], look_at: [0, 0, 0]}",
    /*14*/ "lights: [{kind: ambient, color: [0.2, 0.2, 0.2]}, {kind: directional, direction: [0, -1, 0]}]",
    /*15*/ "layers:",
    /*16*/ "  - {name: still, parts: [still/*]}",
    /*17*/
    "  - {name: fleet, parts: [one/*, two/*], group: foreground, preferences: {resolution_scale: 0.5}}",
    /*18*/ "regulator: {policy: hold, hold_frames: 5, geometric_px: 2, magnification: 0}",
    /*19*/ "warp: affi",
    /*20*/ "bound: dop14",
    /*21*/ "extents: {expected_reuse_frames: 4}",
    /*22*/ "clip_margin: 0.5"};

/// A box from (1, 0, 0) to (3, 1, 1).
const char* const kBox =
    "v 1 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 0 1\nv 3 0 1\nv 3 1 1\nv 1 1 1\n"
    "f 5 6 7 8\nf 2 1 4 3\nf 1 5 8 4\nf 6 2 3 7\nf 8 7 3 4\nf 1 2 6 5\n";

Sequence load(const TemporaryFolder& folder, const std::vector<std::string>& lines = kLines) {
  folder.write("box.obj", kBox);
  return load_sequence(folder.write("test.yaml", text_of(lines)));
}

TEST(LoadSequence, EveryKeyArrives) {
  const TemporaryFolder folder;
  const Sequence s = load(folder);
  EXPECT_EQ(s.name, "test");
  EXPECT_EQ(s.frames, 48);
  EXPECT_EQ(s.display_px, layers::ivec2(640, 480));
  ASSERT_EQ(s.layers.layers.size(), 2u);
  EXPECT_EQ(s.layers.layers[1].parts.size(), 2u);
  EXPECT_EQ(s.layers.layers[1].group, layers::OrderGroup::Foreground);
  EXPECT_EQ(s.layers.layers[1].preferences.resolution_scale, 0.5);
  EXPECT_EQ(s.regulator.policy, regulator::Policy::Hold);
  EXPECT_EQ(s.regulator.hold_frames, 5);
  EXPECT_EQ(s.regulator.thresholds.geometric_px, 2);
  EXPECT_EQ(s.regulator.thresholds.magnification, 0);
  EXPECT_EQ(s.warp, "affi");
  EXPECT_EQ(s.bound, layers::BoundKind::Dop14);
  EXPECT_EQ(s.extents.expected_reuse_frames, 4);
  EXPECT_EQ(s.clip_margin, 0.5);
  EXPECT_EQ(s.scene->meshes.size(), 2u);  // two models of one file each; instances share
  EXPECT_EQ(layers::first_defect(*s.scene), "");
}

TEST(LoadSequence, PoliciesThatLookAheadOrKeepABudgetAreNamedWithTheirNumbers) {
  const TemporaryFolder folder;
  std::vector<std::string> lines = kLines;
  const std::size_t regulator = lines.size() - 5;
  ASSERT_EQ(lines[regulator].rfind("regulator:", 0), 0u);
  lines[regulator] =
      "regulator: {policy: budget, budget_polygons: 900, budget_pixels: 0, budget_chunks: 8, budget_ms: 2.5, "
      "min_resolution: 0.5, predict: linear, cutoff_px: 0.5, lookahead_frames: 7}";
  const regulator::RegulatorOptions options = load(folder, lines).regulator;
  EXPECT_EQ(options.policy, regulator::Policy::Budget);
  EXPECT_EQ(options.budget.polygons, 900);
  EXPECT_EQ(options.budget.pixels, 0);
  EXPECT_EQ(options.budget.chunks, 8);
  EXPECT_EQ(options.budget.ms, 2.5);
  EXPECT_EQ(options.budget.min_resolution, 0.5);
  EXPECT_EQ(options.lookahead.predict, regulator::Prediction::Linear);
  EXPECT_EQ(options.budget.cutoff_px, 0.5);
  EXPECT_EQ(options.lookahead.frames, 7);
}

TEST(LoadSequence, LightAndFacesAreRegulatedAsTheFileSays) {
  const TemporaryFolder folder;
  std::vector<std::string> lines = kLines;
  lines[17] = "regulator: {photometric: 0.2, light_angle_deg: 90, color_warp: false, turned_px: 12}";
  const regulator::RegulatorOptions options = load(folder, lines).regulator;
  EXPECT_EQ(options.thresholds.photometric, 0.2);
  EXPECT_DOUBLE_EQ(options.thresholds.light_angle_rad, std::acos(0.0));
  EXPECT_FALSE(options.color_warp);
  EXPECT_EQ(options.thresholds.turned_px, 12);
  lines[17] = "regulator: {light_angle_deg: 181}";
  EXPECT_THAT(message_of([&] { load(folder, lines); }), HasSubstr(":18: regulator.light_angle_deg is '181'"));
}

TEST(LoadSequence, ModelsStandWhereTheFileSays) {
  const TemporaryFolder folder;
  const Sequence s = load(folder);
  const auto bounds = [&](int part, double t) {
    layers::WorldBounds b;
    for (const layers::dvec3& p : layers::world_positions(s.scene->at(t), s.scene->parts[part]))
      b.lo = glm::min(b.lo, p), b.hi = glm::max(b.hi, p);
    return b;
  };
  // 2 × 1 × 1 scaled to a length of 4, centred, at (0, 1, 0).
  EXPECT_NEAR(bounds(0, 0).lo.x, -2, 1e-5);
  EXPECT_NEAR(bounds(0, 0).hi.y, 2, 1e-5);
  // Scale 2, not centred, flying to z = -8; level there, but at t = 0 banked 90° to the right: x becomes -y.
  EXPECT_NEAR(bounds(1, 0).lo.y, -6, 1e-4);
  EXPECT_NEAR(bounds(1, 2).lo.z, -8, 1e-4);
  // A quarter turn about y per second: +x goes to -z.
  EXPECT_NEAR(bounds(2, 1).lo.z, -6, 1e-4);
  const glm::dvec4 eye = s.scene->at(0).camera.world_from_camera * glm::dvec4(0, 0, -20, 1);
  EXPECT_NEAR(glm::length(glm::dvec3(eye)), 0, 1e-9);  // look_at
}

const std::vector<tests::Fault> kFaults = {
    {2, "frames: 0", "frames is '0', rule: a whole number from 1"},
    {2, "frames: 2.5", "frames is '2.5', rule: a whole number"},
    {2, "frames: many", "frames is 'many'"},
    {2, "", "has the key 'frames'", true},
    {2, "framse: 48", "key 'framse' is not known here; keys are assets, background, bound"},
    {2, "framse: 48", "; did you mean 'frames'"},
    {3, "fps: -24", "fps is '-24', rule: a number from 1e-09"},
    {3, "fps: .nan", "fps is '.nan', rule: a number from 1e-09"},
    {3, "fps: .inf", "fps is '.inf'"},
    {3, "fps: {a: 1}", "fps is a map"},
    {4, "display: [-640, 480]", "display[0] is '-640'"},
    {4, "display: [640]", "display is a list of 1"},
    {4, "display: 640", "display is '640'"},
    {4, "color: red", "key 'color' is not known here; keys are assets, background, bound, building, camera"},
    {6, "  - {id: still, file: gone.obj}", "'gone.obj' is not there"},
    {6, "  - {id: still, file: \"no-such-package:/usr/a.obj\"}", "sequences/fetch-assets"},
    {6, "  - {id: still, file: box.obj, length_m: 0}",
     "models[0].length_m is '0', rule: a number from 1e-09"},
    {6, "  - {id: still, file: box.obj, length_m: 1, scale: 1}", "not together with scale"},
    {6, "  - {id: still, file: box.obj, centered: maybe}",
     "models[0].centered is 'maybe', rule: true or false"},
    {6, "  - {id: still, file: box.obj, wings: 2}",
     "key 'wings' is not known here; keys are carried_by, centered, file, flight"},
    {6, "  - {id: still, id: other, file: box.obj}", "each key only once"},
    {11, "      - {name: one, flight: []}", "flight is a list of 0"},
    {11, "      - {name: one, flight: [{t: 1, position: [0, 0, 0]}, {t: 1, position: [1, 0, 0]}]}",
     "flight[1].t is '1', rule: after the key before it"},
    {11, "      - {name: one, flight: [{t: 0, position: [0, .nan, 0]}]}",
     "position[1] is '.nan', rule: a number from -1e+09"},
    {11, "      - {name: one, position: [1, 2]}", "position is a list of 2, rule: a list of 3 numbers"},
    {12, "      - {name: two, spin: {axis: [0, 0, 0], deg_per_s: 1}}",
     "axis is a list of 3, rule: not the zero vector"},
    {13, "camera: {near_m: 5, far_m: 5}", "near_m below far_m"},
    {13, "camera: {fov_deg: 180}", "camera.fov_deg is '180', rule: a number from 1 to 170"},
    {13, "camera: {position: [1, 1, 1], look_at: [1, 1, 1]}", "rule: another place than position"},
    {14, "lights: [{kind: sun}]", "lights[0].kind is 'sun', rule: one of ambient, directional, point"},
    {14, "lights: [{kind: sopt}]", "one of ambient, directional, point, spot; did you mean 'spot'"},
    {14, "lights: [{kind: ambient, color: \"#12345\"}]", "rule: [r, g, b] in linear light"},
    {14, "lights: [{kind: ambient, color: [-1, 0, 0]}]", "color[0] is '-1'"},
    {16, "  - {name: still, parts: [nothing/*]}", "layer 'still': part glob 'nothing/*' matches no part"},
    {16, "  - {name: fleet, parts: [still/*]}", "layer 'fleet': name is used twice", true},
    {16, "  - {name: still, parts: [still/*], group: middle}",
     "group is 'middle', rule: one of background, normal, foreground"},
    {17, "  - {name: fleet, parts: [one/*], preferences: {resolution_scale: 5}}",
     "resolution_scale is '5', rule: a number from 1e-09 to 4"},
    {18, "regulator: {policy: best}",
     "regulator.policy is 'best', rule: one of direct, reference, hold, interpolate, threshold"},
    {18, "regulator: {magnification: 0.5}", "regulator.magnification is '0.5', rule: a number from 1"},
    {19, "warp: bent", "warp is 'bent'"},
    {20, "bound: sphere", "bound is 'sphere', rule: one of box8, dop14, dop26"},
    {22, "clip_margin: 2", "clip_margin is '2', rule: a number from 0 to 1"},
    {22, "clip_margin: [0.5", "not YAML", true},
};

TEST(LoadSequence, WhatIsWrongIsRefusedWithItsLine) {
  tests::expect_refused(kLines, kFaults, [](const std::vector<std::string>& lines) {
    const TemporaryFolder folder;
    load(folder, lines);
  });
}

TEST(LoadSequence, WhatIsNoMapOrNotThereIsRefused) {
  const TemporaryFolder folder;
  for (const std::string text : {"", "- 1\n- 2\n", "hello", "\t: [", "a: &a [*a]\n", "? [1]\n: 2\n"})
    EXPECT_NE(message_of([&] { load_sequence(folder.write("odd.yaml", text)); }), "") << text;
  EXPECT_THAT(message_of([] { load_sequence("no-such-thing"); }),
              HasSubstr("canyon, canyon/1997, canyon/background"));
  EXPECT_THAT(message_of([&] { load_sequence(folder.write("bare.yaml", "frames: 1\n")); }),
              HasSubstr("shows nothing"));
}

TEST(LoadSequence, DeepNestingIsRefusedBeforeTheStackEnds) {
  const TemporaryFolder folder;
  const std::string deep = "frames: " + std::string(200000, '[');
  EXPECT_NE(message_of([&] { load_sequence(folder.write("deep.yaml", deep)); }), "");
}

TEST(LoadSequence, VariantSaysOnlyWhatIsDifferent) {
  const TemporaryFolder folder;
  folder.write("box.obj", kBox);
  folder.write("test.yaml", text_of(kLines));
  const Sequence s = load_sequence(folder.write(
      "variant.yaml", "extends: test.yaml\nname: variant\nlayers: [{name: all, parts: ['*']}]\n"));
  EXPECT_EQ(s.name, "variant");
  EXPECT_EQ(s.frames, 48);
  ASSERT_EQ(s.layers.layers.size(), 1u);
  EXPECT_EQ(s.layers.layers[0].parts.size(), 3u);
  EXPECT_THAT(message_of([&] { load_sequence(folder.write("loop.yaml", "extends: loop.yaml\n")); }),
              HasSubstr("circle"));
}

// Only the named part is there, and the bounds are its own.
TEST(LoadSequence, PartsOfAModelAreTakenByGlobs) {
  const TemporaryFolder folder;
  folder.write("two.obj",
               "o near\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no far\nv 8 0 0\nv 12 0 0\nv 8 2 0\nf 4 5 6\n");
  const auto text = [](const std::string& keys) {
    return "frames: 1\nmodels: [{id: m, file: two.obj, centered: true, " + keys + "}]\n";
  };
  const Sequence s = load_sequence(folder.write("far.yaml", text("parts: ['*fa?']")));
  ASSERT_EQ(s.scene->parts.size(), 1u);
  const layers::WorldBounds bounds = bounds_of_scene(*s.scene);
  EXPECT_NEAR(bounds.lo.x, -2, 1e-6);
  EXPECT_NEAR(bounds.hi.x, 2, 1e-6);
  EXPECT_NEAR(bounds.hi.y, 1, 1e-6);
  EXPECT_EQ(load_sequence(folder.write("both.yaml", text("parts: ['*near', '*far']"))).scene->parts.size(),
            2u);
  const Sequence rest = load_sequence(folder.write("rest.yaml", text("without: ['*near']")));
  ASSERT_EQ(rest.scene->parts.size(), 1u);
  EXPECT_EQ(rest.scene->parts[0].name, s.scene->parts[0].name);
  for (const std::string key : {"parts", "without"})
    EXPECT_THAT(message_of([&] { load_sequence(folder.write("none.yaml", text(key + ": ['*fur']"))); }),
                HasSubstr(key + " has '*fur', rule: each matches a part of the file"));
}

// A variant that replaces its base's models by shapes.
TEST(LoadSequence, VariantMayHaveNoModels) {
  const TemporaryFolder folder;
  folder.write("box.obj", kBox);
  folder.write("base.yaml", "frames: 1\nmodels: [{id: m, file: box.obj}]\n");
  const Sequence s = load_sequence(
      folder.write("variant.yaml", "extends: base.yaml\nmodels: []\nshapes: [{id: ball, sphere: 1}]\n"));
  ASSERT_EQ(s.scene->parts.size(), 1u);
  EXPECT_EQ(s.scene->parts[0].name, "ball");
}

TEST(LoadSequence, WithoutLayersAndCameraTheyAreMadeUp) {
  const TemporaryFolder folder;
  std::vector<std::string> lines(kLines.begin(), kLines.begin() + 12);
  const Sequence s = load(folder, lines);
  EXPECT_EQ(s.layers.unassigned_parts, 0);
  EXPECT_EQ(s.layers.layers.size(), 3u);
  EXPECT_EQ(s.scene->cameras.size(), 1u);
  EXPECT_EQ(s.scene->lights.size(), 2u);
}

// --- Fetching ---

/// sequences/fetch-assets with an apt-get and a dpkg of our own; returns its exit code.
int fetch(const TemporaryFolder& folder, const std::string& name) {
  const std::string command = "PATH='" + folder.path() + "/bin':$PATH TALISMAN_ASSETS='" + folder.path() +
                              "/assets' '" + TALISMAN_SOURCE_DIR "/sequences/fetch-assets' '" + name +
                              "' > '" + folder.path() + "/log' 2>&1";
  return WEXITSTATUS(std::system(command.c_str()));
}

void write_tool(const TemporaryFolder& folder, const std::string& name, const std::string& script) {
  const std::string file = folder.write("bin/" + name, "#!/bin/sh\n" + script);
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
}

std::string log_of(const TemporaryFolder& folder) {
  std::ifstream in(folder.path() + "/log");
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(FetchAssets, UnpacksWhatTheSequenceListsOnce) {
  const TemporaryFolder folder;
  write_tool(folder, "apt-get",
             "echo \"$2\" >> '" + folder.path() + "/calls'; echo deb > \"$2_1_all.deb\"\n");
  write_tool(folder, "dpkg", "mkdir -p \"$3/usr\" && cp \"$2\" \"$3/usr/content\"\n");
  const std::string file = folder.write("film.yaml", "name: film\npackages: [some-data, more.data]\n");
  EXPECT_EQ(fetch(folder, file), 0) << log_of(folder);
  EXPECT_TRUE(std::filesystem::exists(folder.path() + "/assets/some-data/usr/content"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() + "/assets/more.data/usr/content"));
  EXPECT_EQ(fetch(folder, file), 0);
  std::ifstream calls(folder.path() + "/calls");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(calls), {}), "some-data\nmore.data\n");
}

// A .sh3f is a zip file: it becomes a folder of its name.
TEST(FetchAssets, ArchivesOfAPackageBecomeFolders) {
  const TemporaryFolder folder;
  folder.write("zip/chair/chair.obj", kBox);
  const std::string zip = "cd '" + folder.path() + "/zip' && cmake -E tar cf ../some.sh3f --format=zip chair";
  ASSERT_EQ(std::system(zip.c_str()), 0);
  write_tool(folder, "apt-get", "cp '" + folder.path() + "/some.sh3f' \"$2_1_all.deb\"\n");
  write_tool(folder, "dpkg", "mkdir -p \"$3/usr\" && cp \"$2\" \"$3/usr/some.sh3f\"\n");
  EXPECT_EQ(fetch(folder, folder.write("film.yaml", "packages: [some-data]\n")), 0) << log_of(folder);
  EXPECT_TRUE(std::filesystem::exists(folder.path() + "/assets/some-data/usr/some/chair/chair.obj"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() + "/assets/some-data/usr/some.sh3f"));
}

TEST(FetchAssets, FailureNamesTheCommandAndLeavesNothing) {
  const TemporaryFolder folder;
  write_tool(folder, "apt-get", "echo 'E: Unable to locate package' >&2; exit 100\n");
  write_tool(folder, "dpkg", "exit 0\n");
  EXPECT_EQ(fetch(folder, folder.write("film.yaml", "packages: [some-data]\n")), 1);
  EXPECT_THAT(log_of(folder), HasSubstr("'apt-get download some-data' failed"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() + "/assets"));
}

TEST(FetchAssets, UnknownNamesAreBadArguments) {
  const TemporaryFolder folder;
  EXPECT_EQ(fetch(folder, "no-such-sequence"), 2);
  EXPECT_EQ(fetch(folder, folder.write("evil.yaml", "packages: [../../etc]\n")), 1);
  EXPECT_THAT(log_of(folder), HasSubstr("is no package name"));
}

// --- The canyon ---

class Canyon : public ::testing::Test {
 protected:
  void SetUp() override {
    try {
      file_ = read_sequence_file(sequence_file_of("canyon"));
    } catch (const InputError& e) {
      GTEST_SKIP() << "content was not fetched: " << e.what();
    }
    field_ = read_height_field(*file_.recipe.terrain);
    // Ships and camera as points: their tracks alone, without reading the models.
    for (const ModelRecipe& model : file_.recipe.models) fly(model.instances[0].motion);
    fly(file_.recipe.camera->motion);
  }
  void fly(const Motion& motion) {
    flights_.nodes.push_back({"flier", -1, {}});
    flights_.tracks.push_back({static_cast<int>(flights_.nodes.size()) - 1, *motion.flight});
  }
  double clearance(const layers::dvec3& p) const { return p.y - ground_height(field_, p.x, p.z); }

  SequenceFile file_;
  layers::HeightField field_;
  layers::Scene flights_;
};

TEST_F(Canyon, NobodyTouchesTheGroundOrLeavesTheWalls) {
  const double half_width = 0.5 * (field_.columns - 1) * field_.cell_x_m;
  for (int step = 0; step < 4 * file_.settings.frames; ++step) {
    const layers::SceneFrame frame = flights_.at(step / (4 * file_.settings.fps));
    for (const glm::dmat4& world_from_node : frame.world_from_node) {
      const layers::dvec3 p(world_from_node[3]);
      // A fighter is 14 to 17 m long and as wide, so 9 m around its middle must be free.
      for (const layers::dvec3 offset : {layers::dvec3(0), layers::dvec3(9, 0, 0), layers::dvec3(-9, 0, 0),
                                         layers::dvec3(0, 0, 9), layers::dvec3(0, 0, -9)})
        ASSERT_GT(clearance(p + offset), 1.0)
            << "frame " << step / 4.0 << " at " << p.x << " " << p.y << " " << p.z;
      ASSERT_LT(std::abs(p.x), half_width - 20);
      ASSERT_LT(p.y, 150) << "above the rim";
    }
  }
}

TEST_F(Canyon, CameraSeesTheShips) {
  const double reach = std::tan(glm::radians(file_.recipe.camera->fov_deg / 2));
  int seen = 0, hidden = 0, shown = 0;
  for (int f = 0; f < file_.settings.frames; ++f) {
    const layers::SceneFrame frame = flights_.at(f / file_.settings.fps);
    const glm::dmat4 world_from_camera = frame.world_from_node.back();
    for (std::size_t k = 0; k + 1 < frame.world_from_node.size(); ++k, ++shown) {
      const glm::dvec4 ship = frame.world_from_node[k][3];
      const glm::dvec4 c = glm::inverse(world_from_camera) * ship;
      seen += -c.z > 10 && std::max(std::abs(c.x), std::abs(c.y)) < -c.z * reach;
      for (int step = 1; step < 20; ++step)
        if (clearance(layers::dvec3(glm::mix(world_from_camera[3], ship, step / 20.0))) < 0) {
          ++hidden;
          break;
        }
    }
  }
  EXPECT_GT(seen, shown * 9 / 10);
  EXPECT_LT(hidden, shown / 10);
}

TEST_F(Canyon, HasTheLayersThatItsReadmeNames) {
  const Sequence canyon = load_sequence("canyon");
  EXPECT_EQ(canyon.frames, 250);
  EXPECT_EQ(canyon.layers.layers.size(), 11u);
  EXPECT_EQ(canyon.layers.unassigned_parts, 0);
  for (const layers::Layer& layer : canyon.layers.layers) EXPECT_GE(layer.rigid_node, 0) << layer.name;
  for (const std::string& warning : canyon.warnings) ADD_FAILURE() << warning;
  const Sequence background = load_sequence("canyon/background");
  EXPECT_EQ(background.layers.layers.size(), 5u);
  EXPECT_EQ(background.layers.unassigned_parts, 0);
}

}  // namespace
}  // namespace talisman::sequences
