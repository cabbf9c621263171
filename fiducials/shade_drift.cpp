// SPDX-License-Identifier: Apache-2.0
#include "fiducials/shade_drift.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "layers/built_effects.h"
#include "layers/clip.h"

namespace talisman::fiducials {

namespace {

using layers::dmat4;
using layers::dvec3;
using layers::dvec4;
using layers::LayerState;
using layers::ShadeTrace;

/// Effects whose traces move over a surface.
constexpr bool kAnyTrace = layers::is_built(layers::Effect::ShadowMap) ||
                           layers::is_built(layers::Effect::SpecularLayer) ||
                           layers::is_built(layers::Effect::ReflectionMap);

/// How far beyond the display a path is followed, as the points of the fit are at least.
constexpr double kBeyond_px = 1;

bool exists(const dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// That part of the receiver's bounds that is on the display.
layers::RectD seen_part(const LayerState& now) {
  const layers::RectD display{{0, 0}, dvec2(now.view.display_px)};
  return layers::intersection(now.screen_bounds_px, display);
}

/// Projects places in the receiver's space as it lies now.
class Projector {
 public:
  explicit Projector(const LayerState& now)
      : now_(now),
        clip_from_receiver_(layers::clip_from_world(now.camera, now.view.display_px) *
                            now.world_from_receiver),
        view_(layers::view_half_spaces(now.camera.near_m, kBeyond_px / dvec2(now.view.display_px), 0)) {}

  struct Path {
    double px = 0;
    dvec2 end{0, 0};
  };

  /// The segment on the display, as far as it is in view.
  Path path(const dvec3& from, const dvec3& to) const {
    const dvec4 a = clip_from_receiver_ * dvec4(from, 1), b = clip_from_receiver_ * dvec4(to, 1);
    double t0 = 0, t1 = 1;
    for (const layers::HalfSpace& side : view_) {
      const double da = side.distance(a), db = side.distance(b);
      if (!(da >= 0) && !(db >= 0)) return {};
      if (!(da >= 0)) t0 = std::max(t0, da / (da - db));
      if (!(db >= 0)) t1 = std::min(t1, da / (da - db));
    }
    if (!(t0 < t1)) return {};
    const dvec2 start = screen(a + t0 * (b - a)), end = screen(a + t1 * (b - a));
    const double length = glm::distance(start, end);
    return std::isfinite(length) ? Path{length, end} : Path{};
  }

 private:
  dvec2 screen(const dvec4& clip) const { return layers::screen_from_clip(clip, now_.view.display_px); }

  const LayerState& now_;
  dmat4 clip_from_receiver_;
  layers::ViewHalfSpaces view_;
};

/// The worst of what is included; `enough` where that is beyond a limit, and no more is asked for.
struct Worst {
  double enough_px = std::numeric_limits<double>::infinity();
  ShadeMotion motion;
  bool enough() const { return motion.px > enough_px; }
};

void include(Worst& worst, double px, dvec2 where_px, int trace) {
  if (!(px > worst.motion.px)) return;
  worst.motion.px = px;
  worst.motion.where_px = where_px;
  worst.motion.trace = trace;
}

/// A place that is known in one state only crosses all that is seen.
void include_crossing(const LayerState& now, int trace, Worst& worst) {
  const layers::RectD seen = seen_part(now);
  include(worst, std::hypot(seen.width(), seen.height()), (seen.lo + seen.hi) / 2.0, trace);
}

void add_trace(const Projector& projector, const LayerState& now, const ShadeTrace& then_trace,
               const ShadeTrace& now_trace, int index, Worst& worst) {
  if (!then_trace.on_receiver && !now_trace.on_receiver) return;
  const std::size_t count = std::min(then_trace.places.size(), now_trace.places.size());
  for (std::size_t i = 0; i < count && !worst.enough(); ++i) {
    const dvec3 &from = then_trace.places[i], &to = now_trace.places[i];
    const bool was = exists(from), is = exists(to);
    if (was && is) {
      if (from == to) continue;
      const Projector::Path path = projector.path(from, to);
      include(worst, path.px, path.end, index);
    } else if (was != is) {
      include_crossing(now, index, worst);
    }
  }
}

/// Is there anything that could run over the surface, and would be seen?
bool may_run(const LayerState& then, const LayerState& now) {
  return kAnyTrace && now.touches_display && !(then.traces.empty() && now.traces.empty());
}

void add_traces(const LayerState& then, const LayerState& now, Worst& worst) {
  const Projector projector(now);
  for (std::size_t i = 0; i < std::min(then.traces.size(), now.traces.size()) && !worst.enough(); ++i)
    add_trace(projector, now, then.traces[i], now.traces[i], static_cast<int>(i), worst);
  if (then.traces.size() != now.traces.size())  // the receiver, or what it stands in, was not finite
    include_crossing(now, -1, worst);
}

}  // namespace

ShadeMotion shade_motion(const LayerState& then, const LayerState& now) {
  Worst worst;
  ShadeMotion& motion = worst.motion;
  if (!may_run(then, now)) {
    motion.why_not = kAnyTrace && !(then.traces.empty() && now.traces.empty())
                         ? "out of view"
                         : "no shadow, highlight or reflection in it moves by itself";
    return motion;
  }
  motion.computed = true;
  add_traces(then, now, worst);
  motion.where_px = glm::clamp(motion.where_px, dvec2(0), dvec2(now.view.display_px));
  return motion;
}

bool shade_runs_beyond(const LayerState& then, const LayerState& now, double limit_px) {
  if (!may_run(then, now)) return false;
  Worst worst{limit_px, {}};
  add_traces(then, now, worst);
  return worst.enough();
}

std::string_view name(ShadeTrace::Kind kind) {
  switch (kind) {
    case ShadeTrace::Kind::Shadow:
      return "shadow";
    case ShadeTrace::Kind::Highlight:
      return "highlight";
    case ShadeTrace::Kind::Reflection:
      return "reflection";
  }
  return "?";
}

}  // namespace talisman::fiducials
