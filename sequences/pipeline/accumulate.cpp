// SPDX-License-Identifier: Apache-2.0
#include "sequences/pipeline/accumulate.h"

#include <algorithm>

#include <glm/vec4.hpp>

#include "layers/check.h"

namespace talisman::sequences {

namespace {

using regulator::Action;
using regulator::LayerDecision;

/// Sums of pictures of one size.
class MeanPicture {
 public:
  void add(const chunker::Frame& picture) {
    if (count_++ == 0) {
      mean_ = picture;
      sums_.assign(picture.pixels.size(), Sum(0));
    }
    TALISMAN_CHECK_EQ(picture.pixels.size(), sums_.size());
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const chunker::Linear16& pixel = picture.pixels[i];
      sums_[i] += Sum(pixel.r, pixel.g, pixel.b, pixel.a);
    }
  }

  chunker::Frame mean() {
    const auto rounded = [this](std::uint32_t sum) {
      return static_cast<std::uint16_t>((2 * sum + count_) / (2 * count_));
    };
    for (std::size_t i = 0; i < sums_.size(); ++i)
      mean_.pixels[i] = {rounded(sums_[i].x), rounded(sums_[i].y), rounded(sums_[i].z), rounded(sums_[i].w)};
    return std::move(mean_);
  }

 private:
  /// Of at most kMostAccumulated values of 16 bits.
  using Sum = glm::uvec4;
  chunker::Frame mean_;
  std::vector<Sum> sums_;  ///< by pixel
  std::uint32_t count_ = 0;
};

void add(const regulator::LayerCost& cost, regulator::LayerCost& sum) {
  sum.polygons += cost.polygons;
  sum.pixels += cost.pixels;
  sum.chunks += cost.chunks;
  sum.bytes += cost.bytes;
}

void add(const LayerDecision& decision, LayerDecision& sum) {
  add(decision.cost, sum.cost);
  sum.shown_geometric_px = std::max(sum.shown_geometric_px, decision.shown_geometric_px);
  if (decision.action == Action::Rerender || sum.action == Action::Drop) sum.action = decision.action;
}

void add(const PredictiveReport& report, PredictiveReport& sum) {
  sum.parts_drawn += report.parts_drawn;
  sum.parts += report.parts;
  sum.joins_planned += report.joins_planned;
  sum.joins_without_content += report.joins_without_content;
  sum.prediction_vertices += report.prediction_vertices;
  sum.surprises += report.surprises;
  sum.surprised += report.surprised;
  sum.buffer_bytes = std::max(sum.buffer_bytes, report.buffer_bytes);
  sum.edge_pixels += report.edge_pixels;
  sum.joined += report.joined;
}

/// The pictures but the first are added to it.
void add(const FrameReport& report, FrameReport& sum) {
  for (std::size_t i = 0; i < std::min(sum.plan.decisions.size(), report.plan.decisions.size()); ++i)
    add(report.plan.decisions[i], sum.plan.decisions[i]);
  add(report.reference, sum.reference);
  sum.render += report.render;
  for (std::size_t i = 0; i < std::min(sum.render_by_layer.size(), report.render_by_layer.size()); ++i)
    sum.render_by_layer[i] += report.render_by_layer[i];
  sum.composite += report.composite;
  sum.shade += report.shade;
  sum.late_renders += report.late_renders;
  if (sum.predictive && report.predictive) add(*report.predictive, *sum.predictive);
  sum.times.plan_ms += report.times.plan_ms;
  sum.times.render_ms += report.times.render_ms;
  sum.times.composite_ms += report.times.composite_ms;
}

/// Pictures are told apart by nobody who reads of frames.
void in_frames(int frame, int pictures, FrameReport& report) {
  report.frame = report.plan.frame = frame;
  if (report.predictive) {
    report.predictive->slice_first /= pictures;
    report.predictive->edge_pixels /= pictures;
    report.predictive->slice_frames = std::max(report.predictive->slice_frames / pictures, 1);
  }
  for (LayerDecision& decision : report.plan.decisions) {
    if (decision.action == Action::Drop) continue;
    decision.depicts_frame = decision.depicts_frame < 0 ? -1 : decision.depicts_frame / pictures;
    decision.reason += "; the first of " + std::to_string(pictures) + " pictures";
  }
}

}  // namespace

Pipeline pipeline_of_pictures(const Pipeline& pipeline) {
  Pipeline pictures = pipeline;
  pictures.settings.fps *= pipeline.settings.accumulate;
  pictures.settings.frames *= pipeline.settings.accumulate;
  pictures.settings.accumulate = 1;
  return pictures;
}

FrameReport accumulated_step(const Pipeline& pipeline, int frame,
                             const std::function<FrameReport(const Pipeline&, int picture)>& step) {
  const Pipeline pictures = pipeline_of_pictures(pipeline);
  const int count = pipeline.settings.accumulate;
  MeanPicture mean;
  FrameReport sum;
  for (int j = 0; j < count; ++j) {
    FrameReport report = step(pictures, frame * count + j);
    if (!report.picture.pixels.empty()) mean.add(report.picture);
    if (j == 0)
      sum = std::move(report);
    else
      add(report, sum);
  }
  if (!sum.picture.pixels.empty()) sum.picture = mean.mean();
  in_frames(frame, count, sum);
  return sum;
}

chunker::Frame accumulated_picture(const Pipeline& pipeline, int frame,
                                   const std::function<chunker::Frame(const Pipeline&, int picture)>& draw) {
  const Pipeline pictures = pipeline_of_pictures(pipeline);
  MeanPicture mean;
  for (int j = 0; j < pipeline.settings.accumulate; ++j)
    mean.add(draw(pictures, frame * pipeline.settings.accumulate + j));
  return mean.mean();
}

}  // namespace talisman::sequences
