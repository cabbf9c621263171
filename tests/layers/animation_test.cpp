// SPDX-License-Identifier: Apache-2.0
#include "layers/animation.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace talisman::layers {
namespace {

constexpr double kPi = std::numbers::pi;

bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool finite(const glm::dquat& q) { return std::isfinite(q.w + q.x + q.y + q.z); }

Keys<dvec3> bend(Interpolation interpolation) {
  return {{0, 1, 3}, {{0, 0, 0}, {1, 0, 0}, {1, 4, 0}}, interpolation};
}

dvec3 forward_of(const Transform& t) { return t.rotation * dvec3{0, 0, -1}; }
dvec3 right_of(const Transform& t) { return t.rotation * dvec3{1, 0, 0}; }
dvec3 up_of(const Transform& t) { return t.rotation * dvec3{0, 1, 0}; }

Transform fly(const FlightTrack& flight, double t_s) { return transform_at({0, flight}, {}, t_s); }

FlightTrack flight_through(std::vector<dvec3> positions,
                           Interpolation interpolation = Interpolation::CatmullRom) {
  FlightTrack flight;
  for (std::size_t i = 0; i < positions.size(); ++i)
    flight.position.times_s.push_back(static_cast<double>(i));
  flight.position.values = std::move(positions);
  flight.position.interpolation = interpolation;
  return flight;
}

TEST(ValueAt, OneKeyHoldsAtAllTimes) {
  for (const auto interpolation : {Interpolation::Step, Interpolation::Linear, Interpolation::CatmullRom})
    for (const double t_s : {-1e9, 0.0, 2.0, 1e9})
      EXPECT_EQ(value_at(Keys<dvec3>{{2}, {{1, 2, 3}}, interpolation}, t_s), (dvec3{1, 2, 3}));
}

TEST(ValueAt, KeysAreMetExactlyAndEndsHold) {
  for (const auto interpolation : {Interpolation::Step, Interpolation::Linear, Interpolation::CatmullRom}) {
    const auto keys = bend(interpolation);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(value_at(keys, keys.times_s[i]), keys.values[i]);
    EXPECT_EQ(value_at(keys, -1e9), keys.values.front());
    EXPECT_EQ(value_at(keys, 1e9), keys.values.back());
  }
}

TEST(ValueAt, StepKeepsTheKeyBeforeUntilTheNext) {
  EXPECT_EQ(value_at(bend(Interpolation::Step), std::nextafter(1.0, 0.0)), (dvec3{0, 0, 0}));
}

TEST(ValueAt, LinearIsHalfWayInTheMiddle) {
  EXPECT_EQ(value_at(bend(Interpolation::Linear), 2), (dvec3{1, 2, 0}));
}

// The independent oracle: Barry & Goldman's pyramid of linear interpolations, which shares nothing with the
// Hermite form of the implementation. Keys lie in time as the knots do, where the pace is even and drops out.
dvec3 barry_goldman(const std::vector<dvec3>& p, const std::vector<double>& k, int i, double u) {
  const auto mix = [&](const dvec3& a, const dvec3& b, int ka, int kb) {
    return a * ((k[kb] - u) / (k[kb] - k[ka])) + b * ((u - k[ka]) / (k[kb] - k[ka]));
  };
  const dvec3 a1 = mix(p[i - 1], p[i], i - 1, i), a2 = mix(p[i], p[i + 1], i, i + 1);
  const dvec3 a3 = mix(p[i + 1], p[i + 2], i + 1, i + 2);
  return mix(mix(a1, a2, i - 1, i + 1), mix(a2, a3, i, i + 2), i, i + 1);
}

TEST(ValueAt, CatmullRomIsTheCentripetalSpline) {
  constexpr unsigned kSeed = 7;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> any(-5, 5);
  for (int trial = 0; trial < 200; ++trial) {
    Keys<dvec3> keys{{0}, {{any(random), any(random), any(random)}}, Interpolation::CatmullRom};
    for (int i = 1; i < 6; ++i) {
      keys.values.push_back({any(random), any(random), any(random)});
      keys.times_s.push_back(keys.times_s.back() +
                             std::sqrt(glm::distance(keys.values[i - 1], keys.values[i])));
    }
    for (int i = 1; i < 4; ++i)
      for (const double share : {0.1, 0.5, 0.9}) {
        const double t_s = keys.times_s[i] + share * (keys.times_s[i + 1] - keys.times_s[i]);
        EXPECT_LT(glm::distance(value_at(keys, t_s), barry_goldman(keys.values, keys.times_s, i, t_s)),
                  1e-12);
      }
  }
}

// Uneven key times are where a spline by position alone would jump in speed.
TEST(ValueAt, CatmullRomVelocityIsContinuousForUnevenTimes) {
  const Keys<dvec3> keys{{0, 0.1, 3, 3.2, 7},
                         {{0, 0, 0}, {3, 1, 0}, {4, -2, 1}, {9, 0, 2}, {9, 1, 2}},
                         Interpolation::CatmullRom};
  const double h = 1e-6;
  for (int i = 1; i < 4; ++i) {
    const double t_s = keys.times_s[i];
    const dvec3 before = (value_at(keys, t_s) - value_at(keys, t_s - h)) / h;
    const dvec3 after = (value_at(keys, t_s + h) - value_at(keys, t_s)) / h;
    EXPECT_LT(glm::distance(before, after), 1e-3 * (1 + glm::length(before))) << "key " << i;
  }
}

// What stands still must stand still bit by bit, or every frame of it would look as if it moved.
TEST(ValueAt, EqualKeysStandStillBitByBit) {
  const dvec3 p{0.1, 1.0 / 3, -2.7};
  const glm::dquat q = unit({0.3, 0.1, 0.7, -0.2});
  for (const auto interpolation : {Interpolation::Linear, Interpolation::CatmullRom}) {
    const Keys<dvec3> keys{{0, 1, 2, 3}, {{5, 5, 5}, p, p, {9, 0, 1}}, interpolation};
    const Keys<glm::dquat> turns{{1, 2}, {q, -q}, interpolation};
    const glm::dquat still = value_at(turns, 1.5);
    for (double t_s = 1; t_s <= 2; t_s += 0.01) {
      EXPECT_EQ(value_at(keys, t_s), p);
      const glm::dquat turn = value_at(turns, t_s);
      EXPECT_TRUE(turn == still || turn == -still) << "antipodes are one rotation";
    }
  }
}

TEST(ValueAt, HugeTinyAndCoincidentPositionsStayFinite) {
  const double huge = 1e300, tiny = 5e-324;
  const Keys<dvec3> keys{
      {0, 1, 2, 3, 4, 5, 6},
      {{0, 0, 0}, {0, 0, 0}, {huge, -huge, huge}, {-huge, huge, 0}, {tiny, 0, 0}, {0, tiny, 0}, {0, 0, 0}},
      Interpolation::CatmullRom};
  for (double t_s = -1; t_s < 7; t_s += 0.013) EXPECT_TRUE(finite(value_at(keys, t_s))) << t_s;
}

TEST(ValueAt, KeysOneUlpApartStayFinite) {
  const Keys<dvec3> keys{
      {1, std::nextafter(1.0, 2.0), 1e9}, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, Interpolation::CatmullRom};
  for (const double t_s : {0.0, 1.0, std::nextafter(1.0, 2.0), 1.5, 1e9, 2e9})
    EXPECT_TRUE(finite(value_at(keys, t_s)));
}

TEST(ValueAt, RotationsTakeTheShorterArcWhateverTheSign) {
  const glm::dquat a = glm::angleAxis(0.2, dvec3{0, 1, 0}), b = glm::angleAxis(1.0, dvec3{0, 1, 0});
  const glm::dquat middle = glm::angleAxis(0.6, dvec3{0, 1, 0});
  for (const glm::dquat& end : {b, -b}) {
    const glm::dquat value = value_at(Keys<glm::dquat>{{0, 1}, {a, end}, Interpolation::Linear}, 0.5);
    EXPECT_NEAR(std::fabs(glm::dot(value, middle)), 1, 1e-15);
  }
}

// Half a turn apart has no shorter arc, and 1e-9 apart divides by almost nothing.
TEST(ValueAt, OppositeAndNearlyEqualRotationsStayUnit) {
  const glm::dquat a(1, 0, 0, 0);
  for (const glm::dquat& b :
       {glm::dquat(0, 0, 1, 0), glm::dquat(-1e-17, 1, 0, 0), glm::angleAxis(1e-9, dvec3{1, 0, 0})})
    for (double t_s = 0; t_s <= 1; t_s += 0.05) {
      const glm::dquat value = value_at(Keys<glm::dquat>{{0, 1}, {a, b}, Interpolation::Linear}, t_s);
      EXPECT_NEAR(glm::length(value), 1, 1e-14);
    }
}

TEST(Unit, ZeroAndNonFiniteAreTheIdentity) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const glm::dquat& q :
       {glm::dquat(0, 0, 0, 0), glm::dquat(nan, 0, 0, 1), glm::dquat(HUGE_VAL, 0, 0, 0)})
    EXPECT_EQ(unit(q), glm::dquat(1, 0, 0, 0));
  EXPECT_NEAR(glm::length(unit({1e-200, 1e-200, 0, 0})), 1, 1e-15) << "squares underflow";
  EXPECT_NEAR(glm::length(unit({1e200, 0, 1e200, 0})), 1, 1e-15) << "squares overflow";
}

TEST(TransformAt, EmptyChannelsKeepTheNodesOwnValues) {
  Transform own;
  own.translation = {1, 2, 3};
  own.scale = {4, 5, 6};
  TransformTrack track;
  track.scale = {{0, 1}, {{1, 1, 1}, {2, 2, 2}}, Interpolation::Linear};
  const Transform moved = transform_at({0, track}, own, 1);
  EXPECT_EQ(moved.translation, own.translation);
  EXPECT_EQ(moved.scale, (dvec3{2, 2, 2}));
}

TEST(TransformAt, LoopRepeatsBothWays) {
  TransformTrack track;
  track.translation = {{1, 2, 4}, {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, Interpolation::Linear};
  track.loop = true;
  for (const double t_s : {1.5, 4.5, 1.5 - 3, 1.5 + 3e6, 1.5 - 3e6})
    EXPECT_NEAR(transform_at({0, track}, {}, t_s).translation.x, 0.5, 1e-9) << t_s;
}

// Channels of one track may end at different times; looped one by one they would drift apart.
TEST(TransformAt, LoopedChannelsShareOnePeriod) {
  TransformTrack track;
  track.translation = {{0, 1}, {{0, 0, 0}, {1, 0, 0}}, Interpolation::Linear};
  track.scale = {{0, 2}, {{1, 1, 1}, {3, 3, 3}}, Interpolation::Linear};
  track.loop = true;
  const Transform late = transform_at({0, track}, {}, 3.5);
  EXPECT_DOUBLE_EQ(late.translation.x, 1) << "held to the end of the period";
  EXPECT_DOUBLE_EQ(late.scale.x, 2.5);
}

TEST(TransformAt, LoopOfOneKeyHolds) {
  TransformTrack track;
  track.translation = {{5}, {{7, 8, 9}}, Interpolation::Linear};
  track.loop = true;
  EXPECT_EQ(transform_at({0, track}, {}, -1e9).translation, (dvec3{7, 8, 9}));
}

TEST(TransformAt, SpinIsExactAfterManyTurns) {
  const SpinTrack spin{{0, 0, 3}, kPi / 2};
  const dvec3 turned = transform_at({0, spin}, {}, 4e6 + 1).rotation * dvec3{1, 0, 0};
  EXPECT_LT(glm::distance(turned, dvec3{0, 1, 0}), 1e-8);
}

TEST(TransformAt, SpinOfHugeRateOrTimeStaysUnit) {
  for (const double rate : {1e9, 1e308})
    for (const double t_s : {-1e9, 1e9, 1e308})
      EXPECT_NEAR(glm::length(transform_at({0, SpinTrack{{1, 1, 0}, rate}}, {}, t_s).rotation), 1, 1e-14);
}

TEST(Flight, LooksAlongItsPathWithTheHorizonLevel) {
  const auto flight = flight_through({{0, 0, 0}, {3, 1, 1}, {5, 0, 4}, {5, 2, 9}});
  const double h = 1e-6;
  for (const double t_s : {0.4, 1.0, 1.7, 2.9}) {
    const Transform here = fly(flight, t_s);
    const dvec3 step = fly(flight, t_s + h).translation - fly(flight, t_s - h).translation;
    EXPECT_LT(glm::distance(forward_of(here), glm::normalize(step)), 1e-4);
    EXPECT_NEAR(right_of(here).y, 0, 1e-12);
    EXPECT_GT(up_of(here).y, 0);
  }
}

TEST(Flight, KeepsItsDirectionWhereItIsHeld) {
  const auto flight = flight_through({{0, 0, 0}, {3, 0, 0}, {3, 0, 4}});
  EXPECT_LT(glm::distance(forward_of(fly(flight, 1e9)), forward_of(fly(flight, 2))), 1e-12);
  EXPECT_LT(glm::distance(forward_of(fly(flight, -1e9)), forward_of(fly(flight, 0))), 1e-12);
}

TEST(Flight, LooksAtItsTarget) {
  auto flight = flight_through({{0, 0, 0}, {10, 0, 0}});
  flight.target = {{0, 1}, {{5, 3, -5}, {5, 0, 8}}, Interpolation::Linear};
  const Transform t = fly(flight, 0.5);
  EXPECT_LT(glm::distance(forward_of(t), glm::normalize(dvec3{5, 1.5, 1.5} - t.translation)), 1e-12);
}

TEST(Flight, PositiveBankRollsToTheRight) {
  auto flight = flight_through({{0, 0, 0}, {0, 0, -1}});
  flight.bank_rad = {{0}, {0.3}, Interpolation::Linear};
  const Transform t = fly(flight, 0.5);
  EXPECT_LT(glm::distance(forward_of(t), dvec3{0, 0, -1}), 1e-12);
  EXPECT_NEAR(right_of(t).y, -std::sin(0.3), 1e-12) << "the right wing goes down";
}

// Standing still has no tangent: the last direction of travel stays, and before any travel the first to come.
TEST(Flight, StandingStillKeepsTheLastGoodDirection) {
  for (const auto interpolation : {Interpolation::Linear, Interpolation::CatmullRom}) {
    const auto stops = flight_through({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 5}}, interpolation);
    EXPECT_LT(glm::distance(forward_of(fly(stops, 2.5)), dvec3{1, 0, 0}), 1e-12);
    const auto waits = flight_through({{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 5}}, interpolation);
    EXPECT_LT(glm::distance(forward_of(fly(waits, 0.5)), dvec3{0, 0, 1}), 1e-12);
  }
}

TEST(Flight, NeverMovingLooksAhead) {
  for (const auto& flight : {flight_through({{1, 2, 3}}), flight_through({{1, 2, 3}, {1, 2, 3}})})
    EXPECT_EQ(forward_of(fly(flight, 0.5)), (dvec3{0, 0, -1}));
}

// A dive: straight down the horizon has no side, so the picture keeps the heading that it had before.
TEST(Flight, StraightDownKeepsTheHeading) {
  const auto dive =
      flight_through({{-2, 9, 0}, {-1, 9, 0}, {0, 9, 0}, {0, 5, 0}, {0, 0, 0}}, Interpolation::Linear);
  const Transform t = fly(dive, 3.5);
  EXPECT_LT(glm::distance(forward_of(t), dvec3{0, -1, 0}), 1e-12);
  EXPECT_LT(glm::distance(right_of(t), dvec3{0, 0, 1}), 1e-12)
      << "the right side of someone heading along +x";
  EXPECT_LT(glm::distance(up_of(t), dvec3{1, 0, 0}), 1e-12);
}

TEST(Flight, TargetAtTheEyeFallsBackToThePath) {
  auto flight = flight_through({{0, 0, 0}, {2, 0, 0}}, Interpolation::Linear);
  flight.target = {{0}, {{1, 0, 0}}, Interpolation::Linear};
  EXPECT_LT(glm::distance(forward_of(fly(flight, 0.5)), dvec3{1, 0, 0}), 1e-12);
}

// Small integer grids provoke every degeneracy at once: repeated keys, reversals, vertical pieces, target on
// the path.
TEST(Flight, DegenerateGridsGiveFiniteOrthonormalFrames) {
  constexpr unsigned kSeed = 42;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_int_distribution<int> small(-1, 1), count(1, 6);
  const auto point = [&] { return dvec3{small(random), small(random), small(random)}; };
  for (int trial = 0; trial < 3000; ++trial) {
    std::vector<dvec3> positions(count(random));
    for (auto& p : positions) p = point();
    auto flight = flight_through(positions, trial % 2 ? Interpolation::CatmullRom : Interpolation::Linear);
    if (trial % 3 == 0) flight.target = {{0, 2}, {point(), point()}, Interpolation::Linear};
    for (double t_s = -0.5; t_s < 6; t_s += 0.25) {
      const Transform t = fly(flight, t_s);
      ASSERT_TRUE(finite(t.translation) && finite(t.rotation)) << "trial " << trial << " at " << t_s;
      ASSERT_NEAR(glm::length(t.rotation), 1, 1e-12);
    }
  }
}

TEST(LookRotation, ZeroAndNonFiniteForwardLookAlongTheHeading) {
  for (const dvec3& forward : {dvec3{0, 0, 0}, dvec3{NAN, 0, 0}, dvec3{HUGE_VAL, 0, 0}}) {
    const glm::dquat q = look_rotation(forward, {1, 0, 0}, 0);
    EXPECT_LT(glm::distance(q * dvec3{0, 0, -1}, dvec3{1, 0, 0}), 1e-12);
  }
}

TEST(Moves, EqualKeysAndZeroRatesDoNot) {
  TransformTrack still;
  still.translation = {{0, 1}, {{1, 2, 3}, {1, 2, 3}}, Interpolation::Linear};
  EXPECT_FALSE(moves({0, still}));
  EXPECT_FALSE(moves({0, TransformTrack{}}));
  EXPECT_FALSE(moves({0, SpinTrack{{0, 1, 0}, 0}}));
  EXPECT_FALSE(moves({0, flight_through({{1, 1, 1}})}));
  still.scale = {{0, 1}, {{1, 1, 1}, {1, 1, 1.01}}, Interpolation::Linear};
  EXPECT_TRUE(moves({0, still}));
  EXPECT_TRUE(moves({0, SpinTrack{}}));
  EXPECT_TRUE(moves({0, flight_through({{0, 0, 0}, {1, 0, 0}})}));
}

}  // namespace
}  // namespace talisman::layers
