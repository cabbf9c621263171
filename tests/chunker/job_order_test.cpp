// SPDX-License-Identifier: Apache-2.0
// Every order has each job once, and no picture depends on it.
#include "chunker/job_order.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace talisman::chunker {
namespace {

std::vector<std::size_t> all(std::size_t jobs, std::uint32_t order) {
  const JobOrder number(jobs, order);
  std::vector<std::size_t> numbers(jobs);
  for (std::size_t i = 0; i < jobs; ++i) numbers[i] = number[i];
  return numbers;
}

TEST(JobOrder, EachJobOnceInEveryOrder) {
  for (const std::size_t jobs : {0u, 1u, 2u, 3u, 4u, 6u, 30u, 1024u, 30030u})
    for (const std::uint32_t order : {0u, 1u, 2u, 7u, 4294967295u}) {
      std::vector<std::size_t> numbers = all(jobs, order);
      std::sort(numbers.begin(), numbers.end());
      std::vector<std::size_t> expected(jobs);
      std::iota(expected.begin(), expected.end(), std::size_t{0});
      EXPECT_EQ(numbers, expected) << jobs << " jobs, order " << order;
    }
}

TEST(JobOrder, ZeroIsByIndexAndOthersAreNot) {
  EXPECT_EQ(all(5, 0), (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(all(10, 1),
            (std::vector<std::size_t>{1, 8, 5, 2, 9, 6, 3, 0, 7,
                                      4}));  // by hand: 1 + 7 i; 1·3 + 1 = 4 shares 2 with 10, so do 5 and 6
  EXPECT_NE(all(1024, 2), all(1024, 3));
}

}  // namespace
}  // namespace talisman::chunker
