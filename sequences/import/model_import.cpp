// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/model_import.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string_view>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <glm/geometric.hpp>

#include "sequences/files/program_folder.h"
#include "sequences/import/model_cache.h"
#include "sequences/import/scene_stream.h"

extern char** environ;

namespace talisman::sequences {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kKeptErrors = 64 * 1024;

/// Closes itself.
class PipeEnd {
 public:
  explicit PipeEnd(int fd = -1) : fd_(fd) {}
  ~PipeEnd() { close(); }
  PipeEnd(const PipeEnd&) = delete;
  PipeEnd& operator=(const PipeEnd&) = delete;
  void reset(int fd) {
    close();
    fd_ = fd;
  }
  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

struct Pipe {
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw OutputError(std::string("no pipe: ") + std::strerror(errno));
    read.reset(ends[0]);
    write.reset(ends[1]);
  }
  PipeEnd read, write;
};

/// Large arrays in pages of 2 MB where the machine has them, and kept for the next: an importer is gone before it would
/// give anything back, and most of its time was the kernel's, that of clearing pages of 4 kB (OBJ of 5 million
/// triangles: a third of the time is left). What the user has set himself stands.
constexpr const char* kImporterMemory =
    "GLIBC_TUNABLES=glibc.malloc.hugetlb=1:glibc.malloc.mmap_threshold=4294967296:"
    "glibc.malloc.trim_threshold=4294967296:glibc.malloc.top_pad=16777216";

std::vector<char*> importer_environment() {
  std::vector<char*> variables;
  bool is_set = false;
  for (char** variable = environ; *variable; ++variable) {
    is_set |= std::string_view(*variable).starts_with("GLIBC_TUNABLES=");
    variables.push_back(*variable);
  }
  if (!is_set) variables.push_back(const_cast<char*>(kImporterMemory));
  variables.push_back(nullptr);
  return variables;
}

/// The running child; it is killed and collected whatever happens.
class Child {
 public:
  Child(const std::vector<std::string>& arguments, Pipe& out, Pipe& errors) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, out.write.get(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, errors.write.get(), STDERR_FILENO);
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    // Its own process group: an interrupt from the terminal is for us, who decide what becomes of the child.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const std::vector<char*> variables = importer_environment();
    const int error = ::posix_spawn(&pid_, argv[0], &actions, &attributes, argv.data(), variables.data());
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0)
      throw OutputError(arguments[0] + ": " + std::strerror(error) + "; it is built with the tool");
    out.write.close();
    errors.write.close();
  }
  ~Child() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  /// The wait status.
  int wait() {
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return status;
  }

 private:
  pid_t pid_ = -1;
};

/// Wall time per processor time: the machine may have other work, and what it has must not decide what a file is.
constexpr int kPatience = 10;

struct Outcome {
  std::vector<std::uint8_t> bytes;
  std::string errors;
  bool timed_out = false, too_long = false;
  int status = 0;
};

/// Reads what is there. False at the end of the stream.
template <typename Bytes>
bool read_some(PipeEnd& fd, Bytes& into) {
  std::array<char, 65536> buffer;
  const ssize_t n = ::read(fd.get(), buffer.data(), buffer.size());
  if (n < 0 && errno == EINTR) return true;
  if (n <= 0) {
    fd.close();
    return false;
  }
  into.insert(into.end(), buffer.data(), buffer.data() + n);
  return true;
}

int milliseconds_until(Clock::time_point deadline) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
  return left > 0 ? static_cast<int>(left) : 0;
}

/// Both streams until both end, or until the deadline.
void drain(Pipe& out, Pipe& errors, const ImportLimits& limits, Outcome& outcome) {
  const auto deadline = Clock::now() + kPatience * std::chrono::seconds(limits.seconds);
  const std::size_t most = static_cast<std::size_t>(limits.megabytes) << 20;
  while (out.read.get() >= 0 || errors.read.get() >= 0) {
    pollfd fds[2] = {{out.read.get(), POLLIN, 0}, {errors.read.get(), POLLIN, 0}};
    const int ready = ::poll(fds, 2, milliseconds_until(deadline));
    if (ready < 0 && errno == EINTR) continue;
    outcome.timed_out = ready == 0;
    outcome.too_long = outcome.bytes.size() > most;
    if (ready <= 0 || outcome.too_long) return;
    if (fds[0].revents) read_some(out.read, outcome.bytes);
    if (fds[1].revents) read_some(errors.read, outcome.errors);
    if (outcome.errors.size() > kKeptErrors) outcome.errors.erase(0, outcome.errors.size() - kKeptErrors / 2);
  }
}

Outcome run(const std::vector<std::string>& arguments, const ImportLimits& limits) {
  Outcome outcome;
  Pipe out, errors;
  Child child(arguments, out, errors);
  drain(out, errors, limits, outcome);
  if (!outcome.timed_out && !outcome.too_long) outcome.status = child.wait();
  return outcome;
}

/// The text behind the last "error: " line; empty when there is none.
std::string last_error(const std::string& output) {
  std::istringstream lines(output);
  std::string found;
  for (std::string line; std::getline(lines, line);)
    if (line.rfind("error: ", 0) == 0) found = line.substr(7);
  return found;
}

/// What went wrong with the child, in words; empty when nothing did.
std::string failure(const Outcome& outcome, const ImportLimits& limits) {
  std::string too_slow = "takes longer to read than the limit of " + std::to_string(limits.seconds) +
                         " s of processor time (--import-limit-s)";
  if (outcome.timed_out) return too_slow;
  if (outcome.too_long)
    return "is larger than the limit of " + std::to_string(limits.megabytes) + " MB (--import-memory-mb)";
  if (WIFSIGNALED(outcome.status)) {
    const int signal = WTERMSIG(outcome.status);
    if (signal == SIGXCPU || signal == SIGKILL) return too_slow;
    return "crashed its reader (signal " + std::to_string(signal) + ", " + ::strsignal(signal) + ")";
  }
  if (WEXITSTATUS(outcome.status) == kSuccess) return {};
  const std::string why = last_error(outcome.errors);
  return why.empty() ? "its reader failed with exit code " + std::to_string(WEXITSTATUS(outcome.status))
                     : why;
}

ImportLimits& the_limits() {
  static ImportLimits limits;
  return limits;
}

/// Nothing of such a triangle is ever drawn; of a needle of less than 1e-7 of its length there is as little to see.
bool has_area(const layers::Mesh& mesh, std::size_t first_index) {
  constexpr double kNeedle = 1e-7;
  layers::dvec3 p[3];
  for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.positions[mesh.indices[first_index + k]];
  const layers::dvec3 a = p[1] - p[0], b = p[2] - p[0], c = p[2] - p[1];
  const double longest2 = std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
  return glm::length(glm::cross(a, b)) > kNeedle * longest2;
}

/// What deforms may have area later.
void warn_of_no_area(ImportedModel& model) {
  if (!model.scene.skins.empty()) return;
  std::size_t triangles = 0;
  for (const layers::Part& part : model.scene.parts) {
    const layers::Mesh& mesh = model.scene.meshes[static_cast<std::size_t>(part.mesh)];
    if (!mesh.morphs.empty()) return;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      if (has_area(mesh, i)) return;
    triangles += mesh.indices.size() / 3;
  }
  if (triangles == 0) return;
  model.warnings.push_back(triangles == 1 ? "its only triangle has no area"
                                          : "all " + std::to_string(triangles) + " triangles have no area");
}

}  // namespace

const ImportLimits& import_limits() { return the_limits(); }
void use_import_limits(const ImportLimits& limits) { the_limits() = limits; }

std::vector<std::string> files_read(const ImportedModel& model) {
  std::vector<std::string> files;
  for (const FileUse& use : model.files)
    if (use.kind == FileUse::Kind::Content) files.push_back(use.path);
  return files;
}

ImportedModel import_model(const std::string& path, const ImportLimits& limits,
                           const std::vector<std::string>& folders) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw InputError(std::filesystem::exists(path, error) ? "is not a file" : "does not exist", path);
  const std::string reader = importer_program();
  const CachedModel cached(path, limits, reader, folders);
  if (auto model = cached.find()) {
    warn_of_no_area(*model);
    return std::move(*model);
  }
  std::vector<std::string> arguments = {reader, path, std::to_string(limits.seconds),
                                        std::to_string(limits.megabytes)};
  arguments.insert(arguments.end(), folders.begin(), folders.end());
  const Outcome outcome = run(arguments, limits);
  if (const std::string what = failure(outcome, limits); !what.empty()) throw InputError(what, path);
  try {
    ImportedModel model = model_from_bytes(outcome.bytes);
    cached.keep(outcome.bytes, model);
    warn_of_no_area(model);
    return model;
  } catch (const InputError& e) {
    throw InputError(e.what(), path);
  }
}

}  // namespace talisman::sequences
