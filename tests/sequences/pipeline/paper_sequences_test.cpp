// SPDX-License-Identifier: Apache-2.0
//
// The three sequences of [LS97 7] as their READMEs describe them: layers, what they are made of, what is drawn again
// and what it costs. Skipped where their content was not fetched.

#include <algorithm>
#include <atomic>
#include <fstream>
#include <optional>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sequences/commands/options.h"
#include "sequences/results/run.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::sequences {
namespace {

using layers::Layer;
using layers::LayerKind;

/// Empty if the content is not there.
std::optional<Sequence> loaded(const std::string& name) {
  try {
    return load_sequence(name);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

Summary planned(const Sequence& sequence, CommandLine line, const std::string& out) {
  line.out = out;
  line.progress = "none";
  const ResolvedRun resolved = resolve(line, sequence, true);
  const std::atomic<bool> stop = false;
  return run(sequence, resolved.settings, resolved.options, stop).summary;
}

Summary planned(const Sequence& sequence, const CommandLine& line) {
  const tests::TemporaryFolder folder;
  return planned(sequence, line, folder.path());
}

long count_of(const Sequence& sequence, LayerKind kind) {
  return std::ranges::count_if(sequence.layers.layers, [&](const Layer& l) { return l.kind == kind; });
}

void expect_complete(const Sequence& sequence) {
  EXPECT_EQ(sequence.layers.unassigned_parts, 0);
  EXPECT_EQ(sequence.layers.defect, "");
}

const LayerSummary& layer_of(const Summary& summary, const std::string& name) {
  return *std::ranges::find(summary.layers, name, &LayerSummary::name);
}

CommandLine policy(const char* name) {
  CommandLine line;
  line.policy = name;
  return line;
}

// --- canyon/1997 ---

// The rates of [LS97 7.1]: 19 % mean, 32 % by polygons, a third of the polygons, parts 5 to 30 %, the sky once; ours
// may differ by a few per cent, as nothing is known of the paper's content.
TEST(PaperSequences, CanyonOf1997HasThePapersRates) {
  const std::optional<Sequence> canyon = loaded("canyon/1997");
  if (!canyon) GTEST_SKIP() << "content was not fetched";
  expect_complete(*canyon);
  ASSERT_EQ(canyon->layers.layers.size(), 10u);
  const Summary summary = planned(*canyon, policy("threshold"));
  double drawn = 0, all = 0;
  for (const LayerSummary& layer : summary.layers) {
    const double rate = layer.renders / 250.0;
    drawn += rate * layer.polygons;
    all += layer.polygons;
    if (layer.name == "sky" || layer.name == "land") continue;
    EXPECT_GE(rate, 0.05) << layer.name;  // and not 5 - 5 %, which would be nothing at all
    EXPECT_LE(rate, 0.30 + 0.05) << layer.name;
  }
  const LayerSummary &land = layer_of(summary, "land"), &sky = layer_of(summary, "sky");
  EXPECT_EQ(sky.renders, 1);
  EXPECT_LE(summary.mean_update_rate(), 0.25);
  EXPECT_GE(drawn / all, 0.25);
  EXPECT_LE(drawn / all, 0.40);
  EXPECT_NEAR(static_cast<double>(summary.polygons_rendered()) / (250 * all), drawn / all, 1e-9);
  EXPECT_GE(land.polygons / all, 0.15);
  EXPECT_LE(land.polygons / all, 0.24);
  EXPECT_GE(land.renders / 250.0 * land.polygons / drawn, 0.60);
}

// --- barnyard ---

void expect_papers_layers(const Sequence& barnyard) {
  expect_complete(barnyard);
  EXPECT_EQ(count_of(barnyard, LayerKind::Geometry), 119);
  EXPECT_EQ(count_of(barnyard, LayerKind::Shadow), 2);
  EXPECT_EQ(barnyard.layers.layers.size(), 121u);
  std::set<int> receivers, lights;
  for (const Layer& layer : barnyard.layers.layers)
    if (layer.kind == LayerKind::Shadow) receivers.insert(layer.base), lights.insert(layer.light);
  EXPECT_EQ(receivers.size(), 2u);
  EXPECT_EQ(lights.size(), 2u) << "one receiver per light";
  // Static: nothing but the camera moves.
  EXPECT_EQ(barnyard.scene->tracks.size(), 1u);
  EXPECT_EQ(barnyard.scene->tracks[0].node, barnyard.scene->cameras[0].node);
}

// A camera that moves among things at rest: their shadow maps are drawn once; nothing is merged; and at a tenth of a
// pixel far fewer than a third of the layers are drawn in a frame, which triple framing would.
void expect_few_drawn_and_each_map_once(const Sequence& barnyard) {
  CommandLine line = policy("threshold");
  line.geometric_px = 0.1;
  line.frames = "0-47";
  const Summary summary = planned(barnyard, line);
  for (const LayerSummary& layer : summary.layers) {
    EXPECT_FALSE(layer.is_aggregate) << layer.name;
  }
  ASSERT_EQ(summary.shadow_maps.size(), 2u);
  for (const LayerSummary& map : summary.shadow_maps) EXPECT_EQ(map.renders, 1) << map.name;
  EXPECT_LT(summary.mean_update_rate(), 1 / 3.0);
}

// Without seams the same layers, and fewer triangles: the tiles end where their neighbours begin.
void expect_tiles_without_seams(const Sequence& barnyard) {
  const std::optional<Sequence> bare = loaded("barnyard/seams");
  ASSERT_TRUE(bare);
  expect_complete(*bare);
  ASSERT_EQ(bare->layers.layers.size(), barnyard.layers.layers.size());
  int tiles = 0, polygons = 0;
  for (const Layer& layer : bare->layers.layers)
    if (layer.name.starts_with("land") && layer.kind == LayerKind::Geometry)
      ++tiles, polygons += layer.polygons;
  EXPECT_EQ(tiles, 20);
  EXPECT_EQ(polygons, 2 * 80 * 64) << "each cell of the ground is in one tile";
}

// One test, because the content takes seconds to read.
TEST(PaperSequences, BarnyardIsAsItsReadmeSays) {
  const std::optional<Sequence> barnyard = loaded("barnyard");
  if (!barnyard) GTEST_SKIP() << "content was not fetched";
  expect_papers_layers(*barnyard);
  expect_few_drawn_and_each_map_once(*barnyard);
  expect_tiles_without_seams(*barnyard);
}

// --- chicken ---

void expect_eighty_layers(const Sequence& chicken) {
  expect_complete(chicken);
  EXPECT_EQ(chicken.layers.layers.size(), 80u);
  // 40 to 50 % of the display's resolution by area, but for what is shown singly.
  for (const Layer& layer : chicken.layers.layers) {
    if (layer.kind != LayerKind::Geometry) continue;
    const double area = layer.preferences.resolution_scale * layer.preferences.resolution_scale;
    if (layer.name.starts_with("chicken") || layer.name == "tailgate")
      EXPECT_EQ(area, 1) << layer.name;
    else
      EXPECT_TRUE(area >= 0.39 && area <= 0.5) << layer.name << " " << area;
  }
}

// The wing lies over the tailgate and the tailgate beside the body: for some frames the two are one sprite, before
// and after it they are not, and nothing else is merged.
void expect_merged_for_a_while(const Sequence& chicken) {
  const tests::TemporaryFolder folder;
  planned(chicken, policy("threshold"), folder.path());
  std::ifstream file(folder.path() + "/decisions.jsonl");
  std::set<std::string> merged;
  std::set<int> frames;
  for (std::string text; std::getline(file, text);) {
    const nlohmann::json d = nlohmann::json::parse(text);
    const std::string name = d["layer"];
    if (name.find('+') == std::string::npos) continue;
    merged.insert(name);
    frames.insert(d["frame"].get<int>());
  }
  EXPECT_FALSE(frames.empty());
  EXPECT_LT(frames.size(), 120u) << "it is resolved again";
  for (const std::string& name : merged) {
    EXPECT_NE(name.find("tailgate"), std::string::npos) << name;
    EXPECT_NE(name.find("wing"), std::string::npos) << name;
  }
}

// At most 60 % of the pixels of drawing every sprite in every frame, and 30 % of the same at the display's resolution.
void expect_saved_pixels(const Sequence& chicken) {
  const Summary threshold = planned(chicken, policy("threshold"));
  const Summary reference = planned(chicken, policy("reference"));
  Sequence full = chicken;
  for (Layer& layer : full.layers.layers) layer.preferences.resolution_scale = 1;
  const Summary full_reference = planned(full, policy("reference"));
  const auto pixels = [](const Summary& s) { return static_cast<double>(s.pixels_rendered()); };
  EXPECT_LE(pixels(threshold), 0.60 * pixels(reference));
  EXPECT_LE(pixels(threshold), 0.30 * pixels(full_reference));
}

TEST(PaperSequences, ChickenIsAsItsReadmeSays) {
  const std::optional<Sequence> chicken = loaded("chicken");
  if (!chicken) GTEST_SKIP() << "content was not fetched";
  expect_eighty_layers(*chicken);
  expect_merged_for_a_while(*chicken);
  expect_saved_pixels(*chicken);
}

}  // namespace
}  // namespace talisman::sequences
