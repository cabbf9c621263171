// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a glTF 2.0 file say? Its JSON, read with care, and the bytes it refers to.
///
/// A `.glb` file is a header (magic "glTF", version, length) and chunks (length, type, bytes): the first is the
/// JSON, the second, if there is one, the buffer without a URI (glTF 2.0, 4.4). Everything is checked where it
/// is read: an index, a length or a type that does not fit is an InputError that names it.

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sequences/files/errors.h"
#include "sequences/files/file_uses.h"
#include "sequences/import/texture_search.h"

namespace talisman::sequences {

using Json = nlohmann::json;

/// The numbers of an accessor (gltf_accessors.h).
struct Accessed {
  int components = 1;
  std::size_t count = 0;
  std::vector<double> values;  ///< components · count
  double at(std::size_t element, int component) const { return values[element * components + component]; }
};

struct GltfFile {
  ModelPlace place;
  Json json;
  std::vector<std::uint8_t> binary;                  ///< of a GLB
  std::map<int, std::vector<std::uint8_t>> buffers;  ///< those read so far
  std::map<int, std::vector<std::uint8_t>> views;    ///< those that had to be decoded, likewise
  std::map<int, Accessed> decoded = {};  ///< accessors of the primitive at work that hold other content
  FileUses uses = {};                    ///< what was asked of the file system
};

/// Reads and parses the file; refuses other versions than 2 and required extensions that are not in
/// `gltf_extension_is_read`. Throws InputError without the file's name.
GltfFile read_gltf_file(const ModelPlace& place);

/// Is it a glTF 1 file, by the version of its GLB header or of its JSON?
bool is_gltf1(const std::string& path);

/// Is the extension drawn, or at least read to the letter?
bool gltf_extension_is_read(const std::string& name);

/// The extensions that are used and not read, in the order of the file.
std::vector<std::string> gltf_extensions_not_read(const GltfFile& file);

// --- JSON. A member that is absent gives `otherwise`; one of another type is an InputError.

double number_of(const Json& object, const char* key, double otherwise);
/// A whole number from 0; -1 where it is absent.
int index_of(const Json& object, const char* key);
std::string text_of(const Json& object, const char* key, const std::string& otherwise = {});
bool flag_of(const Json& object, const char* key, bool otherwise);
/// Exactly `count` finite numbers, or `otherwise`.
std::vector<double> numbers_of(const Json& object, const char* key, std::size_t count,
                               const std::vector<double>& otherwise);
/// An array of any length; empty where it is absent.
const Json& list_of(const Json& object, const char* key);
/// An object; an empty one where it is absent.
const Json& object_of(const Json& object, const char* key);
/// The extension of that name in `object`, or null.
const Json* extension_of(const Json& object, const char* name);
/// The item `index` of the file's top-level array `kind`, an object.
const Json& item_of(const GltfFile& file, const char* kind, int index);

// --- Bytes

/// The bytes of a buffer view. Valid as long as the file.
std::span<const std::uint8_t> bytes_of_view(GltfFile& file, int view);

/// What a URI means: the bytes of a data URI, or of the file it names beside the model. Throws InputError.
std::vector<std::uint8_t> bytes_of_uri(GltfFile& file, const std::string& uri);

/// %20 becomes a space (RFC 3986, 2.1); what is no pair of hexadecimal digits stays.
std::string percent_decoded(const std::string& uri);

}  // namespace talisman::sequences
