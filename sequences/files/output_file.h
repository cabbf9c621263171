// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A file that is written: every step is looked at, and fails as an OutputError that names the file as the user knows it.
/// All files of results go through it, so that a fault of the disk can be tried at each step
/// (tests/sequences/commands/disk_faults_test.cpp).

#include <string>
#include <string_view>

#include "sequences/files/errors.h"

namespace talisman::sequences {

class OutputFile {
 public:
  /// `flags` as open(2) takes them; `shown` is the name in messages.
  OutputFile(const std::string& path, const std::string& shown, int flags);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes);
  void flush();  ///< to the disk, where the file can be flushed
  void close();

 private:
  std::string shown_;
  int fd_;
};

void rename_file(const std::string& from, const std::string& to, const std::string& shown);

}  // namespace talisman::sequences
