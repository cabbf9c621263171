// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace talisman::sequences {

namespace {

[[noreturn]] void fail(const std::string& shown, int error) {
  throw OutputError(shown + ": cannot be written: " + std::strerror(error));
}

}  // namespace

OutputFile::OutputFile(const std::string& path, const std::string& shown, int flags)
    : shown_(shown), fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
  if (fd_ < 0) fail(shown_, errno);
}

OutputFile::~OutputFile() {
  if (fd_ >= 0) ::close(fd_);
}

void OutputFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(shown_, errno);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

/// EINVAL and EROFS: the file is something that cannot be flushed, which is no failure.
void OutputFile::flush() {
  if (::fsync(fd_) != 0 && errno != EINVAL && errno != EROFS) fail(shown_, errno);
}

void OutputFile::close() {
  const int closed = ::close(fd_);
  fd_ = -1;
  if (closed != 0 && errno != EINTR) fail(shown_, errno);
}

void rename_file(const std::string& from, const std::string& to, const std::string& shown) {
  if (std::rename(from.c_str(), to.c_str()) != 0) fail(shown, errno);
}

}  // namespace talisman::sequences
