// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/renderer/sheets.h"

#include <algorithm>
#include <cmath>

#include "layers/check.h"
#include "sequences/experiments/renderer/measure.h"
#include "sequences/pictures/page.h"

namespace talisman::sequences {
namespace {

constexpr int kCropWidth = 128, kCropHeight = 96, kScale = 2, kLargestGain = 64;

struct Place {
  std::size_t picture = 0;  ///< index of the sampled frame
  Crop crop;
};

/// Over all sampled frames.
Place place_of(const std::vector<const std::vector<Image8>*>& others, const std::vector<Image8>& truth) {
  Place best;
  double most = -1;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    std::vector<const Image8*> pictures;
    for (const std::vector<Image8>* other : others) pictures.push_back(&(*other)[k]);
    const Crop crop = most_different(pictures, truth[k], kCropWidth, kCropHeight);
    const double sum = squared_difference(pictures, truth[k], crop);
    if (sum > most) most = sum, best = {k, crop};
  }
  return best;
}

/// The largest power of two that does not make a difference of `largest` brighter than white.
int gain_for(int largest) {
  int gain = 1;
  while (gain < kLargestGain && 2 * gain * largest <= 255) gain *= 2;
  return gain;
}

std::string where(int frame, const Crop& crop) {
  return "frame " + std::to_string(frame) + ", " + std::to_string(crop.width) + "x" +
         std::to_string(crop.height) + " px at " + std::to_string(crop.x) + "," + std::to_string(crop.y);
}

std::string decibels(const PictureError& error) {
  return std::isfinite(error.quality.psnr_db) ? fixed(error.quality.psnr_db, 1) + " dB" : "identical";
}

std::string file_name(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

}  // namespace

Image8 knob_sheet(const KnobResults& results, std::size_t knob) {
  const Knob& shown = results.ladder.knobs[knob];
  TALISMAN_CHECK(shown.called());
  const std::vector<Image8>& base = results.measured[shown.base()].pictures;
  std::vector<const std::vector<Image8>*> others;
  for (const KnobRung& rung : shown.rungs) others.push_back(&results.measured[rung.variant].pictures);
  const Place place = place_of(others, base);
  const auto crop_of = [&](std::size_t variant) {
    return cropped(results.measured[variant].pictures[place.picture], place.crop);
  };
  const Image8 base_crop = crop_of(shown.base());
  int largest = 1;
  for (const KnobRung& rung : shown.rungs)
    largest = std::max(largest, largest_difference(crop_of(rung.variant), base_crop));
  const int gain = gain_for(largest);
  std::vector<SheetColumn> columns;
  const auto add = [&](const std::string& label, std::size_t variant, const PictureError& error) {
    const double ms = results.measured[variant].cpu.median_ms;
    const Image8 crop = crop_of(variant);
    columns.push_back(
        {{label, decibels(error), "FLIP " + fixed(error.quality.flip, 4), fixed(ms, 1) + " ms cpu"},
         {crop, difference(crop, base_crop, gain)}});
  };
  for (const RungResult& rung : results.rungs)
    if (rung.knob == knob) {
      const char* mark = rung.variant == kTruth ? " = truth" : rung.variant == shown.base() ? " = base" : "";
      add(shown.rungs[rung.rung].label + mark, rung.variant, rung.alone);
    }
  if (shown.in_sprites) add("truth", kTruth, error_of(results.measured[kTruth].pictures, base));
  return sheet_of({shown.name + ": " + where(results.frames[place.picture], place.crop),
                   std::string("below: difference from the ") + (shown.in_sprites ? "base" : "truth") +
                       ", times " + std::to_string(gain)},
                  columns, kScale);
}

Image8 effect_sheet(const EffectResults& effects) {
  std::vector<SheetColumn> columns;
  for (const EffectResult& effect : effects.pictures) {
    const std::vector<Image8>&with = effects.frames[0].pictures,
          &without = effects.frames[effect.without].pictures;
    const Place place = place_of({&without}, with);
    columns.push_back(
        {{std::string(layers::name(effect.call.effect)), "FLIP " + fixed(effect.error.quality.flip, 4),
          "frame " + std::to_string(effects.frame_load.frames[place.picture])},
         {cropped(with[place.picture], place.crop), cropped(without[place.picture], place.crop)}});
  }
  return sheet_of({"effects: with (above) and without (below)"}, columns, kScale);
}

std::string knob_sheet_file(const Knob& knob) { return "knob-" + file_name(knob.name) + ".png"; }

void write_renderer_sheets(const RendererReport& report, const std::string& dir) {
  for (std::size_t k = 0; k < report.knobs.ladder.knobs.size(); ++k) {
    const Knob& knob = report.knobs.ladder.knobs[k];
    if (knob.called()) write_png(dir + "/" + knob_sheet_file(knob), knob_sheet(report.knobs, k));
  }
  if (!report.effects.pictures.empty()) write_png(dir + "/effects.png", effect_sheet(report.effects));
}

}  // namespace talisman::sequences
