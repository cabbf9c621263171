// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/content_hash.h"

#include <gtest/gtest.h>

#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

// The examples of FIPS 180.
TEST(ContentHash, IsSha1) {
  EXPECT_EQ(hash_of_text(""), "da39a3ee5e6b4b0d3255bfef95601890afd80709");
  EXPECT_EQ(hash_of_text("abc"), "a9993e364706816aba3e25717850c26c9cd0d89d");
  EXPECT_EQ(hash_of_text("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "84983e441c3bd26ebaae4aa1f95129e5e54670f1");
}

TEST(ContentHash, OfAFileIsThatOfItsBytes) {
  const tests::TemporaryFolder folder;
  // Longer than one block of reading, and of all byte values.
  std::string bytes;
  for (int i = 0; i < 3'000'001; ++i) bytes += static_cast<char>(i * 31 / 7);
  EXPECT_EQ(hash_of_file(folder.write("a", bytes)), hash_of_text(bytes));
  EXPECT_EQ(hash_of_file(folder.write("empty", "")), hash_of_text(""));
  EXPECT_EQ(tests::message_of([&] { hash_of_file(folder.path() + "/none"); }),
            folder.path() + "/none: cannot be read");
}

}  // namespace
}  // namespace talisman::sequences
