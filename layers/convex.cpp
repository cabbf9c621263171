// SPDX-License-Identifier: Apache-2.0
#include "layers/convex.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

namespace talisman::layers {

namespace {

constexpr int kMaxApart = 48;    ///< supports while the sets seem to be apart; GJK needs some 5
constexpr int kMaxExpand = 60;   ///< supports of the expanding polytope
constexpr int kExtraSteps = 10;  ///< supports spent on better bounds after the decision
constexpr double kEnough = 0.8;  ///< bounds within this ratio of each other are good enough
constexpr double kRounding = 1e-14;

bool contains(const ConvexSet& s) { return s.apex || !s.points.empty(); }

dvec3 middle(const ConvexSet& s) {
  dvec3 sum{0, 0, 0};
  for (const dvec3& p : s.points) sum += p;
  return s.points.empty() ? *s.apex : sum / static_cast<double>(s.points.size());
}

const dvec3& point_of(const ConvexSet& s, int index) {
  return index == Enclosure::kApex ? *s.apex : s.points[static_cast<std::size_t>(index)];
}

/// The index of the point farthest along n.
int farthest(const ConvexSet& s, const dvec3& n) {
  int best = s.apex ? Enclosure::kApex : 0;
  double most = s.apex ? glm::dot(*s.apex, n) : -HUGE_VAL;
  const int count = static_cast<int>(s.points.size());
  for (int i = 0; i < count; ++i) {
    const dvec3& p = s.points[static_cast<std::size_t>(i)];
    const double d = p.x * n.x + p.y * n.y + p.z * n.z;
    if (d > most) most = d, best = i;
  }
  return best;
}

/// A point set that has the origin as near as the simplex has, at most four points.
struct Simplex {
  std::array<dvec3, 4> p;
  int size = 0;
  void assign(std::initializer_list<dvec3> points) {
    size = 0;
    for (const dvec3& q : points) p[size++] = q;
  }
};

/// Reduces `s` to the face nearest to the origin, returns the nearest point.
dvec3 nearest_on_segment(Simplex& s, const dvec3& a, const dvec3& b) {
  const dvec3 ab = b - a;
  const double t = -glm::dot(a, ab), length2 = glm::dot(ab, ab);
  if (t <= 0 || length2 == 0) return s.assign({a}), a;
  if (t >= length2) return s.assign({b}), b;
  return s.assign({a, b}), a + ab * (t / length2);
}

/// By the regions of the triangle (Ericson, Real-Time Collision Detection, 5.1.5).
dvec3 nearest_on_triangle(Simplex& s, const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 ab = b - a, ac = c - a;
  const double d1 = -glm::dot(ab, a), d2 = -glm::dot(ac, a);
  const double d3 = -glm::dot(ab, b), d4 = -glm::dot(ac, b);
  const double d5 = -glm::dot(ab, c), d6 = -glm::dot(ac, c);
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (va > 0 && vb > 0 && vc > 0) {
    const dvec3 n = glm::cross(ab, ac);  // by the normal, since weights of small areas lose digits
    s.assign({a, b, c});
    return n * (glm::dot(n, a) / glm::dot(n, n));
  }
  Simplex best;
  dvec3 nearest = nearest_on_segment(best, a, b);
  for (const auto& [p, q] : {std::pair{a, c}, std::pair{b, c}}) {
    Simplex other;
    const dvec3 v = nearest_on_segment(other, p, q);
    if (glm::dot(v, v) < glm::dot(nearest, nearest)) nearest = v, best = other;
  }
  s = best;
  return nearest;
}

/// The origin is on the other side of plane (a, b, c) than d; or the plane is none.
bool beyond(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  const dvec3 n = glm::cross(b - a, c - a);
  const double origin = -glm::dot(a, n), inside = glm::dot(d - a, n);
  return origin * inside <= 0;
}

/// Empty where the origin is inside the tetrahedron.
bool nearest_on_tetrahedron(Simplex& s, dvec3& nearest) {
  const auto p = s.p;
  constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
  bool outside = false;
  for (const auto& f : kFaces) {
    if (!beyond(p[f[0]], p[f[1]], p[f[2]], p[f[3]])) continue;
    Simplex face;
    const dvec3 v = nearest_on_triangle(face, p[f[0]], p[f[1]], p[f[2]]);
    if (outside && glm::dot(v, v) >= glm::dot(nearest, nearest)) continue;
    nearest = v, s = face, outside = true;
  }
  return outside;
}

bool nearest_on(Simplex& s, dvec3& nearest) {
  const auto p = s.p;
  switch (s.size) {
    case 1:
      nearest = p[0];
      return true;
    case 2:
      nearest = nearest_on_segment(s, p[0], p[1]);
      return true;
    case 3:
      nearest = nearest_on_triangle(s, p[0], p[1], p[2]);
      return true;
    default:
      return nearest_on_tetrahedron(s, nearest);
  }
}

/// The polytope inside A - C that grows towards its boundary where that is nearest to the origin.
class Polytope {
 public:
  struct Face {
    std::array<int, 3> v;
    double distance;  ///< signed, of the origin below the face; HUGE_VAL: a face without area
    dvec3 normal;
  };

  /// `p` are four points that are not in one plane.
  explicit Polytope(const std::array<dvec3, 4>& p) {
    for (const dvec3& q : p) vertices_[vertex_count_++] = q;
    const bool turned = glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) > 0;
    constexpr int kFaces[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}};
    for (const auto& f : kFaces) turned ? add_face(f[0], f[2], f[1]) : add_face(f[0], f[1], f[2]);
  }

  const Face& nearest() const {
    return *std::min_element(faces_.begin(), faces_.begin() + face_count_,
                             [](const Face& f, const Face& g) { return f.distance < g.distance; });
  }

  /// False where `w` adds nothing or there is no room left.
  bool add(const dvec3& w) {
    if (vertex_count_ == kVertices) return false;
    edge_count_ = 0;
    for (int i = 0; i < face_count_;) {
      const Face& f = faces_[i];
      const bool seen = f.distance < HUGE_VAL && glm::dot(f.normal, w) > f.distance;
      if (!seen) {
        ++i;
        continue;
      }
      for (int k = 0; k < 3; ++k) toggle_edge(f.v[k], f.v[(k + 1) % 3]);
      faces_[i] = faces_[--face_count_];
    }
    if (edge_count_ < 3 || face_count_ + edge_count_ > kFaces) return false;
    vertices_[vertex_count_] = w;
    for (int k = 0; k < edge_count_; ++k) add_face(edges_[k][0], edges_[k][1], vertex_count_);
    ++vertex_count_;
    return true;
  }

 private:
  static constexpr int kVertices = 4 + kMaxExpand, kFaces = 2 * kVertices, kEdges = 3 * kFaces;

  void add_face(int a, int b, int c) {
    Face f{{a, b, c}, HUGE_VAL, {0, 0, 0}};
    const dvec3 n = glm::cross(vertices_[b] - vertices_[a], vertices_[c] - vertices_[a]);
    const double length = glm::length(n);
    if (length > 0) f.normal = n / length, f.distance = glm::dot(f.normal, vertices_[a]);
    faces_[face_count_++] = f;
  }

  /// The edges that only one removed face had are the rim of the hole.
  void toggle_edge(int a, int b) {
    for (int k = 0; k < edge_count_; ++k) {
      if (edges_[k][0] != b || edges_[k][1] != a) continue;
      edges_[k] = edges_[--edge_count_];
      return;
    }
    edges_[edge_count_++] = {a, b};
  }

  std::array<dvec3, kVertices> vertices_;
  std::array<Face, kFaces + 1> faces_;
  std::array<std::array<int, 2>, kEdges> edges_;
  int vertex_count_ = 0, face_count_ = 0, edge_count_ = 0;
};

class DepthQuery {
 public:
  DepthQuery(const ConvexSet& a, const ConvexSet& c, double tolerance, double worthwhile)
      : a_(a), c_(c), tolerance_(tolerance), worthwhile_(worthwhile) {
    result_.upper = HUGE_VAL, result_.lower = -HUGE_VAL;
  }

  DepthDecision run(dvec3 n) {
    if (search_apart(n)) {
      note_enclosure();
      expand();
    }
    result_.deeper = result_.upper > tolerance_;
    return result_;
  }

 private:
  /// The point of A - C farthest along unit n; every call bounds the depth from above.
  dvec3 support(const dvec3& n) {
    ++result_.iterations;
    const int a = farthest(a_, n), c = farthest(c_, -n);
    const dvec3 w = point_of(a_, a) - point_of(c_, c);
    if (seen_count_ < kMaxApart) seen_[seen_count_++] = {w, a, c};
    scale_ = std::fmax(scale_, glm::length(w));
    const double h = glm::dot(w, n);
    if (h < result_.upper) result_.upper = h, result_.normal = n;
    return w;
  }

  bool spent() {
    const bool apart = result_.upper <= tolerance_, deeper = result_.lower > tolerance_;
    const double most_room = apart ? tolerance_ - result_.lower : result_.upper - tolerance_;
    return (apart || deeper) && (extra_++ >= kExtraSteps || most_room < worthwhile_);
  }

  /// The origin is in the simplex: of which points is that made?
  void note_enclosure() {
    if (simplex_.size != 4) return;
    Enclosure found;
    for (int k = 0; k < 4; ++k) {
      const Seen* at = std::find_if(seen_.begin(), seen_.begin() + seen_count_,
                                    [&](const Seen& s) { return s.w == simplex_.p[k]; });
      found.a[k] = at->a, found.c[k] = at->c;
    }
    result_.enclosure = found;
  }

  /// GJK. True if the simplex reaches the origin, that is, the sets meet.
  bool search_apart(dvec3 n) {
    for (int step = 0; step < kMaxApart; ++step) {
      const dvec3 w = support(n);
      if (std::find(simplex_.p.begin(), simplex_.p.begin() + simplex_.size, w) !=
          simplex_.p.begin() + simplex_.size)
        break;  // no point lies farther: the nearest point is found to rounding
      simplex_.p[simplex_.size++] = w;
      dvec3 v;
      if (!nearest_on(simplex_, v)) return true;
      const double distance = glm::length(v);
      if (distance <= kRounding * scale_) return true;
      result_.lower = std::fmax(result_.lower, -distance);
      n = v / -distance;
      const bool bounded = -result_.upper >= kEnough * distance;
      if (result_.upper <= tolerance_ && (bounded || spent())) return false;
    }
    if (result_.upper > tolerance_) result_.decided = false;
    return false;
  }

  /// Four points of A - C that are not in one plane, from what the simplex has. False where A - C is flat;
  /// the directions that show it have then bounded the depth by rounding.
  bool complete() {
    if (simplex_.size == 1 && !widen(axes())) return false;
    if (simplex_.size == 2) {
      const dvec3 d = simplex_.p[1] - simplex_.p[0];
      const dvec3 u = perpendicular(d), v = glm::normalize(glm::cross(d, u));
      if (!widen({u, -u, v, -v})) return false;
    }
    if (simplex_.size == 4) return true;
    const dvec3 n = glm::cross(simplex_.p[1] - simplex_.p[0], simplex_.p[2] - simplex_.p[0]);
    const double length = glm::length(n);
    return length > 0 && widen({n / length, n / -length});
  }

  static std::initializer_list<dvec3> axes() {
    static constexpr double kOne = 1;
    static const std::initializer_list<dvec3> kAxes = {{kOne, 0, 0},  {-kOne, 0, 0}, {0, kOne, 0},
                                                       {0, -kOne, 0}, {0, 0, kOne},  {0, 0, -kOne}};
    return kAxes;
  }

  static dvec3 perpendicular(const dvec3& d) {
    const dvec3 a = glm::abs(d);
    const dvec3 e = a.x <= a.y && a.x <= a.z ? dvec3{1, 0, 0} : a.y <= a.z ? dvec3{0, 1, 0} : dvec3{0, 0, 1};
    return glm::normalize(glm::cross(d, e));
  }

  /// Adds the first support that leaves the span of the simplex.
  bool widen(std::initializer_list<dvec3> directions) {
    for (const dvec3& n : directions) {
      const dvec3 w = support(n);
      if (glm::dot(w - simplex_.p[0], n) <= kRounding * scale_) continue;
      simplex_.p[simplex_.size++] = w;
      return true;
    }
    return false;
  }

  void expand() {
    if (result_.upper <= tolerance_ || !complete() || result_.upper <= tolerance_) return;
    Polytope polytope(simplex_.p);
    for (int step = 0; step < kMaxExpand; ++step) {
      const auto face = polytope.nearest();
      result_.lower = std::fmax(result_.lower, face.distance);
      if (result_.lower > tolerance_ && (result_.lower >= kEnough * result_.upper || spent())) return;
      const dvec3 w = support(face.normal);
      if (result_.upper <= tolerance_ || spent()) return;
      if (glm::dot(w, face.normal) - face.distance <= kRounding * scale_) return;  // the boundary itself
      if (!polytope.add(w)) break;
    }
    result_.decided = result_.lower > tolerance_;
  }

  const ConvexSet& a_;
  const ConvexSet& c_;
  double tolerance_, worthwhile_, scale_ = 0;
  int extra_ = 0;
  Simplex simplex_;
  DepthDecision result_;
  struct Seen {
    dvec3 w;
    int a, c;
  };
  std::array<Seen, kMaxApart> seen_;  ///< the supports while the sets seemed to be apart
  int seen_count_ = 0;
};

/// Of the origin from the plane of three corners, on the side of the fourth; -HUGE_VAL: no tetrahedron.
double distance_below(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& inner) {
  const dvec3 n = glm::cross(b - a, c - a);
  const double side = glm::dot(n, a - inner), length = glm::length(n);
  if (side == 0 || length == 0) return -HUGE_VAL;
  return (side > 0 ? glm::dot(n, a) : -glm::dot(n, a)) / length;
}

}  // namespace

double depth_within(const Enclosure& enclosure, const ConvexSet& a, const ConvexSet& c) {
  std::array<dvec3, 4> p;
  for (int k = 0; k < 4; ++k) p[k] = point_of(a, enclosure.a[k]) - point_of(c, enclosure.c[k]);
  return std::min(std::min(distance_below(p[0], p[1], p[2], p[3]), distance_below(p[0], p[1], p[3], p[2])),
                  std::min(distance_below(p[0], p[2], p[3], p[1]), distance_below(p[1], p[2], p[3], p[0])));
}

DepthDecision decide_depth(const ConvexSet& a, const ConvexSet& c, double tolerance, const dvec3& guess,
                           double worthwhile) {
  if (!contains(a) || !contains(c)) return {false, true, -HUGE_VAL, -HUGE_VAL, {0, 0, 0}, 0, {}};
  dvec3 n = guess;
  if (n == dvec3{0, 0, 0}) n = middle(c) - middle(a);
  const double length = glm::length(n);
  return DepthQuery(a, c, tolerance, worthwhile).run(length > 0 ? n / length : dvec3{0, 0, 1});
}

}  // namespace talisman::layers
