// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/view.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "sequences/commands/ineffective.h"
#include "sequences/commands/run_words.h"
#include "sequences/commands/stop.h"
#include "sequences/commands/words.h"
#include "sequences/experiments/culling/visibility.h"
#include "sequences/files/errors.h"
#include "sequences/files/freed_memory.h"
#include "sequences/view/server.h"
#include "sequences/view/view_request.h"

namespace talisman::sequences {

namespace {

bool is_sequence_file(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".yaml" || extension == ".yml";
}

/// Without those that the policy does not read: the page has the controls of all policies, as a sequence has their keys.
std::vector<std::string> words_of_policy(const std::string& sequence, const Sequence& loaded,
                                         std::vector<std::string> words) {
  const CommandLine asked = command_line_from(sequence, words, false);
  const regulator::Policy policy =
      asked.policy.empty() ? loaded.regulator.policy : choice("--policy", asked.policy, kPolicyWords);
  const std::vector<std::string> foreign = options_of_other_policies(asked, policy);
  std::erase_if(words, [&](const std::string& word) {
    return std::find(foreign.begin(), foreign.end(), word.substr(0, word.find('='))) != foreign.end();
  });
  return words;
}

/// The sequence under the words of a request. It is read again only where what is read depends on them.
Variant resolve_words(const CommandLine& line, const Sequence& loaded,
                      const std::vector<std::string>& words) {
  CommandLine asked = command_line_from(line.sequence, words_of_policy(line.sequence, loaded, words), false);
  asked.content = line.content;
  if (loaded.seam == Seam::None) return {loaded, resolve(asked, loaded, true).settings};
  const ContentOptions content = content_options(asked);
  const Sequence again = content == loaded.content ? loaded : load_sequence(line.sequence, content);
  return {again, resolve(asked, again, true).settings};
}

template <typename T, std::size_t N>
std::vector<std::string> texts_of(const Words<T, N>& words) {
  std::vector<std::string> texts;
  for (const Word<T>& word : words) texts.emplace_back(word.text);
  return texts;
}

/// All that can be asked of a sequence, with cells or without: one that it cannot is refused in words.
std::vector<std::string> texts_of_visibility() {
  std::vector<std::string> texts;
  for (const VisibilityOptions& options : visibility_triples(true)) texts.push_back(text_of(options));
  return texts;
}

/// The words of the options that are choices.
std::map<std::string, std::vector<std::string>> words_of_choices() {
  return {{"policy", texts_of(kPolicyWords)},     {"predict", texts_of(kPredictionWords)},
          {"joining", texts_of(kJoiningWords)},   {"motion-norm", texts_of(kMotionNormWords)},
          {"stagger", texts_of(kSwitchWords)},    {"regroup", texts_of(kRegroupWords)},
          {"refresh", texts_of(kRefreshWords)},   {"regroup-prices", texts_of(kRegroupPricesWords)},
          {"color-warp", texts_of(kSwitchWords)}, {"choice", texts_of(kChoiceRuleWords)},
          {"warp", texts_of(kCurveWords)},        {"bound", texts_of(kBoundWords)},
          {"cycles", texts_of(kCyclesWords)},     {"compositor", texts_of(kCompositorWords)},
          {"visibility", texts_of_visibility()},  {"shading", texts_of(kShadingWords)},
          {"samples", {"1", "4", "16"}},          {"late-chunks", texts_of(kSwitchWords)}};
}

/// Shows each option that the page may set, with its name.
template <typename Show>
void for_each_settable(const CLI::App& command, const Show& show) {
  const std::vector<std::string>& settable = settable_options();
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_lnames().empty()) continue;
    const std::string& name = option->get_lnames().front();
    if (std::find(settable.begin(), settable.end(), name) != settable.end()) show(*option, name);
  }
}

}  // namespace

std::vector<ViewControl> view_controls(const CLI::App& command) {
  auto choices = words_of_choices();
  std::vector<ViewControl> controls;
  for_each_settable(command, [&](const CLI::Option& option, const std::string& name) {
    controls.push_back({name, option.get_group(), option.get_description(), choices[name]});
  });
  return controls;
}

std::vector<std::string> given_settings(const CLI::App& command) {
  std::vector<std::string> given;
  for_each_settable(command, [&](const CLI::Option& option, const std::string& name) {
    if (option.count() > 0) given.push_back("--" + name + "=" + option.results().front());
  });
  return given;
}

ViewSource view_source(const ViewOptions& options) {
  ViewSource source;
  source.name = options.line.sequence;
  source.given = options.given;
  source.controls = options.controls;
  std::shared_ptr<const Sequence> loaded;
  try {
    loaded = std::make_shared<const Sequence>(load_with_warnings(options.line));
  } catch (const InputError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    source.fault = error.what();
    source.resolve = [fault = source.fault](const std::vector<std::string>&) -> Variant {
      throw InputError(fault);
    };
    return source;
  }
  resolve(options.line, *loaded, true);  // a slip of the command line is no fault of the scene
  source.out = options.line.out.empty() ? "out/" + loaded->name + "-view" : options.line.out;
  if (is_sequence_file(loaded->file)) source.base = loaded->file;
  source.resolve = [line = options.line, loaded](const std::vector<std::string>& words) {
    return resolve_words(line, *loaded, words);
  };
  return source;
}

int run_view(const ViewOptions& options, const std::atomic<bool>& stop, std::ostream& out) {
  heeds_stop = true;
  constexpr int kLargestPort = 65535;
  if (options.port < 0 || options.port > kLargestPort)
    throw InputError("--port is " + std::to_string(options.port) + ", must be from 0 (any) to 65535");
  share_freed_memory();
  ViewSource source = view_source(options);
  const bool is_readable = source.fault.empty();
  serve_view(std::move(source), options.port, stop, out);
  return is_readable ? kSuccess : kBadInput;
}

}  // namespace talisman::sequences
