// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/settings_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <stdexcept>

#include "sequences/results/settings_fields.h"
#include "tests/sequences/results/changed_settings.h"

namespace talisman::sequences {
namespace {

/// Stands for a value of any type in an aggregate initialisation.
struct Any {
  template <typename T>
  operator T() const {
    throw std::logic_error("used in unevaluated expressions alone");
  }
};

/// The number of members of an aggregate: the most values by which it can be initialised.
template <typename T, typename... Values>
constexpr int members_of() {
  if constexpr (requires { T{Values{}..., Any{}}; })
    return members_of<T, Values..., Any>();
  else
    return sizeof...(Values);
}

/// Every type that is made of settings, and that the list therefore takes apart.
constexpr int kSettings =
    members_of<Settings>() - 7  // regulator, fit, view, extents, placement, render; cells, which are content
    + members_of<regulator::RegulatorOptions>() -
    8  // thresholds, lookahead, budget, predictive, regroup, lod, latency, kalman
    + members_of<regulator::Thresholds>() + members_of<regulator::LookaheadOptions>() +
    members_of<regulator::BudgetOptions>() + members_of<regulator::PredictiveOptions>() +
    members_of<regulator::RegroupOptions>() + members_of<regulator::LodOptions>() +
    members_of<regulator::LatencyOptions>() + members_of<layers::KalmanNoise>() +
    members_of<warp::FitOptions>() + members_of<layers::View>() + members_of<layers::ExtentOptions>() +
    members_of<layers::PlacementOptions>() + members_of<chunker::RenderOptions>();

int count(const Settings& settings) {
  int n = 0;
  for_each_setting(settings, [&n](const char*, const auto&) { ++n; });
  return n;
}

TEST(MembersOf, CountsWhatAnAggregateHolds) {
  struct Three {
    int a = 0;
    double b = 1;
    std::vector<int> c;
  };
  EXPECT_EQ(members_of<Three>(), 3);
  EXPECT_EQ(members_of<layers::View>(), 2);
}

TEST(SettingsJson, NamesEveryMemberOfTheSettings) {
  EXPECT_EQ(count({}), kSettings);
  EXPECT_EQ(json_of(Settings{}).size(), static_cast<std::size_t>(kSettings)) << "no two have the same name";
}

TEST(SettingsJson, EveryFieldChangesItsOwnEntryAlone) {
  const nlohmann::ordered_json before = json_of(Settings{});
  for (int k = 0; k < kSettings; ++k) {
    const ChangedSettings changed = changed_settings(k);
    const nlohmann::ordered_json after = json_of(changed.settings);
    for (const auto& [name, value] : after.items())
      EXPECT_EQ(value != before[name], name == changed.field) << name;
  }
  EXPECT_EQ(changed_settings(kSettings).field, "");
}

TEST(SettingsJson, ReadsAsUsersWriteIt) {
  Settings settings;
  settings.view.display_px = {640, 480};
  settings.regulator.policy = regulator::Policy::Budget;
  settings.regulator.budget.pixels = 5000;
  settings.curve = warp::Curve::per2;
  settings.explicit_order = {{3, 1}};
  const nlohmann::ordered_json json = json_of(settings);
  EXPECT_EQ(json["display_px"].dump(), "[640,480]");
  EXPECT_EQ(json["policy"], "budget");
  EXPECT_EQ(json["budget_pixels"], 5000);
  EXPECT_TRUE(json["budget_polygons"].is_null()) << "no limit";
  EXPECT_TRUE(json["budget_ms"].is_null()) << "no limit";
  EXPECT_EQ(json["warp"], "per2");
  EXPECT_EQ(json["bound"], "box8");
  EXPECT_EQ(json["explicit_order"].dump(), "[[3,1]]");
  EXPECT_TRUE(json["compression"].is_null()) << "off";
}

}  // namespace
}  // namespace talisman::sequences
