// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/surroundings.h"

#include "sequences/content/asset_paths.h"

namespace talisman::sequences {

namespace {

constexpr int kMaxHeightMap_rows = 1 << 20;

void read_rgb(const YamlValue& value, GroundClass& ground) {
  const std::vector<YamlValue> rgb = value.items(3);
  if (rgb.size() != 3) value.fail("a list of 3 whole numbers, each from 0 to 255");
  for (int k = 0; k < 3; ++k) ground.rgb[k] = rgb[k].integer(0, 255);
}

const Table<GroundClass>& class_keys() {
  static const Table<GroundClass> table =
      Table<GroundClass>("class")
          .custom("rgb", list_type(whole_type(0, 255), 3, 3), read_rgb, "",
                  "colour in the class image; the nearest one counts")
          .required()
          .key("texture", &GroundClass::texture_file, asset(), "", "picture that lies there")
          .required();
  return table;
}

void read_heights(const YamlValue& value, TerrainContent& terrain) {
  const layers::dvec2 heights = pair({-20000, 20000}).read(value);
  terrain.low_m = heights.x, terrain.high_m = heights.y;
}

void read_class_list(const YamlValue& value, TerrainContent& terrain) {
  terrain.list_file = asset().read(value);
  terrain.classes = read_ground_classes(terrain.list_file);
}

void read_class_textures(const YamlValue& value, TerrainContent& terrain) {
  const std::vector<GroundClass> classes = list_of(class_keys()).read(value);
  terrain.classes.insert(terrain.classes.end(), classes.begin(), classes.end());
}

const Table<TerrainContent>& classes_keys() {
  static const Table<TerrainContent> table =
      Table<TerrainContent>("classes")
          .key("file", &TerrainContent::classes_file, asset(), "",
               "class image, with as many pixels as `heights`")
          .required()
          .custom("list", asset().type, read_class_list, "", "a terrain list of Extreme Tux Racer")
          .custom("textures", list_of(class_keys()).type, read_class_textures, "",
                  "classes of your own, after those of `list`")
          .key("texels_per_cell", &TerrainContent::texels_per_cell, whole(1, 32), "texels",
               "of the baked texture; memory grows with the square")
          .key("tile_m", &TerrainContent::tile_m, number(kPositive), "m",
               "side of one repetition of a texture")
          .at_least_one_of({"list", "textures"});
  return table;
}

const Table<SkyContent>& cloud_keys() {
  static const Table<SkyContent> table =
      Table<SkyContent>("clouds")
          .key("file", &SkyContent::clouds_file, asset(), "",
               "picture whose grey or alpha is the cover; tiled")
          .required()
          .key("cover", &SkyContent::cloud_cover, number({0, 1}), "", "opacity of the densest cloud")
          .key("tile_m", &SkyContent::clouds_m, number(kPositive), "m", "side of one tile")
          .key("height_m", &SkyContent::cloud_height_m, number(kPositive), "m", "above the centre");
  return table;
}

/// A map that is read into the same content as the one around it.
template <typename T>
void add_map(Table<T>& table, const char* key, const Table<T>& inner, const char* meaning) {
  table.custom(
      key, map_type(inner.keys()),
      [&inner](const YamlValue& value, T& into) { inner.keys().read(value.map(), &into); }, "", meaning);
}

/// The patch of a sky: the way it is seen from its centre.
Table<SkyContent> patch_keys(const layers::dvec2& azimuth_deg, const Range& azimuths,
                             const Range& elevations) {
  return Table<SkyContent>()
      .begins([azimuth_deg](SkyContent& sky) { sky.azimuth_deg = azimuth_deg; })
      .key("azimuth_deg", &SkyContent::azimuth_deg, interval(azimuths), "°",
           "from, to; 0 is -z, positive to the right")
      .key("elevation_deg", &SkyContent::elevation_deg, interval(elevations), "°", "from, to");
}

}  // namespace

const Table<TerrainContent>& terrain_keys() {
  static const Table<TerrainContent> table = [] {
    Table<TerrainContent> t("terrain");
    t.key("name", &TerrainContent::name, text(), "",
          "parts are `name/0`, `name/1`, … from near to far, in each segment from left to right")
        .key("heights", &TerrainContent::heights_file, asset(), "",
             "grey image; a row is a row of samples, row 0 at z = 0, later rows towards -z, centred in x")
        .required()
        .key("cell_m", &TerrainContent::cell_m, number({kLeast, 10000}), "m", "distance of samples")
        .custom("height_m", pair({-20000, 20000}).type, read_heights, "m", "at black, at white")
        .otherwise("[0, 150]")
        .key("first_row", &TerrainContent::first_row, whole(0, kMaxHeightMap_rows), "",
             "rows before it are left out; it lies at z = 0")
        .key("smooth_cells", &TerrainContent::smooth_cells, number({0, 16}), "cells",
             "standard deviation of a Gaussian against the steps of 8-bit heights")
        .key("segments", &TerrainContent::segments, whole(1, 1000), "",
             "parts: more follow parallax more closely, and are more sprites")
        .key("across", &TerrainContent::across, whole(1, 1000), "",
             "tiles side by side in each segment: `segments` times so many parts")
        .key("seam_cells", &TerrainContent::seam_cells, whole(0, 64), "cells",
             "by which a tile reaches over its far and its right border")
        .key("every", &TerrainContent::every, whole(1, 64), "samples",
             "between vertices: 2 is a quarter of the triangles; cells of tiles and seams grow with it");
    add_map(t, "classes", classes_keys(), "what lies on the ground");
    return t.otherwise("one colour");
  }();
  return table;
}

const Table<SkyContent>& sky_keys() {
  using enum SkyContent::Kind;
  static const Table<SkyContent> table = [] {
    Table<SkyContent> t("sky");
    t.key("kind", &SkyContent::kind, choice<SkyContent::Kind>({{"dome", Dome}, {"backdrop", Backdrop}}), "",
          "a patch of a sphere, or a flat picture")
        .key("name", &SkyContent::name, text(), "", "of its one part")
        .key("center", &SkyContent::center, vector(), "m", "from where azimuth and elevation are measured")
        .key("radius_m", &SkyContent::radius_m, number(kPositive), "m",
             "of the dome, or distance of the backdrop")
        .key("horizon", &SkyContent::horizon, color(), "", "at elevation 0 and below")
        .key("zenith", &SkyContent::zenith, color(), "", "at the patch's upper end");
    add_map(t, "clouds", cloud_keys(), "baked into its texture");
    t.otherwise("none");
    return t.when(is("kind", {"dome"}), patch_keys({-90, 90}, {-360, 360}, {-90, 90}))
        .when(is("kind", {"backdrop"}), patch_keys({-60, 60}, {-85, 85}, {-85, 85}));
  }();
  return table;
}

}  // namespace talisman::sequences
