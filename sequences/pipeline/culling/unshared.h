// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Memory that only saves time: a copy of its owner begins without it.

#include <memory>

namespace talisman::sequences {

template <typename T>
class Unshared {
 public:
  Unshared() = default;
  Unshared(const Unshared&) {}
  Unshared(Unshared&&) noexcept = default;
  Unshared& operator=(const Unshared& other) {
    if (this != &other) memory_.reset();
    return *this;
  }
  Unshared& operator=(Unshared&&) noexcept = default;
  ~Unshared() = default;

  void make() { memory_ = std::make_shared<T>(); }
  explicit operator bool() const { return memory_ != nullptr; }
  T& operator*() const { return *memory_; }
  T* operator->() const { return memory_.get(); }

 private:
  std::shared_ptr<T> memory_;  ///< shared with nobody; T need not be known where the owner is
};

}  // namespace talisman::sequences
