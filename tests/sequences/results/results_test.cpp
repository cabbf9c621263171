// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/summary.h"
#include "sequences/results/timing.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace talisman::sequences {
namespace {

FrameLine drawn_line(int frame) {
  FrameLine line;
  line.frame = frame;
  line.frame_hash = "0123456789abcdef";
  line.renders = 2;
  line.polygons = {100, 400};
  line.pixels.filled = 1'234'567'890'123;
  line.times.plan_ms = 0.25;
  line.times.io_ms = 1.5;
  return line;
}

TEST(FrameLine, RoundTripsThroughJsonWithQuality) {
  FrameLine line = drawn_line(7);
  line.quality = FrameQuality{};
  line.quality->total = {41.5, 0.99, 0.02, 17, 0.125};
  line.quality->reuse.psnr_db = INFINITY;  // identical pictures: null in JSON, infinite again when read
  const std::optional<FrameLine> back = frame_line_from_json(json_of(line));
  ASSERT_TRUE(back);
  EXPECT_EQ(json_of(*back), json_of(line));
  EXPECT_EQ(back->pixels.filled, 1'234'567'890'123);
  EXPECT_TRUE(std::isinf(back->quality->reuse.psnr_db));
}

TEST(FrameLine, RoundTripsThroughJsonWithCompression) {
  FrameLine line = drawn_line(7);
  EXPECT_FALSE(nlohmann::json::parse(json_of(line)).contains("compression")) << "not called for: not there";
  line.compression = CompressionReport{};
  line.compression->original_bytes = 40960;
  line.compression->compressed_bytes = 4096;
  line.compression->error = {123456, 7'654'321'012'345, 0, 1024};
  line.compression->cache = {3, 1, 400};
  const std::optional<FrameLine> back = frame_line_from_json(json_of(line));
  ASSERT_TRUE(back && back->compression);
  EXPECT_EQ(json_of(*back), json_of(line));
  EXPECT_EQ(back->compression->error, line.compression->error);
  const nlohmann::json json = nlohmann::json::parse(json_of(line))["compression"];
  EXPECT_EQ(json["ratio"], 10);
  EXPECT_EQ(json["cache_hit_rate"], 0.75);
  EXPECT_TRUE(json["alpha_psnr_db"].is_null()) << "lossless";
}

TEST(FrameLine, CutOrForeignLinesAreRefused) {
  const std::string whole = json_of(drawn_line(7));
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(frame_line_from_json(whole.substr(0, length))) << length;
  EXPECT_FALSE(frame_line_from_json("{}"));
  EXPECT_FALSE(frame_line_from_json(R"({"frame":"seven"})"));
  EXPECT_FALSE(frame_line_from_json("[1,2,3]"));
}

TEST(FrameLine, PlannedFramesHaveNullForWhatWasNotMeasured) {
  FrameLine line = drawn_line(0);
  line.frame_hash.clear();
  const nlohmann::json json = nlohmann::json::parse(json_of(line));
  EXPECT_TRUE(json["pixels_filled"].is_null());
  EXPECT_TRUE(json["modelled_ms"].is_null());
  EXPECT_FALSE(json["polygons_rendered"].is_null());
}

TEST(FrameLine, HasItsEntriesInThisOrder) {
  FrameLine line = drawn_line(3);
  line.visibility.emplace();
  line.budget_gap = regulator::BudgetGap{1.5, 2, true};
  EXPECT_EQ(
      json_of(line),
      R"({"schema":"talisman.frame/1","frame":3,"frame_hash":"0123456789abcdef","layers_in_view":0,)"
      R"("renders":2,"reuses":0,"layers_assessed":0,"mean_geometric_px":0.0,"mean_geometric_px_by_pixels":0.0,)"
      R"("shadow_maps_drawn":0,"shadow_maps_reused":0,)"
      R"("reflections_drawn":0,"polygons_rendered":100,"polygons_reference":400,"pixels_rendered":0,)"
      R"("pixels_reference":0,"pixels_filled":1234567890123,"pixels_composited":0,)"
      R"("pixels_in_registers":0,"chunks_rendered":0,)"
      R"("chunks_clear":0,"fragments":0,"texture_samples":0,"sprite_bytes":0,"modelled_ms":0.0,)"
      R"("modelled_drawing_ms":0.0,"depth_complexity":1.0,)"
      R"("visibility":{"layers":0,"queries":0,"pairs":0,"exact_tests":0,"edges":0,"swaps":0,)"
      R"("components":0,"merged_components":0,"merged_layers":0,"resolved_components":0,)"
      R"("resolved_layers":0,"expression_registers":0,"expression_operators":0,"expression_reads":0,"merged_parts":0},)"
      R"("budget_gap":{"greedy_px":1.5,"optimal_px":2.0,"gap":0.25,"exact":true}})");
}

// What a clock says would make two runs of the same thing differ.
TEST(FrameLine, TimesAreInTheLinesOfTheirOwnFile) {
  FrameLine line = drawn_line(7);
  FrameLine slower = line;
  slower.times = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(json_of(slower), json_of(line));
  EXPECT_NE(timing_json(slower), timing_json(line));
  const std::optional<FrameTiming> back = timing_from_json(timing_json(slower));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->frame, 7);
  EXPECT_EQ(back->times.plan_ms, 1);
  EXPECT_EQ(back->times.io_ms, 4);
}

TEST(Timing, LinesOfFramesThatWereOnlyPlannedHaveNullForTheRest) {
  FrameLine line = drawn_line(7);
  line.frame_hash.clear();
  EXPECT_EQ(timing_json(line),
            R"({"schema":"talisman.timing/1","frame":7,"plan_ms":0.25,"sort_ms":null,)"
            R"("render_ms":null,"compress_ms":null,"composite_ms":null,"io_ms":null,"late_pixels":0})");
}

TEST(Timing, LinesOfOtherKindsAreToldApart) {
  EXPECT_TRUE(is_process_line(process_json()));
  EXPECT_FALSE(timing_from_json(process_json()));
  EXPECT_FALSE(is_process_line(timing_json(drawn_line(1))));
  const std::string whole = timing_json(drawn_line(7));
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(timing_from_json(whole.substr(0, length)) || is_process_line(whole.substr(0, length)));
  const nlohmann::json process = nlohmann::json::parse(process_json());
  EXPECT_GE(process["threads"], 1);
  EXPECT_FALSE(process["version"].get<std::string>().empty());
}

Summary two_layer_summary() {
  Summary s;
  s.sequence = "test";
  s.layers.resize(2);
  LayerSummary &cheap = s.layers[0], &dear = s.layers[1];
  cheap.name = "cheap", cheap.parts = 1, cheap.polygons = 100, cheap.renders = 10;
  cheap.sum_geometric_px += 5.0, cheap.max_geometric_px = 1, cheap.sprite_px = {32, 32};
  dear.name = "dear", dear.parts = 2, dear.polygons = 300, dear.renders = 2;
  dear.sum_geometric_px += 20.0, dear.max_geometric_px = 4, dear.sprite_px = {64, 16};
  cheap.frames_shown = dear.frames_shown = 10;
  for (int frame = 0; frame < 10; ++frame) s.frames.push_back(drawn_line(frame));
  return s;
}

TEST(Summary, RatesAreThoseOfThePaper) {
  const Summary s = two_layer_summary();
  EXPECT_DOUBLE_EQ(s.mean_update_rate(), (1.0 + 0.2) / 2);
  EXPECT_DOUBLE_EQ(s.cost_weighted_update_rate(), (100 * 1.0 + 300 * 0.2) / 400);
  EXPECT_DOUBLE_EQ(s.layers[1].mean_geometric_px(), 2);
}

TEST(Summary, JsonHoldsEveryPromisedField) {
  const nlohmann::json json = nlohmann::json::parse(json_of(two_layer_summary()));
  EXPECT_EQ(json["schema"], "talisman.summary/1");
  for (const char* field :
       {"sequence", "policy", "warp", "frames", "display_px", "layers", "mean_update_rate",
        "cost_weighted_update_rate", "polygons_rendered", "polygons_reference", "pixels_rendered",
        "pixels_composited", "chunks_rendered", "chunks_clear", "effects", "modelled_ms"})
    EXPECT_TRUE(json.contains(field)) << field;
  for (const char* field : {"name", "parts", "polygons", "renders", "update_rate", "mean_geometric_px",
                            "max_geometric_px", "sprite_px"})
    EXPECT_TRUE(json["layers"][0].contains(field)) << field;
  EXPECT_FALSE(json.contains("quality")) << "quality only when asked for";
  EXPECT_FALSE(json.contains("wall_ms")) << "times are in timing.jsonl alone";
  EXPECT_EQ(json["polygons_rendered"], 1000);
}

TEST(Summary, EmptyRunHasNoNan) {
  const Summary empty;
  EXPECT_EQ(json_of(empty).find("nan"), std::string::npos);
  EXPECT_EQ(table_of(empty).find("nan"), std::string::npos);
  EXPECT_DOUBLE_EQ(empty.mean_update_rate(), 0);
}

TEST(Summary, MeanPsnrIsThatOfTheMeanSquaredError) {
  Summary s = two_layer_summary();
  for (FrameLine& line : s.frames) {
    line.quality = FrameQuality{};
    line.quality->total.psnr_db = line.quality->reuse.psnr_db = INFINITY;
  }
  s.frames[0].quality->total.psnr_db = 30;  // one bad frame of ten: its squared error is spread over ten
  const nlohmann::json json = nlohmann::json::parse(json_of(s));
  EXPECT_NEAR(json["quality"]["psnr_db"].get<double>(), 40, 1e-9);
  EXPECT_TRUE(json["quality_of_reuse"]["psnr_db"].is_null()) << "identical pictures";
}

TEST(HashOf, EveryBitOfThePictureCounts) {
  chunker::Frame a{2, 1, {{1, 2, 3, 4}, {5, 6, 7, 8}}};
  chunker::Frame b = a;
  EXPECT_EQ(hash_of(a), hash_of(b));
  b.pixels[1].b ^= 0x100;
  EXPECT_NE(hash_of(a), hash_of(b));
}

}  // namespace
}  // namespace talisman::sequences
