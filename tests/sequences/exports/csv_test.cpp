// SPDX-License-Identifier: Apache-2.0
// Tables for spreadsheets: read back by the rules of RFC 4180, and compared with what the JSON says.
#include <filesystem>
#include <map>
#include <string>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Rows = std::vector<std::map<std::string, std::string>>;

/// Fields of a whole file as RFC 4180 has them; empty where the file breaks its rules.
std::vector<std::vector<std::string>> fields_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows(1, {""});
  for (std::size_t k = 0; k < csv.size(); ++k) {
    std::string& field = rows.back().back();
    if (csv[k] == '"') {
      if (!field.empty()) return {};  // quotes are around whole fields
      for (++k; k < csv.size(); ++k) {
        if (csv[k] != '"')
          field += csv[k];
        else if (k + 1 < csv.size() && csv[k + 1] == '"')
          field += csv[k++];
        else
          break;
      }
      if (k + 1 >= csv.size() || (csv[k + 1] != ',' && csv[k + 1] != '\r')) return {};
    } else if (csv[k] == ',') {
      rows.back().emplace_back();
    } else if (csv.compare(k, 2, "\r\n") == 0) {
      ++k;
      rows.push_back({""});
    } else if (csv[k] == '\r' || csv[k] == '\n') {
      return {};
    } else {
      field += csv[k];
    }
  }
  rows.pop_back();  // the last line ends, too
  return rows;
}

class Export : public Tool {
 protected:
  /// Rows by the names of their columns.
  Rows table(const std::string& name) const {
    const auto fields = fields_of(read(name));
    Rows rows;
    for (std::size_t r = 1; r < fields.size(); ++r) {
      EXPECT_EQ(fields[r].size(), fields[0].size()) << name << " row " << r;
      std::map<std::string, std::string> row;
      for (std::size_t c = 0; c < std::min(fields[r].size(), fields[0].size()); ++c)
        EXPECT_TRUE(row.emplace(fields[0][c], fields[r][c]).second) << "two columns " << fields[0][c];
      rows.push_back(row);
    }
    return rows;
  }
};

/// A run of two layers, one of which has a name that must be quoted, with all that a run can report.
class ExportOfARender : public Export {
 protected:
  void SetUp() override {
    Export::SetUp();
    std::string yaml = kPassing;
    yaml.replace(yaml.find("{name: ball"), 11, "{name: 'a \"ball\", round'");
    write("passing.yaml", yaml);
    const Outcome render = run(
        "render passing.yaml --frames 0-14 --size 96x72 --compression 85 --quality --progress none --out o");
    ASSERT_EQ(render.exit_code, 0) << render.output;
    const Outcome exported = run("export o --csv");
    ASSERT_EQ(exported.exit_code, 0) << exported.output;
    EXPECT_EQ(exported.output,
              "wrote decisions.csv, frames.csv, timing.csv, layers.csv, effects.csv, run.csv in o\n");
  }
};

TEST_F(ExportOfARender, DecisionsAreThoseOfTheJson) {
  const Rows decisions = table("o/decisions.csv");
  const std::vector<std::string> json_lines = lines("o/decisions.jsonl");
  ASSERT_EQ(decisions.size(), json_lines.size());
  for (std::size_t k = 0; k < decisions.size(); ++k) {
    const nlohmann::json json = nlohmann::json::parse(json_lines[k]);
    EXPECT_EQ(decisions[k].at("layer"), json["layer"]);
    EXPECT_EQ(decisions[k].at("reason"), json["reason"]);
    EXPECT_EQ(decisions[k].at("frame"), json["frame"].dump());
    EXPECT_EQ(decisions[k].at("warp_x"), json["warp"][2].dump());
    EXPECT_EQ(decisions[k].at("warp_yx"), json["warp"][3].dump());
    EXPECT_EQ(decisions[k].at("warp_wx"), "") << "an affine warp has six numbers";
    EXPECT_EQ(decisions[k].at("cost_pixels"), json["cost"]["pixels"].dump());
    const nlohmann::json& fiducials = json["fiducials"];
    EXPECT_EQ(decisions[k].at("magnification"), fiducials.is_null() ? "" : fiducials["magnification"].dump());
  }
  EXPECT_THAT(read("o/decisions.csv"), HasSubstr("\"a \"\"ball\"\", round\""));
}

TEST_F(ExportOfARender, FramesAreThoseOfTheJson) {
  const Rows frames = table("o/frames.csv");
  const std::vector<std::string> json_lines = lines("o/frames.jsonl");
  ASSERT_EQ(frames.size(), 15u);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const nlohmann::json json = nlohmann::json::parse(json_lines[k]);
    EXPECT_EQ(frames[k].at("frame_hash"), json["frame_hash"]);
    EXPECT_EQ(frames[k].at("compression_ratio"), json["compression"]["ratio"].dump());
    EXPECT_EQ(frames[k].at("quality_total_ssim"), json["quality"]["total"]["ssim"].dump());
    EXPECT_EQ(frames[k].at("visibility_pairs"), json["visibility"]["pairs"].dump());
    EXPECT_EQ(frames[k].at("budget_gap"), "") << "was not asked for";
  }
  EXPECT_EQ(table("o/timing.csv").size(), 15u);
  EXPECT_GT(std::stod(table("o/timing.csv")[0].at("render_ms")), 0);
}

TEST_F(ExportOfARender, LayersEffectsAndRunAreThoseOfTheSummary) {
  const nlohmann::json summary = nlohmann::json::parse(read("o/summary.json"));
  const Rows layers = table("o/layers.csv"), effects = table("o/effects.csv"), of_run = table("o/run.csv");
  ASSERT_EQ(layers.size(), summary["layers"].size());
  for (std::size_t k = 0; k < layers.size(); ++k) {
    EXPECT_EQ(layers[k].at("name"), summary["layers"][k]["name"]);
    EXPECT_EQ(layers[k].at("sprite_height_px"), summary["layers"][k]["sprite_px"][1].dump());
  }
  ASSERT_EQ(effects.size(), summary["effects"].size());
  for (const auto& row : effects) EXPECT_EQ(row.at("why"), summary["effects"][row.at("effect")]["why"]);
  ASSERT_EQ(of_run.size(), 1u);
  EXPECT_EQ(of_run[0].at("sequence"), "passing");
  EXPECT_EQ(of_run[0].at("display_width_px"), "96");
  EXPECT_EQ(of_run[0].at("mean_update_rate"), summary["mean_update_rate"].dump());
  EXPECT_EQ(of_run[0].at("quality_of_reuse_flip"), summary["quality_of_reuse"]["flip"].dump());
}

TEST_F(Export, OfAPlanLeavesEmptyWhatWasNotMeasured) {
  ASSERT_EQ(run("plan cube.obj --frames 0-4 --size 64x48 --progress none --out p").exit_code, 0);
  ASSERT_EQ(run("export p --csv").exit_code, 0);
  const Rows frames = table("p/frames.csv");
  ASSERT_EQ(frames.size(), 5u);
  EXPECT_EQ(frames[0].at("pixels_filled"), "");
  EXPECT_NE(frames[0].at("polygons_rendered"), "");
  EXPECT_EQ(table("p/run.csv")[0].at("modelled_ms"), "");
  EXPECT_EQ(table("p/timing.csv")[0].at("render_ms"), "");
}

TEST_F(Export, OfWhatIsNoCompleteRunIsOneErrorLine) {
  fs::create_directories(folder_ / "empty");
  expect_bad_input("export empty --csv",
                   {"empty", "holds no results", "must be the folder of a render or a plan"});
  expect_bad_input("export nowhere --csv", {"nowhere", "is no folder"});
  expect_bad_input("export cube.obj --csv", {"cube.obj", "is no folder"});
  expect_bad_input("export empty", {"must be --csv, --sqlite or --trace"});
  ASSERT_EQ(run("plan cube.obj --frames 0-4 --size 64x48 --progress none --out p").exit_code, 0);
  const std::string frames = read("p/frames.jsonl"), summary = read("p/summary.json");
  write("p/frames.jsonl.partial", "");
  expect_bad_input("export p --csv", {"p", "not complete (frames.jsonl.partial)", "--resume"});
  fs::remove(folder_ / "p/frames.jsonl.partial");
  write("p/frames.jsonl", frames + "{\"schema\":\"others.frame/1\"}\n");
  expect_bad_input("export p --csv", {"p/frames.jsonl:6", "no line of ours", "talisman.frame/1"});
  write("p/frames.jsonl", "no JSON\n");
  expect_bad_input("export p --csv", {"p/frames.jsonl:1", "talisman.frame/1"});
  write("p/frames.jsonl", frames.substr(0, frames.find('\n') + 1));
  expect_bad_input("export p --csv", {"p/frames.jsonl", "has 1 frames", "must be those of summary.json, 5"});
  write("p/frames.jsonl", frames);
  write("p/summary.json", "{}");
  expect_bad_input("export p --csv", {"p/summary.json", "talisman.summary/1"});
  write("p/summary.json", summary);
  fs::remove(folder_ / "p/decisions.jsonl");
  expect_bad_input("export p --csv", {"p/decisions.jsonl", "cannot be read"});
}

}  // namespace
}  // namespace talisman
