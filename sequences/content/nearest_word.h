// SPDX-License-Identifier: Apache-2.0
#pragma once

/// "Did you mean": which of the words that are allowed was meant by one that is not?

#include <string>
#include <vector>

namespace talisman::sequences {

/// The word with the fewest edits (a letter changed, added, left out, or exchanged with the one beside it)
/// from `written`, the first of several; empty when none is as near as a third of its letters, since then
/// something else was meant. A word that alone begins with `written`, three letters or more, comes first.
std::string nearest_word(const std::string& written, const std::vector<std::string>& words);

/// "; did you mean 'frames'", or nothing.
std::string did_you_mean(const std::string& written, const std::vector<std::string>& words);

}  // namespace talisman::sequences
