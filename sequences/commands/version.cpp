// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/version.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include <hwy/targets.h>

#include "chunker/job_order.h"
#include "chunker/span_composite.h"
#include "git_commit.h"
#include "layers/effect.h"
#include "sequences/commands/missing_effects.h"
#include "sequences/files/child_process.h"
#include "sequences/files/errors.h"
#include "sequences/files/program_folder.h"
#include "sequences/import/confinement.h"

namespace talisman::sequences {
namespace {

/// "all 17", or "15 of 17, without shadow_map, texture".
std::string effects_text() {
  const layers::EffectSet built = built_effects();
  const auto count = std::count(built.begin(), built.end(), true);
  if (count == std::ssize(built)) return "all " + std::to_string(count);
  std::string text = std::to_string(count) + " of " + std::to_string(built.size());
  const char* before = ", without ";
  for (const layers::Effect effect : layers::kAllEffects) {
    if (built[static_cast<std::size_t>(effect)]) continue;
    text += before + std::string(layers::name(effect));
    before = ", ";
  }
  return text;
}

/// The best of those that the inner loops are compiled for and this machine has.
const char* simd_target() {
  const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(usable & -usable);  // the lower the bit, the better the target
}

/// What holds readers of models, as they say themselves.
std::string confinement() {
  const ChildResult asked = run_child({importer_program(), kAskForConfinement});
  return asked.succeeded() ? asked.reason(1) : "talisman_import is not there";
}

}  // namespace

std::string version_text() {
  return "talisman " TALISMAN_VERSION "\ncommit: " TALISMAN_COMMIT "\neffects: " + effects_text() +
         "\nsimd: " + simd_target() + "\nreaders of models: " + confinement();
}

void use_asked_instruction_set() {
  const char* asked = std::getenv("TALISMAN_SIMD");
  if (!asked) return;
  std::string names;
  for (const std::int64_t set : chunker::instruction_sets()) {
    const std::string name = chunker::instruction_set_name(set);
    if (name == asked) return chunker::use_instruction_set(set);
    names += (names.empty() ? "" : ", ") + name;
  }
  throw InputError("TALISMAN_SIMD is '" + std::string(asked) + "', must be one of " + names);
}

void use_asked_job_order() {
  const char* asked = std::getenv("TALISMAN_ORDER");
  if (!asked) return;
  const std::string_view text(asked);
  std::uint32_t order = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), order);
  if (error != std::errc() || end != text.data() + text.size())
    throw InputError("TALISMAN_ORDER is '" + std::string(text) +
                     "', must be a whole number from 0 to 4294967295");
  chunker::use_job_order(order);
}

}  // namespace talisman::sequences
