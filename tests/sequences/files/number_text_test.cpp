// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/number_text.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace talisman::sequences {
namespace {

TEST(NumberText, OfFiniteValues) {
  EXPECT_EQ(fixed(1.25, 1), "1.2");  // to even
  EXPECT_EQ(fixed(-2, 3), "-2.000");
  EXPECT_EQ(percent_of(1, 3), "33.3");
  EXPECT_EQ(number_text("%.2e", 12345), "1.23e+04");
  EXPECT_EQ(exact(1.0 / 3), "0.333333333");
  EXPECT_EQ(number_or_null(0.5).dump(), "0.5");
  EXPECT_EQ(fixed(std::numeric_limits<double>::max(), 2).size(), 309u + 3);
}

TEST(NumberText, OfWhatIsNotFinite) {
  for (const double value : {double(NAN), double(INFINITY), -double(INFINITY)}) {
    EXPECT_EQ(fixed(value, 2), "-");
    EXPECT_EQ(number_text("%.2e", value), "");
    EXPECT_EQ(exact(value), "");
    EXPECT_EQ(number_or_null(value).dump(), "null");
  }
  EXPECT_EQ(percent_of(1, 0), "-");
  EXPECT_EQ(percent_of(1, -1), "-");
}

}  // namespace
}  // namespace talisman::sequences
