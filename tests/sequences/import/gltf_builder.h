// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Small glTF files, made in the test: bytes, accessors over them, and the JSON around it.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sequences/import/model_import.h"
#include "tests/sequences/temporary_folder.h"

namespace talisman::tests {

using Json = nlohmann::json;

inline std::string base64(const std::string& bytes) {
  static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned v = 0;
    for (std::size_t k = 0; k < 3; ++k)
      v = v << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (int k = 0; k < 4; ++k)
      text += i + static_cast<std::size_t>(k) <= bytes.size() ? kDigits[v >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// A square from (-1, -1, 0) to (1, 1, 0) on one node, which a test changes.
class Gltf {
 public:
  Json json;
  std::string bytes;

  Gltf() {
    json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
    json["nodes"] = Json::array({{{"name", "square"}, {"mesh", 0}}});
    const int positions = add<float>({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, 5126, "VEC3");
    const int indices = add<std::uint16_t>({0, 1, 2, 0, 2, 3}, 5123, "SCALAR");
    json["meshes"] = Json::array(
        {{{"name", "sheet"},
          {"primitives", Json::array({{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}})}}});
  }

  Json& primitive() { return json["meshes"][0]["primitives"][0]; }

  /// A view over new bytes, which begin at a multiple of 4.
  template <typename T>
  int view(const std::vector<T>& values) {
    while (bytes.size() % 4 != 0) bytes += '\0';
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}});
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  template <typename T>
  int add(const std::vector<T>& values, int component, const std::string& type, bool normalized = false) {
    const int width = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : type[3] - '0';
    Json accessor = {{"bufferView", view(values)},
                     {"componentType", component},
                     {"count", values.size() / static_cast<std::size_t>(width)},
                     {"type", type}};
    if (normalized) accessor["normalized"] = true;
    json["accessors"].push_back(accessor);
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  std::string text() const {
    Json whole = json;
    whole["buffers"] = Json::array(
        {{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}});
    return whole.dump();
  }

  /// As a GLB file: header, JSON chunk, binary chunk.
  std::string glb() const {
    Json whole = json;
    whole["buffers"] = Json::array({{{"byteLength", bytes.size()}}});
    std::string content = whole.dump(), binary = bytes;
    content.resize((content.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    std::string file = "glTF";
    const auto word = [&file](std::size_t value) {
      const auto v = static_cast<std::uint32_t>(value);
      file.append(reinterpret_cast<const char*>(&v), 4);
    };
    word(2), word(12 + 8 + content.size() + 8 + binary.size());
    word(content.size()), file += "JSON" + content;
    word(binary.size()), file += std::string("BIN\0", 4) + binary;
    return file;
  }

  sequences::ImportedModel import() const {
    const TemporaryFolder folder;
    return sequences::import_model(folder.write("model.gltf", text()));
  }
  std::string refusal() const {
    return message_of([this] { import(); });
  }
};

}  // namespace talisman::tests
