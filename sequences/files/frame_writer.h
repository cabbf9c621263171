// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Writing frames while the next ones are drawn.
///
/// Encoding a picture takes about as long as drawing it, and one thread only. So frames go, in order, through
/// a short queue to a thread of their own; and what needs no order, as encoding, may be prepared beside it, the
/// frames of the queue at one time. What a job does for one frame is done whole before that of the
/// next begins: first the picture gets its final name, then its line is written. So a run may be killed at
/// any moment and still every line speaks of a picture that is there.
///
/// A job that throws ends the writing: it and all jobs behind it are dropped, and the next call of `submit`
/// or `finish` throws what it threw, in the caller's thread.

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <mutex>
#include <thread>

namespace talisman::sequences {

class FrameWriter {
 public:
  using Job = std::function<void()>;
  using Preparation = std::function<Job()>;

  /// At most `capacity` ≥ 1 jobs wait, besides the one at work. More evens out frames that take long to draw;
  /// each holds a picture in memory (8 bytes per pixel).
  explicit FrameWriter(std::size_t capacity = 2);
  /// Drops what waits; the job at work is finished.
  ~FrameWriter();
  FrameWriter(const FrameWriter&) = delete;
  FrameWriter& operator=(const FrameWriter&) = delete;

  /// Waits while the queue is full.
  void submit(Job job);
  /// The same of the job that `prepare` returns. That begins at once, in a thread of its own; what it throws counts as
  /// thrown by the job.
  void submit_prepared(Preparation prepare);
  /// Waits until all jobs are done. More may be submitted afterwards.
  void finish();

 private:
  void work();
  void wait_for_room(std::unique_lock<std::mutex>& lock);
  void rethrow_failure();

  std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::future<Job>> waiting_;
  bool busy_ = false, stopping_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  ///< last: it uses all the others
};

}  // namespace talisman::sequences
