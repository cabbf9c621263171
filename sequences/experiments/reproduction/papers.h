// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The papers whose results are tried, each a table of items and claims (paper.h). Who adds one writes its items in
/// files of their own and lists them here.

#include <vector>

#include "sequences/experiments/reproduction/paper.h"

namespace talisman::sequences {

std::vector<Paper> all_papers();

/// What the words of --only ask for: a paper's tag, or TAG:ITEM; all of them where there are none. Throws InputError that
/// names the word and lists what there is.
std::vector<Paper> chosen_papers(const std::vector<Paper>& papers, const std::vector<std::string>& only);

}  // namespace talisman::sequences
