// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers/rounds.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <iterator>
#include <utility>

#include <tbb/global_control.h>
#include <nlohmann/json.hpp>

namespace talisman::bench {
namespace {

double process_cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

struct Times {
  std::vector<double> cpu_ms, wall_ms;
};

void run_once(const Contender& contender, Times* times) {
  using Clock = std::chrono::steady_clock;
  const double cpu = process_cpu_ms();
  const auto wall = Clock::now();
  contender.run();
  const std::chrono::duration<double, std::milli> taken = Clock::now() - wall;
  if (times == nullptr) return;
  times->cpu_ms.push_back(process_cpu_ms() - cpu);
  times->wall_ms.push_back(taken.count());
}

}  // namespace

void run_rounds(const Job& job, const std::vector<Contender>& contenders, int rounds) {
  std::vector<Times> times(contenders.size());
  for (int round = -1; round < rounds; ++round) {
    for (std::size_t k = 0; k < contenders.size(); ++k) {
      const std::size_t which = round % 2 == 0 ? k : contenders.size() - 1 - k;
      run_once(contenders[which], round < 0 ? nullptr : &times[which]);
    }
  }
  for (std::size_t k = 0; k < contenders.size(); ++k) {
    nlohmann::json line = {{"job", job.name},           {"contender", contenders[k].name},
                           {"work", job.work},          {"unit", job.unit},
                           {"cpu_ms", times[k].cpu_ms}, {"wall_ms", times[k].wall_ms}};
    if (contenders[k].check) {
      contenders[k].run();
      const Agreement agreement = contenders[k].check();
      line["agrees"] = agreement.agrees;
      line["agreement"] = agreement.words;
    }
    std::printf("%s\n", line.dump().c_str());
    std::fflush(stdout);
  }
}

Agreement compare_bytes(const std::vector<unsigned char>& a, const std::vector<unsigned char>& b,
                        double least_db) {
  double squares = 0;
  int worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const int difference = std::abs(static_cast<int>(a[i]) - static_cast<int>(b[i]));
    worst = std::max(worst, difference);
    squares += difference * difference;
  }
  if (worst == 0) return {true, "the same bytes"};
  const double db = 10 * std::log10(255.0 * 255.0 * static_cast<double>(a.size()) / squares);
  char words[64];
  std::snprintf(words, sizeof words, "%.1f dB, worst %d", db, worst);
  return {db >= least_db, words};
}

int run_program(std::span<char* const> arguments, const std::string& program, const std::string& job_in_words,
                const std::vector<std::string>& fallback,
                const std::function<void(const std::string& job, int rounds)>& run_job) {
  const int rounds = arguments.size() > 1 ? std::atoi(arguments[1]) : 0;
  if (rounds < 1) {
    std::fprintf(stderr, "usage: %s ROUNDS [%s ...]\n", program.c_str(), job_in_words.c_str());
    return 2;
  }
  try {
    std::vector<std::string> jobs(arguments.begin() + 2, arguments.end());
    for (const std::string& job : jobs.empty() ? fallback : jobs) run_job(job, rounds);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s: %s\n", program.c_str(), error.what());
    return 2;
  }
  return 0;
}

std::function<void()> on_threads(int threads, std::function<void()> f) {
  return [threads, f = std::move(f)] {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    f();
  };
}

}  // namespace talisman::bench
