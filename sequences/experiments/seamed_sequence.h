// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A sequence with the seams that one setting needs (content/seams.h), beside others of the same sequence. What is
/// prepared for drawing is shared where the scene is the same.

#include <optional>

#include "chunker/render.h"
#include "sequences/content/seams.h"

namespace talisman::sequences {

class SeamedSequence {
 public:
  SeamedSequence(const Sequence& given, const Settings& settings)
      : sequence_(with_seams_for(given, settings)) {}
  SeamedSequence(const SeamedSequence&) = delete;
  SeamedSequence& operator=(const SeamedSequence&) = delete;

  const Sequence& sequence() const { return sequence_; }

  /// `shared` where that is of this very scene. Of another one it is made when it is first asked for.
  const chunker::PreparedScene& prepared(const chunker::PreparedScene& shared) {
    if (sequence_.scene.get() == &shared.scene()) return shared;
    if (!own_) own_.emplace(*sequence_.scene);
    return *own_;
  }

 private:
  Sequence sequence_;
  std::optional<chunker::PreparedScene> own_;
};

}  // namespace talisman::sequences
