// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <sstream>

extern char** environ;

namespace talisman::sequences {
namespace {

constexpr std::size_t kKeptOutput = 64 * 1024;

/// What the child does between its birth and the start of the program. posix_spawn and not fork: other
/// threads of ours may hold locks.
class Actions {
 public:
  Actions() { posix_spawn_file_actions_init(&actions_); }
  ~Actions() { posix_spawn_file_actions_destroy(&actions_); }
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;

  // Files are opened before the directory changes, so that their names mean what they mean to us.
  void set(const ChildOptions& options, int output_fd) {
    const std::string in = options.stdin_file.empty() ? "/dev/null" : options.stdin_file;
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, in.c_str(), O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, output_fd, STDERR_FILENO);
    if (options.stdout_file.empty())
      posix_spawn_file_actions_adddup2(&actions_, output_fd, STDOUT_FILENO);
    else
      posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, options.stdout_file.c_str(),
                                       O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (!options.directory.empty())
      posix_spawn_file_actions_addchdir_np(&actions_, options.directory.c_str());
  }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

/// Wall time per processor time: the machine may have other work.
constexpr int kPatienceWithChild = 10;

/// The limits hold from the program's first instruction on: util-linux's prlimit sets them for itself and becomes the
/// program. Set from here they would come when it already runs, on a busy machine too late.
std::vector<std::string> limited(const std::vector<std::string>& arguments, const ChildLimits& limits) {
  std::vector<std::string> all{"prlimit"};
  const auto set = [&](const char* option, std::int64_t most) {
    if (most > 0) all.push_back(option + std::to_string(most));
  };
  set("--cpu=", limits.seconds);
  set("--as=", limits.memory_bytes);
  set("--fsize=", limits.file_bytes);
  if (all.size() == 1) return arguments;
  all.push_back("--");
  all.insert(all.end(), arguments.begin(), arguments.end());
  return all;
}

/// What prlimit and shells end with where there is no such program.
constexpr int kNoSuchProgram = 127;

/// False: nothing came until the deadline, if there is one.
bool wait_for_output(int fd, const ChildLimits& limits, std::chrono::steady_clock::time_point deadline) {
  if (limits.seconds == 0) return true;
  pollfd waiting{fd, POLLIN, 0};
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    const int ready = ::poll(&waiting, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (ready >= 0 || errno != EINTR) return ready > 0;
  }
}

/// Until the end, or until the child has to be ended.
std::string read_tail(int fd, pid_t pid, const ChildLimits& limits, bool& timed_out) {
  const auto deadline =
      std::chrono::steady_clock::now() + kPatienceWithChild * std::chrono::seconds(limits.seconds);
  std::string tail;
  std::array<char, 4096> buffer;
  for (;;) {
    if (!wait_for_output(fd, limits, deadline)) {
      timed_out = true;
      ::kill(pid, SIGKILL);
      return tail;
    }
    const ssize_t n = ::read(fd, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return tail;
    tail.append(buffer.data(), static_cast<std::size_t>(n));
    if (tail.size() > 2 * kKeptOutput) tail.erase(0, tail.size() - kKeptOutput);
  }
}

int wait_for_exit(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

ChildResult run_child(const std::vector<std::string>& arguments, const ChildOptions& options) {
  ChildResult result;
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    result.output = std::strerror(errno);
    return result;
  }
  Actions actions;
  actions.set(options, ends[1]);
  const std::vector<std::string> command = limited(arguments, options.limits);
  std::vector<char*> argv;
  for (const std::string& a : command) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  pid_t pid = 0;
  const int error = ::posix_spawnp(&pid, argv[0], actions.get(), nullptr, argv.data(), environ);
  ::close(ends[1]);
  if (error != 0) {
    result.output = arguments[0] + ": " + std::strerror(error);
  } else {
    result.output = read_tail(ends[0], pid, options.limits, result.timed_out);
    result.exit_code = wait_for_exit(pid);
    result.started = command.size() == arguments.size() || result.exit_code != kNoSuchProgram;
    result.timed_out =
        result.timed_out || (options.limits.seconds > 0 &&
                             (result.exit_code == 128 + SIGXCPU || result.exit_code == 128 + SIGKILL));
  }
  ::close(ends[0]);
  return result;
}

std::string ChildResult::reason(int lines) const {
  std::vector<std::string> kept;
  std::istringstream in(output);
  for (std::string line; std::getline(in, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) kept.push_back(line);
  if (kept.empty()) return "exit code " + std::to_string(exit_code);
  const std::size_t first = kept.size() > static_cast<std::size_t>(lines) ? kept.size() - lines : 0;
  std::string joined = kept[first];
  for (std::size_t i = first + 1; i < kept.size(); ++i) joined += " | " + kept[i];
  return joined;
}

}  // namespace talisman::sequences
