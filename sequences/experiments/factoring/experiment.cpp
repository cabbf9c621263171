// SPDX-License-Identifier: Apache-2.0
#include "sequences/experiments/factoring/experiment.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "layers/check.h"
#include "sequences/experiments/factoring/variants.h"
#include "sequences/experiments/regulator/setting_run.h"
#include "sequences/pipeline/layer_planning.h"
#include "sequences/pipeline/shade_passes.h"
#include "sequences/pipeline/step.h"

namespace talisman::sequences {
namespace {

using layers::dvec3;
using layers::Layer;
using layers::ShadowsAs;

// --- Layers of one frame ---

/// The layer of this name in another variant: names of surfaces are the same in all of them.
const Layer& layer_named(const LayerTable& layers, const std::string& name) {
  for (const Layer& layer : layers)
    if (layer.name == name) return layer;
  TALISMAN_CHECK(false);  // a variant without this layer
  return layers[0];
}

/// Makes the pictures of one frame.
class LayerPainter {
 public:
  LayerPainter(const Pipeline& flush, const Pipeline& whole, const PipelineState& state,
               const FrameReport& report, const chunker::PreparedScene& prepared, bool constant_blend)
      : flush_(flush),
        whole_(whole),
        state_(state),
        report_(report),
        prepared_(prepared),
        constant_blend_(constant_blend),
        now_(flush.scene.at(time_of(flush, report.frame))) {}

  std::vector<ShadedLayer> paint() {
    std::vector<ShadedLayer> pictures;
    const std::vector<ShownSprite>& shown = report_.shown;
    for (std::size_t i = 0; i < shown.size();) {
      std::size_t end = i + 1;
      while (end < shown.size() && layer(shown[end]).base == shown[i].layer) ++end;
      pictures.push_back(picture({shown.data() + i, end - i}));
      i = end;
    }
    return pictures;
  }

 private:
  const Layer& layer(const ShownSprite& sprite) const { return report_.layers[sprite.layer]; }

  /// A base and what lies directly in front of it.
  ShadedLayer picture(std::span<const ShownSprite> group) {
    const Layer& base = layer(group.front());
    const layers::SpritePlacement& placement = state_.memory[base.id].placement;
    const layers::Affine2& a = placement.screen_from_sprite;
    TALISMAN_CHECK(a.a == 1 && a.b == 0 && a.c == 0 && a.d == 1);  // texel on pixel
    ShadedLayer picture;
    picture.layer = base.id;
    picture.origin_px = {static_cast<int>(std::lround(a.tx)), static_cast<int>(std::lround(a.ty))};
    picture.fade = group.front().multipliers.alpha;
    if (group.size() == 1)
      picture.sprite = state_.sprites.find(base.id);
    else
      add_terms(group, placement, picture);
    return picture;
  }

  void add_terms(std::span<const ShownSprite> group, const layers::SpritePlacement& placement,
                 ShadedLayer& picture) {
    for (const ShownSprite& sprite : group) {
      TALISMAN_CHECK(state_.memory[sprite.layer].placement == placement);
      picture.terms.push_back(
          {layer(sprite).kind,
           draw_layer_linear({flush_, report_.layers, maps_, prepared_, now_}, layer(sprite), placement),
           sprite.multipliers.color});
    }
    const Layer& whole = layer_named(whole_.authored, layer(group.front()).name);
    const bool two = layer(group.front()).factored.second_texture && !constant_blend_;
    const auto base = two ? chunker::BasePasses::Two : chunker::BasePasses::One;
    const layers::vec2 gains =
        two ? layers::vec2(group[0].multipliers.color.x, group[1].multipliers.color.x) : layers::vec2(1);
    const Drawing drawing{whole_, whole_.authored, whole_maps_, prepared_, now_};
    picture.surface = chunker::surface_of(draw_terms(drawing, whole, placement, base), gains);
    picture.unfactored =
        draw_layer_linear(drawing, whole, placement, two ? std::optional(gains) : std::nullopt);
  }

  const Pipeline& flush_;
  const Pipeline& whole_;
  const PipelineState& state_;
  const FrameReport& report_;
  const chunker::PreparedScene& prepared_;
  bool constant_blend_;
  layers::SceneFrame now_;
  ShadowMapStore maps_, whole_maps_;
};

FactoredMask all_of(const std::vector<ShadedLayer>& pictures) { return FactoredMask(pictures.size(), true); }

// --- The pictures of a frame ---

Pipeline pipeline_of(const Variant& variant) {
  return make_pipeline(*variant.sequence.scene, variant.sequence.layers, variant.settings);
}

/// A variant of which single frames are drawn, each by itself: every layer in every frame.
struct FreshVariant {
  explicit FreshVariant(Variant given) : variant(std::move(given)), pipeline(pipeline_of(variant)) {}
  FreshVariant(const FreshVariant&) = delete;
  FreshVariant& operator=(const FreshVariant&) = delete;
  Image8 draw(int frame, const chunker::PreparedScene& prepared) const {
    PipelineState state(pipeline);
    return to_image8(step(pipeline, state, frame, &prepared).picture);
  }
  Variant variant;
  Pipeline pipeline;
};

RegulatorSetting own_policy(const Variant& variant) {
  const regulator::RegulatorOptions& options = variant.settings.regulator;
  return {std::string(regulator::name(options.policy)), "", 0, options};
}

/// All variants, frame after frame.
class Experiment {
 public:
  Experiment(const Variant& given, const ExperimentFrames& frames)
      : variant_(with_shadows_as(given, std::nullopt)),
        whole_(unfactored(variant_)),
        frames_(frames),
        prepared_(*given.sequence.scene),
        flush_(texel_on_pixel(variant_, ShadeResolution::Full)),
        coarse_(texel_on_pixel(variant_, ShadeResolution::Own)),
        placed_(without_reuse(variant_)),
        one_pass_(texel_on_pixel(whole_, ShadeResolution::Full)),
        as_shade_(texel_on_pixel(with_shadows_as(given, ShadowsAs::Shade), ShadeResolution::Full)),
        as_light_(texel_on_pixel(with_shadows_as(given, ShadowsAs::Light), ShadeResolution::Full)),
        as_multiply_(texel_on_pixel(with_shadows_as(given, ShadowsAs::Multiply), ShadeResolution::Full)),
        as_atop_(texel_on_pixel(with_shadows_as(given, ShadowsAs::Atop), ShadeResolution::Full)),
        factored_(variant_.sequence, variant_.settings, own_policy(variant_)),
        unfactored_(whole_.sequence, whole_.settings, own_policy(whole_)) {
    result_.blends_over_time = blends_over_time(given.sequence);
    for (const Picture picture : kPictures) result_.losses.push_back({picture, {}});
    for (const Layer& layer : given.sequence.layers.layers) {
      if (layer.base >= 0) ++result_.layers.back().shade_layers;
      if (layer.base < 0) result_.layers.push_back({layer.name, 0, 0, {}});
    }
    std::erase_if(result_.layers, [](const FactoredLayer& layer) { return layer.shade_layers == 0; });
  }

  FactoringResult run(ProgressKind kind) {
    const std::vector<int>& sampled = result_.sampled = sampled_frames(frames_);
    Progress progress(kind, "compared", static_cast<int>(sampled.size()));
    for (int frame = 0; frame <= frames_.last; ++frame) {
      const bool judged = is_sampled(sampled, frame), drawn = judged || is_sampled(sampled, frame + 1);
      for (SettingRun* run : {&factored_, &unfactored_}) {
        run->advance(frame, drawn ? &prepared_ : nullptr);
        if (frame >= frames_.first) run->count();
      }
      if (!judged) continue;
      compare_frame(frame);
      progress.advance();
    }
    result_.factored = factored_.result();
    result_.unfactored = unfactored_.result();
    return std::move(result_);
  }

 private:
  void compare_frame(int frame) {
    PipelineState state(flush_.pipeline);
    const FrameReport report = step(flush_.pipeline, state, frame, &prepared_);
    const auto pictures = shaded_layers(flush_.pipeline, one_pass_.pipeline, state, report, prepared_, false);
    const FramePrediction prediction = predict(pictures, all_of(pictures));
    check(pictures, prediction, report.picture);
    const Image8 truth = to_image8(frame_of_truth(prediction));
    lose(Picture::OverAlone, frame, to_image8(report.picture), truth);
    lose(Picture::ShadeResolution, frame, coarse_.draw(frame, prepared_), truth);
    lose(Picture::Placement, frame, placed_.draw(frame, prepared_), truth);
    judge(Picture::Reuse, frame, factored_, truth);
    const Image8 own = result_.blends_over_time ? constant_truth(state, report) : truth;
    lose(Picture::AsShade, frame, as_shade_.draw(frame, prepared_), truth);
    lose(Picture::AsLight, frame, as_light_.draw(frame, prepared_), truth);
    lose(Picture::AsMultiply, frame, as_multiply_.draw(frame, prepared_), own);
    lose(Picture::AsAtop, frame, as_atop_.draw(frame, prepared_), truth);
    lose(Picture::OnePass, frame, one_pass_.draw(frame, prepared_), own);
    judge(Picture::UnfactoredReuse, frame, unfactored_, own);
    keep_worst(frame, prediction, report.picture);
  }

  FramePrediction predict(const std::vector<ShadedLayer>& pictures, const FactoredMask& factored) const {
    return predict_frame(pictures, factored, flush_.variant.settings.view.display_px,
                         variant_.sequence.scene->background);
  }

  /// The frame with its textures blended as their materials say.
  Image8 constant_truth(const PipelineState& state, const FrameReport& report) const {
    const auto pictures = shaded_layers(flush_.pipeline, one_pass_.pipeline, state, report, prepared_, true);
    return to_image8(frame_of_truth(predict(pictures, FactoredMask(pictures.size(), false))));
  }

  /// The whole frame, and each layer as if it alone were factored.
  void check(const std::vector<ShadedLayer>& pictures, const FramePrediction& prediction,
             const chunker::Frame& shown) {
    PredictionCheck whole;
    whole.add(prediction, shown);
    result_.frame += whole;
    add_cells(prediction, shown);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      if (!pictures[i].factors()) continue;
      FactoredMask alone(pictures.size(), false);
      alone[i] = true;
      PredictionCheck own;
      own.add(predict(pictures, alone),
              composite_layers(pictures, alone, prediction.size_px, variant_.sequence.scene->background));
      const std::string& name = flush_.pipeline.authored[pictures[i].layer].name;
      const auto layer = std::find_if(result_.layers.begin(), result_.layers.end(),
                                      [&](const FactoredLayer& l) { return l.name == name; });
      layer->check += own;
      ++layer->frames_shown;
    }
  }

  void add_cells(const FramePrediction& prediction, const chunker::Frame& shown) {
    for (std::size_t i = 0; i < prediction.pixels.size(); ++i) {
      const dvec3 predicted = prediction.pixels[i].error();
      const dvec3 measured = linear_of(shown.pixels[i]) - prediction.pixels[i].truth;
      for (int c = 0; c < 3; ++c)
        if (std::fabs(predicted[c]) > kNothing)
          ++result_.cells[{static_cast<int>(std::lround(predicted[c] * kCellsOfWhite)),
                           static_cast<int>(std::lround(measured[c] * kCellsOfWhite))}];
    }
  }

  std::vector<FrameDiff>& losses(Picture picture) {
    return result_.losses[static_cast<std::size_t>(picture)].frames;
  }
  void lose(Picture picture, int frame, const Image8& shown, const Image8& truth) {
    losses(picture).push_back({std::to_string(frame), compare(shown, truth)});
  }
  void judge(Picture picture, int frame, SettingRun& run, const Image8& truth) {
    const Image8 unknown;
    run.judge({unknown, truth});
    losses(picture).push_back({std::to_string(frame), run.quality()});
  }

  void keep_worst(int frame, const FramePrediction& prediction, const chunker::Frame& shown) {
    double squares = 0;
    for (const PixelPrediction& pixel : prediction.pixels) {
      const dvec3 e = pixel.error();
      squares += e.x * e.x + e.y * e.y + e.z * e.z;
    }
    if (result_.worst.frame >= 0 && squares <= worst_squares_) return;
    worst_squares_ = squares;
    result_.worst = {frame, shown, prediction};
  }

  Variant variant_, whole_;
  ExperimentFrames frames_;
  chunker::PreparedScene prepared_;
  FreshVariant flush_, coarse_, placed_, one_pass_, as_shade_, as_light_, as_multiply_, as_atop_;
  SettingRun factored_, unfactored_;
  FactoringResult result_;
  double worst_squares_ = 0;
};

}  // namespace

std::vector<ShadedLayer> shaded_layers(const Pipeline& flush, const Pipeline& whole,
                                       const PipelineState& state, const FrameReport& report,
                                       const chunker::PreparedScene& prepared, bool constant_blend) {
  return LayerPainter(flush, whole, state, report, prepared, constant_blend).paint();
}

FactoringResult measure_factoring(const Variant& variant, const ExperimentFrames& frames,
                                  ProgressKind progress) {
  TALISMAN_CHECK(is_factored(variant.sequence));
  return Experiment(variant, frames).run(progress);
}

}  // namespace talisman::sequences
