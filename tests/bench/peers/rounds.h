// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Several ways to do one job, timed side by side.
///
/// In each round every contender runs once, in turn, every other round backwards: what else the machine does falls on
/// all of them. Processor time is that of the whole process, threads included; on a machine that is not quiet it says
/// more than the clock. One JSON line per contender goes to the standard output, tests/bench/run makes the table.

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace talisman::bench {

/// Does the picture (or the fit) agree with the oracle?
struct Agreement {
  bool agrees = true;
  std::string words;  ///< by how much: "52.1 dB, worst 1"
};

struct Contender {
  std::string name;
  std::function<void()> run;
  std::function<Agreement()> check = {};  ///< of what the last run made; empty: there is nothing to compare
};

struct Job {
  std::string name;
  double work = 0;   ///< of one run, 0: only times are told
  std::string unit;  ///< of the work: "Mpx"
};

/// Runs `rounds` ≥ 1 rounds after one that is not counted, then the checks, and prints.
void run_rounds(const Job& job, const std::vector<Contender>& contenders, int rounds);

/// Mean square and largest difference of two pictures of bytes, which have the same length. Agreement: at least
/// `least_db`.
Agreement compare_bytes(const std::vector<unsigned char>& a, const std::vector<unsigned char>& b,
                        double least_db);

/// The program PROGRAM ROUNDS [JOB ...]: runs each job, `fallback` where none is named; 2 where that cannot be done.
int run_program(std::span<char* const> arguments, const std::string& program, const std::string& job_in_words,
                const std::vector<std::string>& fallback,
                const std::function<void(const std::string& job, int rounds)>& run_job);

/// Limits the tasks of oneTBB to `threads` while it runs `f`.
std::function<void()> on_threads(int threads, std::function<void()> f);

}  // namespace talisman::bench
