// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "sequences/files/errors.h"
#include "sequences/files/folders.h"

namespace talisman::sequences {
namespace {

/// What the owner wrote into it.
std::string owner_of(int fd) {
  char text[24] = {};
  const ssize_t n = ::pread(fd, text, sizeof text - 1, 0);
  return n > 0 ? " (process " + std::string(text, static_cast<std::size_t>(n)) + ")" : std::string();
}

/// An owner that ended between our opening and our locking removed the file: the lock is on nothing.
bool is_removed(int fd) {
  struct stat status {};
  return ::fstat(fd, &status) == 0 && status.st_nlink == 0;
}

void write_owner(int fd) {
  const std::string own = std::to_string(::getpid());
  const bool written = ::ftruncate(fd, 0) == 0 && ::pwrite(fd, own.data(), own.size(), 0) > 0;
  (void)written;  // only the other run's message is poorer for it
}

}  // namespace

FolderLock::FolderLock(const std::string& folder) : path_(folder + "/.lock") {
  create_folder(folder);
  while (true) {
    fd_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (fd_ < 0) throw OutputError(path_ + ": cannot be written: " + std::strerror(errno));
    const int locked = ::flock(fd_, LOCK_EX | LOCK_NB);
    if (locked != 0 && errno == EWOULDBLOCK) {
      const std::string owner = owner_of(fd_);
      ::close(fd_);
      throw OutputError(folder + " is being written by another run" + owner);
    }
    if (locked != 0 || !is_removed(fd_)) break;
    ::close(fd_);
  }
  write_owner(fd_);
}

FolderLock::~FolderLock() {
  ::unlink(path_.c_str());
  ::close(fd_);
}

}  // namespace talisman::sequences
