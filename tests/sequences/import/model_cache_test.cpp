// SPDX-License-Identifier: Apache-2.0
// Cold, warm and damaged caches give the same model; a change of any file that it came from gives another.
#include "sequences/import/model_cache.h"

#include <sys/resource.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/files/cache.h"
#include "sequences/import/scene_stream.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using tests::message_of;
using tests::TemporaryFolder;

std::string textured_square_obj() {
  return "mtllib square.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
         "o square\nusemtl paint\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
}

std::string square_mtl(const std::string& texture) {
  return "newmtl paint\nKd 1 1 1\nmap_Kd " + texture + "\n";
}

std::string grey_ppm(char grey) { return std::string("P6\n1 1\n255\n") + grey + grey + grey; }

/// Page faults of all readers that have ended: more of them, and one has run.
long reader_work() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_minflt;
}

class ModelCacheTest : public testing::Test {
 protected:
  ModelCacheTest() {
    use_cache({cache_.path(), 64});
    model_ = folder_.write("models/square.obj", textured_square_obj());
    folder_.write("models/square.mtl", square_mtl("paint.ppm"));
    folder_.write("models/paint.ppm", grey_ppm('a'));
  }
  ~ModelCacheTest() override { use_cache({}); }

  ImportedModel read() { return read(model_); }
  /// Not before its files have settled (file_uses.h): what changed a moment ago is not kept.
  ImportedModel read(const std::string& path) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const long before = reader_work();
    ImportedModel model = import_model(path);
    reader_ran_ = reader_work() != before;
    return model;
  }
  /// All that a scene is made of.
  std::vector<std::uint8_t> bytes(const ImportedModel& model) const {
    ImportedModel content = model;
    content.files.clear();
    return bytes_from_model(content);
  }
  int grey_of(const ImportedModel& model) const { return model.scene.textures.at(0).rgba.at(0); }

  const TemporaryFolder cache_, folder_;
  std::string model_;
  bool reader_ran_ = false;
};

TEST_F(ModelCacheTest, WarmGivesTheSameAndStartsNoReader) {
  use_cache({});
  const ImportedModel without = read();
  use_cache({cache_.path(), 64});
  const ImportedModel cold = read();
  EXPECT_TRUE(reader_ran_);
  const ImportedModel warm = read();
  EXPECT_FALSE(reader_ran_);
  EXPECT_EQ(bytes(cold), bytes(without));
  EXPECT_EQ(bytes(warm), bytes(without));
}

TEST_F(ModelCacheTest, WarningsComeWithTheModel) {
  fs::remove(folder_.path() + "/models/paint.ppm");
  const ImportedModel cold = read(), warm = read();
  EXPECT_FALSE(reader_ran_);
  ASSERT_THAT(cold.warnings, SizeIs(1));
  EXPECT_EQ(warm.warnings, cold.warnings);
}

TEST_F(ModelCacheTest, DamagedCutAndEmptyEntriesGiveTheSameAndAreReplaced) {
  const auto want = bytes(read());
  ASSERT_FALSE(fs::is_empty(cache_.path()));
  const fs::path entry = fs::directory_iterator(cache_.path())->path();
  std::ifstream in(entry, std::ios::binary);
  const std::string whole(std::istreambuf_iterator<char>(in), {});
  std::string damaged = whole;
  damaged[whole.size() / 2] ^= 1;
  for (const std::string& content : {damaged, whole.substr(0, whole.size() / 2), std::string()}) {
    std::ofstream(entry, std::ios::binary) << content;
    EXPECT_EQ(bytes(read()), want);
    EXPECT_TRUE(reader_ran_);
    EXPECT_EQ(bytes(read()), want);
    EXPECT_FALSE(reader_ran_);
  }
}

TEST_F(ModelCacheTest, ChangedTextureIsReadAnew) {
  EXPECT_EQ(grey_of(read()), 'a');
  folder_.write("models/paint.ppm", grey_ppm('b'));
  EXPECT_EQ(grey_of(read()), 'b');
  EXPECT_EQ(grey_of(read()), 'b');
  EXPECT_FALSE(reader_ran_);
}

TEST_F(ModelCacheTest, ChangedMaterialFileIsReadAnew) {
  EXPECT_EQ(grey_of(read()), 'a');
  folder_.write("models/other.ppm", grey_ppm('c'));
  folder_.write("models/square.mtl", square_mtl("other.ppm"));
  EXPECT_EQ(grey_of(read()), 'c');
}

TEST_F(ModelCacheTest, TextureThatWasMissingAppears) {
  fs::remove(folder_.path() + "/models/paint.ppm");
  EXPECT_THAT(read().warnings, SizeIs(1));
  folder_.write("textures/paint.ppm", grey_ppm('d'));  // one of the folders that are searched
  const ImportedModel found = read();
  EXPECT_THAT(found.warnings, IsEmpty());
  EXPECT_EQ(grey_of(found), 'd');
  folder_.write("models/PAINT.PPM", grey_ppm('e'));  // nearer, but not the name that is written
  EXPECT_EQ(grey_of(read()), 'd');
  folder_.write("models/paint.ppm", grey_ppm('f'));  // as it is written
  EXPECT_EQ(grey_of(read()), 'f');
}

TEST_F(ModelCacheTest, TheSameModelElsewhereHasItsOwnTextures) {
  EXPECT_EQ(grey_of(read()), 'a');
  const std::string copy = folder_.write("copies/square.obj", textured_square_obj());
  folder_.write("copies/square.mtl", square_mtl("paint.ppm"));
  folder_.write("copies/paint.ppm", grey_ppm('g'));
  EXPECT_EQ(grey_of(read(copy)), 'g');
}

TEST_F(ModelCacheTest, EditedModelIsReadAnewAndTheOldOneIsStillKnown) {
  const auto before = bytes(read());
  folder_.write("models/square.obj", textured_square_obj() + "f 1/1 2/2 4/4\n");
  const ImportedModel edited = read();
  EXPECT_TRUE(reader_ran_);
  EXPECT_NE(bytes(edited), before);
  folder_.write("models/square.obj", textured_square_obj());
  EXPECT_EQ(bytes(read()), before);
  EXPECT_FALSE(reader_ran_);
}

TEST_F(ModelCacheTest, WhatCannotBeReadIsNotKept) {
  const std::string bad = folder_.write("bad.obj", "this is no model");
  const std::string first = message_of([&] { read(bad); });
  EXPECT_THAT(first, HasSubstr("bad.obj"));
  EXPECT_EQ(message_of([&] { read(bad); }), first);
  EXPECT_TRUE(fs::is_empty(cache_.path()));
}

TEST_F(ModelCacheTest, UnwritableCacheOnlyCostsTime) {
  const auto want = bytes(read());
  use_cache({folder_.write("file", "x") + "/cache", 64});
  EXPECT_EQ(bytes(read()), want);
  EXPECT_TRUE(reader_ran_);
}

}  // namespace
}  // namespace talisman::sequences
