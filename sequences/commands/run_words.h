// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The words of `render` and `plan`, told once: to the command line, and to whoever else takes them (python/).

#include <string>
#include <vector>

#include "sequences/commands/option_group.h"
#include "sequences/commands/options.h"

namespace talisman::sequences {

/// The sequence; and what every command that runs one takes: where to, which frames, how large. `folder` in words: what
/// --out is without the option. More may be added to the group.
void add_sequence_option(CLI::App& command, CommandLine& line);
OptionGroup add_run_group(CLI::App& command, CommandLine& line, const std::string& folder);
/// The sequence and the options of `plan`, which `render` has too. `line` must live as long as `command`.
void add_run_options(CLI::App& command, CommandLine& line);
/// Those about content, which every command has that opens it.
void add_content_options(CLI::App& command, ContentWords& words);
/// Those of `explain` and `view`: what decides; and the folder of what, "the pictures", and its name.
void add_decision_options(CLI::App& command, CommandLine& line, const std::string& folder_of,
                          const std::string& folder);
/// Of them those that say how sprites are drawn, which `view` has, too.
void add_drawing_options(CLI::App& command, CommandLine& line);
/// The further options of `render`.
void add_audit_options(CLI::App& command, CommandLine& line);
void add_picture_options(CLI::App& command, CommandLine& line);
/// Those of a run that is made in parts.
void add_shard_options(CLI::App& command, CommandLine& line, bool plan_only);

/// What `talisman plan SEQUENCE WORDS…` (or render) would be told. Throws InputError for a word that is unknown
/// or has not the value that it needs; what the values may be is checked by `resolve`.
CommandLine command_line_from(const std::string& sequence, std::vector<std::string> words, bool plan_only);

}  // namespace talisman::sequences
