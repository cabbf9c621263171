// SPDX-License-Identifier: Apache-2.0
// The choice of levels of a frame (regulator/lod/solver.h): cold, where nothing has changed, and where a little has.
#include <cmath>
#include <random>

#include <benchmark/benchmark.h>

#include "regulator/lod/solver.h"

namespace {

using talisman::regulator::LodChoice;
using talisman::regulator::LodProblem;
using talisman::regulator::LodSolver;

/// Layers of five levels, each twice as dear as the one below, and gains that fall.
LodProblem levels_of(int layers, double share) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  LodProblem problem;
  double all = 0;
  for (int i = 0; i < layers; ++i) {
    const double cost = 0.05 + uniform(random), power = 0.3 + uniform(random);
    std::vector<LodChoice> choices;
    for (int k = 0; k < 5; ++k)
      choices.push_back({cost * std::pow(2, k - 4), cost * std::pow((k + 1) / 5.0, power)});
    all += cost;
    problem.add(choices);
  }
  problem.budget_ms = share * all;
  return problem;
}

void solve_cold(benchmark::State& state) {
  const LodProblem problem = levels_of(static_cast<int>(state.range(0)), 0.4);
  for (auto _ : state) benchmark::DoNotOptimize(talisman::regulator::solve(problem));
}
BENCHMARK(solve_cold)->Arg(100)->Arg(1000)->Arg(10'000)->Unit(benchmark::kMicrosecond);

void solve_unchanged(benchmark::State& state) {
  const LodProblem problem = levels_of(static_cast<int>(state.range(0)), 0.4);
  LodSolver solver;
  int iterations = solver.solve(problem).iterations;
  for (auto _ : state) {
    const auto solution = solver.solve(problem);
    iterations = solution.iterations;
    benchmark::DoNotOptimize(solution);
  }
  state.counters["iterations"] = iterations;
}
BENCHMARK(solve_unchanged)->Arg(100)->Arg(1000)->Arg(10'000)->Unit(benchmark::kMicrosecond);

/// Each frame two of the layers are worth something else.
void solve_changed(benchmark::State& state) {
  LodProblem problem = levels_of(static_cast<int>(state.range(0)), 0.4);
  LodSolver solver;
  std::size_t at = 0;
  for (auto _ : state) {
    for (int k = 0; k < 2; ++k) problem.choices[at++ * 7919 % problem.choices.size()].benefit *= 0.999;
    benchmark::DoNotOptimize(solver.solve(problem));
  }
}
BENCHMARK(solve_changed)->Arg(1000)->Unit(benchmark::kMicrosecond);

}  // namespace
