// SPDX-License-Identifier: Apache-2.0
// To be preloaded: a disk that fails once. Of the operations on files below the folder FAULT_BELOW, counted from 1, the
// FAULT_AT-th fails with "No space left on device"; a write writes half of its bytes before. FAULT_AT=0: none fails. The
// number of operations so far is kept in the file FAULT_COUNT, which outlasts the process. And an instant that does not
// depend on the speed of the machine: as soon as the file or folder SIGNAL_AT is there, the process sends itself SIGNAL.
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

std::string setting(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::atomic<long> operations{0};

/// Is it to fail?
bool counts(const std::string& path) {
  static const std::string below = setting("FAULT_BELOW");
  static const long fails_at = std::atol(setting("FAULT_AT").c_str());
  if (below.empty() || path.rfind(below, 0) != 0) return false;
  const long number = ++operations;
  static const int count = next<int(const char*, int, ...)>("open")(
      setting("FAULT_COUNT").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  const std::string text = std::to_string(number);
  static auto* const write_at = next<ssize_t(int, const void*, size_t, off_t)>("pwrite");
  (void)write_at(count, text.data(), text.size(), 0);
  return number == fails_at;
}

std::string path_of(int fd) {
  char path[4096];
  const ssize_t n = ::readlink(("/proc/self/fd/" + std::to_string(fd)).c_str(), path, sizeof path);
  return n > 0 ? std::string(path, static_cast<size_t>(n)) : std::string();
}

std::string absolute(const char* path) {
  if (path[0] == '/') return path;
  char folder[4096];
  return ::getcwd(folder, sizeof folder) ? std::string(folder) + "/" + path : std::string(path);
}

int full() {
  errno = ENOSPC;
  return -1;
}

/// An operation that made the file or folder `path` has ended with `result`.
int made(const char* path, int result) {
  static const std::string awaited = setting("SIGNAL_AT");
  static std::atomic<bool> sent{false};
  if (result >= 0 && !awaited.empty() && absolute(path) == awaited && !sent.exchange(true))
    ::kill(::getpid(), std::atoi(setting("SIGNAL").c_str()));
  return result;
}

}  // namespace

extern "C" {

ssize_t write(int fd, const void* bytes, size_t size) {
  static auto* const real = next<ssize_t(int, const void*, size_t)>("write");
  if (fd <= 2 || !counts(path_of(fd))) return real(fd, bytes, size);
  if (size > 1) (void)real(fd, bytes, size / 2);
  return full();
}

int fsync(int fd) {
  static auto* const real = next<int(int)>("fsync");
  return counts(path_of(fd)) ? full() : real(fd);
}

int rename(const char* from, const char* to) {
  static auto* const real = next<int(const char*, const char*)>("rename");
  return counts(absolute(to)) ? full() : made(to, real(from, to));
}

int mkdir(const char* path, mode_t mode) {
  static auto* const real = next<int(const char*, mode_t)>("mkdir");
  return counts(absolute(path)) ? full() : made(path, real(path, mode));
}

int open(const char* path, int flags, ...) {
  static auto* const real = next<int(const char*, int, ...)>("open");
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  if (!(flags & O_CREAT)) return real(path, flags, mode);
  return counts(absolute(path)) ? full() : made(path, real(path, flags, mode));
}

int open64(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  return open(path, flags, mode);
}
}
