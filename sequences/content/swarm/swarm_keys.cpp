// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/swarm/swarm_keys.h"

namespace talisman::sequences {

const Table<SwarmContent>& swarm_keys() {
  using S = SwarmContent;
  using Shape = SwarmContent::Shape;
  static const Table<S> table =
      Table<S>("swarm")
          .key("count", &S::count, whole(1, kLargestSwarm), "", "how many things")
          .key("shape", &S::shape,
               choice<Shape>({{"quad", Shape::Quad},
                              {"block", Shape::Block},
                              {"sphere", Shape::Sphere},
                              {"molecule", Shape::Molecule}}),
               "", "of 1, 6, 144 and 300 quads")
          .key("size", &S::size, number(kPositive), "",
               "factor: at 1 a block has edges of 1, a sphere a radius of 0.75, a molecule lies within 2.5")
          .key("quad_edges", &S::quad_edges_m, interval(kPositive), "m", "of quads: shortest, longest")
          .key("cube", &S::cube_m, number(kPositive), "m", "its side; its middle is the origin")
          .key("seed", &S::seed, whole(0, 2'000'000'000), "", "of all that is random")
          .key("moving", &S::moving_percent, number({0, 100}), "%",
               "how many of them move: those with the lowest numbers, rounded")
          .key("translation", &S::translation_m, number(kNotNegative), "m",
               "in a frame at most, along each axis")
          .key("rotation_deg", &S::rotation_deg, number(kNotNegative), "°",
               "in a frame at most, about each axis")
          .key("wrap", &S::wrap, truth(), "", "what leaves the cube enters it on the opposite side")
          .key("colors", &S::colors, whole(1, 1000), "", "materials")
          .key("lights", &S::lights, whole(0, 16), "",
               "point lights at random places of the cube, with linear attenuation, beside those of `lights`")
          .placed([](S& swarm, const YamlValue& self) {
            swarm.file = self.file();
            swarm.line = self.line();
          });
  return table;
}

}  // namespace talisman::sequences
