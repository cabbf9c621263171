// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/terminal_text.h"

#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

TEST(Harmless, TakesFromTheTerminalWhatIsNoText) {
  EXPECT_EQ(harmless("\x1b]0;title\x07\x1b[2Jred"), "\\x1b]0;title\\x07\\x1b[2Jred");
  EXPECT_EQ(harmless("a\nb\tc\x7f"), "a\\x0ab\\x09c\\x7f");
  EXPECT_EQ(harmless("a\nb\r", true), "a\nb\\x0d");
  EXPECT_EQ(harmless("\xc2\x9b"
                     "2J"),
            "\\u009b2J");
  EXPECT_EQ(harmless("\xe2\x80\xae"
                     "cod.exe"),
            "\\u202ecod.exe");
  EXPECT_EQ(harmless(std::string("a\0b", 3)), "a\\x00b");
}

TEST(Harmless, LeavesTextAsItIs) {
  for (const char* text :
       {"", "Flügel #2", "名前", "a\\x1b", "\xe2\x80\x93", "\xc3\xa9", "\xe2\x80", "\xff\xfe"})
    EXPECT_EQ(harmless(text), text);
}

}  // namespace
}  // namespace talisman::sequences
