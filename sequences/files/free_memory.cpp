// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/free_memory.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>

#include <sys/resource.h>

namespace talisman::sequences {

namespace {

/// The number at the start of a text, in bytes; empty for "max" and all else that is none.
std::optional<std::int64_t> number_in(const std::string& text) {
  const std::size_t at = text.find_first_not_of(" \t");
  std::int64_t value = 0;
  if (at == std::string::npos) return std::nullopt;
  const auto read = std::from_chars(text.data() + at, text.data() + text.size(), value);
  return read.ec == std::errc() && value >= 0 ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> number_of_file(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  return std::getline(in, line) ? number_in(line) : std::nullopt;
}

/// "MemAvailable:  123 kB" of a file of such lines, in bytes.
std::optional<std::int64_t> entry_of(const std::string& file, const std::string& name) {
  constexpr std::int64_t kMost_kB = INT64_MAX / 1024;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.rfind(name + ":", 0) == 0)
      if (const auto kB = number_in(line.substr(name.size() + 1))) return std::min(*kB, kMost_kB) * 1024;
  return std::nullopt;
}

void limit(std::optional<std::int64_t>& free, std::int64_t bytes) {
  free = std::min(free.value_or(bytes), std::max<std::int64_t>(bytes, 0));
}

/// The process's group and those above it.
void limit_by_groups(const std::string& root, std::optional<std::int64_t>& free) {
  namespace fs = std::filesystem;
  std::ifstream in(root + "/proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("0::/", 0) != 0) continue;  // version 2
    const fs::path top = root + "/sys/fs/cgroup";
    for (fs::path group = fs::path(line.substr(4)).lexically_normal();; group = group.parent_path()) {
      const auto most = number_of_file(top / group / "memory.max"),
                 now = number_of_file(top / group / "memory.current");
      if (most && now) limit(free, *most - *now);
      if (group.empty() || group == group.parent_path()) return;
    }
  }
}

}  // namespace

std::optional<std::int64_t> free_memory_bytes(const std::string& root) {
  std::optional<std::int64_t> free;
  if (const auto available = entry_of(root + "/proc/meminfo", "MemAvailable"))
    limit(free, *available + entry_of(root + "/proc/meminfo", "SwapFree").value_or(0));
  limit_by_groups(root, free);
  rlimit space{};
  if (::getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
    limit(free, static_cast<std::int64_t>(std::min<rlim_t>(space.rlim_cur, INT64_MAX)) -
                    entry_of(root + "/proc/self/status", "VmSize").value_or(0));
  return free;
}

std::int64_t held_memory_bytes(const std::string& root) {
  return entry_of(root + "/proc/self/status", "VmRSS").value_or(0);
}

}  // namespace talisman::sequences
