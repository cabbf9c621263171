// SPDX-License-Identifier: Apache-2.0
#include "regulator/chunk_refresh.h"

#include <algorithm>
#include <cmath>

#include "regulator/chunk_warp.h"
#include "regulator/content_leaves.h"

namespace talisman::regulator {

namespace {

using layers::Affine2;
using layers::dvec2;
using layers::dvec3;
using layers::SpritePlacement;

constexpr double kDisplayMargin_px = 2;  ///< what lies farther off does not reach into a pixel that is seen

/// What one warp makes of all chunks.
struct Verdict {
  std::vector<double> px;        ///< by chunk; < 0: nothing known reaches into it
  std::vector<char> shown;       ///< by chunk
  std::vector<ChunkRect> reach;  ///< of each leaf, if it were drawn now
  double worst_px = 0;
  std::size_t worst_leaf = 0;
};

/// A leaf as of an instant that its box reaches into chunks of.
struct HeldLeaf {
  std::size_t instant = 0, leaf = 0;
  Corners then;
  ChunkRect reach;
};

template <typename Visit>
void for_each_chunk(const ChunkRect& rect, int columns, const Visit& visit) {
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) visit(static_cast<std::size_t>(y) * columns + x);
}

class Judge {
 public:
  Judge(const LayerContent& content, const SpriteChunks& chunks, const ContentView& now,
        const SpritePlacement& placement, layers::ivec2 display_px, const ChunkLimits& limits)
      : content_(content),
        chunks_(chunks),
        placement_(placement),
        display_px_(display_px),
        limits_(limits),
        near_m_(now.near_m),
        leaves_(content_leaves(box_corners(content, now), display_px, kDisplayMargin_px, now.near_m)),
        texel_from_first_(*inverse(placement.screen_from_sprite)) {
    for (std::size_t s = 0; s < chunks.instants.size(); ++s)
      for (const ChunkRect& reach : chunks.instants[s]->reach) {
        char any = 0;
        for_each_chunk(reach, chunks.count.x, [&](std::size_t c) { any |= chunks.of_chunk[c] == s; });
        holds_.push_back(any);
      }
    for (std::size_t s = 0; s < chunks.instants.size(); ++s)
      for (std::size_t k = 0; k < leaves_.size(); ++k) {
        if (!holds(s, leaves_[k].box)) continue;
        held_.push_back({s, k, then_of(s, leaves_[k]), {}});
        held_.back().reach = reach_of(held_.back().then, texel_from_first_);
      }
  }

  ChunkJudgement judge() {
    ChunkJudgement judgement;
    const std::vector<ChunkPlace> places = places_of_chunks();
    const ChunkWarp found = chunk_warp(places, chunks_.count, limits_);
    judgement.fitted = found.fitted;
    judgement.share.stored = stored();
    if (!is_sound(found.fitted))
      judgement.why_whole = found.fitted.warp.is_affine() ? "the warp folds" : "the warp is perspective";
    else if (found.off > kMostChunksOver * judgement.share.stored)
      judgement.why_whole = "most of its chunks are off";
    else
      finish(verdict(found.fitted.warp.affine()), judgement);
    return judgement;
  }

 private:
  Corners then_of(std::size_t s, const ContentLeaf& leaf) const {
    return corners_of_part(corners_of(chunks_.instants[s]->corners, leaf.box), leaf.lo, leaf.hi);
  }

  ChunkRect reach_of(const Corners& corners, const Affine2& texel) const {
    const BoxReach reach = box_reach(BoxCorners(corners), texel, dvec2(placement_.size_px), 1, near_m_);
    return reach.sight == BoxSight::Outside ? ChunkRect{} : chunks_in(reach.bounds, chunks_.count);
  }

  /// Does the box reach into a chunk of that instant?
  bool holds(std::size_t s, std::size_t box) const { return holds_[s * content_.boxes.size() + box] != 0; }

  /// For each chunk that shows something: the leaf nearest to its middle that is before the eye, then and now.
  std::vector<ChunkPlace> places_of_chunks() const {
    std::vector<ChunkPlace> nearest(chunks_.of_chunk.size());
    std::vector<double> distance(nearest.size(), HUGE_VAL);
    for (const HeldLeaf& held : held_) {
      const ContentLeaf& leaf = leaves_[held.leaf];
      if (!leaf.on_display || !is_before(held.then) || !is_before(leaf.now)) continue;
      ChunkPlace place{-1, held.instant == 0, middle_of(held.then), middle_of(leaf.now)};
      const dvec2 at = texel_from_first_(place.then_px) / double(kRefreshChunk);
      for_each_chunk(held.reach, chunks_.count.x, [&](std::size_t c) {
        if (chunks_.of_chunk[c] != held.instant) return;
        const double apart = glm::distance(at, dvec2(column_and_row(c)) + 0.5);
        if (!(apart < distance[c])) return;
        distance[c] = apart;
        place.chunk = static_cast<int>(c);
        nearest[c] = place;
      });
    }
    std::erase_if(nearest, [](const ChunkPlace& place) { return place.chunk < 0; });
    return nearest;
  }

  bool is_before(const Corners& corners) const {
    return std::all_of(corners.begin(), corners.end(), [this](const dvec3& p) { return p.z > near_m_; });
  }

  static dvec2 middle_of(const Corners& corners) {
    const dvec3 middle = corners.front() + corners.back();
    return dvec2(middle) / middle.z;
  }

  layers::ivec2 column_and_row(std::size_t c) const {
    return {static_cast<int>(c) % chunks_.count.x, static_cast<int>(c) / chunks_.count.x};
  }

  /// Chunks whose image meets the display.
  std::vector<char> shown_by(const Affine2& screen_from_texel) const {
    std::vector<char> shown(chunks_.of_chunk.size());
    for (std::size_t c = 0; c < shown.size(); ++c) {
      const dvec2 corner(kRefreshChunk * column_and_row(c));
      layers::RectD bounds;
      for (const dvec2& k : {dvec2(0, 0), dvec2(1, 0), dvec2(0, 1), dvec2(1, 1)})
        bounds.include(screen_from_texel(corner + double(kRefreshChunk) * k));
      shown[c] = bounds.hi.x >= -1 && bounds.hi.y >= -1 && bounds.lo.x <= display_px_.x + 1 &&
                 bounds.lo.y <= display_px_.y + 1;
    }
    return shown;
  }

  Verdict verdict(const Affine2& warp) const {
    Verdict v;
    const Affine2 screen_from_texel = warp * placement_.screen_from_sprite,
                  texel_from_screen = *inverse(screen_from_texel);
    v.shown = shown_by(screen_from_texel);
    v.px.assign(v.shown.size(), -1);
    v.reach.reserve(leaves_.size());
    for (const ContentLeaf& leaf : leaves_)
      v.reach.push_back(leaf.on_display ? reach_of(leaf.now, texel_from_screen) : ChunkRect{});
    for (const HeldLeaf& held : held_) add(held, warp, v);
    for (std::size_t k = 0; k < leaves_.size(); ++k) add_entering(k, warp, v);
    return v;
  }

  /// What the chunks of one instant make of one leaf.
  void add(const HeldLeaf& held, const Affine2& warp, Verdict& v) const {
    const ContentLeaf& leaf = leaves_[held.leaf];
    const auto is_met = [&](std::size_t c) { return chunks_.of_chunk[c] == held.instant && v.shown[c]; };
    bool any = false;
    for (const ChunkRect& rect : {held.reach, v.reach[held.leaf]})
      for_each_chunk(rect, chunks_.count.x, [&](std::size_t c) { any = any || is_met(c); });
    if (!any) return;
    if (!leaf.on_display &&
        box_reach(BoxCorners(held.then), warp, dvec2(display_px_), kDisplayMargin_px, near_m_).sight ==
            BoxSight::Outside)
      return;
    const double px = apart_px(BoxCorners(held.then), warp, BoxCorners(leaf.now));
    for (const ChunkRect& rect : {held.reach, v.reach[held.leaf]})
      for_each_chunk(rect, chunks_.count.x, [&](std::size_t c) {
        if (is_met(c)) v.px[c] = std::max(v.px[c], px);
      });
    if (px <= v.worst_px) return;
    v.worst_px = px;
    v.worst_leaf = held.leaf;
  }

  /// The same for chunks of instants in which the leaf reached into none.
  void add_entering(std::size_t k, const Affine2& warp, Verdict& v) const {
    std::vector<std::size_t> instants;
    for_each_chunk(v.reach[k], chunks_.count.x, [&](std::size_t c) {
      const std::size_t s = chunks_.of_chunk[c];
      if (v.shown[c] && !holds(s, leaves_[k].box) &&
          std::find(instants.begin(), instants.end(), s) == instants.end())
        instants.push_back(s);
    });
    for (const std::size_t s : instants) add({s, k, then_of(s, leaves_[k]), {}}, warp, v);
  }

  void finish(const Verdict& best, ChunkJudgement& judgement) const {
    judgement.worst_px = best.worst_px;
    for (std::size_t c = 0; c < best.px.size(); ++c)
      if (best.px[c] > limits_.geometric_px)
        judgement.over.push_back(static_cast<int>(c));
      else
        judgement.left_px = std::max(judgement.left_px, best.px[c]);
    judgement.share.drawn = static_cast<int>(judgement.over.size());
    if (best.worst_px > 0)
      if (const dvec3& corner = leaves_[best.worst_leaf].now[0]; corner.z > near_m_)
        judgement.where_px = dvec2(corner) / corner.z;
    const Affine2 warp = judgement.fitted.warp.affine();
    if (judgement.share.drawn > kMostChunksOver * judgement.share.stored)
      judgement.why_whole = "most of its chunks are off";
    else if (must_grow(*inverse(warp * placement_.screen_from_sprite)))
      judgement.why_whole = "it outgrows its extents";
    if (!judgement.why_whole.empty()) return;
    add_cost(best, judgement);
    add_steps(best, warp, judgement);
  }

  int stored() const {
    std::vector<char> is_stored(chunks_.of_chunk.size(), 0);
    for (std::size_t s = 0; s < chunks_.instants.size(); ++s)
      for (const ChunkRect& rect : chunks_.instants[s]->reach)
        for_each_chunk(rect, chunks_.count.x,
                       [&](std::size_t c) { is_stored[c] = is_stored[c] || chunks_.of_chunk[c] == s; });
    return static_cast<int>(std::count(is_stored.begin(), is_stored.end(), 1));
  }

  /// How far bounds reach beyond a side at which nothing was cut off.
  double beyond(const layers::RectD& bounds) const {
    const layers::ClippedSides& cut = placement_.clipped;
    const dvec2 size(placement_.size_px);
    double most = 0;
    if (!cut.left) most = std::max(most, -bounds.lo.x);
    if (!cut.right) most = std::max(most, bounds.hi.x - size.x);
    if (!cut.top) most = std::max(most, -bounds.lo.y);
    if (!cut.bottom) most = std::max(most, bounds.hi.y - size.y);
    return most;
  }

  bool must_grow(const Affine2& texel_from_screen) const {
    const double allowed = 1 + limits_.geometric_px * std::sqrt(std::fabs(texel_from_screen.determinant()));
    for (const ContentLeaf& leaf : leaves_) {
      if (!leaf.on_display) continue;
      const double now = beyond(box_bounds(BoxCorners(leaf.now), texel_from_screen));
      if (now <= allowed) continue;
      if (now > allowed + beyond(box_bounds(BoxCorners(then_of(0, leaf)), texel_from_first_))) return true;
    }
    return false;
  }

  void add_cost(const Verdict& best, ChunkJudgement& judgement) const {
    std::vector<char> drawn(chunks_.of_chunk.size(), 0), counted(content_.boxes.size(), 0);
    for (const int c : judgement.over) {
      drawn[c] = 1;
      const layers::ivec2 left = placement_.size_px - kRefreshChunk * column_and_row(c);
      judgement.pixels += std::int64_t{std::min(kRefreshChunk, left.x)} * std::min(kRefreshChunk, left.y);
    }
    for (std::size_t k = 0; k < leaves_.size(); ++k) {
      char& is_counted = counted[leaves_[k].box];
      bool any = false;
      for_each_chunk(best.reach[k], chunks_.count.x, [&](std::size_t c) { any = any || drawn[c]; });
      if (any && !is_counted) judgement.polygons += content_.boxes[leaves_[k].box].triangles;
      is_counted = is_counted || any;
    }
  }

  /// Borders between chunks of different instants, once those over are drawn. A leaf that reaches into both is shown
  /// by both.
  void add_steps(const Verdict& best, const Affine2& warp, ChunkJudgement& judgement) const {
    const std::size_t fresh = chunks_.instants.size();
    std::vector<std::size_t> age(chunks_.of_chunk.begin(), chunks_.of_chunk.end());
    for (const int c : judgement.over) age[c] = fresh;
    std::vector<std::vector<Corners>> shown(leaves_.size());  // where the pictures of each leaf are
    const auto note = [&](std::size_t k, std::size_t instant, const ChunkRect& reach, Corners places) {
      bool any = false;
      for_each_chunk(reach, chunks_.count.x,
                     [&](std::size_t c) { any = any || (age[c] == instant && best.shown[c]); });
      if (!any || !leaves_[k].on_display) return;
      if (instant != fresh)
        for (dvec3& place : places) place = mapped(warp, place);
      for (const Corners& other : shown[k])
        note_step(apart_px(BoxCorners(other), {}, BoxCorners(places)), judgement);
      shown[k].push_back(places);
    };
    for (const HeldLeaf& held : held_) note(held.leaf, held.instant, held.reach, held.then);
    for (std::size_t k = 0; k < leaves_.size(); ++k) note(k, fresh, best.reach[k], leaves_[k].now);
  }

  void note_step(double px, ChunkJudgement& judgement) const {
    judgement.share.step_px = std::max(judgement.share.step_px, px);
    judgement.share.torn_borders += px > limits_.geometric_px;
  }

  const LayerContent& content_;
  const SpriteChunks& chunks_;
  const SpritePlacement& placement_;
  layers::ivec2 display_px_;
  const ChunkLimits& limits_;
  double near_m_;
  std::vector<ContentLeaf> leaves_;
  std::vector<char> holds_;     ///< by instant and box
  std::vector<HeldLeaf> held_;  ///< by instant and leaf
  Affine2 texel_from_first_;
};

}  // namespace

ChunkJudgement judge_chunks(const LayerContent& content, const SpriteChunks& chunks, const ContentView& now,
                            const SpritePlacement& placement, layers::ivec2 display_px,
                            const ChunkLimits& limits) {
  ChunkJudgement judgement;
  if (content.deforms)
    judgement.why_whole = "it deforms";
  else if (chunks.instants.size() >= kMostChunkInstants)
    judgement.why_whole = "its chunks are of too many instants";
  if (!judgement.why_whole.empty()) return judgement;
  return Judge(content, chunks, now, placement, display_px, limits).judge();
}

}  // namespace talisman::regulator
