// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/frame_writer.h"

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "sequences/files/errors.h"

namespace talisman::sequences {
namespace {

TEST(FrameWriter, JobsAreDoneInOrderAndOneAtATime) {
  std::vector<int> done;  // written by the writer alone until it has finished
  std::atomic<int> at_work = 0, most = 0;
  FrameWriter writer;
  for (int i = 0; i < 200; ++i)
    writer.submit([&, i] {
      most = std::max(most.load(), ++at_work);
      done.push_back(i);
      --at_work;
    });
  writer.finish();
  ASSERT_EQ(done.size(), 200u);
  for (int i = 0; i < 200; ++i) EXPECT_EQ(done[i], i);
  EXPECT_EQ(most, 1);
}

TEST(FrameWriter, SubmitWaitsWhileTheQueueIsFull) {
  std::promise<void> gate;
  std::shared_future<void> open = gate.get_future().share();
  std::atomic<int> submitted = 0;
  FrameWriter writer(2);
  std::thread producer([&] {
    for (int i = 0; i < 6; ++i) {
      writer.submit([open] { open.wait(); });
      ++submitted;
    }
  });
  // One at work and two that wait; the fourth call cannot return while the gate is shut, however long we
  // look.
  while (submitted < 3) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(submitted, 3);
  gate.set_value();
  producer.join();
  writer.finish();
  EXPECT_EQ(submitted, 6);
}

TEST(FrameWriter, AFailureReachesTheCallerAndEndsTheWriting) {
  std::atomic<int> done = 0;
  FrameWriter writer(4);
  const auto submit_all = [&] {
    for (int i = 0; i < 50; ++i)
      writer.submit([&, i] {
        if (i == 3) throw OutputError("disk is full");
        ++done;
      });
    writer.finish();
  };
  try {
    submit_all();
    FAIL() << "nothing was thrown";
  } catch (const OutputError& error) {
    EXPECT_EQ(std::string(error.what()), "disk is full");
  }
  EXPECT_EQ(done, 3) << "what was before it is done, what is behind it is dropped";
  EXPECT_THROW(writer.submit([] {}), OutputError);
  EXPECT_THROW(writer.finish(), OutputError);
}

TEST(FrameWriter, AFailureOfTheLastJobIsSeenByFinish) {
  FrameWriter writer;
  writer.submit([] { throw OutputError("no space"); });
  EXPECT_THROW(writer.finish(), OutputError);
}

TEST(FrameWriter, GoesOnAfterFinish) {
  int done = 0;
  FrameWriter writer;
  writer.finish();  // nothing to do
  writer.submit([&] { ++done; });
  writer.finish();
  EXPECT_EQ(done, 1);
  writer.submit([&] { ++done; });
  writer.finish();
  EXPECT_EQ(done, 2);
}

TEST(FrameWriter, EndsWithoutFinishAndGivesBackWhatItHeld) {
  const auto picture = std::make_shared<int>(7);
  {
    FrameWriter writer(3);
    for (int i = 0; i < 3; ++i) writer.submit([picture] { std::this_thread::yield(); });
  }
  EXPECT_EQ(picture.use_count(), 1);
}

TEST(FrameWriter, PreparationsRunBesideEachOtherAndTheirJobsInOrder) {
  std::vector<int> done;  // written by the writer alone until it has finished
  std::promise<void> second_began;
  std::shared_future<void> begun = second_began.get_future().share();
  std::atomic<bool> met = false;
  FrameWriter writer;
  for (int i = 0; i < 100; ++i)
    writer.submit_prepared([&, i, begun]() -> FrameWriter::Job {
      if (i == 0) met = begun.wait_for(std::chrono::seconds(60)) == std::future_status::ready;
      if (i == 1) second_began.set_value();
      return [&done, i] { done.push_back(i); };
    });
  writer.finish();
  EXPECT_TRUE(met) << "the first was prepared alone";
  ASSERT_EQ(done.size(), 100u);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(done[i], i);
}

TEST(FrameWriter, AFailedPreparationEndsTheWritingAsItsJobWould) {
  std::atomic<int> done = 0;
  FrameWriter writer;
  const auto submit_all = [&] {
    for (int i = 0; i < 50; ++i)
      writer.submit_prepared([&, i]() -> FrameWriter::Job {
        if (i == 3) throw OutputError("no module");
        return [&done] { ++done; };
      });
    writer.finish();
  };
  EXPECT_THROW(submit_all(), OutputError);
  EXPECT_EQ(done, 3) << "what was before it is done, what is behind it is dropped";
  EXPECT_THROW(writer.submit_prepared([] { return FrameWriter::Job(); }), OutputError);
}

}  // namespace
}  // namespace talisman::sequences
