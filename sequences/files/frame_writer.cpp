// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/frame_writer.h"

#include <utility>

#include "layers/check.h"

namespace talisman::sequences {

FrameWriter::FrameWriter(std::size_t capacity) : capacity_(capacity) {
  TALISMAN_CHECK_GE(capacity, std::size_t{1});
  thread_ = std::thread([this] { work(); });
}

FrameWriter::~FrameWriter() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  thread_.join();
}

void FrameWriter::wait_for_room(std::unique_lock<std::mutex>& lock) {
  changed_.wait(lock, [this] { return waiting_.size() < capacity_ || failure_; });
  rethrow_failure();
}

void FrameWriter::submit(Job job) {
  std::promise<Job> ready;
  ready.set_value(std::move(job));
  std::unique_lock lock(mutex_);
  wait_for_room(lock);
  waiting_.push_back(ready.get_future());
  changed_.notify_all();
}

void FrameWriter::submit_prepared(Preparation prepare) {
  std::unique_lock lock(mutex_);
  wait_for_room(lock);
  waiting_.push_back(std::async(std::launch::async, std::move(prepare)));
  changed_.notify_all();
}

void FrameWriter::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return (waiting_.empty() && !busy_) || failure_; });
  rethrow_failure();
}

void FrameWriter::rethrow_failure() {
  if (failure_) std::rethrow_exception(failure_);
}

void FrameWriter::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return !waiting_.empty() || stopping_; });
    if (stopping_) return;
    std::future<Job> next = std::move(waiting_.front());
    waiting_.pop_front();
    busy_ = true;
    lock.unlock();
    changed_.notify_all();  // there is room for the next
    std::exception_ptr failure;
    try {
      next.get()();  // and its picture is given back before anyone is told that it is done
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    busy_ = false;
    if (failure) {
      failure_ = failure;
      waiting_.clear();
    }
    changed_.notify_all();
    if (failure) return;
  }
}

}  // namespace talisman::sequences
