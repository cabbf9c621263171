// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What glTF 2.0 and its extensions say, as pixels: a file of a few triangles, a picture of 64 × 64, and colours worked
/// out by hand. The camera stands at z = 3 and sees 1.5 up and down in the plane z = 0, so that pixel x lies at
/// (x + 0.5 − 32) · 1.5 / 32: the square from −1 to 1 covers 11 to 52, −0.5 is pixel 21, 0.5 is pixel 42. One ambient
/// light of 1 shows a base colour as it is: 1, 0.5, 0.25, 0.2 in linear light are 255, 188, 137, 124 in sRGB.

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "chunker/render.h"
#include "sequences/content/sequence.h"
#include "sequences/pipeline/make_pipeline.h"
#include "sequences/pipeline/step.h"
#include "tests/sequences/import/gltf_builder.h"

namespace talisman::tests {

using sequences::Sequence;

using Rgb = std::vector<int>;
inline const Rgb kBlack = {0, 0, 0}, kWhite = {255, 255, 255}, kRed = {255, 0, 0}, kGreen = {0, 255, 0},
                 kBlue = {0, 0, 255}, kYellow = {255, 255, 0};

struct Pixel {
  int x, y;
  Rgb color;
};

struct PixelCase {
  std::string name;
  std::function<void(Gltf&)> change;
  std::vector<Pixel> pixels;
  int frame = 0;  ///< at 10 per second
  std::string light = "[1, 1, 1]";
  std::string lights{};  ///< a list of lights instead of that one
};

// --- Parts of files

inline constexpr std::initializer_list<float> kCornersOfSquare = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};

inline Json plain(const Json& color) {
  return {{"pbrMetallicRoughness", {{"baseColorFactor", color}, {"metallicFactor", 0}}}};
}

/// The square in a material.
inline Json& look(Gltf& file, const Json& material) {
  file.primitive()["material"] = file.json["materials"].size();
  file.json["materials"].push_back(material);
  return file.json["materials"].back();
}
inline void red(Gltf& file) { look(file, plain({1, 0, 0, 1})); }

inline int attribute(Gltf& file, const char* name, int accessor) {
  file.primitive()["attributes"][name] = accessor;
  return accessor;
}

/// The square once more, on a node of its own; returns the node.
inline Json& second_node(Gltf& file, const Json& node) {
  file.json["nodes"].push_back(node);
  file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size() - 1);
  return file.json["nodes"].back();
}

/// A picture as texture, looked up without a filter. `rgb`: row by row from the top.
inline int picture(Gltf& file, int width, const std::vector<std::uint8_t>& rgb) {
  const std::string head = "P6\n" + std::to_string(width) + " " +
                           std::to_string(rgb.size() / 3 / static_cast<std::size_t>(width)) + "\n255\n";
  std::vector<std::uint8_t> bytes(head.begin(), head.end());
  bytes.insert(bytes.end(), rgb.begin(), rgb.end());
  file.json["images"].push_back({{"bufferView", file.view(bytes)}, {"mimeType", "image/x-ppm"}});
  file.json["samplers"].push_back({{"magFilter", 9728}, {"minFilter", 9728}});
  file.json["textures"].push_back(
      {{"source", file.json["images"].size() - 1}, {"sampler", file.json["samplers"].size() - 1}});
  return static_cast<int>(file.json["textures"].size()) - 1;
}

/// Red, green above blue, yellow.
inline int four_colors(Gltf& file) {
  return picture(file, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 0});
}

/// The picture over the square, (0, 0) at its upper left.
inline Json& textured_square(Gltf& file, int texture) {
  attribute(file, "TEXCOORD_0", file.add<float>({0, 1, 1, 1, 1, 0, 0, 0}, 5126, "VEC2"));
  Json material = plain({1, 1, 1, 1});
  material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
  return look(file, material);
}
inline Json& base_map(Json& material) { return material["pbrMetallicRoughness"]["baseColorTexture"]; }

inline const std::vector<Pixel> kFourColors = {
    {21, 21, kRed}, {42, 21, kGreen}, {21, 42, kBlue}, {42, 42, kYellow}};
inline const std::vector<Pixel> kSquare = {
    {32, 32, kRed}, {12, 12, kRed}, {51, 51, kRed}, {8, 32, kBlack}, {32, 56, kBlack}};

inline void animate(Gltf& file, const char* path, const std::vector<float>& times, int output,
                    const char* how) {
  const int input = file.add<float>(times, 5126, "SCALAR");
  file.json["animations"] = Json::array(
      {{{"samplers", Json::array({{{"input", input}, {"output", output}, {"interpolation", how}}})},
        {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}})}}});
}

inline int morph_to_the_right(Gltf& file) {
  const int target = file.add<float>({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, 5126, "VEC3");
  file.primitive()["targets"] = Json::array({{{"POSITION", target}}});
  return target;
}

/// All corners hang on the first joint, node 1.
inline void skin_on(Gltf& file, const Json& joint) {
  file.json["nodes"][0]["skin"] = 0;
  second_node(file, joint);
  file.json["skins"] = Json::array({{{"joints", {1}}}});
  attribute(file, "JOINTS_0", file.add<std::uint8_t>(std::vector<std::uint8_t>(16, 0), 5121, "VEC4"));
  attribute(file, "WEIGHTS_0",
            file.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 5126, "VEC4"));
}

/// Draws the case's frame and compares its pixels, each channel to 3.
inline void expect_pixels(const PixelCase& wanted) {
  const TemporaryFolder folder;
  Gltf file;
  wanted.change(file);
  folder.write("m.gltf", file.text());
  const Sequence sequence = sequences::load_sequence(folder.write(
      "m.yaml",
      "frames: 21\nfps: 10\ndisplay: [64, 64]\nmodels: [{id: m, file: m.gltf}]\n"
      "camera: {fov_deg: 53.13010235, near_m: 0.1, far_m: 100, position: [0, 0, 3]}\n"
      "lights: " +
          (wanted.lights.empty() ? "[{kind: ambient, color: " + wanted.light + "}]" : wanted.lights) + "\n"));
  sequences::Settings settings;
  settings.view.display_px = sequence.display_px;
  settings.fps = sequence.fps;
  settings.frames = sequence.frames;
  const sequences::Pipeline pipeline = sequences::make_pipeline(*sequence.scene, sequence.layers, settings);
  const chunker::PreparedScene prepared(*sequence.scene, settings.render);
  const std::vector<std::uint8_t> rgb =
      chunker::srgb_bytes(sequences::draw_direct(pipeline, wanted.frame, prepared));
  for (const Pixel& pixel : wanted.pixels)
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(rgb[static_cast<std::size_t>(3 * (64 * pixel.y + pixel.x) + k)],
                  pixel.color[static_cast<std::size_t>(k)], 3)
          << "channel " << k << " of (" << pixel.x << ", " << pixel.y << ")";
}

}  // namespace talisman::tests
