// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What was probably meant by a word that is not known?
///
/// The distance of two words is the least number of letters that are added, left out, changed or swapped with
/// their neighbour, no letter twice (the restricted Damerau-Levenshtein distance).

#include <span>
#include <string>
#include <string_view>

namespace talisman::sequences {

/// O(length²).
int edit_distance(std::string_view a, std::string_view b);

/// The known word at the least distance, the first of several; empty where it is more than a third of the
/// letters away (but one letter always may be).
std::string nearest_word(std::string_view written, std::span<const std::string> known);

}  // namespace talisman::sequences
