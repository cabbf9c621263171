// SPDX-License-Identifier: Apache-2.0
// The document and the schema of sequence files are made from the tables of the reader, and schema and reader
// are of one mind: files that one takes the other takes, and what is wrong is refused by both. The validator is
// not ours: Debian's python3-jsonschema, on YAML read by python3-yaml.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/content/asset_paths.h"
#include "sequences/content/key_docs.h"
#include "sequences/content/key_schema.h"
#include "sequences/content/sequence_file.h"
#include "tests/sequences/sequence_lines.h"

namespace talisman::sequences {
namespace {

using ::testing::HasSubstr;
using tests::Fault;
using tests::message_of;
using tests::TemporaryFolder;
using tests::text_of;

const std::string kDocument = TALISMAN_SOURCE_DIR "/docs/sequence-format.md";
const std::string kSchema = TALISMAN_SOURCE_DIR "/docs/sequence.schema.json";

std::string content_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The file must be `right`; with TALISMAN_UPDATE_DOCS in the environment it is made so.
void expect_content(const std::string& file, const std::string& right) {
  if (std::getenv("TALISMAN_UPDATE_DOCS")) std::ofstream(file, std::ios::binary) << right;
  EXPECT_EQ(content_of(file), right) << file << ": run this test with TALISMAN_UPDATE_DOCS=1";
}

TEST(SequenceFormat, TablesOfTheDocumentAreThoseOfTheReader) {
  expect_content(kDocument, documented(content_of(kDocument), sequence_keys().keys()));
}

TEST(SequenceSchema, FileIsMadeFromTheTables) {
  expect_content(kSchema, json_schema(sequence_keys().keys()));
}

/// What the validator says of each file: "ok" or what is wrong.
std::vector<std::string> verdicts(const std::vector<std::string>& files) {
  const TemporaryFolder folder;
  const std::string out = folder.path() + "/verdicts";
  std::string command =
      "/usr/bin/python3 '" TALISMAN_SOURCE_DIR "/tests/sequences/content/validate.py' '" + kSchema + "'";
  for (const std::string& file : files) command += " '" + file + "'";
  EXPECT_EQ(std::system((command + " > '" + out + "'").c_str()), 0)
      << "is python3-jsonschema installed? see ./setup";
  std::vector<std::string> lines;
  std::ifstream in(out);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  lines.resize(files.size(), "no verdict");
  return lines;
}

TEST(SequenceSchema, ShippedSequencesPassBoth) {
  std::vector<std::string> files;
  for (const std::string& name : known_sequences()) files.push_back(sequence_file_of(name));
  ASSERT_GE(files.size(), 5u);
  const std::vector<std::string> found = verdicts(files);
  for (std::size_t i = 0; i < files.size(); ++i) {
    EXPECT_EQ(found[i], "ok") << files[i];
    const std::string message = message_of([&] { read_sequence_file(files[i]); });
    EXPECT_TRUE(message.empty() || message.find("fetch-assets") != std::string::npos) << message;
  }
}

// --- A file that has everything ---

// NOLINTBEGIN(bugprone-suspicious-missing-comma): a line of the file may take two of these
const std::vector<std::string> kEveryKey = {
    /*1*/ "name: 2001",
    /*2*/ "frames: 48",
    /*3*/ "fps: 29.97",
    /*4*/ "display: [640, 480]",
    /*5*/ "background: '#102030'",
    /*6*/ "shapes:",
    /*7*/
    "  - {id: disc, cylinder: [8, 0.2], taper: 0.5, segments: 3, color: [0, 1.5, 0], shininess: 1.0e+5}",
    /*8*/ "  - {id: ball, sphere: 2, carried_by: disc, spin: {axis: [0, 1, 0], deg_per_s: -90}, opacity: 0}",
    /*9*/
    "  - {id: floor, plane: [8, 8], segments: 1, texture: a.png, texture2: a.png, texture_blend: [0, 1]}",
    /*10*/ "  - {id: crate, box: [1, 1, 1], instances: [{name: one, position: [0, 0, 0]}, {name: two}]}",
    /*11*/ "models:",
    /*12*/ "  - {id: still, file: a.obj, length_m: 4, centered: true, rotation_deg: [0, 90, 0]}",
    /*13*/
    "  - {id: ship, file: a.obj, scale: 2, flight: [{t: 0, position: [0, 0, 0], bank_deg: 90}, {t: 2, "
    "position: [0, 0, -8]}]}",
    /*14*/
    "terrain: {heights: a.png, height_m: [0, 150], smooth_cells: 0, classes: {file: a.png, textures: [{rgb: "
    "[0, 0, 255], texture: a.png}]}}",
    /*15*/ "sky: {kind: backdrop, azimuth_deg: [-85, 85], clouds: {file: a.png, cover: 1}}",
    /*16*/ "camera: {fov_deg: 60, near_m: 1, far_m: 100, position: [0, 0, 20], look_at: [0, 0, 0]}",
    /*17*/ "lights:",
    /*18*/ "  - {kind: ambient, color: '#ffffff', intensity: 0.2}",
    /*19*/
    "  - {kind: directional, direction: [0, -1, 0], casts_shadow: true, shadow_map: {resolution_px: 512}}",
    /*20*/ "  - {kind: point, position: [0, 9, 0]}",
    /*21*/ "  - {kind: spot, position: [0, 9, 0], look_at: [0, 0, 0], inner_deg: 0, outer_deg: 90}",
    /*22*/ "layers:",
    /*23*/ "  - {name: all, parts: ['*'], group: background, fade: [{t: 0, value: 1}, {t: 1, value: 0}]}",
    /*24*/
    "  - {name: floor, parts: [floor], casts_shadows: false, shading: {textures: {}, first_blend: 0.5}}",
    /*25*/ "  - {name: ball, parts: [ball], preferences: {resolution_scale: 4, importance: {sampling: 0}}}",
    /*26*/ "order: [{behind: all, front: b*}]",
    /*27*/ "cycles: keep",
    /*28*/
    "regulator: {policy: hold, hold_frames: 1, magnification: 0, uncovered_px: -1, light_angle_deg: 180}",
    /*29*/ "warp: per2i",
    /*30*/ "bound: dop14",
    /*31*/ "extents: {expected_reuse_frames: 4, max_growth: 1}",
    /*32*/ "placement: {slab_directions: 30, max_sprite_px: 32}",
    /*33*/ "compression: {quality: 100}",
    /*34*/ "clip_margin: 0"};
// NOLINTEND(bugprone-suspicious-missing-comma)

/// A folder with the files that kEveryKey names.
class Folder {
 public:
  Folder() {
    for (const char* name : {"a.png", "a.obj"}) folder_.write(name, "is there");
  }
  std::string write(const std::string& name, const std::vector<std::string>& lines) const {
    return folder_.write(name, text_of(lines));
  }
  std::string write(const std::string& name, const Fault& fault) const {
    std::vector<std::string> lines = kEveryKey;
    lines[fault.line - 1] = fault.text;
    return write(name, lines);
  }

 private:
  TemporaryFolder folder_;
};

/// Every fault as the file fault-N.yaml.
std::vector<std::string> write_all(const Folder& folder, const std::vector<Fault>& faults) {
  std::vector<std::string> files;
  for (const Fault& fault : faults)
    files.push_back(folder.write("fault-" + std::to_string(files.size()) + ".yaml", fault));
  return files;
}

/// The reader must refuse each file with its message, at its line.
void expect_refused(const std::vector<std::string>& files, const std::vector<Fault>& faults) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string message = message_of([&] { read_sequence_file(files[i]); });
    EXPECT_THAT(message, HasSubstr(faults[i].message)) << faults[i].text;
    const std::string place =
        faults[i].elsewhere ? ".yaml:" : ".yaml:" + std::to_string(faults[i].line) + ":";
    EXPECT_THAT(message, HasSubstr(place)) << faults[i].text;
  }
}

TEST(SequenceSchema, FileWithEverythingPassesBoth) {
  const Folder folder;
  const std::string file = folder.write("right.yaml", kEveryKey);
  EXPECT_EQ(verdicts({file})[0], "ok");
  EXPECT_EQ(message_of([&] { read_sequence_file(file); }), "");
}

TEST(SequenceSchema, VariantMayLeaveOutWhatItsBaseHas) {
  const Folder folder;
  folder.write("base.yaml", kEveryKey);
  const std::string file =
      folder.write("variant.yaml", std::vector<std::string>{"extends: base.yaml", "fps: 12"});
  EXPECT_EQ(verdicts({file})[0], "ok");
  EXPECT_EQ(message_of([&] { read_sequence_file(file); }), "");
}

// One or more for each kind of rule that a table can state.
const std::vector<Fault> kSchemaFaults = {
    // Keys: unknown, missing, in the wrong company.
    {3, "fsp: 24", "key 'fsp' is not known here"},
    {16, "camera: {fov: 60}", "key 'fov' is not known here"},
    {2, "", "has the key 'frames'", true},
    {12, "  - {id: still}", "has the key 'file'"},
    {8, "  - {id: ball, sphere: 2, spin: {axis: [0, 1, 0]}}", "has the key 'deg_per_s'"},
    {12, "  - {id: still, file: a.obj, scale: 1, length_m: 2}", "not together with scale"},
    {13, "  - {id: ship, file: a.obj, look_at: [0, 0, 0], flight: [{t: 0, position: [0, 0, 0]}]}",
     "not together with flight"},
    {24, "  - {name: floor, parts: [floor], shading: {first_blend: 0.5}}", "only together with textures"},
    {8, "  - {id: ball, sphere: 2, taper: 1}", "only together with cylinder"},
    {10, "  - {id: crate}", "has one of the keys box, sphere, cylinder, plane and disc"},
    {10, "  - {id: crate, box: [1, 1, 1], plane: [1, 1]}",
     "one of box, sphere, cylinder, plane and disc, not two"},
    {14, "terrain: {heights: a.png, classes: {file: a.png}}", "has the key 'list' or 'textures'"},
    {20, "  - {kind: point, color: '#ffffff'}", "has the key 'position'"},
    // Keys that belong to a branch.
    {18, "  - {kind: ambient, casts_shadow: true}", "casts_shadow goes with kind directional, point or spot"},
    {19, "  - {kind: directional, direction: [0, -1, 0], inner_deg: 5}", "inner_deg goes with kind spot"},
    {19, "  - {kind: directional}", "has the key 'direction'"},
    {10, "  - {id: crate, box: [1, 1, 1], position: [0, 0, 0], instances: [{name: one}]}",
     "position goes without instances"},
    {9, "  - {id: floor, plane: [8, 8], texture_blend: [0, 1]}", "texture_blend goes with texture2"},
    {7, "  - {id: disc, cylinder: [8, 0.2], segments: 2}", "a whole number from 3 to 512"},
    {10, "  - {id: crate, box: [1, 1, 1], segments: 0}", "a whole number from 1 to 512"},
    {15, "sky: {kind: backdrop, azimuth_deg: [-86, 85]}", "azimuth_deg[0] is '-86'"},
    {15, "sky: {elevation_deg: [-91, 0]}", "elevation_deg[0] is '-91'"},
    // Numbers.
    {3, "fps: 0", "a number from 1e-09 to 1000"},
    {3, "fps: 1000.5", "a number from 1e-09 to 1000"},
    {3, "fps: fast", "fps is 'fast'"},
    {3, "fps: .inf", "fps is '.inf'"},
    {34, "clip_margin: -0.1", "a number from 0 to 1"},
    {34, "clip_margin: 1.1", "a number from 0 to 1"},
    {18, "  - {kind: ambient, intensity: -1}", "a number from 0 to 1e+09"},
    {28, "regulator: {magnification: 0.5}", "a number from 1"},
    {2, "frames: 2.5", "a whole number from 1"},
    {32, "placement: {slab_directions: 31}", "a whole number from 2 to 30"},
    {2, "frames: [48]", "frames is a list of 1"},
    // Truths, texts, words, colours.
    {12, "  - {id: still, file: a.obj, centered: maybe}", "true or false"},
    {1, "name: ''", "a text"},
    {1, "name: [a]", "a text"},
    {29, "warp: bent", "one of trn, trni"},
    {27, "cycles: [keep]", "one of merge, keep"},
    {5, "background: '#12345'", "[r, g, b] in linear light"},
    {5, "background: [0, 0, -1]", "background[2] is '-1'"},
    {5, "background: [0, 0]", "[r, g, b] in linear light"},
    // Lists and maps.
    {4, "display: [640]", "display is a list of 1"},
    {4, "display: [640, 480, 2]", "a list of 2 whole numbers"},
    {16, "camera: {position: [0, 1]}", "a list of 3 numbers"},
    {13, "  - {id: ship, file: a.obj, flight: []}", "flight is a list of 0"},
    {23, "  - {name: all, parts: []}", "parts is a list of 0"},
    {23, "  - {name: all, parts: all}", "parts is 'all'"},
    {26, "order: {behind: all, front: floor}", "order is a map"},
    {33, "compression: 85", "rule: a map"},
    {21, "  - spot", "rule: a map"},
    // Either of two types.
    {23, "  - {name: all, parts: ['*'], fade: 2}", "a number from 0 to 1"},
    {23, "  - {name: all, parts: ['*'], fade: [{t: 0, value: 2}]}", "a number from 0 to 1"},
    {8, "  - {id: ball, sphere: 0}", "a number from 1e-09 to 1e+09"},
    {8, "  - {id: ball, sphere: [1, 1, 0]}", "each from 1e-09 to 1e+09"},
};

TEST(SequenceSchema, WhatIsWrongIsRefusedByBoth) {
  const Folder folder;
  const std::vector<std::string> files = write_all(folder, kSchemaFaults);
  expect_refused(files, kSchemaFaults);
  const std::vector<std::string> found = verdicts(files);
  for (std::size_t i = 0; i < files.size(); ++i)
    EXPECT_NE(found[i], "ok") << kSchemaFaults[i].line << ": " << kSchemaFaults[i].text;
}

TEST(SequenceSchema, FileThatShowsNothingIsRefusedByBoth) {
  const Folder folder;
  const std::string file = folder.write("bare.yaml", std::vector<std::string>{"frames: 1"});
  EXPECT_THAT(message_of([&] { read_sequence_file(file); }),
              HasSubstr("bare.yaml:1: the file is a map, rule: it shows nothing"));
  EXPECT_NE(verdicts({file})[0], "ok");
}

// The list in the document under "What the schema cannot say", as far as it shows without the scene.
const std::vector<Fault> kBeyondTheSchema = {
    {16, "camera: {near_m: 5, far_m: 5}", "near_m below far_m"},
    {21, "  - {kind: spot, inner_deg: 31}", "inner_deg at most outer_deg"},
    {15, "sky: {azimuth_deg: [10, 10]}", "the first below the second"},
    {16, "camera: {position: [1, 1, 1], look_at: [1, 1, 1]}", "another place than position"},
    {8, "  - {id: ball, sphere: 2, spin: {axis: [0, 0, 0], deg_per_s: 1}}", "not the zero vector"},
    {19, "  - {kind: directional, direction: [0, 0, 0]}", "not the zero vector"},
    {13, "  - {id: ship, file: a.obj, flight: [{t: 1, position: [0, 0, 0]}, {t: 1, position: [1, 0, 0]}]}",
     "after the key before it"},
    {23, "  - {name: all, parts: ['*'], fade: [{t: 1, value: 0}, {t: 0, value: 0}]}",
     "after the key before it"},
    {12, "  - {id: still, file: gone.obj}", "'gone.obj' is not there"},
    {3, "fps: .nan", "fps is '.nan'"},
    {2, "frames: 48.0", "a whole number from 1"},
    {3, "frames: 24", "each key only once"},
};

TEST(SequenceSchema, WhatItCannotSayIsRefusedByTheReader) {
  const Folder folder;
  const std::vector<std::string> files = write_all(folder, kBeyondTheSchema);
  expect_refused(files, kBeyondTheSchema);
  const std::vector<std::string> found = verdicts(files);
  for (std::size_t i = 0; i < files.size(); ++i)
    EXPECT_EQ(found[i], "ok") << "the schema can say it after all: " << kBeyondTheSchema[i].text;
}

TEST(SequenceSchema, NumbersAndTruthsAreWrittenPlainly) {
  // The reader's YAML is more generous than the schema: quotes around a number, and the words of YAML 1.1.
  const Folder folder;
  const std::string file = folder.write("quoted.yaml", Fault{3, "fps: '24'", ""});
  EXPECT_EQ(message_of([&] { read_sequence_file(file); }), "");
  EXPECT_NE(verdicts({file})[0], "ok");
}

}  // namespace
}  // namespace talisman::sequences
