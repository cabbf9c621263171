// SPDX-License-Identifier: Apache-2.0
// confined_child WORD FILE: confines itself as a reader of models does, then tries what WORD says. Prints "done", or why not.
#include <arpa/inet.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <thread>

#include "sequences/import/confinement.h"

namespace {

int forked() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  return static_cast<int>(child);
}

int executed() {
  char* const words[] = {const_cast<char*>("true"), nullptr};
  return ::execv("/bin/true", words);
}

int with_a_thread() {
  int sum = 0;
  std::thread([&sum] { sum = 1; }).join();
  return sum == 1 ? 0 : -1;
}

int tried(const std::string& word, const char* file) {
  if (word == "socket") return ::socket(AF_INET, SOCK_STREAM, 0);
  if (word == "local socket") return ::socket(AF_UNIX, SOCK_STREAM, 0);
  if (word == "fork") return forked();
  if (word == "exec") return executed();
  if (word == "creat") return ::creat(file, 0666);
  if (word == "open to write") return ::open(file, O_WRONLY);
  if (word == "open to make") return ::open(file, O_RDONLY | O_CREAT, 0666);
  if (word == "mkdir") return ::mkdir(file, 0777);
  if (word == "rename") return ::rename(file, (std::string(file) + ".new").c_str());
  if (word == "unlink") return ::unlink(file);
  if (word == "kill") return ::kill(::getppid(), 0);
  if (word == "thread") return with_a_thread();
  if (word == "read") return ::open(file, O_RDONLY);
  std::fprintf(stderr, "error: '%s' is nothing to try\n", word.c_str());
  std::exit(2);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const std::string why = talisman::sequences::confine(10, 4096);
  if (!why.empty()) {
    std::printf("no filter: %s\n", why.c_str());
    return 77;
  }
  errno = 0;
  const bool is_done = tried(argv[1], argv[2]) >= 0;
  std::printf("%s\n", is_done ? "done" : std::strerror(errno));
  return 0;
}
