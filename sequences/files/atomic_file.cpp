// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include "sequences/files/output_file.h"
#include "sequences/files/temporary_files.h"

namespace talisman::sequences {
namespace {

void flush_and_rename(const std::string& temporary, const std::string& path) {
  OutputFile file(temporary, path, O_RDONLY);
  file.flush();
  file.close();
  rename_file(temporary, path, path);
}

}  // namespace

void write_atomically(const std::string& path,
                      const std::function<void(const std::string& temporary)>& content) {
  const std::string temporary = temporary_name(path);
  try {
    content(temporary);
    flush_and_rename(temporary, path);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
}

void write_text_atomically(const std::string& path, const std::string& text) {
  write_atomically(path, [&](const std::string& temporary) {
    OutputFile file(temporary, path, O_WRONLY | O_CREAT | O_TRUNC);
    file.write(text);
    file.close();
  });
}

}  // namespace talisman::sequences
