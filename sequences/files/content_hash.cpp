// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/content_hash.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <vector>

#include <OpenImageIO/hash.h>

#include "sequences/files/errors.h"

namespace talisman::sequences {

namespace {

std::string digest(OIIO::SHA1& hash) {
  std::string text = hash.digest();
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

}  // namespace

std::string hash_of_text(std::string_view text) {
  OIIO::SHA1 hash(text.data(), text.size());
  return digest(hash);
}

std::string hash_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError("cannot be read", path);
  OIIO::SHA1 hash;
  std::vector<char> block(1 << 20);
  while (in) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    hash.append(block.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) throw InputError("cannot be read to its end", path);
  return digest(hash);
}

}  // namespace talisman::sequences
