// SPDX-License-Identifier: Apache-2.0
// How long does a stack of sprites take to composite, for us and for others?
//
//   composite_peers ROUNDS [SPRITES/DEPTH[/unwarped] ...]    prints what tests/bench/run reads
//
// A job is named by the number of sprites and by how many displays their rectangles fill. "ours, …" are other
// threads and instruction sets; all of ours must give the bytes of chunker::reference.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "chunker/reference.h"
#include "chunker/span_composite.h"
#include "tests/bench/peers/compositors.h"
#include "tests/bench/peers/rounds.h"

namespace talisman::bench {
namespace {

struct StackJob {
  int sprites = 80, displays = 4;
  bool unwarped = false;
};

StackJob parse(const std::string& name) {
  StackJob job;
  char rest[16] = "";
  const int read = std::sscanf(name.c_str(), "%d/%d/%15s", &job.sprites, &job.displays, rest);
  job.unwarped = std::string(rest) == "unwarped";
  if (read < 2 || job.sprites < 1 || job.displays < 1 || (read == 3 && !job.unwarped))
    throw std::runtime_error("'" + name + "' is no job, must be SPRITES/DEPTH or SPRITES/DEPTH/unwarped");
  return job;
}

/// Ours on one and two threads; with `every_set` on each instruction set, too.
std::vector<Contender> ours(const SpriteStack& stack, chunker::Frame& frame, bool every_set) {
  const auto draw = [&stack, &frame] { chunker::composite_into(frame, stack.placed, kDisplay, kBackground); };
  const auto check = [&stack, &frame] {
    const bool same = frame == chunker::reference::composite(stack.placed, kDisplay, kBackground);
    return Agreement{same, same ? "the same bytes" : "other bytes than the reference"};
  };
  std::vector<Contender> all = {{"ours", on_threads(1, draw), check},
                                {"ours, 2 threads", on_threads(2, draw), check}};
  if (!every_set) return all;
  for (const std::int64_t set : chunker::instruction_sets()) {
    const auto draw_on_set = [draw, set] {
      chunker::use_instruction_set(set);
      draw();
      chunker::use_instruction_set(0);
    };
    all.push_back(
        {std::string("ours, ") + chunker::instruction_set_name(set), on_threads(1, draw_on_set), check});
  }
  return all;
}

void run_job(const std::string& name, int rounds) {
  const StackJob job = parse(name);
  const SpriteStack stack = make_sprite_stack(job.sprites, job.displays, job.unwarped);
  chunker::Frame frame;
  ArgbFrame peer_frame(static_cast<std::size_t>(kDisplay.x) * kDisplay.y);
  std::vector<Contender> contenders = ours(stack, frame, name == "80/4");
  [[maybe_unused]] const auto add_peer = [&](const char* peer, std::function<void()> run) {
    const auto check = [&] { return compare_bytes(bytes_of(peer_frame), exact_composite(stack), 40); };
    contenders.push_back({peer, std::move(run), check});
  };
#ifdef TALISMAN_PEER_QT5
  add_peer("Qt5", qt5_compositor(stack, peer_frame));
#endif
#ifdef TALISMAN_PEER_PIXMAN
  add_peer("pixman", pixman_compositor(stack, peer_frame));
#endif
#ifdef TALISMAN_PEER_OPENCV
  add_peer("OpenCV", opencv_compositor(stack, peer_frame));
#endif
  const auto pixels = chunker::composite_into(frame, stack.placed, kDisplay, kBackground).pixels_composited;
  run_rounds({"composite " + name, 1e-6 * static_cast<double>(pixels), "Mpx"}, contenders, rounds);
}

}  // namespace
}  // namespace talisman::bench

int main(int argc, char** argv) {
  return talisman::bench::run_program({argv, static_cast<std::size_t>(argc)}, "composite_peers",
                                      "SPRITES/DEPTH[/unwarped]", {"80/4", "119/4"},
                                      talisman::bench::run_job);
}
