// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What does a PLY file hold? A header of elements ("element vertex 8") and their properties ("property float x",
/// "property list uchar int vertex_indices"), then their values in that order: text, or binary of either byte order.
///
/// Any elements in any order, with any properties. Source: G. Turk, "The PLY Polygon File Format" (1994).

#include <cstddef>
#include <string>
#include <vector>

namespace talisman::sequences {

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float, Double };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::Float;
  bool is_list = false;
  PlyType count_type = PlyType::Uint8;  ///< of a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
  /// The values of all items, one after the other; of a list its length and then its values.
  std::vector<double> values;
  /// Which property has the first of these names that is there; -1: none.
  int property(std::initializer_list<const char*> names) const;
};

struct PlyFile {
  std::vector<PlyElement> elements;
  std::vector<std::string> pictures;  ///< "comment TextureFile NAME"
  const PlyElement* element(const std::string& name) const;
};

/// Where the values of one item begin, one entry per property. Walks through an element item by item.
class PlyItems {
 public:
  explicit PlyItems(const PlyElement& element) : element_(element), starts_(element.properties.size()) {}
  /// False behind the last one.
  bool next();
  double value(int property) const { return element_.values[starts_[static_cast<std::size_t>(property)]]; }
  std::size_t length(int property) const { return static_cast<std::size_t>(value(property)); }
  double entry(int property, std::size_t k) const {
    return element_.values[starts_[static_cast<std::size_t>(property)] + 1 + k];
  }

 private:
  const PlyElement& element_;
  std::vector<std::size_t> starts_;
  std::size_t item_ = 0, at_ = 0;
};

/// Throws InputError without the file's name. Cost: 8 bytes of memory per value.
PlyFile read_ply_file(const std::string& path);

}  // namespace talisman::sequences
