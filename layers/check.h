// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Programmer mistakes. A failed CHECK prints the expression, both values where there are two, and the place, and
/// aborts. It is never used for numeric outcomes (those are statuses in results) nor for user input (those are
/// exceptions of the readers in sequences/).

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

namespace talisman::layers {

[[noreturn]] inline void check_failed(const char* file, int line, const std::string& what) {
  std::fprintf(stderr, "%s:%d: check failed: %s\n", file, line, what.c_str());
  std::abort();
}

template <typename A, typename B>
std::string both_values(const char* expression, const A& a, const B& b) {
  std::ostringstream out;
  out << expression << " (" << a << " against " << b << ")";
  return out.str();
}

}  // namespace talisman::layers

#define TALISMAN_CHECK(condition)                                                       \
  do {                                                                                  \
    if (!(condition)) ::talisman::layers::check_failed(__FILE__, __LINE__, #condition); \
  } while (false)
#define TALISMAN_CHECK_OP(a, op, b)                                                                   \
  do {                                                                                                \
    if (!((a)op(b)))                                                                                  \
      ::talisman::layers::check_failed(__FILE__, __LINE__,                                            \
                                       ::talisman::layers::both_values(#a " " #op " " #b, (a), (b))); \
  } while (false)
#define TALISMAN_CHECK_EQ(a, b) TALISMAN_CHECK_OP(a, ==, b)
#define TALISMAN_CHECK_LT(a, b) TALISMAN_CHECK_OP(a, <, b)
#define TALISMAN_CHECK_LE(a, b) TALISMAN_CHECK_OP(a, <=, b)
#define TALISMAN_CHECK_GE(a, b) TALISMAN_CHECK_OP(a, >=, b)
