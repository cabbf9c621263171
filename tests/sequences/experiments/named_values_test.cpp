// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/named_values.h"

#include <cmath>

#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

struct Ship {
  double mass_t = 0, speed_kn = 0;
};

constexpr NamedValue<Ship> kColumns[] = {
    {"mass_t", [](const Ship& s) { return s.mass_t; }},
    {"speed_kn", [](const Ship& s) { return s.speed_kn; }},
};

TEST(NamedValues, CsvHasACellForEachNameAndNoneForWhatIsNotFinite) {
  EXPECT_EQ(csv_names(kColumns), ",mass_t,speed_kn");
  EXPECT_EQ(csv_cells(kColumns, Ship{1.5, 1.0 / 3}), ",1.5,0.333333333");
  EXPECT_EQ(csv_cells(kColumns, Ship{NAN, HUGE_VAL}), ",,");
}

TEST(NamedValues, JsonKeepsTheOrderAndHasNullForWhatIsNotFinite) {
  nlohmann::ordered_json json = {{"ship", "a"}};
  put(json, kColumns, Ship{2, -HUGE_VAL});
  EXPECT_EQ(json.dump(), R"({"ship":"a","mass_t":2.0,"speed_kn":null})");
}

TEST(Quoted, QuotesAreDoubled) {
  EXPECT_EQ(quoted("a,b"), "\"a,b\"");
  EXPECT_EQ(quoted("wing \"left\""), "\"wing \"\"left\"\"\"");
}

}  // namespace
}  // namespace talisman::sequences
