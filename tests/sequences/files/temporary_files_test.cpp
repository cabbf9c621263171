// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/temporary_files.h"

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <set>

#include <gtest/gtest.h>

#include "sequences/files/folders.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

Names files_in(const std::string& folder) {
  Names names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

std::string name_of(const std::string& path) { return fs::path(path).filename().string(); }

/// A process that makes a temporary name and does nothing more until it is ended.
class Writer {
 public:
  explicit Writer(const std::string& path) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    pid_ = fork();
    if (pid_ == 0) {
      const std::string name = temporary_name(path);
      if (write(ends[1], name.data(), name.size()) < 0) _exit(1);
      close(ends[1]);
      for (;;) pause();
    }
    close(ends[1]);
    char buffer[256];
    for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;)
      temporary_.append(buffer, static_cast<std::size_t>(n));
    close(ends[0]);
  }
  ~Writer() { collect(); }
  void kill() { ::kill(pid_, SIGKILL); }
  void collect() {
    if (pid_ <= 0) return;
    kill();
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }
  const std::string& temporary() const { return temporary_; }

 private:
  pid_t pid_ = -1;
  std::string temporary_;
};

TEST(TemporaryName, IsHiddenInTheSameFolderAndUnique) {
  const std::string a = temporary_name("/out/frames/0001.png"), b = temporary_name("/out/frames/0001.png");
  EXPECT_NE(a, b);
  EXPECT_EQ(fs::path(a).parent_path(), "/out/frames");
  EXPECT_EQ(name_of(a).rfind(".tmp-" + std::to_string(getpid()) + "-", 0), 0u) << a;
  EXPECT_EQ(fs::path(a).extension(), ".png");
}

TEST(RemoveAbandonedFiles, TakesThoseOfKilledProcessesAndNoOthers) {
  const tests::TemporaryFolder folder;
  const std::string target = folder.path() + "/0001.png";
  Writer killed(target), alive(target);
  const Names stay{"0001.png",     ".tmp-",      ".tmp-12-notes.txt",        ".hidden",    ".tmp-1-2-3",
                   ".tmp-x-1-1-a", ".tmp.-1-1-", name_of(alive.temporary()), "tmp-1-1-1-a"};
  for (const std::string& name : stay) folder.write(name, "kept");
  const std::string own = name_of(temporary_name(target));
  folder.write(own, "half");
  folder.write(name_of(killed.temporary()), "half");
  killed.collect();
  remove_abandoned_files(folder.path());
  Names expected = stay;
  expected.insert(own);
  EXPECT_EQ(files_in(folder.path()), expected);
}

TEST(RemoveAbandonedFiles, AKilledProcessThatNobodyHasCollectedIsGone) {
  const tests::TemporaryFolder folder;
  Writer killed(folder.path() + "/summary.json");
  folder.write(name_of(killed.temporary()), "half");
  killed.kill();
  siginfo_t info;
  const auto pid = static_cast<id_t>(std::stol(name_of(killed.temporary()).substr(5)));
  ASSERT_EQ(waitid(P_PID, pid, &info, WEXITED | WNOWAIT), 0);  // it has ended, and stays a zombie
  remove_abandoned_files(folder.path());
  EXPECT_EQ(files_in(folder.path()), Names{});
}

TEST(RemoveAbandonedFiles, ANumberThatAnotherProcessHasTodayIsNoSignOfLife) {
  // As in a container, where every run has the same number.
  const tests::TemporaryFolder folder;
  folder.write(".tmp-" + std::to_string(getpid()) + "-1-0-0001.png", "half");
  remove_abandoned_files(folder.path());
  EXPECT_EQ(files_in(folder.path()), Names{});
}

TEST(RemoveAbandonedFiles, FoldersAndLinksOfThatNameStay) {
  const tests::TemporaryFolder folder;
  fs::create_directory(folder.path() + "/.tmp-999999999-1-0-folder");
  fs::create_symlink("/nowhere", folder.path() + "/.tmp-999999999-1-0-link");
  remove_abandoned_files(folder.path());
  EXPECT_EQ(files_in(folder.path()).size(), 2u);
  remove_abandoned_files(folder.path() + "/no such folder");
}

TEST(PrepareFolder, OfAnyCommandIsFreeOfWhatAKilledOneLeft) {
  const tests::TemporaryFolder folder;
  const std::string out = folder.path() + "/maps";
  prepare_folder(out);
  folder.write("maps/0001.png", "kept");
  folder.write("maps/.tmp-999999999-1-0-0002.png", "half");
  prepare_folder(out);
  EXPECT_EQ(files_in(out), Names{"0001.png"});
}

}  // namespace
}  // namespace talisman::sequences
