// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/compared_run.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "sequences/commands/run_words.h"
#include "sequences/commands/words.h"
#include "sequences/content/nearest_word.h"
#include "sequences/content/value_type.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {

namespace {

using regulator::Policy;

/// The options that decide, or say how what is decided is done: not where the results go.
constexpr std::array kDecidingOptions = {
    "geometric-px",  "hold",           "stagger",         "blend",           "lookahead",
    "predict",       "latency-ms",     "tree-k",          "joining",         "motion-norm",
    "intervals",     "adaptive",       "photometric",     "light-angle-deg", "shadow-map-px",
    "turned-px",     "color-warp",     "budget-ms",       "budget-polygons", "budget-pixels",
    "budget-chunks", "min-resolution", "cutoff-px",       "choice",          "depth-complexity",
    "warp",          "bound",          "material-points", "cycles",          "compositor",
    "expected-reuse"};

const char* main_option(Policy policy) {
  switch (policy) {
    case Policy::Threshold:
    case Policy::Oracle:
    case Policy::Predictive:
      return "geometric-px";
    case Policy::Hold:
    case Policy::Interpolate:
      return "hold";
    case Policy::Lookahead:
      return "lookahead";
    case Policy::Budget:
      return "budget-ms";
    default:
      return nullptr;
  }
}

/// Errors of one setting begin with it.
template <typename Work>
auto about(const std::string& setting, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError("'" + setting + "': " + error.what());
  }
}

std::string option_of(Policy policy, std::string key) {
  std::replace(key.begin(), key.end(), '_', '-');
  const std::vector<std::string> options(kDecidingOptions.begin(), kDecidingOptions.end());
  const auto is_known = [&](const std::string& name) {
    return std::find(options.begin(), options.end(), name) != options.end();
  };
  if (policy == Policy::Budget && is_known("budget-" + key)) return "--budget-" + key;
  if (is_known(key)) return "--" + key;
  throw InputError("key is '" + key + "', must be one of " + listed(options) + did_you_mean(key, options));
}

std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// "KEY=VALUE", or a bare value where it is the first.
void add_words(Policy policy, const std::string& part, bool is_first, std::vector<std::string>& words) {
  const std::size_t equals = part.find('=');
  const std::string value = equals == std::string::npos ? part : part.substr(equals + 1);
  if (value.empty()) throw InputError("a value is missing, must be VALUE or KEY=VALUE");
  if (equals != std::string::npos) {
    words.push_back(option_of(policy, part.substr(0, equals)) + "=" + value);
    return;
  }
  const char* option = main_option(policy);
  if (!option || !is_first)
    throw InputError("'" + part + "' is a bare value, must be KEY=VALUE" +
                     (option ? " behind the first" : " with policy " + std::string(regulator::name(policy))));
  words.push_back(std::string("--") + option + "=" + value);
}

std::vector<std::string> words_from(const std::string& setting) {
  const std::size_t colon = setting.find(':');
  const std::string policy_word = setting.substr(0, colon);
  const Policy policy = choice("policy", policy_word, kPolicyWords);
  std::vector<std::string> words{"--policy=" + policy_word};
  if (colon == std::string::npos) return words;
  const std::vector<std::string> parts = parts_of(setting.substr(colon + 1), ',');
  for (std::size_t k = 0; k < parts.size(); ++k) add_words(policy, parts[k], k == 0, words);
  return words;
}

}  // namespace

std::vector<std::string> words_of_setting(const std::string& setting) {
  return about(setting, [&] { return words_from(setting); });
}

ResolvedRun resolve_setting(const std::string& setting, const CommandLine& given, const Sequence& sequence) {
  return about(setting, [&] {
    CommandLine line = command_line_from(given.sequence, words_from(setting), true);
    line.frames = given.frames;
    line.size = given.size;
    line.progress = given.progress;
    return resolve(line, sequence, false);
  });
}

}  // namespace talisman::sequences
