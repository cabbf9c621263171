// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/scene_stream.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "sequences/files/utf8.h"

namespace talisman::sequences {

namespace {

constexpr std::uint32_t kSceneMagic =
    0x4d534c54;  // "TLSM"; both ends run on one machine, so bytes are in its order
constexpr std::uint32_t kVersion = 5;

[[noreturn]] void fail(const std::string& what) { throw InputError("scene stream: " + what); }

/// Types whose bytes are their value: numbers and the vectors, quaternions and matrices of them.
template <typename T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool> && !std::is_enum_v<T> &&
                !std::is_same_v<T, layers::Transform> && !std::is_same_v<T, LayerTag> &&
                !std::is_same_v<T, layers::SpinTrack>;

class Writer {
 public:
  template <Plain T>
  void value(const T& v) {
    raw(&v, sizeof v);
  }
  void flag(bool v) { value(static_cast<std::uint8_t>(v)); }
  template <typename Enum>
  void choice(Enum v, Enum) {
    value(static_cast<std::uint8_t>(v));
  }
  template <Plain T>
  void array(const std::vector<T>& v) {
    value(static_cast<std::uint64_t>(v.size()));
    raw(v.data(), v.size() * sizeof(T));
  }
  void path(const std::string& s) {
    value(static_cast<std::uint64_t>(s.size()));
    raw(s.data(), s.size());
  }
  void text(const std::string& s) { path(s); }
  template <typename T>
  void list(const std::vector<T>& v) {
    value(static_cast<std::uint64_t>(v.size()));
    for (const T& item : v) fields(*this, item);
  }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  void raw(const void* from, std::size_t size) {
    const auto* first = static_cast<const std::uint8_t*>(from);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  std::vector<std::uint8_t> bytes_;
};

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : rest_(bytes), size_(bytes.size()) {}

  template <Plain T>
  void value(T& v) {
    raw(&v, sizeof v);
  }
  void flag(bool& v) {
    std::uint8_t byte = 0;
    value(byte);
    if (byte > 1) fail("flag " + std::to_string(byte) + ", rule: 0 or 1" + place());
    v = byte == 1;
  }
  template <typename Enum>
  void choice(Enum& v, Enum last) {
    std::uint8_t byte = 0;
    value(byte);
    if (byte > static_cast<std::uint8_t>(last)) fail("unknown choice " + std::to_string(byte) + place());
    v = static_cast<Enum>(byte);
  }
  template <Plain T>
  void array(std::vector<T>& v) {
    v.resize(length(sizeof(T)));
    raw(v.data(), v.size() * sizeof(T));
  }
  /// As it is: the file system knows no encoding.
  void path(std::string& s) {
    s.resize(length(1));
    raw(s.data(), s.size());
  }
  /// In UTF-8, whatever the model has: names go into results.
  void text(std::string& s) {
    path(s);
    s = utf8_from(s);
  }
  // Items are made one by one, so that a false length costs no more memory than there are bytes for items.
  template <typename T>
  void list(std::vector<T>& v) {
    const std::size_t n = length(1);
    for (std::size_t i = 0; i < n; ++i) {
      T item;
      fields(*this, item);
      v.push_back(std::move(item));
    }
  }
  void expect_end() const {
    if (!rest_.empty()) fail(std::to_string(rest_.size()) + " bytes too many" + place());
  }

 private:
  std::string place() const { return " (byte " + std::to_string(size_ - rest_.size()) + ")"; }
  std::size_t length(std::size_t item_bytes) {
    std::uint64_t n = 0;
    value(n);
    if (n > rest_.size() / item_bytes)
      fail("length " + std::to_string(n) + ", but only " + std::to_string(rest_.size()) + " bytes follow" +
           place());
    return static_cast<std::size_t>(n);
  }
  void raw(void* to, std::size_t size) {
    if (size > rest_.size()) fail("ends too early" + place());
    if (size > 0) std::memcpy(to, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }
  std::span<const std::uint8_t> rest_;
  std::size_t size_;
};

/// "This struct, to be read or to be written": one list of fields serves both directions.
template <typename T, typename Struct>
concept Of = std::is_same_v<std::remove_const_t<T>, Struct>;

template <typename Stream, Of<layers::MorphTarget> T>
void fields(Stream& s, T& m) {
  s.array(m.positions);
  s.array(m.normals);
  s.array(m.tangents);
}

template <typename Stream, Of<layers::Mesh> T>
void fields(Stream& s, T& m) {
  s.text(m.name);
  s.array(m.positions);
  s.array(m.normals);
  s.array(m.uvs);
  s.array(m.emissive_uvs);
  s.array(m.normal_uvs);
  s.array(m.tangents);
  s.array(m.colors);
  s.array(m.alphas);
  s.array(m.indices);
  s.array(m.joints);
  s.array(m.weights);
  s.list(m.morphs);
}

template <typename Stream, Of<layers::Texture> T>
void fields(Stream& s, T& t) {
  s.text(t.name);
  s.value(t.width);
  s.value(t.height);
  s.array(t.rgba);
  s.flag(t.has_alpha);
  s.choice(t.wrap_u, layers::Wrap::Mirror);
  s.choice(t.wrap_v, layers::Wrap::Mirror);
  s.flag(t.nearest);
  s.flag(t.nearest_minified);
  s.flag(t.finest);
  s.flag(t.one_level);
}

template <typename Stream, Of<layers::Material> T>
void fields(Stream& s, T& m) {
  s.text(m.name);
  s.value(m.base_color);
  s.value(m.opacity);
  s.value(m.texture);
  s.value(m.texture2);
  s.value(m.texture_blend);
  s.value(m.specular);
  s.value(m.shininess);
  s.value(m.emissive);
  s.value(m.emissive_texture);
  s.value(m.normal_texture);
  s.value(m.normal_scale);
  s.value(m.alpha_cutoff);
  s.value(m.reflectivity);
  s.flag(m.two_sided);
  s.flag(m.unlit);
}

template <typename Stream, Of<layers::Skin> T>
void fields(Stream& s, T& skin) {
  s.text(skin.name);
  s.array(skin.joints);
  s.array(skin.joint_from_mesh);
}

template <typename Stream, Of<layers::Node> T>
void fields(Stream& s, T& node) {
  s.text(node.name);
  s.value(node.parent);
  s.value(node.local.translation);
  s.value(node.local.rotation);
  s.value(node.local.scale);
  s.array(node.morph_weights);
}

template <typename Stream, typename K>
void keys(Stream& s, K& k) {
  s.array(k.times_s);
  s.array(k.values);
  s.choice(k.interpolation, layers::Interpolation::CubicSpline);
  s.array(k.in_tangents);
  s.array(k.out_tangents);
}

template <typename Stream, Of<layers::TransformTrack> T>
void fields(Stream& s, T& track) {
  keys(s, track.translation);
  keys(s, track.rotation);
  keys(s, track.scale);
  s.flag(track.loop);
  s.value(track.loop_end_s);
}

template <typename Stream, Of<layers::Keys<double>> T>
void fields(Stream& s, T& k) {
  keys(s, k);
}

template <typename Stream, Of<layers::MorphTrack> T>
void fields(Stream& s, T& track) {
  s.list(track.weights);
  s.flag(track.loop);
  s.value(track.loop_end_s);
}

template <typename Stream, Of<layers::FlightTrack> T>
void fields(Stream& s, T& track) {
  keys(s, track.position);
  keys(s, track.target);
  keys(s, track.bank_rad);
}

template <typename Stream, Of<layers::SpinTrack> T>
void fields(Stream& s, T& track) {
  s.value(track.axis);
  s.value(track.rate_rad_per_s);
}

enum class MotionKind : std::uint8_t { Transform, Flight, Spin, Morph };

void fields(Writer& s, const layers::Track& track) {
  s.value(track.node);
  s.choice(static_cast<MotionKind>(track.motion.index()), MotionKind::Morph);
  std::visit([&](const auto& motion) { fields(s, motion); }, track.motion);
}

void fields(Reader& s, layers::Track& track) {
  s.value(track.node);
  MotionKind kind{};
  s.choice(kind, MotionKind::Morph);
  if (kind == MotionKind::Transform) fields(s, track.motion.emplace<layers::TransformTrack>());
  if (kind == MotionKind::Flight) fields(s, track.motion.emplace<layers::FlightTrack>());
  if (kind == MotionKind::Spin) fields(s, track.motion.emplace<layers::SpinTrack>());
  if (kind == MotionKind::Morph) fields(s, track.motion.emplace<layers::MorphTrack>());
}

template <typename Stream, Of<layers::Light> T>
void fields(Stream& s, T& light) {
  s.text(light.name);
  s.choice(light.kind, layers::Light::Kind::Spot);
  s.value(light.node);
  s.value(light.position);
  s.value(light.direction);
  s.value(light.color);
  s.value(light.inner_cone_rad);
  s.value(light.outer_cone_rad);
  s.value(light.attenuation);
  s.value(light.range_m);
  s.flag(light.casts_shadow);
  s.value(light.shadow.resolution_px);
  s.value(light.shadow.bias_texels);
  s.value(light.shadow.slope_bias);
  s.value(light.shadow.pcf_radius);
}

template <typename Stream, Of<layers::Camera> T>
void fields(Stream& s, T& camera) {
  s.text(camera.name);
  s.value(camera.node);
  s.value(camera.fov_y_rad);
  s.value(camera.near_m);
  s.value(camera.far_m);
}

template <typename Stream, Of<layers::Part> T>
void fields(Stream& s, T& part) {
  s.text(part.name);
  s.value(part.node);
  s.value(part.mesh);
  s.value(part.material);
  s.value(part.skin);
}

template <typename Stream, Of<std::string> T>
void fields(Stream& s, T& line) {
  s.text(line);
}

template <typename Stream, Of<LayerTag> T>
void fields(Stream& s, T& tag) {
  s.value(tag.node);
  s.text(tag.layer);
}

template <typename Stream, Of<FileUse> T>
void fields(Stream& s, T& use) {
  s.choice(use.kind, FileUse::Kind::Code);
  s.path(use.path);
  s.value(use.bytes);
  s.value(use.changed_ns);
  s.flag(use.settled);
}

template <typename Stream, Of<layers::Scene> T>
void fields(Stream& s, T& scene) {
  s.list(scene.meshes);
  s.list(scene.textures);
  s.list(scene.materials);
  s.list(scene.skins);
  s.list(scene.nodes);
  s.list(scene.tracks);
  s.list(scene.lights);
  s.list(scene.cameras);
  s.list(scene.parts);
  s.value(scene.background);
  s.value(scene.active_camera);
}

template <typename Stream, Of<ImportedModel> T>
void fields(Stream& s, T& model) {
  fields(s, model.scene);
  s.list(model.warnings);
  s.list(model.notes);
  s.list(model.layer_tags);
  s.list(model.files);
  s.value(model.exposure_lx);
}

template <typename T>
std::vector<std::uint8_t> to_bytes(const T& content) {
  Writer writer;
  writer.value(kSceneMagic);
  writer.value(kVersion);
  fields(writer, content);
  return writer.take();
}

template <typename T>
T from_bytes(std::span<const std::uint8_t> bytes) {
  Reader reader(bytes);
  std::uint32_t magic = 0, version = 0;
  reader.value(magic);
  if (magic != kSceneMagic) fail("does not begin with its magic number");
  reader.value(version);
  if (version != kVersion) fail("version " + std::to_string(version) + ", rule: " + std::to_string(kVersion));
  T content;
  fields(reader, content);
  reader.expect_end();
  return content;
}

void check_scene(const layers::Scene& scene) {
  if (const std::string defect = layers::first_defect(scene); !defect.empty()) throw InputError(defect);
}

}  // namespace

std::vector<std::uint8_t> bytes_from_scene(const layers::Scene& scene) { return to_bytes(scene); }

layers::Scene scene_from_bytes(std::span<const std::uint8_t> bytes) {
  layers::Scene scene = from_bytes<layers::Scene>(bytes);
  check_scene(scene);
  return scene;
}

std::vector<std::uint8_t> bytes_from_model(const ImportedModel& model) { return to_bytes(model); }

ImportedModel model_from_bytes(std::span<const std::uint8_t> bytes) {
  ImportedModel model = from_bytes<ImportedModel>(bytes);
  check_scene(model.scene);
  if (!(model.exposure_lx > 0 && std::isfinite(model.exposure_lx)))
    fail("exposure " + std::to_string(model.exposure_lx) + ", rule: above 0");
  for (const LayerTag& tag : model.layer_tags)
    if (tag.node < 0 || tag.node >= static_cast<int>(model.scene.nodes.size()))
      fail("layer '" + tag.layer + "' is given to node " + std::to_string(tag.node));
  return model;
}

}  // namespace talisman::sequences
