// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/temporary_files.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>
#include <vector>

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;

/// When the process started, in clock ticks since the machine did: field 22 of proc(5) stat. Together with the
/// number of a process, which is used again, it names one process. Empty if there is no such process.
std::optional<std::string> start_of(const std::string& process) {
  std::ifstream in("/proc/" + process + "/stat");
  std::string text;
  if (!std::getline(in, text)) return std::nullopt;
  std::istringstream fields(text.substr(text.rfind(')') + 1));  // the name before it may hold anything
  std::string state, field;
  fields >> state;
  if (state == "Z" || state == "X") return std::nullopt;  // killed, and not yet collected by its parent
  for (int k = 4; k <= 22; ++k) fields >> field;
  return field;
}

bool is_alive(const std::string& process, const std::string& start) {
  if (fs::exists("/proc/self/stat")) return start_of(process) == start;
  return ::kill(static_cast<pid_t>(std::stol(process)), 0) == 0 || errno == EPERM;
}

}  // namespace

std::string temporary_name(const std::string& path) {
  static std::atomic<unsigned> counter{0};
  const std::string start = start_of("self").value_or("0");  // asked each time: a fork has its own
  const fs::path target(path);
  const std::string unique =
      ".tmp-" + std::to_string(::getpid()) + "-" + start + "-" + std::to_string(counter++) + "-";
  return (target.parent_path() / (unique + target.filename().string())).string();
}

void remove_abandoned_files(const std::string& folder) {
  static const std::regex ours(R"(\.tmp-([1-9]\d{0,8})-(\d{1,20})-\d{1,10}-.+)");
  std::error_code error;
  std::vector<fs::path> abandoned;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    std::smatch parts;
    if (std::regex_match(name, parts, ours) && entry.symlink_status(error).type() == fs::file_type::regular &&
        !is_alive(parts[1], parts[2]))
      abandoned.push_back(entry.path());
  }
  for (const fs::path& file : abandoned) fs::remove(file, error);
}

}  // namespace talisman::sequences
