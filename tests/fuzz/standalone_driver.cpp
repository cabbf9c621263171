// SPDX-License-Identifier: Apache-2.0
// A main for fuzz targets where libFuzzer is missing (it comes with clang): damages its seed files, or bytes
// of its own, at random. Without coverage it finds less; what it finds is as real. The inputs follow from the
// seed number alone: a failure is met again by the same words.
//
//   TARGET [--inputs N | --seconds S] [--seed N] [--keep FILE] [seed files and folders of them…]
//
// Default: 10 seconds, seed number 1. --keep writes each input to FILE before it is fed: after a crash it is there.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
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

struct Words {
  double seconds = 10;
  long inputs = std::numeric_limits<long>::max();
  unsigned seed = 1;
  std::string keep;
  std::vector<Bytes> seeds;
};

[[noreturn]] void refuse(const std::string& what) {
  std::fprintf(stderr, "error: %s\n", what.c_str());
  std::exit(2);
}

Bytes read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) refuse(path + ": cannot be read");
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

/// A file, or all files of a folder in the order of their names.
void add_seeds(const std::string& path, std::vector<Bytes>& seeds) {
  if (!std::filesystem::is_directory(path)) return seeds.push_back(read_file(path));
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(path)) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) seeds.push_back(read_file(file));
}

Words words_of(int argc, char** argv) {
  Words words;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.rfind("--", 0) != 0) {
      add_seeds(word, words.seeds);
      continue;
    }
    if (i + 1 == argc) refuse(word + " needs a value");
    const char* value = argv[++i];
    if (word == "--inputs") {
      words.inputs = std::atol(value);
      words.seconds = std::numeric_limits<double>::infinity();
    } else if (word == "--seconds") {
      words.seconds = std::atof(value);
    } else if (word == "--seed") {
      words.seed = static_cast<unsigned>(std::atol(value));
    } else if (word == "--keep") {
      words.keep = value;
    } else {
      refuse(word + " is no option, rule: --inputs, --seconds, --seed, --keep");
    }
  }
  return words;
}

}  // namespace

int main(int argc, char** argv) {
  const Words words = words_of(argc, argv);
  std::mt19937 random(words.seed);
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [start] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  long inputs = 0;
  for (; inputs < words.inputs && elapsed() < words.seconds; ++inputs) {
    const std::vector<Bytes>& seeds = words.seeds;
    Bytes bytes = seeds.empty() || random() % 8 == 0 ? random_bytes(random) : seeds[random() % seeds.size()];
    for (unsigned changes = random() % 8; changes > 0; --changes) damage(random, bytes);
    if (!words.keep.empty())
      std::ofstream(words.keep, std::ios::binary)
          .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%ld inputs in %.1f s, no failure\n", inputs, elapsed());
}
