// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/parse_error.h"

#include <vector>

#include "sequences/content/nearest_word.h"

namespace talisman::sequences {
namespace {

bool is_option(const std::string& argument) { return argument.size() > 1 && argument.front() == '-'; }

/// Without what it is set to: "--size" of "--size=64x48".
std::string name_of(const std::string& option) { return option.substr(0, option.find('=')); }

/// Without those that --help does not list.
std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command :
       app.get_subcommands([](const CLI::App* listed) { return !listed->get_group().empty(); }))
    names.push_back(command->get_name());
  return names;
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// "'rendr' is no command; did you mean 'render'?"
std::string unknown_word(const std::string& written, const std::string& kind,
                         const std::vector<std::string>& known) {
  const std::string what = "'" + written + "' is no " + kind + "; ";
  if (const std::string nearest = nearest_word(written, known); !nearest.empty())
    return what + "did you mean '" + nearest + "'?";
  std::string names;
  for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
  return what + "must be one of " + names;
}

/// The nearest word, or the shortest that goes on as it begins.
std::string nearest_of(const std::string& written, const std::vector<std::string>& known) {
  std::string nearest = nearest_word(written, known);
  constexpr std::size_t kFewest = 4;  // "--g" may be many
  if (!nearest.empty() || written.size() < kFewest) return nearest;
  for (const std::string& name : known)
    if (name.rfind(written, 0) == 0 && (nearest.empty() || name.size() < nearest.size())) nearest = name;
  return nearest;
}

std::string unexpected(const CLI::App& command, const std::vector<std::string>& arguments) {
  if (const std::optional<UnknownOption> unknown = unknown_option(command, arguments))
    return "'" + unknown->written + "' is no option of " + command.get_name() +
           (unknown->nearest.empty() ? "; --help lists them" : "; did you mean '" + unknown->nearest + "'?");
  return arguments.empty() ? ""
                           : "'" + arguments.front() + "' is one argument too many for " +
                                 command.get_name() + "; --help lists what it takes";
}

}  // namespace

std::optional<UnknownOption> unknown_option(const CLI::App& command,
                                            const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments)
    if (is_option(argument) && argument != "--")
      return UnknownOption{name_of(argument), nearest_of(name_of(argument), options_of(command))};
  return std::nullopt;
}

std::string explained(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> unknown = app.remaining(true);
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  if (parsed.empty() && !unknown.empty())
    return is_option(unknown.front()) ? unknown_word(name_of(unknown.front()), "option", options_of(app))
                                      : unknown_word(unknown.front(), "command", commands_of(app));
  if (std::string what = parsed.empty() ? "" : unexpected(*parsed.front(), unknown); !what.empty())
    return what;
  return error.what();
}

}  // namespace talisman::sequences
