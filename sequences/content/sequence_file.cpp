// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/sequence_file.h"

#include <algorithm>
#include <filesystem>

#include "sequences/content/asset_paths.h"
#include "sequences/content/factoring/factoring_keys.h"
#include "sequences/content/regulator_keys.h"
#include "sequences/files/utf8.h"
#include "warp/warp.h"

namespace talisman::sequences {

namespace {

using layers::ExtentOptions;
using layers::PlacementOptions;

constexpr int kMaxDisplay_px = 16384;
constexpr int kMaxDepthOfExtends = 8;

const Table<ExtentOptions>& extent_keys() {
  using E = ExtentOptions;
  static const Table<E> table =
      Table<E>("extents")
          .key("expected_reuse_frames", &E::expected_reuse_frames, number({1, 10000}), "frames",
               "sprites grow by the motion in so many")
          .key("max_growth", &E::max_growth, number({0, 1}), "",
               "at most this share of the display's larger side, on each side");
  return table;
}

const Table<PlacementOptions>& placement_keys() {
  using P = PlacementOptions;
  static const Table<P> table =
      Table<P>("placement")
          .key("slab_directions", &P::slab_directions, whole(2, 30), "",
               "tried for a sprite's axes: more fit tighter")
          .key("min_rotation_gain", &P::min_rotation_gain, number({0, 1}), "",
               "share of area that a turned sprite must save; 1: never turned")
          .key("resolution_scale", &P::resolution_scale, number({kLeast, 4}), "texels/px",
               "along each axis, of all layers")
          .key("max_sprite_px", &P::max_sprite_px, whole(32, kMaxDisplay_px), "texels",
               "largest side of a sprite: beyond it growth is given up, then resolution");
  return table;
}

const Table<chunker::CompressionOptions>& compression_keys() {
  using C = chunker::CompressionOptions;
  static const Table<C> table =
      Table<C>("compression")
          .key("quality", &C::quality, whole(1, 100), "", "ten more halve the steps: more bytes, less error");
  return table;
}

/// A member of the settings.
template <typename Member>
auto setting(Member Sequence::*member) {
  return at(&SequenceFile::settings, member);
}

/// Results go into a folder of this name: it must not lead anywhere else.
void read_name(const YamlValue& value, SequenceFile& file) {
  const std::string name = value.text();
  const bool leads_away =
      name.find('/') != std::string::npos || name.find("..") != std::string::npos || name == ".";
  const bool printable =
      std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (leads_away || !printable) value.fail("a name: no '/', no '..' and no control characters");
  file.settings.name = name;
}

Table<SequenceFile> film_keys() {
  const auto ignore = [](const YamlValue& value, SequenceFile&) { value.text(); };
  const auto packages = [](const YamlValue& list, SequenceFile&) { texts(0).read(list); };
  return Table<SequenceFile>()
      .custom("extends", asset().type, ignore, "",
              "another sequence file, of which this one says only what is different: each key at the top "
              "replaces the base's whole value")
      .custom("name", text().type, read_name, "", "shown, and the name of the output folder")
      .otherwise("the file's name")
      .key("frames", setting(&Sequence::frames), whole(1, kLongestRun_frames), "frames", "how many")
      .required()
      .key("fps", setting(&Sequence::fps), number({kLeast, 1000}), "frames/s", "how fast")
      .key("display", setting(&Sequence::display_px), whole_pair(1, kMaxDisplay_px), "px", "width, height")
      .key(
          "seam", setting(&Sequence::seam), choice<Seam>({{"none", Seam::None}, {"auto", Seam::Auto}}), "",
          "`auto`: layers that share an edge are drawn beyond it, as far as `geometric_px` lets a crack open")
      .custom("packages", texts(0).type, packages, "",
              "Debian packages with the content, in one line: `[a, b]`")
      .otherwise("none");
}

void read_visibility(const YamlValue& value, SequenceFile& file) {
  const std::optional<VisibilityOptions> options = visibility_from(value.text());
  if (!options) value.fail(kVisibilityRule);
  file.settings.visibility = *options;
}

Table<SequenceFile> pipeline_keys() {
  using enum layers::BoundKind;
  std::vector<std::string> curves;
  for (const warp::Curve curve : warp::kAllCurves) curves.emplace_back(warp::name(curve));
  return Table<SequenceFile>()
      .key("order", &SequenceFile::order, list_of(layer_pair_keys(), 0), "",
           "pairs of layers, which take precedence over geometry")
      .otherwise("geometry alone")
      .key("cycles", setting(&Sequence::cycles),
           choice<Cycles>({{"merge", Cycles::Merge}, {"keep", Cycles::Keep}}), "",
           "layers that hide each other in turn are drawn into one sprite, or keep theirs")
      .key("compositor", setting(&Sequence::compositor),
           choice<Compositor>({{"talisman", Compositor::Talisman}, {"extended", Compositor::Extended}}), "",
           "its operators: `over` alone, or more")
      .custom("visibility", text().type, read_visibility, "",
              "`PRE,CELL,OBJECT`: which tests decide what is looked at and drawn at all; all but "
              "`none,none,frustum` need "
              "`cells`")
      .otherwise("`none,none,none`")
      .key("regulator", setting(&Sequence::regulator), map_of(regulator_keys()), "",
           "what decides which sprites are drawn again")
      .key("warp", setting(&Sequence::warp), one_of(curves), "",
           "curve of [LS97 4.2] that carries old sprites")
      .key("bound", setting(&Sequence::bound),
           choice<layers::BoundKind>({{"box8", Box8}, {"dop14", Dop14}, {"dop26", Dop26}}), "",
           "characteristic polyhedron")
      .key("material_points", setting(&Sequence::material_points), whole(0, layers::kMostMaterialPoints), "",
           "samples of the surface, beside the polyhedron, of each body that deforms or whose light is "
           "followed: an estimate, better with more")
      .key("extents", setting(&Sequence::extents), map_of(extent_keys()), "",
           "how far sprites reach beyond what is seen now")
      .key("placement", setting(&Sequence::placement), map_of(placement_keys()), "",
           "how sprites lie on their layers")
      .key("compression", setting(&Sequence::compression), map_of(compression_keys()), "",
           "sprites are kept compressed, and shown as they come out of it; `--compression 0` switches it off")
      .otherwise("none")
      .key("clip_margin", setting(&Sequence::clip_margin), number({0, 1}), "",
           "share of the display by which the clipping frustum is larger")
      .otherwise(shown(layers::View{}.clip_margin));
}

/// A list of layers, or a map that says how they are found.
void read_layers(const YamlValue& value, SequenceFile& file) {
  if (value.is_map())
    file.auto_layers = auto_layers_keys().read(value);
  else
    file.layers = list_of(layer_keys()).read(value);
}

/// A variant says `extends: FILE` and then only what is different at the top level.
YamlMap read_with_base(const std::string& file, int depth, std::vector<std::string>& files) {
  YamlMap own = read_yaml_file(file);
  files.push_back(file);
  const YamlValue* base = own.find("extends");
  if (!base) return own;
  if (depth >= kMaxDepthOfExtends) base->fail("at most 8 files that extend each other, never in a circle");
  YamlMap merged = read_with_base(resolve_asset(base->text(), file, base->line()), depth + 1, files);
  merged.replace_by(own);
  return merged;
}

}  // namespace

const Table<SequenceFile>& sequence_keys() {
  static const Table<SequenceFile> table =
      Table<SequenceFile>("sequence")
          .extends_by("extends")
          .include(film_keys())
          .include(&SequenceFile::recipe, scene_keys())
          .key("cuts", &SequenceFile::cuts, list_of(cut_keys(), 0), "",
               "large parts that are cut into several, each of which may then be a layer")
          .otherwise("none")
          .custom(
              "layers",
              either_type({list_type(map_type(layer_keys().keys()), 1), map_type(auto_layers_keys().keys())}),
              read_layers, "", "which parts make up which sprite, or how that is found")
          .otherwise("one per moving node, or per top-level node where nothing moves")
          .include(pipeline_keys());
  return table;
}

SequenceFile read_sequence_file(const std::string& file) {
  SequenceFile result;
  result.settings.file = file;
  result.settings.name = utf8_from(std::filesystem::path(file).stem().string());
  sequence_keys().keys().read(read_with_base(file, 0, result.settings.content_files), &result);
  return result;
}

}  // namespace talisman::sequences
