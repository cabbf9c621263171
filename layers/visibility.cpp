// SPDX-License-Identifier: Apache-2.0
#include "layers/visibility.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include <glm/geometric.hpp>

#include "layers/check.h"
#include "layers/convex.h"

namespace talisman::layers {

struct VisibilitySorter::State {
  VisibilityOptions options;
  std::vector<int> last_order;
  std::map<std::vector<int>, int> held;  // component -> frames without a cycle
};

VisibilitySorter::VisibilitySorter(const VisibilityOptions& options)
    : state_(std::make_unique<State>(State{options, {}, {}})) {}
VisibilitySorter::VisibilitySorter(const VisibilitySorter& o) : state_(std::make_unique<State>(*o.state_)) {}
VisibilitySorter::VisibilitySorter(VisibilitySorter&&) noexcept = default;
VisibilitySorter& VisibilitySorter::operator=(VisibilitySorter o) noexcept {
  state_ = std::move(o.state_);
  return *this;
}
VisibilitySorter::~VisibilitySorter() = default;

namespace {

using Edges = std::vector<std::set<int>>;  // behind -> those in front

bool usable(std::span<const dvec3> points) {
  for (const dvec3& p : points)
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
  return !points.empty();
}

bool body_occludes(const dvec3& eye, std::span<const dvec3> a, std::span<const dvec3> b, double touch) {
  if (!usable(a) || !usable(b)) return false;
  const dvec3 origin = a[0];
  std::vector<dvec3> la, lb;
  const WorldBounds none;
  WorldBounds ba = none, bb = none;
  for (const dvec3& p : a) la.push_back(p - origin), ba.lo = glm::min(ba.lo, p), ba.hi = glm::max(ba.hi, p);
  for (const dvec3& p : b) lb.push_back(p - origin), bb.lo = glm::min(bb.lo, p), bb.hi = glm::max(bb.hi, p);
  const auto size = [](const WorldBounds& w) {
    const dvec3 d = w.hi - w.lo;
    return std::max({d.x, d.y, d.z});
  };
  const dvec3 e = eye - origin;
  const double scale = glm::length(e) + size(ba) + size(bb) + glm::length(lb[0]);
  return decide_depth({la}, {lb, &e}, touch * std::fmin(size(ba), size(bb)) + 1e-13 * scale).deeper;
}

bool occludes(const dvec3& eye, const Occluder& a, const Occluder& b, double touch) {
  for (const auto& p : a.bodies)
    for (const auto& q : b.bodies)
      if (body_occludes(eye, p, q, touch)) return true;
  return false;
}

std::vector<std::vector<int>> components(const Edges& edges, const std::vector<int>& start) {
  std::vector<int> index(edges.size(), -1), low(edges.size(), 0), open;
  std::vector<bool> done(edges.size(), false);
  std::vector<std::vector<int>> found;
  int count = 0;
  std::function<void(int)> walk = [&](int u) {
    index[u] = low[u] = count++;
    open.push_back(u);
    for (const int v : edges[u]) {
      if (done[v]) continue;
      if (index[v] < 0) walk(v), low[u] = std::min(low[u], low[v]);
      else low[u] = std::min(low[u], index[v]);
    }
    if (low[u] != index[u]) return;
    std::vector<int> c;
    do c.push_back(open.back()), done[open.back()] = true, open.pop_back();
    while (c.back() != u);
    std::sort(c.begin(), c.end());
    found.push_back(c);
  };
  for (std::size_t i = start.size(); i-- > 0;)
    if (index[start[i]] < 0) walk(start[i]);
  std::reverse(found.begin(), found.end());
  return found;
}

}  // namespace

VisibilityOrder VisibilitySorter::sort(const dvec3& eye, std::span<const Occluder> occluders,
                                       std::span<const ExplicitPair> pairs) {
  VisibilityOrder out;
  const int n = static_cast<int>(occluders.size());
  std::map<int, int> slot;
  for (int i = 0; i < n; ++i) slot[occluders[i].layer] = i;
  TALISMAN_CHECK_EQ(static_cast<int>(slot.size()), n);
  std::vector<int> start(n);
  for (int i = 0; i < n; ++i) start[i] = i;
  const auto rank = [&](int i) {
    const auto& o = state_->last_order;
    return std::find(o.begin(), o.end(), occluders[i].layer) - o.begin();
  };
  std::stable_sort(start.begin(), start.end(), [&](int a, int b) {
    if (occluders[a].group != occluders[b].group) return occluders[a].group < occluders[b].group;
    return rank(a) < rank(b);
  });
  Edges edges(n);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      if (a != b && occluders[a].group == occluders[b].group &&
          occludes(eye, occluders[a], occluders[b], state_->options.touch))
        edges[b].insert(a);
  for (const ExplicitPair& p : pairs) {
    if (!slot.count(p.behind) || !slot.count(p.front)) continue;
    edges[slot[p.front]].erase(slot[p.behind]);
    edges[slot[p.behind]].insert(slot[p.front]);
  }
  for (const auto& c : components(edges, start))
    if (c.size() > 1) {
      std::vector<int> ids;
      for (const int i : c) ids.push_back(occluders[i].layer);
      std::sort(ids.begin(), ids.end());
      state_->held[ids] = -1;
    }
  std::map<std::vector<int>, int> kept;
  for (auto& [ids, age] : state_->held)
    if (++age < std::max(1, state_->options.release_frames)) {
      for (std::size_t k = 0; k < ids.size(); ++k) {
        const int u = ids[k], v = ids[(k + 1) % ids.size()];
        if (slot.count(u) && slot.count(v)) edges[slot[u]].insert(slot[v]);
      }
      kept[ids] = age;
    }
  state_->held = kept;
  for (const auto& c : components(edges, start)) {
    std::vector<int> ids;
    for (const int i : c) ids.push_back(occluders[i].layer);
    std::sort(ids.begin(), ids.end());
    if (ids.size() > 1) {
      MergedComponent m;
      m.layers = ids;
      for (const int u : c)
        for (const int v : edges[u])
          if (std::find(c.begin(), c.end(), v) != c.end())
            m.relations.push_back({occluders[u].layer, occluders[v].layer});
      out.merged.push_back(m);
    }
    out.order.insert(out.order.end(), ids.begin(), ids.end());
    out.groups_back_to_front.push_back(ids);
  }
  state_->last_order = out.order;
  return out;
}

}  // namespace talisman::layers
