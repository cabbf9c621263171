// SPDX-License-Identifier: Apache-2.0
// Fits the affine warp of least maximum error to the corners of a square that turns and goes away, and says how much
// better any other affine warp could be.
#include <talisman/warp/fit.h>

#include <cstdio>
#include <vector>

int main() {
  using namespace talisman;
  const std::vector<layers::dvec2> then_px = {{100, 100}, {300, 100}, {300, 300}, {100, 300}};
  const std::vector<layers::dvec2> now_px = {{104, 98}, {292, 112}, {290, 286}, {103, 301}};

  const warp::FitResult fitted = warp::fit(then_px, now_px, warp::Curve::affi);
  if (!fitted.usable()) return 1;

  const layers::Affine2 map = fitted.warp.affine();
  std::printf("status   %s\n", warp::name(fitted.status).data());
  std::printf("warp     x' = %8.5f x + %8.5f y + %8.3f\n", map.a, map.b, map.tx);
  std::printf("         y' = %8.5f x + %8.5f y + %8.3f\n", map.c, map.d, map.ty);
  std::printf("error    %.4f px at the worst point, %d\n", fitted.max_px, fitted.worst_point);
  std::printf("bound    no affine warp does better than %.4f px\n", fitted.max_lower_bound_px);
  std::printf("identity would be worse: its image of (100, 100) is %.1f px off\n",
              layers::length(now_px[0] - then_px[0]));
}
