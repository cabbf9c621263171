// SPDX-License-Identifier: Apache-2.0
#include "layers/clip.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "layers/check.h"
#include "layers/inline_vector.h"
#include "layers/place_set.h"

namespace talisman::layers {
namespace {

// Written so that NaN is outside.
bool is_outside(double distance, double w) { return !(distance >= -kOnPlane * std::abs(w)); }
/// An end on the plane is its own crossing.
bool is_on_plane(double distance, double w) { return distance <= kOnPlane * std::abs(w); }

bool is_outside(const HalfSpace& h, const dvec4& clip) { return is_outside(h.distance(clip), clip.w); }

/// Rounding leaves a crossing up to an ulp of the far end of its edge away from the plane; on an edge that
/// reaches 1e8 m behind the eye that is more than the near distance. So the crossing is put on the plane.
void put_on_plane(const HalfSpace& h, dvec4& clip) {
  if (h.x != 0) {
    clip.x = -h.w * clip.w / h.x;
  } else if (h.y != 0) {
    clip.y = -h.w * clip.w / h.y;
  } else {
    clip.w = -h.constant / h.w;
  }
}

/// A convex polygon on the surface. A triangle gains at most one vertex per half-space; the rest is for
/// rounding.
struct Polygon {
  static constexpr int kCapacity = 48;
  std::array<MaterialPoint, kCapacity> vertices;
  int count = 0;

  void push(const MaterialPoint& vertex) {
    if (count < kCapacity) vertices[count++] = vertex;
  }
};

/// Always computed from the inner to the outer end, so that both triangles at an edge get the same bits.
MaterialPoint crossing(const HalfSpace& h, const MaterialPoint& inner, double d_inner,
                       const MaterialPoint& outer, double d_outer) {
  const double t = d_inner / (d_inner - d_outer);
  MaterialPoint result;
  for (int i = 0; i < 2; ++i) result.clip[i] = inner.clip[i] + t * (outer.clip[i] - inner.clip[i]);
  const bool at_rest = result.clip[0] == result.clip[1];
  put_on_plane(h, result.clip[h.state]);
  if (at_rest)
    result.clip[1 - h.state] = result.clip[h.state];  // what has not moved has moved by exactly nothing
  return result;
}

/// The distances of all vertices; false if none is outside.
bool is_cut(const HalfSpace& h, const Polygon& polygon, std::array<double, Polygon::kCapacity>& distances) {
  bool cut = false;
  for (int i = 0; i < polygon.count; ++i) {
    const dvec4& clip = polygon.vertices[i].clip[h.state];
    distances[i] = h.distance(clip);
    cut = cut || is_outside(distances[i], clip.w);
  }
  return cut;
}

void clip_polygon(const HalfSpace& h, const Polygon& polygon,
                  const std::array<double, Polygon::kCapacity>& distances, Polygon& result) {
  result.count = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const int j = i + 1 < polygon.count ? i + 1 : 0;
    const MaterialPoint &from = polygon.vertices[i], &to = polygon.vertices[j];
    const bool from_outside = is_outside(distances[i], from.clip[h.state].w);
    const bool to_outside = is_outside(distances[j], to.clip[h.state].w);
    if (!from_outside) result.push(from);
    if (from_outside == to_outside) continue;
    const int inner = from_outside ? j : i, outer = from_outside ? i : j;
    if (is_on_plane(distances[inner], polygon.vertices[inner].clip[h.state].w)) continue;
    result.push(
        crossing(h, polygon.vertices[inner], distances[inner], polygon.vertices[outer], distances[outer]));
  }
}

/// A 26-direction polyhedron has 48.
constexpr std::size_t kUsualPoints = 48;
using Codes = InlineVector<unsigned, kUsualPoints>;

/// The points found so far, each once.
class PointSet {
 public:
  explicit PointSet(std::size_t originals) : places_(originals + 24) {
    has_original_.reserve(originals);
    for (std::size_t i = 0; i < originals; ++i) has_original_.push_back(0);
  }

  void add(const MaterialPoint& candidate) {
    if (candidate.point >= 0 && std::exchange(has_original_[candidate.point], 1)) return;
    places_.add(candidate);
  }
  std::vector<MaterialPoint> take() { return places_.take(); }

 private:
  PlaceSet places_;
  InlineVector<char, kUsualPoints> has_original_;
};

Codes outcodes(std::span<const dvec4> clip_0, std::span<const dvec4> clip_1,
               std::span<const HalfSpace> half_spaces) {
  Codes codes;
  codes.reserve(clip_0.size());
  for (std::size_t i = 0; i < clip_0.size(); ++i) {
    unsigned code = 0;
    for (std::size_t h = 0; h < half_spaces.size(); ++h) {
      const HalfSpace& half_space = half_spaces[h];
      code |= static_cast<unsigned>(is_outside(half_space, half_space.state == 0 ? clip_0[i] : clip_1[i]))
              << h;
    }
    codes.push_back(code);
  }
  return codes;
}

using Visit = std::function<void(std::span<const MaterialPoint>)>;

/// `crossed`: bits of the half-spaces that cut something off this polygon.
void clip_to_crossed(std::span<const HalfSpace> half_spaces, unsigned crossed, Polygon& polygon,
                     Polygon& spare, const Visit& visit) {
  Polygon* current = &polygon;
  Polygon* next = &spare;
  std::array<double, Polygon::kCapacity> distances;
  for (std::size_t h = 0; h < half_spaces.size(); ++h) {
    // What an earlier half-space cut off may be all that this one would have.
    if (!(crossed >> h & 1u) || !is_cut(half_spaces[h], *current, distances)) continue;
    clip_polygon(half_spaces[h], *current, distances, *next);
    std::swap(current, next);
  }
  if (current->count > 0) visit({current->vertices.data(), static_cast<std::size_t>(current->count)});
}

/// The vertices of the clipped surface, each once; its polygons are shown to `also`.
template <typename Also>
std::vector<MaterialPoint> vertices_of_surface(std::span<const std::array<int, 3>> triangles,
                                               std::span<const dvec4> clip_0, std::span<const dvec4> clip_1,
                                               std::span<const HalfSpace> half_spaces, const Also& also) {
  PointSet points(clip_0.size());
  clip_polygons(triangles, clip_0, clip_1, half_spaces, [&](std::span<const MaterialPoint> polygon) {
    for (const MaterialPoint& vertex : polygon) points.add(vertex);
    also(polygon);
  });
  return points.take();
}

}  // namespace

ViewHalfSpaces view_half_spaces(double near_m, dvec2 clip_margin, int state) {
  const dvec2 g = dvec2(1) + 2.0 * clip_margin;
  // Two tolerances beyond the near plane: one is given back by the points that count as on the plane.
  const double nearest = near_m * (1 + 2 * kOnPlane);
  return {{{state, 0, 0, 1, -nearest},
           {state, 1, 0, g.x, 0},
           {state, -1, 0, g.x, 0},
           {state, 0, 1, g.y, 0},
           {state, 0, -1, g.y, 0}}};
}

unsigned outcode(const ViewHalfSpaces& view, const dvec4& clip) {
  unsigned code = 0;
  for (int i = 0; i < kViewHalfSpaces; ++i) code |= static_cast<unsigned>(is_outside(view[i], clip)) << i;
  return code;
}

bool is_same_in_all_coordinates(const MaterialPoint& a, const MaterialPoint& b) {
  for (int state = 0; state < 2; ++state) {
    const dvec4 &p = a.clip[state], apart = glm::abs(p - b.clip[state]);
    const double size = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z), std::fabs(p.w)});
    if (std::max({apart.x, apart.y, apart.z, apart.w}) > kRoundingOfCrossings * size) return false;
  }
  return true;
}

void clip_polygons(std::span<const std::array<int, 3>> triangles, std::span<const dvec4> clip_0,
                   std::span<const dvec4> clip_1, std::span<const HalfSpace> half_spaces,
                   const Visit& visit) {
  TALISMAN_CHECK_EQ(clip_0.size(), clip_1.size());
  TALISMAN_CHECK_LE(half_spaces.size(), 32u);
  const auto codes = outcodes(clip_0, clip_1, half_spaces);
  Polygon polygon, spare;
  for (const auto& triangle : triangles) {
    const unsigned a = codes[triangle[0]], b = codes[triangle[1]], c = codes[triangle[2]];
    if (a & b & c) continue;
    polygon.count = 0;
    for (const int i : triangle) polygon.push({{clip_0[i], clip_1[i]}, i});
    if ((a | b | c) == 0)
      visit({polygon.vertices.data(), triangle.size()});
    else
      clip_to_crossed(half_spaces, a | b | c, polygon, spare, visit);
  }
}

std::vector<MaterialPoint> clip_surface(std::span<const std::array<int, 3>> triangles,
                                        std::span<const dvec4> clip_0, std::span<const dvec4> clip_1,
                                        std::span<const HalfSpace> half_spaces) {
  return vertices_of_surface(triangles, clip_0, clip_1, half_spaces, [](std::span<const MaterialPoint>) {});
}

void PolygonList::reserve(std::size_t polygons) {
  constexpr std::size_t kUsualCorners = 3;
  corners.reserve(corners.size() + kUsualCorners * polygons);
  ends.reserve(ends.size() + polygons);
}

void PolygonList::push(std::span<const MaterialPoint> polygon) {
  corners.insert(corners.end(), polygon.begin(), polygon.end());
  ends.push_back(corners.size());
}

std::span<const MaterialPoint> PolygonList::operator[](std::size_t i) const {
  const std::size_t begin = i == 0 ? 0 : ends[i - 1];
  return std::span(corners).subspan(begin, ends[i] - begin);
}

std::vector<MaterialPoint> clip_surface(std::span<const std::array<int, 3>> triangles,
                                        std::span<const dvec4> clip_0, std::span<const dvec4> clip_1,
                                        std::span<const HalfSpace> half_spaces, PolygonList& polygons) {
  polygons.reserve(triangles.size());
  return vertices_of_surface(triangles, clip_0, clip_1, half_spaces,
                             [&](std::span<const MaterialPoint> polygon) { polygons.push(polygon); });
}

}  // namespace talisman::layers
