// SPDX-License-Identifier: Apache-2.0
// A main for fuzz targets where libFuzzer is missing (it comes with clang): damages its seed files, or bytes
// of its own, at random for a while. Without coverage it finds less; what it finds is as real.
//
//   TARGET [seconds, default 10] [seed number, default 1] [seed files…]
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes random_bytes(std::mt19937& random) {
  Bytes bytes(random() % 512);
  for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random());
  return bytes;
}

/// One of: a bit flipped, a byte replaced, the end cut off, a piece repeated, a piece removed.
void damage(std::mt19937& random, Bytes& bytes) {
  if (bytes.empty()) return bytes.push_back(static_cast<std::uint8_t>(random()));
  const std::size_t at = random() % bytes.size(), length = random() % (bytes.size() - at + 1) % 64;
  const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  const Bytes piece(place, place + static_cast<std::ptrdiff_t>(length));
  switch (random() % 5) {
    case 0:
      bytes[at] ^= static_cast<std::uint8_t>(1u << random() % 8);
      break;
    case 1:
      bytes[at] = static_cast<std::uint8_t>(random());
      break;
    case 2:
      bytes.resize(at);
      break;
    case 3:
      bytes.insert(place, piece.begin(), piece.end());
      break;
    default:
      bytes.erase(place, place + static_cast<std::ptrdiff_t>(length));
  }
}

Bytes read_file(const char* path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    std::fprintf(stderr, "error: %s: cannot be read\n", path);
    std::exit(2);
  }
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 10;
  std::mt19937 random(argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1u);
  std::vector<Bytes> seeds;
  for (int i = 3; i < argc; ++i) seeds.push_back(read_file(argv[i]));
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [start] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  long inputs = 0;
  for (; elapsed() < seconds; ++inputs) {
    Bytes bytes = seeds.empty() || random() % 8 == 0 ? random_bytes(random) : seeds[random() % seeds.size()];
    for (unsigned changes = random() % 8; changes > 0; --changes) damage(random, bytes);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%ld inputs in %.1f s, no failure\n", inputs, elapsed());
}
