// SPDX-License-Identifier: Apache-2.0
// How long does a mesh take to draw, for us and for llvmpipe?
//
//   render_peers ROUNDS [TRIANGLES[/two-sided] ...]    prints what tests/bench/run reads
//
// Ours is compared with chunker::reference by bytes of the sprite; the peer with ours, in 8-bit linear light: it
// interpolates in 8-bit textures and has other samples, so what differs by more lies along edges. Agreement is 30 dB.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "chunker/reference.h"
#include "sequences/files/freed_memory.h"
#include "tests/bench/peers/ball.h"
#include "tests/bench/peers/rounds.h"
#include "tests/support/scenes.h"
#ifdef TALISMAN_PEER_LLVMPIPE
#include "tests/bench/peers/llvmpipe.h"
#endif

namespace talisman::bench {

layers::Scene ball(int triangles) {
  layers::Scene scene = tests::displaced_sphere_scene(triangles);
  scene.textures.assign(1, tests::checker_texture(32, 16));
  for (layers::Material& material : scene.materials) material.texture = 0;
  return scene;
}

namespace {

const std::vector<int> kParts{0};

struct BallJob {
  int triangles = 5000;
  bool two_sided = false;  ///< what faces away is drawn, too: all of it is hidden
};

BallJob parse(const std::string& name) {
  BallJob job;
  char rest[16] = "";
  const int read = std::sscanf(name.c_str(), "%d/%15s", &job.triangles, rest);
  job.two_sided = std::string(rest) == "two-sided";
  if (read < 1 || job.triangles < 8 || (read == 2 && !job.two_sided))
    throw std::runtime_error("'" + name + "' is no job, must be TRIANGLES or TRIANGLES/two-sided");
  return job;
}

struct Work {
  layers::Scene scene;
  chunker::PreparedScene prepared{scene};
  layers::SceneFrame frame = scene.at(0);
  layers::SpritePlacement placement;
  explicit Work(const BallJob& job) : scene(ball(job.triangles)) {
    placement.size_px = kPicture;
    for (layers::Material& material : scene.materials) material.two_sided = job.two_sided;
  }
};

chunker::RenderOptions with_samples(int samples) {
  chunker::RenderOptions options;
  options.shading = chunker::Shading::Gouraud;
  options.filter = chunker::TextureFilter::Bilinear;
  options.mipmaps = false;
  options.samples = samples;
  return options;
}

std::vector<unsigned char> texel_bytes(const chunker::Sprite& sprite, const layers::RectI& rect) {
  std::vector<unsigned char> bytes;
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) {
      const chunker::Texel t = sprite.texel(x, y);
      bytes.insert(bytes.end(), {t.r, t.g, t.b, t.a});
    }
  return bytes;
}

/// Squares of colours are linear light; alpha is linear.
[[maybe_unused]] LinearBytes linear_bytes(const chunker::Sprite& sprite) {
  LinearBytes bytes = texel_bytes(sprite, {0, 0, kPicture.x, kPicture.y});
  for (std::size_t i = 0; i < bytes.size(); ++i)
    if (i % 4 != 3) bytes[i] = static_cast<unsigned char>((bytes[i] * bytes[i] + 127) / 255);
  return bytes;
}

chunker::Sprite drawn(const Work& work, int samples) {
  return chunker::render(work.prepared, work.frame, kParts, kPicture, work.placement, with_samples(samples))
      .sprite;
}

/// The reference looks at every triangle for every pixel, so it draws three windows only: the middle, and two at
/// the outline.
Agreement compare_with_reference(const Work& work, int samples, const chunker::Sprite& sprite) {
  std::vector<unsigned char> ours, exact;
  for (const layers::ivec2 at : {layers::ivec2(496, 496), layers::ivec2(496, 208), layers::ivec2(208, 496)}) {
    layers::SpritePlacement window;
    window.size_px = {32, 32};
    window.screen_from_sprite = {1, 0, static_cast<double>(at.x), 0, 1, static_cast<double>(at.y)};
    const auto add = [](std::vector<unsigned char>& all, const std::vector<unsigned char>& more) {
      all.insert(all.end(), more.begin(), more.end());
    };
    add(ours, texel_bytes(sprite, {at.x, at.y, at.x + 32, at.y + 32}));
    add(exact, texel_bytes(chunker::reference::render(work.prepared, work.frame, kParts, kPicture, window,
                                                      with_samples(samples)),
                           {0, 0, 32, 32}));
  }
  return compare_bytes(ours, exact, 55);
}

Contender ours(const Work& work, int samples, int threads) {
  auto sprite = std::make_shared<chunker::Sprite>();
  std::string name = "ours, " + std::to_string(samples) + (samples == 1 ? " sample" : " samples");
  if (threads > 1) name += ", " + std::to_string(threads) + " threads";
  return {name, on_threads(threads, [&work, samples, sprite] { *sprite = drawn(work, samples); }),
          [&work, samples, sprite] { return compare_with_reference(work, samples, *sprite); }};
}

void run_job(const std::string& name, int rounds) {
  const auto work = std::make_unique<Work>(parse(name));
  std::vector<Contender> contenders = {ours(*work, 16, 1), ours(*work, 4, 1), ours(*work, 1, 1),
                                       ours(*work, 16, 2)};
#ifdef TALISMAN_PEER_LLVMPIPE
  Llvmpipe peer(work->frame);
  for (const bool four_samples : {true, false})
    contenders.push_back({four_samples ? "llvmpipe, 4 samples" : "llvmpipe, no antialiasing",
                          [&peer, four_samples] { peer.draw(four_samples); },
                          [&peer, &work, four_samples] {
                            return compare_bytes(peer.picture(),
                                                 linear_bytes(drawn(*work, four_samples ? 4 : 1)), 30);
                          }});
#endif
  const double polygons = static_cast<double>(work->scene.meshes[0].indices.size()) / 3;
  run_rounds({"sphere " + name, 1e-6 * polygons, "Mtri"}, contenders, rounds);
}

}  // namespace
}  // namespace talisman::bench

int main(int argc, char** argv) {
  talisman::sequences::keep_freed_memory();  // as the tool does; the peer is in the same process
  return talisman::bench::run_program({argv, static_cast<std::size_t>(argc)}, "render_peers",
                                      "TRIANGLES[/two-sided]", {"5000", "70000"}, talisman::bench::run_job);
}
