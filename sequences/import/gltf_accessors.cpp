// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/gltf_accessors.h"

#include <algorithm>
#include <cstring>

namespace talisman::sequences {

namespace {

/// Where the numbers of one element lie.
struct Layout {
  int type = 5126;  ///< of a component
  std::size_t component_bytes = 4;
  int rows = 1, columns = 1;
  std::size_t column_bytes = 4, element_bytes = 4;
  bool normalized = false;
  int components() const { return rows * columns; }
};

std::size_t bytes_of_type(int type) {
  switch (type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      throw InputError("glTF: componentType is " + std::to_string(type) +
                       ", rule: 5120, 5121, 5122, 5123, 5125 or 5126");
  }
}

template <typename T>
T read_as(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

double raw_number(int type, const std::uint8_t* from) {
  switch (type) {
    case 5120:
      return read_as<std::int8_t>(from);
    case 5121:
      return read_as<std::uint8_t>(from);
    case 5122:
      return read_as<std::int16_t>(from);
    case 5123:
      return read_as<std::uint16_t>(from);
    case 5125:
      return read_as<std::uint32_t>(from);
    default:
      return static_cast<double>(read_as<float>(from));
  }
}

Layout layout_of(const Json& accessor) {
  struct Shape {
    const char* name;
    int rows, columns;
  };
  static constexpr Shape kShapes[] = {{"SCALAR", 1, 1}, {"VEC2", 2, 1}, {"VEC3", 3, 1}, {"VEC4", 4, 1},
                                      {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};
  const std::string type = text_of(accessor, "type", "?");
  const auto* shape =
      std::find_if(std::begin(kShapes), std::end(kShapes), [&](const Shape& s) { return type == s.name; });
  if (shape == std::end(kShapes))
    throw InputError("glTF: the type of an accessor is " + type +
                     ", rule: SCALAR, VEC2 … VEC4 or MAT2 … MAT4");
  Layout layout;
  layout.type = index_of(accessor, "componentType");
  layout.component_bytes = bytes_of_type(layout.type);
  layout.rows = shape->rows;
  layout.columns = shape->columns;
  layout.column_bytes = layout.component_bytes * static_cast<std::size_t>(layout.rows);
  if (layout.columns > 1) layout.column_bytes = (layout.column_bytes + 3) / 4 * 4;
  layout.element_bytes = layout.column_bytes * static_cast<std::size_t>(layout.columns);
  layout.normalized = flag_of(accessor, "normalized", false);
  return layout;
}

/// `bytes` must hold `count` elements from `offset` on, `stride` apart.
void check_range(std::size_t bytes, std::size_t offset, std::size_t count, std::size_t stride,
                 std::size_t element) {
  if (count == 0) return;
  if (offset <= bytes && element <= bytes - offset && (count - 1) <= (bytes - offset - element) / stride)
    return;
  throw InputError("glTF: an accessor of " + std::to_string(count) + " elements of " +
                   std::to_string(element) + " bytes, " + std::to_string(stride) + " apart, begins at byte " +
                   std::to_string(offset) + ", rule: inside its view of " + std::to_string(bytes));
}

void read_element(const Layout& layout, const std::uint8_t* from, double* to) {
  for (int c = 0; c < layout.columns; ++c)
    for (int r = 0; r < layout.rows; ++r)
      *to++ = component_value(layout.type, layout.normalized,
                              from + c * layout.column_bytes + r * layout.component_bytes);
}

std::size_t offset_of(const Json& object) {
  return static_cast<std::size_t>(std::max(0, index_of(object, "byteOffset")));
}

void read_view(GltfFile& file, const Json& accessor, const Layout& layout, Accessed& result) {
  const int index = index_of(accessor, "bufferView");
  if (index < 0) return;  // zeros
  const auto bytes = bytes_of_view(file, index);
  const int given = index_of(item_of(file, "bufferViews", index), "byteStride");
  if (given > 0 && static_cast<std::size_t>(given) < layout.element_bytes)
    throw InputError("glTF: byteStride " + std::to_string(given) + ", rule: at least the " +
                     std::to_string(layout.element_bytes) + " bytes of an element");
  const std::size_t stride = given > 0 ? static_cast<std::size_t>(given) : layout.element_bytes;
  const std::size_t offset = offset_of(accessor);
  check_range(bytes.size(), offset, result.count, stride, layout.element_bytes);
  for (std::size_t i = 0; i < result.count; ++i)
    read_element(layout, bytes.data() + offset + i * stride, &result.values[i * result.components]);
}

void apply_sparse(GltfFile& file, const Json& sparse, const Layout& layout, Accessed& result) {
  const auto count = static_cast<std::size_t>(std::max(0, index_of(sparse, "count")));
  const Json &indices = object_of(sparse, "indices"), &values = object_of(sparse, "values");
  const int type = index_of(indices, "componentType");
  const auto places = bytes_of_view(file, index_of(indices, "bufferView"));
  const auto bytes = bytes_of_view(file, index_of(values, "bufferView"));
  const std::size_t place_bytes = bytes_of_type(type), first = offset_of(indices), from = offset_of(values);
  check_range(places.size(), first, count, place_bytes, place_bytes);
  check_range(bytes.size(), from, count, layout.element_bytes, layout.element_bytes);
  double before = -1;
  for (std::size_t i = 0; i < count; ++i) {
    const double place = raw_number(type, places.data() + first + i * place_bytes);
    if (!(place > before && place < static_cast<double>(result.count)))
      throw InputError("glTF: sparse index " + std::to_string(static_cast<long long>(place)) +
                       ", rule: above the one before it and below " + std::to_string(result.count));
    before = place;
    read_element(layout, bytes.data() + from + i * layout.element_bytes,
                 &result.values[static_cast<std::size_t>(place) * result.components]);
  }
}

}  // namespace

double component_value(int type, bool normalized, const std::uint8_t* from) {
  const double raw = raw_number(type, from);
  if (!normalized) return raw;
  switch (type) {
    case 5120:
      return std::max(raw / 127, -1.0);
    case 5121:
      return raw / 255;
    case 5122:
      return std::max(raw / 32767, -1.0);
    case 5123:
      return raw / 65535;
    case 5125:
      return raw / 4294967295.0;
    default:
      return raw;
  }
}

Accessed read_accessor(GltfFile& file, int index) {
  if (const auto found = file.decoded.find(index); found != file.decoded.end()) return found->second;
  const Json& accessor = item_of(file, "accessors", index);
  const Layout layout = layout_of(accessor);
  Accessed result;
  result.components = layout.components();
  const int count = index_of(accessor, "count");
  if (count < 0) throw InputError("glTF: accessor " + std::to_string(index) + " has no count");
  result.count = static_cast<std::size_t>(count);
  result.values.resize(result.count * static_cast<std::size_t>(result.components), 0);
  read_view(file, accessor, layout, result);
  if (const Json& sparse = object_of(accessor, "sparse"); !sparse.empty())
    apply_sparse(file, sparse, layout, result);
  return result;
}

Accessed read_accessor(GltfFile& file, int index, const char* what, int components, int or_components) {
  Accessed result = read_accessor(file, index);
  if (result.components == components || result.components == or_components) return result;
  throw InputError("glTF: " + std::string(what) + " has " + std::to_string(result.components) +
                   " components, rule: " + std::to_string(components) +
                   (or_components > 0 ? " or " + std::to_string(or_components) : ""));
}

}  // namespace talisman::sequences
