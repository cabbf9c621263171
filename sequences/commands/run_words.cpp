// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/run_words.h"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "sequences/files/errors.h"

namespace talisman::sequences {

void add_run_options(CLI::App& command, CommandLine& line) {
  command
      .add_option("sequence", line.sequence, "name of a sequence, path of its YAML file, or path of a model")
      ->required();
  command.add_option("--out", line.out, "result folder (out/<name>; plans: out/<name>-plan)");
  command.add_option("--frames", line.frames, "A-B, inclusive; the frames are those of the full run");
  command.add_option("--policy", line.policy,
                     "direct, reference, hold, interpolate, threshold, budget, lookahead or oracle");
  command.add_option("--geometric-px", line.geometric_px,
                     "threshold of the geometric fiducial, pixels; 0: reuse only what is identical");
  command.add_option("--photometric", line.photometric,
                     "threshold of the photometric fiducial, linear light, 1 is white; 0: not regulated");
  command.add_option("--light-angle-deg", line.light_angle_deg,
                     "threshold of the angle by which a light moves about a layer; 0: not regulated");
  command.add_option("--turned-px", line.turned_px,
                     "threshold of the size of a side that has turned to the eye, pixels; 0: not regulated");
  command.add_option("--color-warp", line.color_warp, "on, or off: as hardware without colour multipliers");
  command.add_option("--hold", line.hold, "N of the policies hold and interpolate");
  command.add_option("--lookahead", line.lookahead,
                     "N of the policy lookahead: frames ahead as of which a sprite may be drawn");
  command.add_option("--budget-polygons", line.budget_polygons,
                     "policy budget: triangles per frame; only first appearances may exceed it");
  command.add_option("--budget-pixels", line.budget_pixels,
                     "policy budget: sprite texels per frame, likewise");
  command.add_option("--budget-chunks", line.budget_chunks,
                     "policy budget: 32x32 chunks of sprites per frame, likewise");
  command.add_option("--budget-ms", line.budget_ms,
                     "policy budget: modelled render time per frame on talisman-1996, likewise");
  command.add_option("--min-resolution", line.min_resolution,
                     "policy budget: least resolution of sprites that must fit, (0, 1]; 1: never lowered");
  command.add_flag("--budget-gap", line.budget_gap,
                   "policy budget: also report the best choice of each frame, and what greedy misses");
  command.add_option("--predict", line.predict,
                     "policy lookahead: frames ahead are known, or linear: extrapolated from the last two");
  command.add_option("--cutoff-px", line.cutoff_px,
                     "policy budget: benefit up to which a layer is not drawn again, pixels");
  command.add_option("--warp", line.warp,
                     "warp curve: trn trni iso isoi so soi aff affi per peri per2 per2i pers pers2");
  command.add_option("--size", line.size, "display, WxH pixels");
  command.add_option("--bound", line.bound, "characteristic polyhedron: box8, dop14 or dop26");
  command.add_option(
      "--cycles", line.cycles,
      "layers that occlude each other in a cycle: merge (into one sprite) or keep (may be wrong)");
  command.add_option(
      "--compositor", line.compositor,
      "talisman: over only; extended: also out and plus with two image registers, so that layers "
      "that go round are not merged unless two of them meet");
  command.add_option("--expected-reuse", line.expected_reuse,
                     "frames for which clipped sprites are enlarged");
  command.add_option("--threads", line.threads,
                     "worker threads; 0: all cores. The bytes do not depend on it");
  command.add_option("--progress", line.progress, "auto, bar, plain or none");
}

void add_picture_options(CLI::App& command, CommandLine& line) {
  command.add_option("--format", line.format, "png, exr or none");
  command.add_option("--shading", line.shading, "flat, gouraud or phong");
  command.add_option("--resolution", line.resolution, "sprite texels per display pixel, each axis");
  command.add_option("--compression", line.compression,
                     "keep sprites compressed: quality 1 to 100 (about 10:1 at 85), 0: none");
  command.add_flag("--video", line.video, "also write video.mp4");
  command.add_flag("--separate", line.separate,
                   "also write each shade sprite alone, and the sum with its base (DIR/separate)");
  command.add_flag("--overlay", line.overlay, "draw each sprite's outline, coloured by age");
  command.add_flag("--quality", line.quality,
                   "PSNR, SSIM and FLIP of each frame against reference and direct (slow)");
  command.add_flag("--resume", line.resume, "continue a run that was stopped");
}

CommandLine command_line_from(const std::string& sequence, std::vector<std::string> words, bool plan_only) {
  CommandLine line;
  CLI::App app;
  add_run_options(app, line);
  if (!plan_only) add_picture_options(app, line);
  words.insert(words.end(), {"--", sequence});  // whatever it begins with
  std::reverse(words.begin(), words.end());     // as CLI11 takes them
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    throw InputError(error.what());
  }
  return line;
}

}  // namespace talisman::sequences
