// SPDX-License-Identifier: Apache-2.0
// Any words, one a line, behind `talisman render carousel`. Only InputError may come out; what is accepted is settings whose
// every number is one.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sequences/commands/options.h"
#include "sequences/commands/run_words.h"
#include "sequences/files/errors.h"
#include "sequences/results/settings_json.h"

namespace {

bool is_finite(const nlohmann::ordered_json& value) {
  if (value.is_structured())
    return std::all_of(value.begin(), value.end(), [](const auto& v) { return is_finite(v); });
  return !value.is_number_float() || std::isfinite(value.get<double>());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace talisman::sequences;
  static const Sequence sequence = load_sequence(TALISMAN_SOURCE_DIR "/sequences/carousel/carousel.yaml");
  std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<std::string> words;
  for (std::string word; std::getline(lines, word);) words.push_back(word);
  try {
    const bool plan_only = size % 2 == 1;
    const auto run = resolve(command_line_from("carousel", words, plan_only), sequence, plan_only);
    if (!is_finite(json_of(run.settings))) std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
