// SPDX-License-Identifier: Apache-2.0
#include <draco/compression/decode.h>

#include "sequences/import/gltf_compression.h"

namespace talisman::sequences {

namespace {

[[noreturn]] void refuse_draco(const std::string& what) {
  throw InputError("KHR_draco_mesh_compression: " + what);
}

std::unique_ptr<draco::Mesh> decode_mesh(std::span<const std::uint8_t> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto kind = draco::Decoder::GetEncodedGeometryType(&buffer);
  if (!kind.ok()) refuse_draco(kind.status().error_msg_string());
  if (kind.value() != draco::TRIANGULAR_MESH) refuse_draco("holds no triangles, rule: a triangular mesh");
  draco::Decoder decoder;
  auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) refuse_draco(mesh.status().error_msg_string());
  return std::move(mesh).value();
}

/// Component types of glTF.
int component_of(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return 5120;
    case draco::DT_UINT8:
      return 5121;
    case draco::DT_INT16:
      return 5122;
    case draco::DT_UINT16:
      return 5123;
    case draco::DT_UINT32:
      return 5125;
    case draco::DT_FLOAT32:
      return 5126;
    default:
      refuse_draco("an attribute of data type " + std::to_string(type) + ", rule: those of glTF");
  }
}

Accessed values_of(const GltfFile& file, int accessor, const draco::PointAttribute& from,
                   std::size_t points) {
  const Json& json = item_of(file, "accessors", accessor);
  Accessed to;
  to.components = from.num_components();
  to.count = points;
  if (index_of(json, "count") != static_cast<int>(points))
    refuse_draco("an attribute has " + std::to_string(points) + " elements, rule: as its accessor says, " +
                 std::to_string(index_of(json, "count")));
  const int type = component_of(from.data_type());
  const bool normalized = flag_of(json, "normalized", false);
  const auto width = static_cast<std::size_t>(draco::DataTypeLength(from.data_type()));
  const std::size_t element = width * static_cast<std::size_t>(to.components);
  if (static_cast<std::size_t>(from.byte_stride()) < element)
    refuse_draco("an attribute with too small a stride");
  to.values.reserve(points * static_cast<std::size_t>(to.components));
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(from.byte_stride()));
  for (std::size_t i = 0; i < points; ++i) {
    const draco::AttributeValueIndex at = from.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
    if (at.value() >= from.size()) refuse_draco("a point has no value of an attribute");
    from.GetValue(at, bytes.data());
    for (int k = 0; k < to.components; ++k)
      to.values.push_back(
          component_value(type, normalized, bytes.data() + static_cast<std::size_t>(k) * width));
  }
  return to;
}

}  // namespace

DracoMesh decoded_draco(GltfFile& file, const Json& primitive, const Json& draco) {
  const std::unique_ptr<draco::Mesh> from = decode_mesh(bytes_of_view(file, index_of(draco, "bufferView")));
  DracoMesh mesh;
  const Json& ids = object_of(draco, "attributes");
  const Json& attributes = object_of(primitive, "attributes");
  for (const auto& [name, unused] : ids.items()) {
    const int accessor = index_of(attributes, name.c_str());
    if (accessor < 0) continue;
    const auto* attribute =
        from->GetAttributeByUniqueId(static_cast<std::uint32_t>(index_of(ids, name.c_str())));
    if (!attribute) refuse_draco(name + " names an attribute that is not there");
    mesh.accessors[accessor] = values_of(file, accessor, *attribute, from->num_points());
  }
  for (draco::FaceIndex f(0); f < from->num_faces(); ++f)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t corner = from->face(f)[static_cast<std::size_t>(k)].value();
      if (corner >= from->num_points()) refuse_draco("a triangle has a corner that is not there");
      mesh.indices.push_back(corner);
    }
  return mesh;
}

}  // namespace talisman::sequences
