// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/gltf_json.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>

#include "sequences/import/gltf_compression.h"

namespace talisman::sequences {

namespace {

constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

constexpr std::array kReadExtensions = {
    "KHR_materials_unlit",     "KHR_texture_transform",     "KHR_materials_emissive_strength",
    "KHR_materials_specular",  "KHR_materials_ior",         "KHR_materials_pbrSpecularGlossiness",
    "KHR_lights_punctual",     "KHR_mesh_quantization",     "EXT_texture_webp",
    "EXT_meshopt_compression", "KHR_draco_mesh_compression"};

std::vector<std::uint8_t> bytes_of_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    throw InputError("is no file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError("cannot be opened");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::uint32_t word_at(std::span<const std::uint8_t> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  if (offset + sizeof value > bytes.size()) throw InputError("ends inside a GLB header");
  std::memcpy(&value, bytes.data() + offset, sizeof value);  // both are little-endian
  return value;
}

/// The next chunk and its type; moves `at` behind it.
std::span<const std::uint8_t> next_chunk(std::span<const std::uint8_t> bytes, std::size_t& at,
                                         std::uint32_t& type) {
  const std::size_t length = word_at(bytes, at);
  type = word_at(bytes, at + 4);
  at += 8;
  if (length > bytes.size() - at)
    throw InputError("has a GLB chunk of " + std::to_string(length) + " bytes, but only " +
                     std::to_string(bytes.size() - at) + " follow");
  const auto chunk = bytes.subspan(at, length);
  at += length;
  return chunk;
}

Json parsed(std::span<const std::uint8_t> text) {
  Json json = Json::parse(text.begin(), text.end(), nullptr, false);
  if (json.is_discarded()) throw InputError("cannot be read as a model: its JSON is damaged");
  if (!json.is_object()) throw InputError("cannot be read as a model: its JSON is no object");
  return json;
}

/// The bytes as they would be written: "67 6c 54 46".
std::string first_bytes(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(4, bytes.size()); ++i) {
    char hex[4];
    std::snprintf(hex, sizeof hex, "%02x ", bytes[i]);
    text += hex;
  }
  return text.substr(0, text.size() - 1);
}

/// A .glb may hold the JSON of a .gltf; anything else than that and GLB is neither.
void check_magic(const std::string& path, std::span<const std::uint8_t> bytes) {
  if (std::filesystem::path(path).extension() != ".glb") return;
  if (bytes.size() >= 4 && word_at(bytes, 0) == kGlbMagic) throw InputError("ends inside a GLB header");
  if (bytes.empty()) throw InputError("is empty, rule: a GLB file begins with 67 6c 54 46, \"glTF\"");
  const auto text = std::find_if(bytes.begin(), bytes.end(), [](std::uint8_t c) { return !std::isspace(c); });
  const bool may_be_json = text != bytes.end() && (*text == '{' || *text == 0xef);
  if (!may_be_json)
    throw InputError("has the magic number " + first_bytes(bytes) +
                     ", rule: a GLB file begins with 67 6c 54 46, \"glTF\"");
}

void read_glb(std::span<const std::uint8_t> bytes, GltfFile& file) {
  if (const std::uint32_t version = word_at(bytes, 4); version != 2)
    throw InputError("is GLB version " + std::to_string(version) + ", rule: 2");
  std::size_t at = 12;
  std::uint32_t type = 0;
  const auto json = next_chunk(bytes, at, type);
  if (type != kJsonChunk) throw InputError("has no JSON in its first GLB chunk");
  file.json = parsed(json);
  if (at + 8 > bytes.size()) return;
  const auto binary = next_chunk(bytes, at, type);
  if (type == kBinaryChunk) file.binary.assign(binary.begin(), binary.end());
}

void check_version(const Json& json) {
  const std::string version = text_of(object_of(json, "asset"), "version", "?");
  if (version.rfind("2.", 0) != 0)
    throw InputError("cannot be read as a model: it is glTF version " + version + ", rule: 2");
  const std::string least = text_of(object_of(json, "asset"), "minVersion", "2.0");
  if (least != "2.0")
    throw InputError("cannot be read as a model: it wants a reader of glTF " + least + ", rule: 2.0");
}

void check_required(const Json& json) {
  std::string lacking;
  for (const Json& name : list_of(json, "extensionsRequired"))
    if (!name.is_string() || !gltf_extension_is_read(name.get<std::string>()))
      lacking += (lacking.empty() ? "" : ", ") + name.dump();
  if (!lacking.empty())
    throw InputError("requires " + lacking + ", rule: only extensions that are read may be required");
}

[[noreturn]] void fail(const char* key, const Json& value, const char* rule) {
  throw InputError("glTF: " + std::string(key) + " is " + value.dump().substr(0, 60) + ", rule: " + rule);
}

const Json* member(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() || found->is_null() ? nullptr : &*found;
}

// --- URIs

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

std::vector<std::uint8_t> from_base64(const std::string& text, std::size_t from) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve((text.size() - from) / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (std::size_t i = from; i < text.size() && text[i] != '='; ++i) {
    const int digit = base64_digit(text[i]);
    if (digit < 0) throw InputError("has a data URI that is no base64");
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> count));
  }
  return bytes;
}

std::vector<std::uint8_t> bytes_of_data_uri(const std::string& uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos) throw InputError("has a data URI without a comma");
  const std::string kBase64 = ";base64";
  const bool encoded =
      comma >= kBase64.size() && uri.compare(comma - kBase64.size(), kBase64.size(), kBase64) == 0;
  if (encoded) return from_base64(uri, comma + 1);
  const std::string text = percent_decoded(uri.substr(comma + 1));
  return {text.begin(), text.end()};
}

const std::vector<std::uint8_t>& bytes_of_buffer(GltfFile& file, int index) {
  const auto [entry, is_new] = file.buffers.try_emplace(index);
  if (!is_new) return entry->second;
  const Json& buffer = item_of(file, "buffers", index);
  const std::string uri = text_of(buffer, "uri");
  entry->second = uri.empty() ? file.binary : bytes_of_uri(file, uri);
  const double length = number_of(buffer, "byteLength", 0);
  if (length > static_cast<double>(entry->second.size()))
    throw InputError("glTF: buffer " + std::to_string(index) + " has " +
                     std::to_string(entry->second.size()) + " bytes, rule: its byteLength, " +
                     std::to_string(static_cast<long long>(length)));
  return entry->second;
}

}  // namespace

bool gltf_extension_is_read(const std::string& name) {
  return std::find(kReadExtensions.begin(), kReadExtensions.end(), name) != kReadExtensions.end();
}

std::vector<std::string> gltf_extensions_not_read(const GltfFile& file) {
  std::vector<std::string> names;
  for (const Json& name : list_of(file.json, "extensionsUsed"))
    if (name.is_string() && !gltf_extension_is_read(name.get<std::string>()))
      names.push_back(name.get<std::string>());
  return names;
}

GltfFile read_gltf_file(const ModelPlace& place) {
  GltfFile file;
  file.place = place;
  file.uses.look_for(place.path);
  const std::vector<std::uint8_t> bytes = bytes_of_file(place.path);
  if (bytes.size() >= 12 && word_at(bytes, 0) == kGlbMagic)
    read_glb(bytes, file);
  else {
    check_magic(place.path, bytes);
    file.json = parsed(bytes);
  }
  check_version(file.json);
  check_required(file.json);
  return file;
}

bool is_gltf1(const std::string& path) {
  const std::vector<std::uint8_t> bytes = bytes_of_file(path);
  if (bytes.size() >= 12 && word_at(bytes, 0) == kGlbMagic) return word_at(bytes, 4) == 1;
  const Json json = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
  if (!json.is_object()) return false;
  const auto asset = json.find("asset");
  const bool said = asset != json.end() && asset->is_object() && asset->contains("version");
  return said && (*asset)["version"].is_string() &&
         (*asset)["version"].get<std::string>().rfind("1.", 0) == 0;
}

double number_of(const Json& object, const char* key, double otherwise) {
  const Json* value = member(object, key);
  if (!value) return otherwise;
  if (!value->is_number() || !std::isfinite(value->get<double>())) fail(key, *value, "a finite number");
  return value->get<double>();
}

int index_of(const Json& object, const char* key) {
  const Json* value = member(object, key);
  if (!value) return -1;
  const double number = number_of(object, key, -1);
  if (!(number >= 0 && number <= std::numeric_limits<int>::max() && number == std::floor(number)))
    fail(key, *value, "a whole number, at least 0");
  return static_cast<int>(number);
}

std::string text_of(const Json& object, const char* key, const std::string& otherwise) {
  const Json* value = member(object, key);
  if (!value) return otherwise;
  if (!value->is_string()) fail(key, *value, "a text");
  return value->get<std::string>();
}

bool flag_of(const Json& object, const char* key, bool otherwise) {
  const Json* value = member(object, key);
  if (!value) return otherwise;
  if (!value->is_boolean()) fail(key, *value, "true or false");
  return value->get<bool>();
}

std::vector<double> numbers_of(const Json& object, const char* key, std::size_t count,
                               const std::vector<double>& otherwise) {
  const Json* value = member(object, key);
  if (!value) return otherwise;
  if (!value->is_array() || value->size() != count)
    fail(key, *value, ("a list of " + std::to_string(count) + " numbers").c_str());
  std::vector<double> numbers;
  for (const Json& item : *value) {
    if (!item.is_number() || !std::isfinite(item.get<double>())) fail(key, *value, "finite numbers");
    numbers.push_back(item.get<double>());
  }
  return numbers;
}

const Json& list_of(const Json& object, const char* key) {
  static const Json kNone = Json::array();
  const Json* value = member(object, key);
  if (!value) return kNone;
  if (!value->is_array()) fail(key, *value, "a list");
  return *value;
}

const Json& object_of(const Json& object, const char* key) {
  static const Json kNone = Json::object();
  const Json* value = member(object, key);
  if (!value) return kNone;
  if (!value->is_object()) fail(key, *value, "an object");
  return *value;
}

const Json* extension_of(const Json& object, const char* name) {
  const Json* extensions = member(object, "extensions");
  const Json* found = extensions ? member(*extensions, name) : nullptr;
  return found && found->is_object() ? found : nullptr;
}

const Json& item_of(const GltfFile& file, const char* kind, int index) {
  const Json& items = list_of(file.json, kind);
  if (index < 0 || static_cast<std::size_t>(index) >= items.size())
    throw InputError("glTF: " + std::string(kind) + " " + std::to_string(index) + " is used, rule: below " +
                     std::to_string(items.size()));
  if (!items[index].is_object()) fail(kind, items[index], "objects");
  return items[index];
}

namespace {

/// The bytes that `view`, or its extension, names.
std::span<const std::uint8_t> bytes_in_buffer(GltfFile& file, const Json& view, int index) {
  const std::vector<std::uint8_t>& buffer = bytes_of_buffer(file, index_of(view, "buffer"));
  const std::size_t offset = static_cast<std::size_t>(std::max(0, index_of(view, "byteOffset")));
  const std::size_t length = static_cast<std::size_t>(std::max(0, index_of(view, "byteLength")));
  if (offset > buffer.size() || length > buffer.size() - offset)
    throw InputError("glTF: bufferView " + std::to_string(index) + " ends at byte " +
                     std::to_string(offset + length) + ", rule: inside its buffer of " +
                     std::to_string(buffer.size()));
  return {buffer.data() + offset, length};
}

}  // namespace

std::span<const std::uint8_t> bytes_of_view(GltfFile& file, int index) {
  const Json& view = item_of(file, "bufferViews", index);
  const Json* meshopt = extension_of(view, "EXT_meshopt_compression");
  if (!meshopt) return bytes_in_buffer(file, view, index);
  const auto [entry, is_new] = file.views.try_emplace(index);
  if (is_new)
    entry->second = decoded_meshopt(*meshopt, bytes_in_buffer(file, *meshopt, index),
                                    static_cast<std::size_t>(std::max(0, index_of(view, "byteLength"))));
  return entry->second;
}

std::string percent_decoded(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(uri[i + 2]) : -1;
    if (low >= 0) i += 2;
    text += low >= 0 ? static_cast<char>(high << 4 | low) : uri[i];
  }
  return text;
}

std::vector<std::uint8_t> bytes_of_uri(GltfFile& file, const std::string& uri) {
  if (uri.rfind("data:", 0) == 0) return bytes_of_data_uri(uri);
  const std::string found = find_file(file.place, percent_decoded(uri), file.uses);
  if (found.empty()) throw InputError("'" + uri + "' is missing");
  return bytes_of_file(found);
}

}  // namespace talisman::sequences
