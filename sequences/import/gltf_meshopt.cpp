// SPDX-License-Identifier: Apache-2.0
#include <meshoptimizer.h>

#include "sequences/import/gltf_compression.h"

namespace talisman::sequences {

namespace {

constexpr std::size_t kMaxStride = 256;  // of the codec

struct MeshoptView {
  std::string mode, filter;
  std::size_t count = 0, stride = 0;
};

[[noreturn]] void refuse(const std::string& what, const std::string& rule) {
  throw InputError("EXT_meshopt_compression: " + what + ", rule: " + rule);
}

std::size_t size_of(const Json& object, const char* key) {
  return static_cast<std::size_t>(std::max(0, index_of(object, key)));
}

void check_filter(const MeshoptView& view) {
  const std::size_t stride = view.stride;
  const std::string with = "stride " + std::to_string(stride) + " with filter " + view.filter;
  if (view.filter == "NONE") return;
  if (view.mode != "ATTRIBUTES") refuse("filter " + view.filter + " of " + view.mode, "only of ATTRIBUTES");
  if (view.filter == "OCTAHEDRAL") {
    if (stride != 4 && stride != 8) refuse(with, "4 or 8");
  } else if (view.filter == "QUATERNION") {
    if (stride != 8) refuse(with, "8");
  } else if (view.filter != "EXPONENTIAL") {
    refuse("filter " + view.filter, "NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL");
  }
}

/// What the decoders take for granted.
MeshoptView checked_view(const Json& from, std::size_t length) {
  MeshoptView view{text_of(from, "mode", "?"), text_of(from, "filter", "NONE"), size_of(from, "count"),
                   size_of(from, "byteStride")};
  const std::string stride = "stride " + std::to_string(view.stride) + " of " + view.mode;
  if (view.mode == "ATTRIBUTES") {
    if (view.stride == 0 || view.stride > kMaxStride || view.stride % 4 != 0)
      refuse(stride, "a multiple of 4, at most " + std::to_string(kMaxStride));
  } else if (view.mode == "TRIANGLES" || view.mode == "INDICES") {
    if (view.stride != 2 && view.stride != 4) refuse(stride, "2 or 4");
    if (view.mode == "TRIANGLES" && view.count % 3 != 0)
      refuse(std::to_string(view.count) + " indices of TRIANGLES", "a multiple of 3");
  } else {
    refuse("mode " + view.mode, "ATTRIBUTES, TRIANGLES or INDICES");
  }
  check_filter(view);
  if (view.count != length / view.stride || length % view.stride != 0)
    refuse(std::to_string(view.count) + " elements of " + std::to_string(view.stride) + " bytes",
           "as many bytes as the view has, " + std::to_string(length));
  return view;
}

/// The first byte of the stream: what it is, and by which version of the codec.
void check_codec(const MeshoptView& view, std::span<const std::uint8_t> source) {
  const bool attributes = view.mode == "ATTRIBUTES";
  const int kind = attributes ? 0xa0 : view.mode == "TRIANGLES" ? 0xe0 : 0xd0, latest = attributes ? 0 : 1;
  if (source.empty()) refuse("no bytes of " + view.mode, "at least a header");
  if ((source[0] & 0xf0) != kind) refuse("a stream of another kind than " + view.mode, "that of its mode");
  if (const int version = source[0] & 0x0f; version > latest)
    refuse("codec version " + std::to_string(version) + " of " + view.mode, attributes ? "0" : "0 or 1");
}

int decode(const MeshoptView& view, std::span<const std::uint8_t> source, std::uint8_t* to) {
  if (view.mode == "ATTRIBUTES")
    return meshopt_decodeVertexBuffer(to, view.count, view.stride, source.data(), source.size());
  if (view.mode == "TRIANGLES")
    return meshopt_decodeIndexBuffer(to, view.count, view.stride, source.data(), source.size());
  return meshopt_decodeIndexSequence(to, view.count, view.stride, source.data(), source.size());
}

}  // namespace

std::vector<std::uint8_t> decoded_meshopt(const Json& meshopt, std::span<const std::uint8_t> source,
                                          std::size_t length) {
  const MeshoptView view = checked_view(meshopt, length);
  check_codec(view, source);
  std::vector<std::uint8_t> bytes(length);
  if (decode(view, source, bytes.data()) != 0)
    refuse(std::to_string(source.size()) + " bytes of " + view.mode + " are damaged",
           "what its encoder wrote");
  if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), view.count, view.stride);
  if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), view.count, view.stride);
  if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), view.count, view.stride);
  return bytes;
}

}  // namespace talisman::sequences
