// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/run_words.h"

#include <algorithm>

#include "sequences/commands/option_group.h"
#include "sequences/commands/parse_error.h"
#include "sequences/commands/words.h"
#include "sequences/files/errors.h"

namespace talisman::sequences {
namespace {

const std::string kProgressMeaning = alternatives(kProgressWords);
const std::string kBoundMeaning = "characteristic polyhedron: " + alternatives(kBoundWords);

void add_sequence(CLI::App& command, CommandLine& line) {
  command
      .add_option("sequence", line.sequence, "name of a sequence, path of its YAML file, or path of a model")
      ->required();
}

void add_run(CLI::App& command, CommandLine& line) {
  add_sequence(command, line);
  OptionGroup(command, "Run")
      .option("--out", line.out, "result folder (out/<name>; plans: out/<name>-plan)")
      .option("--frames", line.frames, "A-B, inclusive; the frames are those of the full run")
      .option("--size", line.size, "display, WxH pixels")
      .option("--threads", line.threads, "worker threads; 0: all cores. The bytes do not depend on it")
      .option("--progress", line.progress, kProgressMeaning)
      .flag("--quiet", line.quiet, "no progress and no table; warnings and errors alone")
      .flag("--force", line.force, "write into --out though it holds files that are not of a run");
}

void add_policy(CLI::App& command, CommandLine& line) {
  OptionGroup(command, "Policy")
      .option("--policy", line.policy, alternatives(kPolicyWords))
      .option("--hold", line.hold, "N of the policies hold and interpolate")
      .option("--lookahead", line.lookahead,
              "N of the policy lookahead: frames ahead as of which a sprite may be drawn")
      .option("--predict", line.predict,
              "policy lookahead: frames ahead are known, or linear: extrapolated from the last two");
}

void add_thresholds(CLI::App& command, CommandLine& line) {
  OptionGroup(command, "Thresholds")
      .option("--geometric-px", line.geometric_px,
              "threshold of the geometric fiducial, pixels; 0: reuse only what is identical")
      .option("--photometric", line.photometric,
              "threshold of the photometric fiducial, linear light, 1 is white; 0: not regulated")
      .option("--light-angle-deg", line.light_angle_deg,
              "threshold of the angle by which a light moves about a layer; 0: not regulated")
      .option("--shadow-map-px", line.shadow_map_px,
              "how far shadows may be off because their map is old, pixels; 0: maps are never old")
      .option("--turned-px", line.turned_px,
              "threshold of the size of a side that has turned to the eye, pixels; 0: not regulated");
}

void add_budget(CLI::App& command, CommandLine& line) {
  OptionGroup(command, "Budget")
      .option("--budget-polygons", line.budget_polygons,
              "policy budget: triangles per frame; only first appearances may exceed it")
      .option("--budget-pixels", line.budget_pixels, "policy budget: sprite texels per frame, likewise")
      .option("--budget-chunks", line.budget_chunks,
              "policy budget: 32x32 chunks of sprites per frame, likewise")
      .option("--budget-ms", line.budget_ms,
              "policy budget: modelled render time per frame on talisman-1996, likewise")
      .option("--min-resolution", line.min_resolution,
              "policy budget: least resolution of sprites that must fit, (0, 1]; 1: never lowered")
      .option("--cutoff-px", line.cutoff_px,
              "policy budget: benefit up to which a layer is not drawn again, pixels")
      .option("--choice", line.choice,
              "policy budget: paper (by benefit over cost) or best (never worse, half the best at least)")
      .option(
          "--depth-complexity", line.depth_complexity,
          "policy budget: pixels filled per texel, by which those of --budget-ms are divided; 0: measured")
      .flag("--budget-gap", line.budget_gap,
            "policy budget: also report the best choice of each frame, and what the choice misses");
}

void add_layers(CLI::App& command, CommandLine& line) {
  OptionGroup(command, "Layers")
      .option("--warp", line.warp,
              "warp curve: trn trni iso isoi so soi aff affi per peri per2 per2i pers pers2")
      .option("--color-warp", line.color_warp, "on, or off: as hardware without colour multipliers")
      .option("--bound", line.bound, kBoundMeaning)
      .option("--material-points", line.material_points,
              "samples of the surface of each body that deforms or whose light is followed, 0 to 1024")
      .option("--cycles", line.cycles,
              "layers that occlude each other in a cycle: merge (into one sprite) or keep (may be wrong)")
      .option("--compositor", line.compositor,
              "talisman: over only; extended: also out and plus with two image registers, so that layers "
              "that go round are not merged unless two of them meet")
      .option("--expected-reuse", line.expected_reuse, "frames for which clipped sprites are enlarged");
}

void add_pictures(CLI::App& command, CommandLine& line) {
  OptionGroup(command, "Pictures")
      .option("--format", line.format, alternatives(kFormatWords))
      .option("--shading", line.shading, alternatives(kShadingWords))
      .option("--resolution", line.resolution, "sprite texels per display pixel, each axis")
      .option("--compression", line.compression,
              "keep sprites compressed: quality 1 to 100 (about 10:1 at 85), 0: none")
      .flag("--video", line.video, "also write video.mp4")
      .flag("--separate", line.separate,
            "also write each shade sprite alone, and the sum with its base (DIR/separate)")
      .flag("--overlay", line.overlay, "draw each sprite's outline, coloured by age")
      .flag("--quality", line.quality,
            "PSNR, SSIM and FLIP of each frame against reference and direct (slow)")
      .option("--audit", line.audit,
              "draw every N-th reuse of a layer fresh and compare: were the fiducials right? Sheets in "
              "DIR/audit")
      .flag("--resume", line.resume, "continue a run that was stopped");
}

void add_decisions(CLI::App& command, CommandLine& line) {
  add_policy(command, line);
  add_thresholds(command, line);
  add_budget(command, line);
  add_layers(command, line);
}

}  // namespace

void add_run_options(CLI::App& command, CommandLine& line) {
  add_run(command, line);
  add_content_options(command, line.content);
  add_decisions(command, line);
}

void add_decision_options(CLI::App& command, CommandLine& line) {
  add_sequence(command, line);
  OptionGroup(command, "Run")
      .option("--out", line.out, "folder of the pictures (out/<name>-explain)")
      .option("--size", line.size, "display, WxH pixels");
  add_content_options(command, line.content);
  add_decisions(command, line);
}

void add_audit_options(CLI::App& command, CommandLine& line) {
  OptionGroup(command, "Audit")
      .option("--every", line.audit, "one reuse of so many of each layer is drawn fresh (8)")
      .option("--shading", line.shading, alternatives(kShadingWords))
      .option("--resolution", line.resolution, "sprite texels per display pixel, each axis")
      .option("--compression", line.compression, "keep sprites compressed: quality 1 to 100, 0: none");
}

void add_content_options(CLI::App& command, ContentWords& words) {
  OptionGroup(command, "Content")
      .flag("--strict", words.strict, "what the content has and the picture lacks is an error")
      .option("--assets", words.assets, "a folder in which files that models name may lie, too")
      .option(
          "--exposure", words.exposure,
          "illuminance that shows 1 on a white surface that faces the light: lux in models, 1 in sequences")
      .option("--turntable", words.turntable,
              "seconds for one turn of the orbiting camera (20; sequences: 5)")
      .flag("--no-stage", words.no_stage, "a bare model stands before black, on no ground");
}

void add_picture_options(CLI::App& command, CommandLine& line) { add_pictures(command, line); }

namespace {

/// "geometric_px" of "--geometric-px".
std::string as_keyword(std::string option) {
  option.erase(0, option.find_first_not_of('-'));
  std::replace(option.begin(), option.end(), '-', '_');
  return option;
}

}  // namespace

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
    const std::optional<UnknownOption> unknown = unknown_option(app, app.remaining());
    if (!unknown) throw InputError(error.what());
    throw InputError(
        "there is no option '" + as_keyword(unknown->written) + "'" +
        (unknown->nearest.empty() ? "" : "; did you mean '" + as_keyword(unknown->nearest) + "'?"));
  }
  return line;
}

}  // namespace talisman::sequences
