// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/file_uses.h"

#include <sys/stat.h>

#include <ctime>
#include <filesystem>
#include <map>

#include "sequences/files/loaded_code.h"

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;

/// Times of change come from a clock that ticks every 4 to 10 ms: two changes within one tick look like one.
constexpr std::int64_t kSettled_ns = 20'000'000;

std::int64_t nanoseconds(const timespec& time) {
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

bool is_of(FileUse::Kind kind, const struct stat& status) {
  return kind == FileUse::Kind::Names ? S_ISDIR(status.st_mode) : S_ISREG(status.st_mode);
}

ContentHash hash_of_names(const std::string& folder) {
  std::map<std::string, bool> names;  // and whether it is a file, as opposed to a folder
  std::error_code error, gone;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    names.emplace(it->path().filename().string(), it->is_regular_file(gone));
  ContentHasher hasher;
  for (const auto& [name, is_file] : names) hasher.add(name).add(is_file);
  return hasher.hash();
}

}  // namespace

void FileUses::look_for(const std::string& path) {
  if (files_.insert(path).second) add(FileUse::Kind::Content, path);
}

void FileUses::list(const std::string& folder) {
  if (folders_.insert(folder).second) add(FileUse::Kind::Names, folder);
}

void FileUses::add_code() {
  for (const std::string& file : loaded_code())
    if (files_.insert(file).second) add(FileUse::Kind::Code, file);
}

void FileUses::add(FileUse::Kind kind, const std::string& path) {
  struct stat status {};
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  if (::stat(path.c_str(), &status) != 0 || !is_of(kind, status)) {
    uses_.push_back({kind == FileUse::Kind::Names ? kind : FileUse::Kind::Missing, path, -1, 0, true});
    return;
  }
  const std::int64_t changed = nanoseconds(status.st_ctim);
  uses_.push_back({kind, path, status.st_size, changed, nanoseconds(now) - changed > kSettled_ns});
}

bool is_unchanged(const FileUse& use) {
  struct stat status {};
  const FileUse::Kind kind = use.kind == FileUse::Kind::Missing ? FileUse::Kind::Content : use.kind;
  const bool is_there = ::stat(use.path.c_str(), &status) == 0 && is_of(kind, status);
  if (use.bytes < 0) return !is_there;
  return is_there && use.settled && status.st_size == use.bytes &&
         nanoseconds(status.st_ctim) == use.changed_ns;
}

std::optional<ContentHash> seen_now(const FileUse& use) {
  std::error_code error;
  switch (use.kind) {
    case FileUse::Kind::Content:
      return hash_of_file(use.path);
    case FileUse::Kind::Names:
      return hash_of_names(use.path);
    case FileUse::Kind::Code:
      return stamp_of(use.path);
    case FileUse::Kind::Missing:
      break;
  }
  return fs::is_regular_file(use.path, error) ? std::nullopt : std::optional(ContentHash{});
}

}  // namespace talisman::sequences
