// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Many small things that move for themselves in a cube: the scenes of [F96 5.2, Appendix A].
///
/// Places and attitudes are random. Of those that move, each has a velocity and an angular velocity of its own, uniform
/// per axis within the ranges and constant over the run. Where things wrap around, one that leaves the cube on one side
/// enters it on the opposite one: a jump, for which no extrapolation can be right.
///
///   quad      random edges along x and y; seen from both sides                 1 quad
///   block     edge 1                                                           6 quads
///   sphere    radius 0.75, 16 × 9 quads                                        144 quads (those at the poles are triangles)
///   molecule  two such spheres, 1.75 from the middle, and a rod of 12          300 quads, within 2.5
///
/// Not printed in the thesis, and so chosen here: the edges of quads, block and sphere, and where the lights stand. The
/// same seed gives the same things on every machine, whatever share of them moves: those with the lowest numbers do.

#include <cstdint>
#include <string>

#include "layers/scene.h"

namespace talisman::sequences {

/// Things of a swarm are so many at most.
inline constexpr int kLargestSwarm = 1'000'000;

struct SwarmContent {
  enum class Shape { Quad, Block, Sphere, Molecule };
  int count = 1000;  ///< 1 … kLargestSwarm
  Shape shape = Shape::Block;
  double size = 1;                   ///< > 0; factor of the shape
  layers::dvec2 quad_edges_m{1, 3};  ///< > 0; of quads: shortest and longest
  double cube_m = 20;                ///< > 0; side of the cube, whose middle is the origin
  std::uint32_t seed = 1;            ///< of all that is random
  double moving_percent = 100;       ///< 0 … 100; how many of the things move, rounded
  double translation_m = 0.15;       ///< ≥ 0; a frame at most, along each axis
  double rotation_deg = 4;           ///< ≥ 0; a frame at most, about each axis
  bool wrap = true;                  ///< false: what leaves the cube flies on
  int colors = 50;                   ///< ≥ 1; materials
  int lights = 4;                    ///< ≥ 0; point lights within the cube, with linear attenuation
  std::string file;                  ///< and line: where it is written
  int line = 0;
};

/// Number of things that move.
int moving_count(const SwarmContent& swarm);

/// Quads of one thing, as the thesis counts them.
int quads_of(SwarmContent::Shape shape);

/// Adds its parts, "swarm/0" and so on, their nodes and tracks, its materials and lights. Motion is per frame of 1 / `fps`
/// seconds; wrap-around is worked out until `last_s`. Throws InputError where things would wrap around too often to be held.
void add_swarm(layers::Scene& scene, const SwarmContent& swarm, double fps, double last_s);

}  // namespace talisman::sequences
