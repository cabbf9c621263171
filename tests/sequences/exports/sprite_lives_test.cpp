// SPDX-License-Identifier: Apache-2.0
// Lives of sprites from decisions written by hand.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sequences/results/exports/sprite_lives.h"

namespace talisman::sequences {
namespace {

nlohmann::ordered_json decision(int frame, const std::string& layer, const std::string& what, double px = 0) {
  return {{"frame", frame},
          {"layer", layer},
          {"decision", what},
          {"reason", what + std::to_string(frame)},
          {"geometric_px", px}};
}

/// "layer 3-5 drawn, 0.5 px, ended by …"
std::vector<std::string> lives_of(const std::vector<nlohmann::ordered_json>& decisions) {
  std::vector<std::string> told;
  SpriteLives lives([&](const SpriteLife& l) {
    told.push_back(l.layer + " " + std::to_string(l.begin) + "-" + std::to_string(l.end) +
                   (l.drawn ? " drawn " : " from before ") + std::to_string(l.max_geometric_px).substr(0, 3) +
                   " " + l.ended);
  });
  for (const auto& d : decisions) lives.add(d);
  lives.finish();
  return told;
}

TEST(SpriteLives, LastUntilTheNextRender) {
  EXPECT_EQ(
      lives_of({decision(0, "a", "rerender"), decision(1, "a", "reuse", 0.5), decision(2, "a", "reuse", 0.2),
                decision(3, "a", "rerender"), decision(4, "a", "reuse", 0.1)}),
      (std::vector<std::string>{"a 0-3 drawn 0.5 rerender3", "a 3-5 drawn 0.1 "}));
}

/// Out of view and back: the old sprite is shown again without a render.
TEST(SpriteLives, ADropEndsALifeAndTheSameSpriteMayBeginAnother) {
  EXPECT_EQ(lives_of({decision(0, "a", "rerender"), decision(1, "a", "drop"), decision(2, "a", "drop"),
                      decision(3, "a", "reuse", 0.3)}),
            (std::vector<std::string>{"a 0-1 drawn 0.0 drop1", "a 3-4 from before 0.3 "}));
}

/// An aggregate has no decisions while its members are apart; a range begins with a sprite from before.
TEST(SpriteLives, AGapInTheDecisionsIsAGapInTheLives) {
  EXPECT_EQ(lives_of({decision(7, "a+b", "reuse", 0.1), decision(7, "c", "rerender"),
                      decision(8, "c", "reuse"), decision(9, "a+b", "reuse"), decision(9, "c", "reuse")}),
            (std::vector<std::string>{"a+b 7-8 from before 0.1 ", "a+b 9-10 from before 0.0 ",
                                      "c 7-10 drawn 0.0 "}));
}

TEST(SpriteLives, NoDecisionsNoLives) { EXPECT_TRUE(lives_of({}).empty()); }

}  // namespace
}  // namespace talisman::sequences
