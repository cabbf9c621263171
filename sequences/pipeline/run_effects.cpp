// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/run_effects.h"

namespace talisman::sequences {

layers::RunEffects run_effects(const Settings& settings) {
  layers::RunEffects run;
  if (settings.compression) run.compression_quality = settings.compression->quality;
  run.mip_filter = settings.render.mipmaps && settings.render.filter == chunker::TextureFilter::Trilinear;
  run.per_pixel = settings.render.shading == chunker::Shading::Phong;
  run.predictive = settings.regulator.policy == regulator::Policy::Predictive;
  run.follows_light = regulator::asks_for_light(settings.regulator);
  return run;
}

}  // namespace talisman::sequences
