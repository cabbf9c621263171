// SPDX-License-Identifier: Apache-2.0
// What goes into the page comes out again bit by bit: read back here with zlib, by the rules of the headers.
#include <bit>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include "sequences/pictures/page_text.h"
#include "sequences/results/report/packed_table.h"

namespace talisman::sequences {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<unsigned char> inflated(const std::string& packed, std::size_t size) {
  std::vector<unsigned char> bytes(size + 1);  // one more, to see that there is none
  uLongf length = bytes.size();
  const int status =
      uncompress(bytes.data(), &length, reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  EXPECT_EQ(status, Z_OK);
  EXPECT_EQ(length, size);
  bytes.resize(size);
  return bytes;
}

/// The way back: planes of bytes, each row XORed with the one before of its series.
std::vector<std::uint64_t> unpacked(const std::string& packed, const std::vector<std::size_t>& series,
                                    std::size_t width) {
  const std::vector<unsigned char> planes = inflated(packed, series.size() * width);
  std::vector<std::uint64_t> rows(series.size()), before(series.size() + 1);
  for (std::size_t start = 0; start < rows.size(); start += PackedColumn::kBlock) {
    const std::size_t n = std::min<std::size_t>(PackedColumn::kBlock, rows.size() - start);
    for (std::size_t i = 0; i < n; ++i) {
      std::uint64_t bits = 0;
      for (std::size_t byte = 0; byte < width; ++byte)
        bits |= std::uint64_t{planes[start * width + byte * n + i]} << (8 * byte);
      rows[start + i] = before[series[start + i]] ^= bits;
    }
  }
  return rows;
}

TEST(PackedColumn, NumbersComeOutBitByBit) {
  // More than one block, so that the last one is shorter than the others.
  const std::vector<double> some = {0.0, -0.0, 1.0 / 3, -1e300, 5e-324, HUGE_VAL, kNaN, 255};
  PackedColumn column(8);
  std::vector<std::size_t> series;
  std::vector<std::uint64_t> expected;
  for (int row = 0; row < 2 * PackedColumn::kBlock + 7; ++row) {
    const double value = some[row % some.size()] * (row % 3);
    series.push_back(row % 5);
    expected.push_back(std::isnan(value) ? 0x7ff8000000000000U : std::bit_cast<std::uint64_t>(value));
    column.add(series.back(), value);
  }
  EXPECT_EQ(unpacked(column.finish(), series, 8), expected);
}

TEST(PackedColumn, IndicesComeOutAndWhatDoesNotChangeTakesNearlyNothing) {
  PackedColumn column(4);
  std::vector<std::size_t> series;
  std::vector<std::uint64_t> expected;
  for (int row = 0; row < 100000; ++row) {
    series.push_back(row % 40);
    expected.push_back(static_cast<std::uint64_t>(row % 40) * 1000);
    column.add(series.back(), static_cast<std::uint32_t>(expected.back()));
  }
  EXPECT_EQ(unpacked(column.finish(), series, 4), expected);
  EXPECT_LT(column.finish().size(), 1500u);
}

TEST(PackedColumn, OfNoRowsIsEmpty) {
  PackedColumn column(8);
  EXPECT_TRUE(unpacked(column.finish(), {}, 8).empty());
}

/// RFC 4648, section 10.
TEST(Base64, IsThatOfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfb"), "//s=");
}

/// What a browser makes of value.toPrecision(4) without zeros behind, or nothing.
TEST(FourDigits, AreThoseOfTheBrowserOrAreLeftToTheText) {
  EXPECT_EQ(four_digits(0.99294), "0.9929");
  EXPECT_EQ(four_digits(6.7), "6.7");
  EXPECT_EQ(four_digits(1), "1");
  EXPECT_EQ(four_digits(9999), "9999");
  EXPECT_EQ(four_digits(0.00012346), "0.0001235");
  EXPECT_FALSE(four_digits(1.0625)) << "half way: printf goes to the even digit, a browser up";
  EXPECT_EQ(four_digits(1.06251), "1.063");
  EXPECT_FALSE(four_digits(10000));
  EXPECT_FALSE(four_digits(0.00001));
  EXPECT_FALSE(four_digits(0));
  EXPECT_FALSE(four_digits(-1));
  EXPECT_FALSE(four_digits(kNaN));
}

std::vector<ColumnInfo> columns() {
  return {{"layer", "layer", "", ""},
          {"reason", "reason", "", ""},
          {"geometric_px", "fiducials/px", "px", ""},
          {"never", "fiducials/never", "", ""}};
}

TEST(FlatLine, FindsColumnsByTheirPlaceAndForgetsThoseOfTheLineBefore) {
  FlatLine line(columns());
  ASSERT_TRUE(line.read(
      R"({"schema": "x/1", "layer": "a", "fiducials": {"px": 2, "other": [1, {"px": 3}]}, "reason": null})"));
  EXPECT_EQ(line.schema(), "x/1");
  EXPECT_EQ(line.cells(), (std::vector<Cell>{"a", std::monostate{}, 2.0, std::monostate{}}));
  ASSERT_TRUE(line.read(R"({"fiducials": null, "layer": true})"));
  EXPECT_EQ(line.schema(), "");
  EXPECT_EQ(line.cells(), (std::vector<Cell>{1.0, std::monostate{}, std::monostate{}, std::monostate{}}));
}

TEST(FlatLine, OfWhatIsCutOffOrNoObjectIsRefused) {
  FlatLine line(columns());
  for (const char* text :
       {"", "null", "[1]", "{\"layer\": \"a\"", "{\"layer\": \"a\"} x", "{\"layer\": nan}"})
    EXPECT_FALSE(line.read(text)) << text;
}

TEST(PackedTable, ReasonsThatDifferInTheirNumbersAloneShareAWord) {
  PackedTable table(columns(), "layer");
  table.add({"a", "geometric 0.5 > 4 px", 0.5, std::monostate{}});
  table.add({"b", "geometric 0.25 > 4 px", 0.25, std::monostate{}});
  table.add({"a", "geometric 0.125 > 4 px", 0.25, std::monostate{}});  // not this row's number
  table.add({"b", std::monostate{}, std::monostate{}, std::monostate{}});
  const PackedField& reason = table.fields()[1];
  ASSERT_EQ(reason.words.size(), 3u);
  EXPECT_EQ(reason.words[1],
            "geometric \x01"
            "a > 4 px");
  EXPECT_EQ(reason.words[2], "geometric 0.125 > 4 px");
  EXPECT_FALSE(table.fields()[3].packed) << "a column of nothing takes no room";
  EXPECT_EQ(table.rows(), 4u);
}

TEST(PackedTable, AColumnThatBeginsLateHasNothingBefore) {
  PackedTable table(columns(), "layer");
  table.add({"a", std::monostate{}, std::monostate{}, std::monostate{}});
  table.add({"b", std::monostate{}, std::monostate{}, std::monostate{}});
  table.add({"a", std::monostate{}, 2.5, std::monostate{}});
  const auto rows = unpacked(table.fields()[2].packed->finish(), {1, 2, 1}, 8);
  EXPECT_TRUE(std::isnan(std::bit_cast<double>(rows[0])));
  EXPECT_TRUE(std::isnan(std::bit_cast<double>(rows[1])));
  EXPECT_EQ(std::bit_cast<double>(rows[2]), 2.5);
}

TEST(PackedTable, AColumnOfNumbersAndWordsIsRefused) {
  PackedTable table(columns(), "layer");
  table.add({"a", std::monostate{}, 2.5, std::monostate{}});
  EXPECT_THROW(table.add({"a", std::monostate{}, "2.5", std::monostate{}}), std::invalid_argument);
}

}  // namespace
}  // namespace talisman::sequences
