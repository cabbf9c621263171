// SPDX-License-Identifier: Apache-2.0
// The tool: one program, a few commands. Everything it does is in the libraries, its words are in
// command_tree.cpp; here are signals, errors and exit codes.
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>

#include <oneapi/tbb/global_control.h>
#include <CLI/CLI.hpp>
#include "sequences/commands/accuracy.h"
#include "sequences/commands/cache_options.h"
#include "sequences/commands/command_tree.h"
#include "sequences/commands/export_command.h"
#include "sequences/commands/inspect.h"
#include "sequences/commands/inspect/inspect_order.h"
#include "sequences/commands/options.h"
#include "sequences/commands/parse_error.h"
#include "sequences/commands/run_words.h"
#include "sequences/commands/stop.h"
#include "sequences/commands/version.h"
#include "sequences/commands/warps.h"
#include "sequences/files/freed_memory.h"
#include "sequences/files/terminal_text.h"
#include "sequences/pictures/diff.h"

namespace {

using namespace talisman::sequences;

std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

extern "C" void on_stop_signal(int signal) {
  stop_requested = true;
  if (heeds_stop) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

int fail(const std::string& what, int code) {
  std::fprintf(stderr, "error: %s\n", harmless(what, true).c_str());
  return code;
}

/// The exit code of a command that ended with `code`: what it printed must have arrived.
int finish(int code) {
  warn_of_cache();
  std::cout.flush();
  const bool flushed = std::fflush(stdout) == 0;
  const std::string why = flushed ? "" : std::string(": ") + std::strerror(errno);
  if (flushed && std::cout && !std::ferror(stdout)) return code;
  return fail("standard output: cannot be written" + why, kFailed);
}

int run(int argc, char** argv) {
  CommandTree tree(stop_requested);
  if (argc == 1) {
    std::cout << tree.app().help();
    return finish(kBadInput);
  }
  try {
    tree.app().parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return finish(tree.app().exit(asked));
  } catch (const CLI::ParseError& error) {
    return fail(explained(tree.app(), error), kBadInput);
  }
  return finish(tree.exit_code());
}

}  // namespace

int main(int argc, char** argv) try {
  keep_freed_memory();
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGINT, on_stop_signal);
  std::signal(SIGTERM, on_stop_signal);
  use_asked_instruction_set();
  use_asked_job_order();
  return run(argc, argv);
} catch (const InputError& error) {
  return fail(error.what(), kBadInput);
} catch (const PartialResult& error) {
  return fail(error.what(), kPartialResult);
} catch (const std::exception& error) {
  return fail(error.what(), kFailed);
}
