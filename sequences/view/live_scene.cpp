// SPDX-License-Identifier: Apache-2.0
#include "sequences/view/live_scene.h"

#include <algorithm>
#include <cmath>

#include "sequences/experiments/effect_removal.h"
#include "sequences/files/errors.h"
#include "sequences/view/flights.h"

namespace talisman::sequences {

namespace {

/// The words of the page stand before those of the command line.
std::vector<std::string> joined_words(const std::vector<std::string>& given,
                                      const std::vector<std::string>& asked) {
  std::vector<std::string> words = asked;
  for (const std::string& word : given) {
    const std::string option = word.substr(0, word.find('=') + 1);
    const bool is_replaced = std::any_of(
        asked.begin(), asked.end(), [&](const std::string& other) { return other.rfind(option, 0) == 0; });
    if (!is_replaced) words.push_back(word);
  }
  return words;
}

void make_coarser(Settings& settings, double scale) {
  if (scale >= 1) return;
  for (int axis = 0; axis < 2; ++axis)
    settings.view.display_px[axis] =
        std::max(1, static_cast<int>(std::lround(settings.view.display_px[axis] * scale)));
  settings.regulator.thresholds.geometric_px *= scale;
}

}  // namespace

LiveScene live_scene(const ViewSource& source, const ViewRequest& request) {
  LiveScene live{source.resolve(joined_words(source.given, request.words)), nullptr};
  Variant& variant = live.variant;
  live.read = variant.sequence.scene;
  for (const layers::Effect effect : request.without) variant = without_effect(variant, effect);
  const layers::ivec2 size = variant.settings.view.display_px;
  if (std::max(size.x, size.y) > kLargestLiveDisplay_px)
    throw InputError("--size: the live view shows at most " + std::to_string(kLargestLiveDisplay_px) +
                     " pixels in either direction");
  make_coarser(variant.settings, request.scale);
  if (request.flight.empty()) return live;
  live.flown = std::make_shared<layers::Scene>(flyable(*variant.sequence.scene));
  fly(*live.flown, request.flight, variant.sequence.fps);
  variant.sequence.scene = live.flown;
  variant.sequence.frames = variant.settings.frames = static_cast<int>(request.flight.size());
  return live;
}

}  // namespace talisman::sequences
