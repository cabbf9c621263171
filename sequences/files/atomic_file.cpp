// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <string_view>

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, int error) {
  throw OutputError(path + ": cannot be written: " + std::strerror(error));
}

/// Hidden, in the same folder (a rename never crosses devices), unique among processes and threads. The
/// extension stays last.
std::string temporary_name(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  const fs::path target(path);
  const std::string unique = ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + "-";
  return (target.parent_path() / (unique + target.filename().string())).string();
}

class Descriptor {
 public:
  Descriptor(const std::string& temporary, const std::string& path, int flags)
      : path_(path), fd_(::open(temporary.c_str(), flags | O_CLOEXEC, 0666)) {
    if (fd_ < 0) fail(path_, errno);
  }
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail(path_, errno);
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
  }
  /// EINVAL and EROFS: the file is something that cannot be flushed, which is no failure.
  void flush() {
    if (::fsync(fd_) != 0 && errno != EINVAL && errno != EROFS) fail(path_, errno);
  }
  void close() {
    const int closed = ::close(fd_);
    fd_ = -1;
    if (closed != 0 && errno != EINTR) fail(path_, errno);
  }

 private:
  const std::string& path_;
  int fd_;
};

void flush_and_rename(const std::string& temporary, const std::string& path) {
  Descriptor file(temporary, path, O_RDONLY);
  file.flush();
  file.close();
  if (::rename(temporary.c_str(), path.c_str()) != 0) fail(path, errno);
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
    Descriptor file(temporary, path, O_WRONLY | O_CREAT | O_TRUNC);
    file.write(text);
    file.close();
  });
}

}  // namespace talisman::sequences
