// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/run_identity.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/sequences/csv_rows.h"
#include "tests/sequences/results/changed_settings.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using ::testing::StartsWith;

/// A grey picture: text, so that a comment may follow.
std::string picture(int width, int height, int grey) {
  std::string text = "P2\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
  for (int k = 0; k < width * height; ++k) text += std::to_string(grey) + "\n";
  return text;
}

/// A sequence that reads every kind of file.
class Content {
 public:
  Content() {
    folder_.write("show.yaml", "extends: base/base.yaml\nframes: 2\n");
    folder_.write("base/base.yaml",
                  "fps: 24\n"
                  "shapes:\n  - {id: box, box: [1, 1, 1], texture: box.pgm}\n"
                  "models:\n  - {id: cube, file: ../models/cube.obj, position: [3, 0, 0]}\n"
                  "terrain:\n  name: land\n  heights: heights.pgm\n"
                  "  classes: {file: classes.pgm, list: ground.lst}\n"
                  "sky: {clouds: {file: clouds.pgm}}\n"
                  "camera: {position: [0, 5, 20], look_at: [0, 0, 0]}\n");
    folder_.write("base/box.pgm", picture(4, 4, 90));
    folder_.write("base/heights.pgm", picture(8, 20, 40));
    folder_.write("base/classes.pgm", picture(8, 20, 0));
    folder_.write("base/ground.lst", "*[name] grass [texture] grass.pgm [col] 0 0 0\n");
    folder_.write("base/grass.pgm", picture(4, 4, 120));
    folder_.write("base/clouds.pgm", picture(4, 4, 200));
    folder_.write("models/cube.obj",
                  "mtllib cube.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl skin\n"
                  "f 1/1 2/2 3/3\n");
    folder_.write("models/cube.mtl", "newmtl skin\nmap_Kd skin.pgm\n");
    folder_.write("models/skin.pgm", picture(4, 4, 60));
  }

  std::string file(const std::string& name) const { return folder_.path() + "/" + name; }
  void append(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::app | std::ios::binary) << text;
  }
  nlohmann::ordered_json run(const Settings& settings = {}, const RunOptions& options = {}) const {
    return run_json(load_sequence(file("show.yaml")), settings, options);
  }

 private:
  tests::TemporaryFolder folder_;
};

const std::set<std::string> kFiles = {"show.yaml",        "base/base.yaml",   "base/box.pgm",
                                      "base/heights.pgm", "base/classes.pgm", "base/ground.lst",
                                      "base/grass.pgm",   "base/clouds.pgm",  "models/cube.obj",
                                      "models/cube.mtl",  "models/skin.pgm"};

TEST(RunIdentity, NamesEveryFileThatTheSequenceIsReadFrom) {
  const nlohmann::ordered_json run = Content().run();
  std::set<std::string> names;
  for (const auto& [name, hash] : run["content"].items()) {
    names.insert(name);
    EXPECT_EQ(hash.get<std::string>().size(), 32u) << name;
  }
  EXPECT_EQ(names, kFiles);
}

TEST(RunIdentity, IsTheSameInAnotherFolder) {
  const Content here, there;
  EXPECT_EQ(here.run(), there.run());
  EXPECT_EQ(first_difference(here.run(), there.run()), "");
}

TEST(RunIdentity, EveryFileIsPartOfIt) {
  for (const std::string& name : kFiles) {
    const Content content;
    const nlohmann::ordered_json before = content.run();
    content.append(name, "\n");  // as a comment would: the scene stays the same
    const nlohmann::ordered_json after = content.run();
    EXPECT_NE(before["identity"], after["identity"]) << name;
    EXPECT_EQ(first_difference(before, after),
              "content file " + name + " has changed, --resume must continue with the same content");
  }
}

TEST(RunIdentity, FilesThatComeAndGoAreTold) {
  const Content content;
  std::filesystem::remove(content.file("models/skin.pgm"));  // a warning, and a plain colour
  const nlohmann::ordered_json without = content.run();
  content.append("models/skin.pgm", picture(4, 4, 60));
  const nlohmann::ordered_json with = content.run();
  EXPECT_THAT(first_difference(without, with), StartsWith("content file models/skin.pgm is new"));
  EXPECT_THAT(first_difference(with, without), StartsWith("content file models/skin.pgm is no longer read"));
}

TEST(RunIdentity, EverySettingIsPartOfIt) {
  const Content content;
  const Sequence sequence = load_sequence(content.file("show.yaml"));
  const nlohmann::ordered_json before = run_json(sequence, {}, {});
  std::set<std::string> identities{before["identity"]};
  int fields = 0;
  for (;; ++fields) {
    const ChangedSettings changed = changed_settings(fields);
    if (changed.field.empty()) break;
    const nlohmann::ordered_json after = run_json(sequence, changed.settings, {});
    EXPECT_TRUE(identities.insert(after["identity"]).second) << changed.field;
    EXPECT_THAT(first_difference(before, after), StartsWith(changed.field + " was "));
  }
  EXPECT_EQ(fields, static_cast<int>(before["settings"].size()));
}

TEST(RunIdentity, NameAndVersionArePartOfIt) {
  const Content content;
  Sequence sequence = load_sequence(content.file("show.yaml"));
  const nlohmann::ordered_json before = run_json(sequence, {}, {});
  sequence.name = "other";
  const nlohmann::ordered_json after = run_json(sequence, {}, {});
  EXPECT_NE(before["identity"], after["identity"]);
  EXPECT_THAT(first_difference(before, after), StartsWith("sequence was \"show\", is \"other\""));
  nlohmann::ordered_json newer = before;
  newer["version"] = "99.0";
  EXPECT_THAT(first_difference(before, newer), StartsWith("version was "));
}

// Which frames are written, and how, makes no other run: parts of one run can be told to belong together.
TEST(RunIdentity, WhatIsWrittenIsComparedButNotPartOfIt) {
  const Content content;
  const Sequence sequence = load_sequence(content.file("show.yaml"));
  const nlohmann::ordered_json before = run_json(sequence, {}, {});
  const std::pair<const char*, void (*)(RunOptions&)> changes[] = {
      {"kind", [](RunOptions& o) { o.plan_only = true; }},
      {"frames", [](RunOptions& o) { o.last_frame = 1; }},
      {"format", [](RunOptions& o) { o.format = FrameFormat::Exr; }},
      {"overlay", [](RunOptions& o) { o.overlay = true; }},
      {"separate", [](RunOptions& o) { o.separate = true; }},
      {"quality", [](RunOptions& o) { o.quality = true; }}};
  for (const auto& [name, change] : changes) {
    RunOptions options;
    change(options);
    const nlohmann::ordered_json after = run_json(sequence, {}, options);
    EXPECT_EQ(before["identity"], after["identity"]) << name;
    EXPECT_THAT(first_difference(before, after), StartsWith(std::string(name) + " was "));
  }
  RunOptions elsewhere;  // and none of these changes a line of the results
  elsewhere.out = "elsewhere";
  elsewhere.video = elsewhere.resume = true;
  elsewhere.progress = ProgressKind::None;
  EXPECT_EQ(first_difference(before, run_json(sequence, {}, elsewhere)), "");
}

}  // namespace
}  // namespace talisman::sequences
