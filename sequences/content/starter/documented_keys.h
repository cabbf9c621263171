// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Keys of a sequence file on a page, each with what the reader's table says of it.

#include <string>

#include "sequences/content/map_keys.h"
#include "sequences/content/starter/yaml_page.h"

namespace talisman::sequences {

/// The keys of the map, or of each map in the list, that stands behind `key`. The key must be there, and be one.
const MapKeys& keys_below(const MapKeys& keys, const std::string& key);

/// "[0, 1.5, 3]", to six digits.
std::string written(const layers::dvec3& v);

class DocumentedKeys {
 public:
  YamlPage& page() { return page_; }

  /// "px: a reused sprite may be this far off …; one of a, b".
  static std::string meaning(const MapKeys& keys, const std::string& key);

  void put(const std::string& prefix, const MapKeys& keys, const std::string& key, const std::string& value);
  /// With the value that holds without it.
  void standard(const std::string& prefix, const MapKeys& keys, const std::string& key);
  /// Behind a #, with `example` or what holds without it.
  void off(const std::string& indent, const MapKeys& keys, const std::string& key,
           const std::string& example = "");
  /// Every key of the map that has a value to be written; the others behind a #.
  void standards(const std::string& indent, const MapKeys& keys);

 private:
  YamlPage page_;
};

}  // namespace talisman::sequences
