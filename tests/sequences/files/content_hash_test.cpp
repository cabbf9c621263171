// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/content_hash.h"

#include <gtest/gtest.h>

#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using tests::TemporaryFolder;

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// As `xxhsum -H2` prints it for an empty file.
TEST(HashOf, IsXxh3) {
  EXPECT_EQ(hash_of({}).hex(), "99aa06d3014798d86001c324468d497f");
  EXPECT_EQ(hash_of({}).hex(), ContentHasher().hash().hex());
}

TEST(ContentHasher, OrderLengthAndTypeCount) {
  const ContentHash hash = ContentHasher().add("ab").add("c").hash();
  EXPECT_EQ(hash, ContentHasher().add("ab").add("c").hash());
  EXPECT_FALSE(hash == ContentHasher().add("a").add("bc").hash());
  EXPECT_FALSE(hash == ContentHasher().add("c").add("ab").hash());
  EXPECT_FALSE(ContentHasher().add(1).hash() == ContentHasher().add(1.0).hash());
  EXPECT_FALSE(ContentHasher().add(hash).hash() == hash);
}

TEST(HashOfFile, IsThatOfItsBytes) {
  const TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 700001; ++i)
    text += static_cast<char>(i * 31 >> 3);  // several blocks, the last not full
  EXPECT_EQ(hash_of_file(folder.write("a", text)), hash_of(bytes_of(text)));
  EXPECT_EQ(hash_of_file(folder.write("empty", "")), hash_of({}));
  text[600000] ^= 1;
  EXPECT_NE(hash_of_file(folder.write("b", text)), hash_of_file(folder.path() + "/a"));
}

TEST(HashOfFile, OfWhatIsNoFileThereIsNone) {
  const TemporaryFolder folder;
  EXPECT_EQ(hash_of_file(folder.path() + "/none"), std::nullopt);
  EXPECT_EQ(hash_of_file(folder.path()), std::nullopt);
  EXPECT_EQ(hash_of_file("/dev/zero"), std::nullopt);
  EXPECT_EQ(hash_of_file(""), std::nullopt);
}

}  // namespace
}  // namespace talisman::sequences
