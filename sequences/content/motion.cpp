// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/motion.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "sequences/content/traces/trace_keys.h"

namespace talisman::sequences {

namespace {

using layers::dvec3;

struct FlightKey {
  double t_s = 0;
  dvec3 position{0};
  std::optional<dvec3> target;
  std::optional<double> bank_rad;
};

const Table<FlightKey>& flight_keys() {
  static const Table<FlightKey> table =
      Table<FlightKey>("flight")
          .key("t", &FlightKey::t_s, number(), "s", "when")
          .required()
          .key("position", &FlightKey::position, vector(), "m", "where it is then")
          .required()
          .key("target", &FlightKey::target, vector(), "m",
               "what the nose points at, the flight's way if no key has it")
          .key("bank_deg", &FlightKey::bank_rad, degrees({-3600, 3600}), "°", "roll, positive to the right")
          .otherwise("between its neighbours; level if no key has it");
  return table;
}

layers::FlightTrack flight_through(const std::vector<FlightKey>& keys) {
  layers::FlightTrack flight;
  for (const FlightKey& key : keys) {
    flight.position.times_s.push_back(key.t_s);
    flight.position.values.push_back(key.position);
    if (key.target) flight.target.times_s.push_back(key.t_s), flight.target.values.push_back(*key.target);
    if (key.bank_rad)
      flight.bank_rad.times_s.push_back(key.t_s), flight.bank_rad.values.push_back(*key.bank_rad);
  }
  // Aim and bank are as smooth as the path.
  flight.target.interpolation = flight.bank_rad.interpolation = layers::Interpolation::CatmullRom;
  return flight;
}

Format<layers::FlightTrack> flight() {
  const auto keys = keys_over_time(flight_keys(), &FlightKey::t_s);
  return {keys.type, [read = keys.read](const YamlValue& list) { return flight_through(read(list)); }};
}

const Table<layers::SpinTrack>& spin_keys() {
  using layers::SpinTrack;
  static const Table<SpinTrack> table =
      Table<SpinTrack>("spin")
          .key("axis", &SpinTrack::axis, direction(), "", "about which it turns, in its own space")
          .key("deg_per_s", &SpinTrack::rate_rad_per_s, degrees(kAnyNumber), "°/s", "how fast")
          .required();
  return table;
}

glm::dquat looking(const dvec3& from, const YamlValue& at) {
  const dvec3 ahead = at.vector() - from;
  if (glm::length(ahead) == 0) at.fail("another place than position");
  const dvec3 z = -glm::normalize(ahead);
  const dvec3 up = std::abs(z.y) > 0.9999 ? dvec3{0, 0, -1} : dvec3{0, 1, 0};
  const dvec3 x = glm::normalize(glm::cross(up, z));
  return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
}

void read_carrier(const YamlValue& value, Motion& motion) {
  motion.carried_by = value.text();
  motion.line = value.line();
}

void read_rotation(const YamlValue& value, Motion& motion) {
  motion.rest.rotation = glm::dquat(glm::radians(value.vector()));
}

/// After the position: what is looked at from there.
void read_look_at(const YamlValue& value, Motion& motion) {
  motion.rest.rotation = looking(motion.rest.translation, value);
}

}  // namespace

const Table<Motion>& motion_keys() {
  const ValueType triple = vector().type;
  static const Table<Motion> table =
      Table<Motion>("motion")
          .placed([](Motion& motion, const YamlValue& self) {
            motion.file = self.file();
            motion.line = self.line();
          })
          .custom("carried_by", with_rule(text().type, "the name of a shape before it"), read_carrier, "",
                  "shape with which it moves: places and flights are in that shape's space")
          .otherwise("the world")
          .key("position", at(&Motion::rest, &layers::Transform::translation), vector(), "m",
               "where it stands")
          .not_with({"flight"})
          .custom("rotation_deg", triple, read_rotation, "°", "turned about x, then y, then z")
          .otherwise("[0, 0, 0]")
          .not_with({"flight"})
          .custom("look_at", with_rule(triple, "another place than position"), read_look_at, "m",
                  "place to which its -z points, instead of `rotation_deg`")
          .not_with({"flight"})
          .key("flight", &Motion::flight, flight(), "", "where it flies, over time")
          .key("trace", &Motion::trace, map_of(trace_keys()), "",
               "moves as somebody's head, camera or body did; position and rotation_deg are then its place "
               "on that")
          .not_with({"flight", "look_at"})
          .key("spin", &Motion::spin, map_of(spin_keys()), "",
               "turns what stands or flies about its own origin");
  return table;
}

}  // namespace talisman::sequences
