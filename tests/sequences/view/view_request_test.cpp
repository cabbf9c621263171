// SPDX-License-Identifier: Apache-2.0
#include "sequences/view/view_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequences/files/errors.h"

namespace talisman::sequences {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string defect(const std::string& body) {
  try {
    view_request_from(body);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(ViewRequest, IsReadAsItStands) {
  const ViewRequest request = view_request_from(
      R"({"tab": "a1", "request": 17, "settings": {"policy": "budget", "budget-ms": 5, "size": "160x120"},
          "without": ["shadow_map"], "flight": [[1, 2, 3, 4, 5, 6.5]], "frame": 12, "mode": "flip", "scale": 0.5,
          "from": 3, "name": "dive"})");
  EXPECT_EQ(request.tab, "a1");
  EXPECT_EQ(request.request, 17);
  EXPECT_THAT(request.words, ElementsAre("--budget-ms=5", "--policy=budget", "--size=160x120"));
  EXPECT_THAT(request.without, ElementsAre(layers::Effect::ShadowMap));
  ASSERT_EQ(request.flight.size(), 1u);
  EXPECT_EQ(request.flight[0].position, layers::dvec3(1, 2, 3));
  EXPECT_EQ(request.flight[0].target, layers::dvec3(4, 5, 6.5));
  EXPECT_EQ(request.frame, 12);
  EXPECT_EQ(request.from, 3);
  EXPECT_EQ(request.mode, "flip");
  EXPECT_EQ(request.scale, 0.5);
  EXPECT_EQ(request.name, "dive");
}

TEST(ViewRequest, WhatIsLeftOutIsPlain) {
  const ViewRequest request = view_request_from("{}");
  EXPECT_TRUE(request.words.empty() && request.flight.empty() && request.without.empty());
  EXPECT_EQ(request.mode, "shown");
  EXPECT_EQ(request.scale, 1);
  EXPECT_EQ(request.frame, 0);
}

TEST(ViewRequest, WhatIsNoRequestIsRefused) {
  for (const char* body : {"",
                           "{",
                           "[]",
                           "null",
                           "17",
                           "\"text\"",
                           "{\"tab\": 1}",
                           "{\"request\": -1}",
                           "{\"request\": 1.5}",
                           "{\"frame\": 1e300}",
                           "{\"frame\": null}",
                           "{\"from\": \"1\"}",
                           "{\"mode\": []}",
                           "{\"settings\": []}",
                           "{\"without\": {}}",
                           "{\"without\": [1]}",
                           "{\"scale\": 0}",
                           "{\"scale\": 1.01}",
                           "{\"scale\": \"1\"}",
                           "{\"flight\": 1}"})
    EXPECT_NE(defect(body), "") << body;
  EXPECT_NE(defect("{\"tab\": \"" + std::string(201, 'a') + "\"}"), "");
  EXPECT_NE(defect(std::string("{\"tab\": \"\xff\"}")), "");
  EXPECT_NE(defect(std::string(60000, '[')), "");
}

// Lists within lists, as deep as a body may be: nobody walks down them.
TEST(ViewRequest, DepthIsNoDanger) {
  const std::string deep = std::string(32000, '[') + std::string(32000, ']');
  for (const char* key : {"tab", "request", "frame", "mode", "without", "flight", "scale", "settings"})
    EXPECT_NE(defect("{\"" + std::string(key) + "\": " + deep + "}"), "") << key;
  EXPECT_NE(defect("{\"settings\": {\"hold\": " + deep + "}}"), "");
  EXPECT_NE(defect("{\"without\": [" + deep + "]}"), "");
  EXPECT_EQ(defect("{\"unknown\": " + deep + "}"), "");
}

// No option that names a file, and none of the program's own.
TEST(ViewRequest, OnlyOptionsOfThePageMayBeSet) {
  for (const char* option : {"out", "assets", "resume", "force", "threads", "video", "frames", "format",
                             "cache", "no-cache", "geometric_px", "--policy", "", "size=1x1 --out"})
    EXPECT_THAT(defect(R"({"settings": {")" + std::string(option) + R"(": "x"}})"),
                HasSubstr("is no option of the live view"))
        << option;
  EXPECT_NE(defect(R"({"settings": {"policy": ["hold"]}})"), "");
  EXPECT_NE(defect(R"({"settings": {"policy": {"a": 1}}})"), "");
  EXPECT_NE(defect(R"({"settings": {"policy": ")" + std::string(201, 'a') + "\"}}"), "");
  EXPECT_EQ(defect(R"({"settings": {"policy": null}})"), "");
}

TEST(ViewRequest, APoseIsAPlaceAndWhatItLooksAt) {
  EXPECT_EQ(defect(R"({"flight": [[0, 0, 0, 0, 0, -1]]})"), "");
  for (const char* pose :
       {"[0, 0, 0, 0, 0]", "[0, 0, 0, 0, 0, 0]", "[0, 0, 0, 0, 0, \"1\"]", "[0, 0, 0, 0, 0, null]",
        "[1e300, 0, 0, 0, 0, 0]", "[0, 1e10, 0, 0, 1e10, 1]", "[0, 0, 0, 0, 0, 1, 2]", "7"})
    EXPECT_THAT(defect("{\"flight\": [" + std::string(pose) + "]}"), HasSubstr("flight")) << pose;
}

TEST(ViewRequest, TheSameSettingsAreOnePlan) {
  const auto key = [](const char* body) { return view_request_from(body).plan_key(); };
  EXPECT_EQ(key(R"({"settings": {"hold": 4, "policy": "hold"}, "frame": 1, "tab": "a", "mode": "flip"})"),
            key(R"({"settings": {"policy": "hold", "hold": 4}, "frame": 2, "tab": "b", "request": 9})"));
  const std::string plain = key("{}");
  for (const char* other : {R"({"settings": {"hold": 4}})", R"({"without": ["texture"]})",
                            R"({"scale": 0.5})", R"({"flight": [[0, 0, 0, 0, 0, -1]]})"})
    EXPECT_NE(key(other), plain) << other;
  EXPECT_NE(key(R"({"flight": [[0, 0, 0, 0, 0, -1]]})"), key(R"({"flight": [[0, 0, 0, 0, 1e-9, -1]]})"));
}

}  // namespace
}  // namespace talisman::sequences
