// SPDX-License-Identifier: Apache-2.0
// Layered EXR files, read by OpenImageIO itself.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <OpenImageIO/imageio.h>

#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

/// A whole file, channel by channel.
struct Channels {
  int width = 0, height = 0;
  std::map<std::string, std::vector<float>> values;
  std::string layers;  ///< talisman:layers
};

Channels read_channels(const std::string& path) {
  const auto in = OIIO::ImageInput::open(path);
  if (!in) return {};
  const OIIO::ImageSpec& spec = in->spec();
  std::vector<float> samples(static_cast<std::size_t>(spec.width) * spec.height * spec.nchannels);
  in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, samples.data());
  Channels channels{spec.width, spec.height, {}, spec.get_string_attribute("talisman:layers")};
  for (int c = 0; c < spec.nchannels; ++c) {
    auto& values = channels.values[spec.channelnames[c]];
    for (std::size_t i = c; i < samples.size(); i += spec.nchannels) values.push_back(samples[i]);
  }
  return channels;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The largest difference of the sum of all contributions from the frame.
double error_of_sums(const Channels& file) {
  double worst = 0;
  for (const std::string color : {"R", "G", "B"})
    for (std::size_t i = 0; i < file.values.at(color).size(); ++i) {
      double sum = 0;
      for (const auto& [name, values] : file.values)
        if (ends_with(name, "." + color)) sum += values[i];
      worst = std::max(worst, std::abs(sum - file.values.at(color)[i]));
    }
  return worst;
}

class LayeredExr : public Tool {
 protected:
  void render(const std::string& arguments) const {
    const Outcome outcome =
        run("render " + arguments + " --format exr-layers --progress none --quiet --out o");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  }
};

/// Shadows, a merged sprite, and old sprites under their warps.
TEST_F(LayeredExr, SumOfContributionsIsTheFrame) {
  write("passing.yaml", kPassing);
  render("passing.yaml --frames 0-14 --size 96x72 --geometric-px 4");
  for (const char* frame : {"o/frames/0000.exr", "o/frames/0007.exr", "o/frames/0014.exr"}) {
    const Channels file = read_channels(path(frame));
    ASSERT_EQ(file.width, 96) << frame;
    EXPECT_LT(error_of_sums(file), 1.0 / 255) << frame;
    EXPECT_GT(*std::max_element(file.values.at("R").begin(), file.values.at("R").end()), 0.05f);
  }
}

/// In the stage's lights, of additive layers, and with sprites that fade into each other.
TEST_F(LayeredExr, SumOfContributionsIsTheFrameOfFadesAndLights) {
  render("carousel --frames 0-9 --size 96x72 --geometric-px 4 --blend 4");
  EXPECT_LT(error_of_sums(read_channels(path("o/frames/0009.exr"))), 1.0 / 255);
  render("stage --frames 0-3 --size 96x72");
  EXPECT_LT(error_of_sums(read_channels(path("o/frames/0003.exr"))), 1.0 / 255);
}

TEST_F(LayeredExr, AgeErrorAndIdAreThoseOfTheDecisions) {
  write("passing.yaml", kPassing);
  render("passing.yaml --frames 0-1 --size 96x72 --geometric-px 20");
  const Channels file = read_channels(path("o/frames/0001.exr"));
  int looked_at = 0;
  for (const std::string& line : lines("o/decisions.jsonl")) {
    const Json decision = Json::parse(line);
    if (decision["frame"] != 1 || !file.values.contains(decision["layer"].get<std::string>() + ".age"))
      continue;
    ++looked_at;
    const auto most = [&](const std::string& channel) {
      const auto& values = file.values.at(decision["layer"].get<std::string>() + channel);
      return *std::max_element(values.begin(), values.end());
    };
    EXPECT_FLOAT_EQ(most(".error"), decision["geometric_px"].get<float>()) << line;
    EXPECT_FLOAT_EQ(most(".age"), 1 - decision["depicts_frame"].get<float>()) << line;
    EXPECT_GT(most(".id"), 0) << line;
  }
  EXPECT_GE(looked_at, 2);
  EXPECT_FLOAT_EQ(*std::max_element(file.values.at("wall.id").begin(), file.values.at("wall.id").end()), 1);
}

/// A dot begins a new name in OpenEXR, and names end at 255 bytes.
TEST_F(LayeredExr, HostileNamesStandInTheHeader) {
  const std::string a(1000, 'a');
  std::string yaml = kPassing;
  yaml.replace(yaml.find("{name: wall"), 11, "{name: '" + a + "'");
  yaml.replace(yaml.find("{name: ball"), 11, "{name: background.R");
  write("names.yaml", yaml);
  render("names.yaml --frames 0-0 --size 96x72");
  const Channels file = read_channels(path("o/frames/0000.exr"));
  ASSERT_TRUE(file.values.contains("background_R.id"));
  EXPECT_LT(error_of_sums(file), 1.0 / 255);
  const Json names = Json::parse(file.layers);
  EXPECT_EQ(names["background_R"], "background.R");
  EXPECT_TRUE(std::any_of(names.begin(), names.end(), [&](const Json& name) { return name == a; }));
}

TEST_F(LayeredExr, IsThePictureOfThePngAndOfTheVideo) {
  write("passing.yaml", kPassing);
  render("passing.yaml --frames 0-3 --size 96x72 --video");
  ASSERT_EQ(run("render passing.yaml --frames 0-3 --size 96x72 --quiet --out p").exit_code, 0);
  const Outcome diff = run("diff o/frames p/frames --json");
  ASSERT_EQ(diff.exit_code, 0) << diff.output;
  EXPECT_LE(Json::parse(diff.output)["worst"]["max_difference"], 1) << diff.output;
  EXPECT_TRUE(files_in("o").contains("video.mp4"));
}

TEST_F(LayeredExr, NeedsSpritesThatAreLaidOverEachOther) {
  expect_bad_input("render cube.obj --format exr-layers --policy direct", {"--format exr-layers", "direct"});
  expect_bad_input("render cube.obj --format exr-layers --compositor extended",
                   {"--format exr-layers", "extended", "must be talisman"});
  expect_bad_input("render cube.obj --format exr-layers --overlay", {"--overlay", "exr-layers"});
}

}  // namespace
}  // namespace talisman
