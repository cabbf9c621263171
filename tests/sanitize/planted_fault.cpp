// SPDX-License-Identifier: Apache-2.0
// Faults that a sanitizer has to find: a build in which it does not is not the build that it is taken for.
//   planted_fault overflow | cast | race
#include <cstdio>
#include <cstring>
#include <thread>
#include <vector>

namespace {

/// Reads one past the end of a vector's memory (address).
int overflow(int size) {
  std::vector<int> numbers(size, 1);
  const int* first = numbers.data();
  return first[size];
}

/// 1e30 is no int (undefined, float-cast-overflow).
int cast(double value) { return static_cast<int>(value * 1e30); }

/// Two threads count in one place (thread).
int race() {
  int count = 0;
  const auto add = [&count] {
    for (int i = 0; i < 10'000; ++i) ++count;
  };
  std::thread other(add);
  add();
  other.join();
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  const char* fault = argc > 1 ? argv[1] : "";
  int result = 0;
  if (std::strcmp(fault, "overflow") == 0)
    result = overflow(argc + 5);
  else if (std::strcmp(fault, "cast") == 0)
    result = cast(argc);
  else if (std::strcmp(fault, "race") == 0)
    result = race();
  else
    return std::fprintf(stderr, "usage: planted_fault overflow | cast | race\n"), 2;
  std::printf("%s went by unnoticed: %d\n", fault, result);
  return 0;
}
