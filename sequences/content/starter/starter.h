// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A sequence file to begin with, made from a model: it shows what the bare model shows, and says every key that
/// may be changed, with its value and what it means (the meanings are those of the reader's tables).

#include <string>
#include <vector>

#include "sequences/content/sequence.h"

namespace talisman::sequences {

struct Starter {
  std::string yaml;
  std::vector<std::string> warnings, notes;  ///< of the model, as in Sequence
};

/// How the starter calls the model of a file: its name, of letters that no glob and no path knows.
std::string id_of_model(const std::string& path);

/// `path` is written as it is, so that the text is right in a file in the working directory; `options` become keys.
/// Frames and decisions are those of the bare model, bit by bit, for an animation of at most 20 s (it is cut there
/// in both). Throws InputError: what is no model, among them sequences.
Starter starter_sequence(const std::string& path, const ContentOptions& options = {});

}  // namespace talisman::sequences
