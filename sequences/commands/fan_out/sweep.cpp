// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/fan_out/sweep.h"

#include <algorithm>

#include "sequences/commands/run_words.h"
#include "sequences/content/key_table.h"
#include "sequences/files/number_text.h"

namespace talisman::sequences {

namespace {

using OptionWords = std::vector<std::string>;

struct SweepFile {
  std::string out, command = "plan";
  OptionWords sequences, options;
  std::vector<OptionWords> settings;
  std::vector<std::vector<OptionWords>> grid;  ///< by key: its alternatives
};

/// "--geometric-px", "4"; a flag alone; nothing for a flag that is false.
OptionWords option_words(const std::string& key, const YamlValue& value) {
  std::string option = "--" + key;
  std::replace(option.begin(), option.end(), '_', '-');
  for (const char* ours : {"--out", "--shard", "--resume", "--plan"})
    if (option == ours)
      value.fail_as("has the key " + key, "not one of out, shard, resume and plan, which the sweep gives");
  const std::string text = value.text();
  if (text == "true") return {option};
  if (text == "false") return {};
  return {option, text};
}

OptionWords option_words(const YamlValue& map) {
  OptionWords words;
  const YamlMap options = map.map();
  for (const auto& [key, value] : options.values())
    for (const std::string& word : option_words(key, value)) words.push_back(word);
  return words;
}

ValueType map_of_options() { return with_rule({.kind = ValueType::Kind::Text}, "a map of options"); }

void read_grid(const YamlValue& grid, SweepFile& file) {
  const YamlMap keys = grid.map();
  for (const auto& [key, values] : keys.values()) {
    std::vector<OptionWords> alternatives;
    for (const YamlValue& value : values.items()) alternatives.push_back(option_words(key, value));
    file.grid.push_back(std::move(alternatives));
  }
}

const Table<SweepFile>& sweep_keys() {
  using S = SweepFile;
  static const Table<S> table =
      Table<S>("sweep")
          .key("out", &S::out, text(), "", "where results go")
          .required()
          .key("command", &S::command, one_of({"plan", "render"}), "", "what is run")
          .key("sequences", &S::sequences, texts(1), "", "names or paths")
          .required()
          .custom(
              "options", map_of_options(), [](const YamlValue& map, S& s) { s.options = option_words(map); },
              "", "of every run")
          .custom(
              "settings", map_of_options(),
              [](const YamlValue& list, S& s) {
                for (const YamlValue& map : list.items()) s.settings.push_back(option_words(map));
              },
              "", "of one run each")
          .custom("grid", map_of_options(), read_grid, "", "every combination is a run")
          .at_least_one_of({"settings", "grid"}, "it runs nothing");
  return table;
}

/// The settings of one sequence, in the order of their jobs.
std::vector<OptionWords> settings_in(const SweepFile& file, const std::string& name) {
  std::vector<OptionWords> all = file.settings;
  if (file.grid.empty()) return all;
  std::vector<OptionWords> combinations = {{}};
  for (const std::vector<OptionWords>& alternatives : file.grid) {
    std::vector<OptionWords> longer;
    for (const OptionWords& begun : combinations)
      for (const OptionWords& alternative : alternatives) {
        longer.push_back(begun);
        longer.back().insert(longer.back().end(), alternative.begin(), alternative.end());
      }
    combinations = std::move(longer);
    if (combinations.size() > kMostJobs)
      throw InputError("has more than " + std::to_string(kMostJobs) + " runs, rule: at most as many", name);
  }
  all.insert(all.end(), combinations.begin(), combinations.end());
  return all;
}

}  // namespace

Sweep read_sweep(const std::string& name) {
  const SweepFile file = sweep_keys().read(read_yaml_file(name));
  Sweep sweep;
  sweep.file = name;
  sweep.out = file.out;
  sweep.render = file.command == "render";
  const std::vector<OptionWords> settings = settings_in(file, name);
  for (const std::string& sequence : file.sequences)
    for (const OptionWords& own : settings) {
      SweepJob job{formatted("%04zu", sweep.jobs.size()), sequence, file.options, own};
      job.words.insert(job.words.end(), own.begin(), own.end());
      sweep.jobs.push_back(std::move(job));
      if (sweep.jobs.size() > kMostJobs)
        throw InputError("has more than " + std::to_string(kMostJobs) + " runs, rule: at most as many", name);
    }
  return sweep;
}

CommandLine command_line_of(const Sweep& sweep, const SweepJob& job, int shard, int shards) {
  CommandLine line = command_line_from(job.sequence, job.words, !sweep.render);
  line.out = sweep.folder(job);
  line.quiet = true;
  line.no_report = true;
  line.resume = sweep.render || shards > 1;
  if (shards > 1) line.shard = std::to_string(shard) + "/" + std::to_string(shards);
  return line;
}

std::string in_shell(const std::vector<std::string>& words) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,%@";
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += ' ';
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
      text += word;
      continue;
    }
    text += '\'';
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += '\'';
  }
  return text;
}

}  // namespace talisman::sequences
