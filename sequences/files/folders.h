// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sequences/files/errors.h"

namespace talisman::sequences {

/// Creates the folder and those above it where they are not there. Throws InputError where a file is in the way, else
/// OutputError.
void create_folder(const std::string& path);

/// The same for a folder to which results are to be written: what a killed writer left there is removed
/// (files/temporary_files.h).
void prepare_folder(const std::string& path);

/// A folder for the results of one kind of report, whose mark is a file that every one of them has ("compare.json"), or
/// MARK.partial from here until finish_report_folder. Other folders with anything in them are not ours: throws
/// InputError. `kind` in words: "a comparison".
void begin_report_folder(const std::string& path, const std::string& mark, const std::string& kind);
void finish_report_folder(const std::string& path, const std::string& mark);

}  // namespace talisman::sequences
