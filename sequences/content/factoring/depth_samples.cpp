// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/factoring/depth_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "layers/inline_vector.h"

namespace talisman::sequences {

namespace {

using layers::dmat4;
using layers::dvec2;
using layers::dvec4;
using layers::ivec2;

/// One piece in one frame: the nearest depth at the centres of coarse pixels.
class PieceDepths {
 public:
  explicit PieceDepths(ivec2 size_px)
      : size_px_(size_px), inverse_w_(size_px.x * std::size_t(size_px.y), 0) {}

  const std::vector<int>& touched() const { return touched_; }
  float at(int pixel) const { return inverse_w_[pixel]; }
  void clear() {
    for (const int pixel : touched_) inverse_w_[pixel] = 0;
    touched_.clear();
  }

  /// `near_m`: what is nearer is cut off.
  void add_triangle(const std::array<dvec4, 3>& clip, double near_m) {
    layers::InlineVector<dvec4, 4> kept;
    for (int i = 0; i < 3; ++i) {
      const dvec4 &a = clip[i], &b = clip[(i + 1) % 3];
      if (a.w >= near_m) kept.push_back(a);
      if ((a.w >= near_m) != (b.w >= near_m)) kept.push_back(a + (b - a) * ((near_m - a.w) / (b.w - a.w)));
    }
    for (std::size_t i = 2; i < kept.size(); ++i) fill({kept[0], kept[i - 1], kept[i]});
  }

 private:
  void fill(const std::array<dvec4, 3>& clip) {
    std::array<dvec2, 3> p;
    dvec2 lo(HUGE_VAL), hi(-HUGE_VAL);
    for (int i = 0; i < 3; ++i) {
      p[i] = layers::screen_from_clip(clip[i], size_px_);
      lo = glm::min(lo, p[i]);
      hi = glm::max(hi, p[i]);
    }
    if (!(lo.x < size_px_.x && lo.y < size_px_.y && hi.x > 0 && hi.y > 0)) return;
    const double area = cross(p[1] - p[0], p[2] - p[0]);
    if (!(std::abs(area) > 0) || !std::isfinite(area)) return;
    const int y0 = first_centre(lo.y), y1 = last_centre(hi.y, size_px_.y);
    const int x0 = first_centre(lo.x), x1 = last_centre(hi.x, size_px_.x);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const dvec2 at(x + 0.5, y + 0.5);
        const double u = cross(p[2] - p[1], at - p[1]) / area, v = cross(p[0] - p[2], at - p[2]) / area;
        const double w = 1 - u - v;
        if (u >= 0 && v >= 0 && w >= 0)
          put(y * size_px_.x + x, static_cast<float>(u / clip[0].w + v / clip[1].w + w / clip[2].w));
      }
  }
  static double cross(dvec2 a, dvec2 b) { return a.x * b.y - a.y * b.x; }
  static int first_centre(double lo) { return static_cast<int>(std::ceil(std::max(lo - 0.5, 0.0))); }
  static int last_centre(double hi, int size) {
    return static_cast<int>(std::floor(std::min(hi - 0.5, size - 1.0)));
  }
  void put(int pixel, float inverse_w) {
    if (inverse_w_[pixel] == 0) touched_.push_back(pixel);
    inverse_w_[pixel] = std::max(inverse_w_[pixel], inverse_w);
  }

  ivec2 size_px_;
  std::vector<float> inverse_w_;  // 0: nothing there
  std::vector<int> touched_;
};

void add_part(const layers::SceneFrame& frame, const layers::Part& part, const dmat4& clip_from_world,
              PieceDepths& depths) {
  const layers::Mesh& mesh = frame.scene->meshes[part.mesh];
  std::vector<dvec4> clip;
  clip.reserve(mesh.positions.size());
  if (layers::deforms(*frame.scene, part)) {
    for (const layers::dvec3& p : layers::world_positions(frame, part))
      clip.push_back(clip_from_world * dvec4(p, 1));
  } else {
    const dmat4 clip_from_part = clip_from_world * frame.world_from_node[part.node];
    for (const layers::vec3& p : mesh.positions) clip.push_back(clip_from_part * dvec4(layers::dvec3(p), 1));
  }
  const auto outside = [](const dvec4& a, const dvec4& b, const dvec4& c) {
    return (a.x > a.w && b.x > b.w && c.x > c.w) || (a.x < -a.w && b.x < -b.w && c.x < -c.w) ||
           (a.y > a.w && b.y > b.w && c.y > c.w) || (a.y < -a.w && b.y < -b.w && c.y < -c.w);
  };
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const dvec4 &a = clip[mesh.indices[i]], &b = clip[mesh.indices[i + 1]], &c = clip[mesh.indices[i + 2]];
    if (!outside(a, b, c)) depths.add_triangle({a, b, c}, frame.camera.near_m);
  }
}

ivec2 coarse_size(ivec2 display_px) {
  const double shrink = std::min(1.0, kDepthSide_px / double(std::max({display_px.x, display_px.y, 1})));
  return {std::max(1, static_cast<int>(std::lround(display_px.x * shrink))),
          std::max(1, static_cast<int>(std::lround(display_px.y * shrink)))};
}

}  // namespace

DepthSamples::DepthSamples(const layers::Scene& scene, std::span<const layers::Layer> pieces,
                           const std::vector<double>& times_s, ivec2 display_px)
    : size_px_(coarse_size(display_px)),
      display_per_coarse_px_(double(display_px.x) * display_px.y / (double(size_px_.x) * size_px_.y)),
      front_(pieces.size() * pieces.size()),
      frames_(front_.size()),
      related_(front_.size()),
      nearest_m_(pieces.size(), HUGE_VAL) {
  for (const double time_s : times_s) add_frame(scene.at(time_s), pieces);
  seen_.clear();
}

void DepthSamples::add_frame(const layers::SceneFrame& frame, std::span<const layers::Layer> pieces) {
  const dmat4 clip_from_world = layers::clip_from_world(frame.camera, size_px_);
  seen_.resize(size_px_.x * std::size_t(size_px_.y));
  for (auto& pixel : seen_) pixel.clear();
  touched_.emplace_back(pieces.size());
  PieceDepths depths(size_px_);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (const int part : pieces[i].parts) add_part(frame, frame.scene->parts[part], clip_from_world, depths);
    touched_.back()[i] = static_cast<double>(depths.touched().size());
    for (const int pixel : depths.touched()) {
      seen_[pixel].push_back({static_cast<int>(i), depths.at(pixel)});
      nearest_m_[i] = std::min(nearest_m_[i], 1.0 / depths.at(pixel));
    }
    depths.clear();
  }
  relate();
}

void DepthSamples::relate() {
  std::map<std::pair<int, int>, std::array<bool, 2>> now;  // [0]: the first is in front somewhere
  for (const std::vector<Seen>& pixel : seen_)
    for (std::size_t i = 0; i < pixel.size(); ++i)
      for (std::size_t k = i + 1; k < pixel.size(); ++k) {
        const Seen &a = pixel[i], &b = pixel[k];
        if (std::abs(a.inverse_w - b.inverse_w) <= kSameDepth * std::max(a.inverse_w, b.inverse_w)) continue;
        const bool a_is_nearer = a.inverse_w > b.inverse_w;
        ++front_[a_is_nearer ? index(a.piece, b.piece) : index(b.piece, a.piece)];
        now[{a.piece, b.piece}][a_is_nearer ? 0 : 1] = true;
      }
  for (const auto& [pair, is_front] : now) {
    const std::size_t one = index(pair.first, pair.second), other = index(pair.second, pair.first);
    ++related_[one];
    ++related_[other];
    frames_[one] += is_front[0];
    frames_[other] += is_front[1];
  }
}

}  // namespace talisman::sequences
