// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A sequence whose first `Room` elements need no memory of their own: for the few points of one layer, of
/// which every frame makes some and forgets them again. Longer ones move to the heap, so no length is wrong.
///
/// Elements are plain values (trivially copyable): growing and copying is copying bytes, and the room that is
/// not used is never written. A contiguous range, and as such a std::span.

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>
#include <type_traits>

namespace talisman::layers {

template <typename T, std::size_t Room>
class InlineVector {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  using value_type = T;
  using const_iterator = const T*;
  using iterator = T*;

  InlineVector() noexcept {}
  InlineVector(std::initializer_list<T> values) { append({values.begin(), values.size()}); }
  explicit InlineVector(std::span<const T> values) { append(values); }
  InlineVector(const InlineVector& other) { append(other); }
  InlineVector& operator=(const InlineVector& other) {
    if (this == &other) return *this;
    clear();
    append(other);
    return *this;
  }

  T* data() { return heap_ ? heap_.get() : room_; }
  const T* data() const { return heap_ ? heap_.get() : room_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }
  T& operator[](std::size_t i) { return data()[i]; }
  const T& operator[](std::size_t i) const { return data()[i]; }
  T& front() { return data()[0]; }
  const T& front() const { return data()[0]; }
  T& back() { return data()[size_ - 1]; }
  const T& back() const { return data()[size_ - 1]; }

  void clear() { size_ = 0; }
  void pop_back() { --size_; }
  /// Only to fewer elements.
  void truncate(std::size_t size) { size_ = std::min(size_, size); }
  void reserve(std::size_t capacity) {
    if (capacity > capacity_) grow(capacity);
  }
  void push_back(const T& value) {
    const T copy = value;  // it may lie in what is moved
    if (size_ == capacity_) grow(2 * capacity_);
    data()[size_++] = copy;
  }
  /// `values` are of another sequence.
  void append(std::span<const T> values) {
    reserve(size_ + values.size());
    std::copy(values.begin(), values.end(), end());
    size_ += values.size();
  }

  friend bool operator==(const InlineVector& a, std::span<const T> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  void grow(std::size_t capacity) {
    std::unique_ptr<T[]> larger(new T[capacity]);
    std::copy(begin(), end(), larger.get());
    heap_ = std::move(larger);
    capacity_ = capacity;
  }

  std::size_t size_ = 0, capacity_ = Room;
  std::unique_ptr<T[]> heap_;
  union {
    T room_[Room];
  };
};

}  // namespace talisman::layers
