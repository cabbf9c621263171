// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/scene_recipe.h"

#include <glm/geometric.hpp>

#include "sequences/content/asset_paths.h"

namespace talisman::sequences {

namespace {

std::string asset(const YamlValue& value) { return resolve_asset(value.text(), value.file(), value.line()); }

glm::dquat turned(const layers::dvec3& degrees) { return glm::dquat(glm::radians(degrees)); }

// --- Motion ---

void add_key(YamlMap key, layers::FlightTrack& flight) {
  double t = 0, bank_deg = 0;
  layers::dvec3 target{0};
  const YamlValue& time = key.need("t");
  t = time.number();
  const layers::dvec3 position = key.need("position").vector();
  const bool has_target = key.has("target"), has_bank = key.has("bank_deg");
  key.read("target", target);
  key.read("bank_deg", bank_deg, {-3600, 3600});
  key.finish();
  const auto& times = flight.position.times_s;
  if (!times.empty() && t <= times.back()) time.fail("after the key before it");
  flight.position.times_s.push_back(t);
  flight.position.values.push_back(position);
  if (has_target) flight.target.times_s.push_back(t), flight.target.values.push_back(target);
  if (has_bank)
    flight.bank_rad.times_s.push_back(t), flight.bank_rad.values.push_back(glm::radians(bank_deg));
}

layers::FlightTrack read_flight(const YamlValue& keys) {
  layers::FlightTrack flight;
  for (const YamlValue& key : keys.items()) add_key(key.map(), flight);
  // Aim and bank are as smooth as the path.
  flight.target.interpolation = flight.bank_rad.interpolation = layers::Interpolation::CatmullRom;
  return flight;
}

layers::SpinTrack read_spin(YamlMap map) {
  layers::SpinTrack spin;
  double deg_per_s = 0;
  if (map.has("axis") && glm::length(map.need("axis").vector()) == 0)
    map.need("axis").fail("not the zero vector");
  map.read("axis", spin.axis);
  map.need("deg_per_s");
  map.read("deg_per_s", deg_per_s, kAnyNumber);
  map.finish();
  spin.rate_rad_per_s = glm::radians(deg_per_s);
  return spin;
}

glm::dquat looking(const layers::dvec3& from, const YamlValue& at) {
  const layers::dvec3 ahead = at.vector() - from;
  if (glm::length(ahead) == 0) at.fail("another place than position");
  const layers::dvec3 z = -glm::normalize(ahead);
  const layers::dvec3 up = std::abs(z.y) > 0.9999 ? layers::dvec3{0, 0, -1} : layers::dvec3{0, 1, 0};
  const layers::dvec3 x = glm::normalize(glm::cross(up, z));
  return glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
}

/// The keys carried_by, position, rotation_deg, look_at, flight and spin; a flight excludes the three that
/// say where something rests.
Motion read_motion(YamlMap& map) {
  Motion motion;
  motion.file = map.self().file();
  motion.line = map.self().line();
  if (const YamlValue* carrier = map.find("carried_by"))
    motion.carried_by = carrier->text(), motion.line = carrier->line();
  layers::dvec3 rotation_deg{0};
  map.read("position", motion.rest.translation);
  map.read("rotation_deg", rotation_deg);
  motion.rest.rotation = turned(rotation_deg);
  if (const YamlValue* at = map.find("look_at")) motion.rest.rotation = looking(motion.rest.translation, *at);
  if (const YamlValue* flight = map.find("flight")) {
    for (const char* key : {"position", "rotation_deg", "look_at"})
      if (map.has(key)) map.need(key).fail("not together with flight");
    motion.flight = read_flight(*flight);
  }
  if (const YamlValue* spin = map.find("spin")) motion.spin = read_spin(spin->map());
  return motion;
}

// --- Models and shapes ---

ModelInstance read_instance(YamlMap map) {
  ModelInstance instance;
  instance.name = map.need("name").text();
  instance.motion = read_motion(map);
  map.finish();
  return instance;
}

/// The key instances, or the motion of the one instance called `id`.
std::vector<ModelInstance> read_instances(YamlMap& map, const std::string& id) {
  std::vector<ModelInstance> instances;
  if (const YamlValue* list = map.find("instances")) {
    for (const YamlValue& item : list->items()) instances.push_back(read_instance(item.map()));
  } else {
    instances.push_back({id, read_motion(map)});
  }
  return instances;
}

ModelRecipe read_model(YamlMap map) {
  ModelRecipe model;
  const std::string id = map.need("id").text();
  model.file = asset(map.need("file"));
  map.read("scale", model.scale, kPositive);
  if (const YamlValue* length = map.find("length_m")) {
    if (map.has("scale")) length->fail("not together with scale");
    model.length_m = length->number(kPositive);
  }
  map.read("turn_deg", model.turn_deg);
  map.read("centered", model.centered);
  map.read("two_sided", model.two_sided);
  model.instances = read_instances(map, id);
  map.finish();
  return model;
}

layers::dvec3 positive_sides(const YamlValue& value) {
  const layers::dvec3 size = value.vector();
  if (!(size.x > 0 && size.y > 0 && size.z > 0)) value.fail("every side above 0");
  return size;
}

/// The one key that says what the shape is, with its size.
void read_kind(YamlMap& map, ShapeContent& shape) {
  using Kind = ShapeContent::Kind;
  int kinds = 0;
  const auto found = [&](const char* key, Kind kind) {
    const YamlValue* value = map.find(key);
    if (!value) return value;
    if (++kinds > 1) value->fail("one of box, sphere, cylinder and plane, not two");
    shape.kind = kind;
    return value;
  };
  if (const YamlValue* box = found("box", Kind::Box)) shape.size_m = positive_sides(*box);
  if (const YamlValue* sphere = found("sphere", Kind::Sphere))
    shape.size_m = sphere->is_list() ? positive_sides(*sphere) : layers::dvec3(sphere->number(kPositive));
  if (const YamlValue* cylinder = found("cylinder", Kind::Cylinder)) {
    const layers::dvec2 size = cylinder->pair(kPositive);
    shape.size_m = {size.x, size.y, size.x};
  }
  if (const YamlValue* plane = found("plane", Kind::Plane)) {
    const layers::dvec2 size = plane->pair(kPositive);
    shape.size_m = {size.x, 1, size.y};
  }
  if (kinds == 0) map.self().fail("has one of the keys box, sphere, cylinder and plane");
}

void read_material(YamlMap& map, layers::Material& material) {
  double opacity = 1, shininess = 0, reflectivity = 0;
  map.read_color("color", material.base_color);
  map.read_color("specular", material.specular);
  map.read_color("emissive", material.emissive);
  map.read("opacity", opacity, {0, 1});
  map.read("shininess", shininess, {0, 1e5});
  map.read("reflectivity", reflectivity, {0, 1});
  map.read("two_sided", material.two_sided);
  map.read("unlit", material.unlit);
  material.reflectivity = static_cast<float>(reflectivity);
  material.opacity = static_cast<float>(opacity);
  material.shininess = static_cast<float>(shininess);
}

/// The keys texture2 and texture_blend.
void read_second_texture(YamlMap& map, const YamlValue& texture, ShapeContent& content) {
  content.second_texture_file = asset(texture);
  if (const YamlValue* blend = map.find("texture_blend"))
    content.material.texture_blend = layers::vec2(blend->pair({0, 1}));
}

ShapeRecipe read_shape(YamlMap map) {
  ShapeRecipe shape;
  ShapeContent& content = shape.content;
  const std::string id = map.need("id").text();
  content.material.name = id;
  read_kind(map, content);
  const bool is_round =
      content.kind == ShapeContent::Kind::Sphere || content.kind == ShapeContent::Kind::Cylinder;
  if (!is_round) content.segments = 1;
  map.read("segments", content.segments, is_round ? 3 : 1, 512);
  if (const YamlValue* taper = map.find("taper")) {
    if (content.kind != ShapeContent::Kind::Cylinder) taper->fail("only with cylinder");
    content.taper = taper->number({0, 1});
  }
  read_material(map, content.material);
  if (const YamlValue* texture = map.find("texture")) content.texture_file = asset(*texture);
  if (const YamlValue* texture = map.find("texture2")) read_second_texture(map, *texture, content);
  shape.instances = read_instances(map, id);
  map.finish();
  return shape;
}

// --- Ground and sky ---

GroundClass read_class(YamlMap map) {
  GroundClass ground;
  const YamlValue& color = map.need("rgb");
  const std::vector<YamlValue> rgb = color.items(3);
  if (rgb.size() != 3) color.fail("a list of 3 whole numbers");
  for (int k = 0; k < 3; ++k) ground.rgb[k] = rgb[k].integer(0, 255);
  ground.texture_file = asset(map.need("texture"));
  map.finish();
  return ground;
}

void read_classes(YamlMap map, TerrainContent& terrain) {
  terrain.classes_file = asset(map.need("file"));
  if (const YamlValue* list = map.find("list")) {
    terrain.list_file = asset(*list);
    terrain.classes = read_ground_classes(terrain.list_file);
  }
  if (const YamlValue* textures = map.find("textures"))
    for (const YamlValue& item : textures->items()) terrain.classes.push_back(read_class(item.map()));
  if (terrain.classes.empty()) map.self().fail("has the key 'list' or 'textures'");
  map.read("texels_per_cell", terrain.texels_per_cell, 1, 32);
  map.read("tile_m", terrain.tile_m, kPositive);
  map.finish();
}

TerrainContent read_terrain(YamlMap map) {
  TerrainContent terrain;
  map.read("name", terrain.name);
  terrain.heights_file = asset(map.need("heights"));
  map.read("cell_m", terrain.cell_m, {0, 10000, true});
  if (const YamlValue* range = map.find("height_m")) {
    const layers::dvec2 heights = range->pair({-20000, 20000});
    terrain.low_m = heights.x, terrain.high_m = heights.y;
  }
  map.read("first_row", terrain.first_row, 0, 1 << 20);
  map.read("smooth_cells", terrain.smooth_cells, {0, 16});
  map.read("segments", terrain.segments, 1, 1000);
  map.read("seam_cells", terrain.seam_cells, 0, 64);
  if (const YamlValue* classes = map.find("classes")) read_classes(classes->map(), terrain);
  map.finish();
  return terrain;
}

/// Two ends, the first below the second.
void read_interval(YamlMap& map, const char* key, const Range& range, layers::dvec2& into) {
  const YamlValue* value = map.find(key);
  if (!value) return;
  into = value->pair(range);
  if (!(into.x < into.y)) value->fail("the first below the second");
}

SkyContent read_sky(YamlMap map) {
  SkyContent sky;
  if (const YamlValue* kind = map.find("kind"))
    sky.kind = static_cast<SkyContent::Kind>(kind->choice({"dome", "backdrop"}));
  const bool flat = sky.kind == SkyContent::Kind::Backdrop;
  map.read("name", sky.name);
  map.read("center", sky.center);
  map.read("radius_m", sky.radius_m, kPositive);
  read_interval(map, "azimuth_deg", flat ? Range{-85, 85} : Range{-360, 360}, sky.azimuth_deg);
  read_interval(map, "elevation_deg", flat ? Range{-85, 85} : Range{-90, 90}, sky.elevation_deg);
  if (flat && !map.has("azimuth_deg")) sky.azimuth_deg = {-60, 60};
  map.read_color("horizon", sky.horizon);
  map.read_color("zenith", sky.zenith);
  if (const YamlValue* clouds = map.find("clouds")) {
    YamlMap c = clouds->map();
    sky.clouds_file = asset(c.need("file"));
    c.read("cover", sky.cloud_cover, {0, 1});
    c.read("tile_m", sky.clouds_m, kPositive);
    c.read("height_m", sky.cloud_height_m, kPositive);
    c.finish();
  }
  map.finish();
  return sky;
}

// --- Camera and lights ---

CameraRecipe read_camera(YamlMap map) {
  CameraRecipe camera;
  map.read("fov_deg", camera.fov_deg, {1, 170});
  map.read("near_m", camera.near_m, kPositive);
  map.read("far_m", camera.far_m, kPositive);
  if (!(camera.near_m < camera.far_m)) map.self().fail("near_m below far_m");
  camera.motion = read_motion(map);
  map.finish();
  return camera;
}

layers::ShadowMapOptions read_shadow_map(YamlMap map) {
  layers::ShadowMapOptions shadow;
  double bias = shadow.bias_texels, slope = shadow.slope_bias;
  map.read("resolution_px", shadow.resolution_px, 0, 8192);
  map.read("bias_texels", bias, {0, 100});
  map.read("slope_bias", slope, {0, 16});
  map.read("pcf_radius", shadow.pcf_radius, 0, 8);
  map.finish();
  shadow.bias_texels = static_cast<float>(bias);
  shadow.slope_bias = static_cast<float>(slope);
  return shadow;
}

/// The keys inner_deg and outer_deg: angles from the axis.
void read_cone(YamlMap& map, layers::Light& light) {
  double inner = 20, outer = 30;
  map.read("inner_deg", inner, {0, 90});
  map.read("outer_deg", outer, {0, 90});
  if (inner > outer) map.self().fail("inner_deg at most outer_deg");
  light.inner_cone_rad = glm::radians(inner);
  light.outer_cone_rad = glm::radians(outer);
}

/// A light that stands (position, look_at) or moves as anything does. In its own space it shines along -z.
void read_place(YamlMap& map, layers::Light& light, std::optional<Motion>& motion) {
  for (const char* key : {"carried_by", "flight", "spin", "look_at"})
    if (map.has(key) || light.kind == layers::Light::Kind::Spot) motion.emplace();
  if (motion) {
    motion = read_motion(map);
    light.direction = {0, 0, -1};
  } else {
    light.position = map.need("position").vector();
  }
}

void read_light(YamlMap map, SceneRecipe& recipe) {
  using Kind = layers::Light::Kind;
  layers::Light light;
  std::optional<Motion> motion;
  double intensity = 1;
  light.kind = static_cast<Kind>(map.need("kind").choice({"ambient", "directional", "point", "spot"}));
  map.read("name", light.name);
  map.read_color("color", light.color);
  map.read("intensity", intensity, kNotNegative);
  light.color *= static_cast<float>(intensity);
  if (light.kind == Kind::Directional) {
    const YamlValue& direction = map.need("direction");
    light.direction = direction.vector();
    if (glm::length(light.direction) == 0) direction.fail("not the zero vector");
  }
  if (light.kind == Kind::Point || light.kind == Kind::Spot) read_place(map, light, motion);
  if (light.kind == Kind::Spot) read_cone(map, light);
  if (light.kind != Kind::Ambient) {
    map.read("casts_shadow", light.casts_shadow);
    if (const YamlValue* shadow = map.find("shadow_map")) light.shadow = read_shadow_map(shadow->map());
    if (light.shadow.resolution_px == 0) light.casts_shadow = false;  // no map: no pass and no layer either
  }
  map.finish();
  recipe.lights.push_back(light);
  recipe.light_motions.push_back(std::move(motion));
}

}  // namespace

SceneRecipe read_scene_recipe(YamlMap& sequence) {
  SceneRecipe recipe;
  sequence.read_color("background", recipe.background);
  if (const YamlValue* shapes = sequence.find("shapes"))
    for (const YamlValue& item : shapes->items()) recipe.shapes.push_back(read_shape(item.map()));
  if (const YamlValue* models = sequence.find("models"))
    for (const YamlValue& item : models->items()) recipe.models.push_back(read_model(item.map()));
  if (const YamlValue* terrain = sequence.find("terrain")) recipe.terrain = read_terrain(terrain->map());
  if (const YamlValue* sky = sequence.find("sky")) recipe.sky = read_sky(sky->map());
  if (const YamlValue* camera = sequence.find("camera")) recipe.camera = read_camera(camera->map());
  if (const YamlValue* lights = sequence.find("lights"))
    for (const YamlValue& item : lights->items()) read_light(item.map(), recipe);
  return recipe;
}

}  // namespace talisman::sequences
