// SPDX-License-Identifier: Apache-2.0
#include "tests/support/random_scene.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <vector>

#include "sequences/pipeline/step.h"
#include "tests/support/scenes.h"

namespace talisman::tests {
namespace {

constexpr int kFrames = 12;
constexpr double kFps = 24;

/// Lots that are the same with every standard library.
class Lots {
 public:
  explicit Lots(std::uint32_t seed) : engine_(seed) {}
  double between(double lo, double hi) { return lo + (hi - lo) * (engine_() >> 8) / 16777216.0; }
  int whole(int lo, int hi) { return lo + static_cast<int>(between(0, hi - lo + 1)); }
  bool one_in(double n) { return between(0, n) < 1; }

 private:
  std::mt19937 engine_;
};

struct Place {
  double x = 0, y = 0, z = 0;
};

Place moved(Lots& lots, Place p, double by) {
  return {p.x + lots.between(-by, by), p.y + lots.between(0, by), p.z + lots.between(-by, by)};
}

Place mix(Place a, Place b, double t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

/// A number as a file would say it.
std::string number(double value) {
  std::ostringstream text;
  text << std::round(1000 * value) / 1000;
  return text.str();
}

template <typename... Numbers>
std::string list(Numbers... numbers) {
  std::string text;
  ((text += (text.empty() ? "[" : ", ") + number(numbers)), ...);
  return text + "]";
}

std::string at(Place p) { return list(p.x, p.y, p.z); }

/// A flight from one place to another in some of the frames.
std::string flight(Lots& lots, Place from, Place to, const std::string& target) {
  const int first = lots.whole(0, kFrames - 3), last = lots.whole(first + 1, kFrames);
  std::ostringstream text;
  text << "flight: [";
  for (int k = 0; k < 2; ++k)
    text << (k == 0 ? "" : ", ") << "{t: " << (k == 0 ? first : last) / kFps
         << ", position: " << at(k == 0 ? from : to) << ", target: " << target << "}";
  text << "]";
  return text.str();
}

std::string standing_or_flying(Lots& lots, Place place, const std::string& target) {
  if (lots.one_in(2)) return "position: " + at(place);
  return flight(lots, place, moved(lots, place, 1.2), target);
}

std::string color(Lots& lots, double lo, double hi) {
  return list(lots.between(lo, hi), lots.between(lo, hi), lots.between(lo, hi));
}

std::string body(Lots& lots, double size) {
  const auto side = [&] { return size * lots.between(0.5, 1.2); };
  switch (lots.whole(0, 2)) {
    case 0:
      return "box: " + list(side(), side(), side());
    case 1:
      return "sphere: " + list(side(), side(), side()) + ", segments: 12";
    default:
      return "cylinder: " + list(side(), side()) + ", segments: 10, taper: " + number(lots.between(0, 1));
  }
}

std::string surface(Lots& lots) {
  std::string text = ", color: " + color(lots, 0.1, 1);
  if (lots.one_in(3)) text += ", specular: " + color(lots, 0.2, 0.8) + ", shininess: 20";
  if (lots.one_in(7)) text += ", emissive: " + color(lots, 0, 0.4);
  if (lots.one_in(7)) text += ", opacity: 0.5, two_sided: true";
  if (lots.one_in(9)) text += ", unlit: true";
  if (lots.one_in(5)) text += ", texture: checker.ppm";
  return text;
}

std::string joined(const std::string& a, const std::string& b) {
  return a + (a.empty() || b.empty() ? "" : ", ") + b;
}

std::string preferences(Lots& lots) {
  const std::string resolution = lots.one_in(3) ? "resolution_scale: 0.5" : "";
  return joined(resolution, lots.one_in(6) ? "min_update_rate: 0.3" : "");
}

/// How shadows are factored: any way that the compositor has, or as the tool likes.
std::string as(Lots& lots, bool extended, bool two_textures) {
  static const char* const kWays[] = {"", "as: shade", "as: light", "as: atop", "as: multiply"};
  return kWays[lots.whole(0, !extended ? 2 : two_textures ? 3 : 4)];
}

std::string shading(Lots& lots, bool extended, bool two_textures) {
  std::string text;
  const auto add = [&](const std::string& term) { text += (text.empty() ? "" : ", ") + term; };
  const std::string way = as(lots, extended, two_textures);
  if (lots.one_in(1.5)) add("shadows: {" + joined(way, preferences(lots)) + "}");
  for (const char* term : {"specular", "reflection"})
    if (lots.one_in(2)) add(term + (": {" + preferences(lots) + "}"));
  if (two_textures && lots.one_in(2)) {
    add("textures: {" + preferences(lots) + "}");
    if (lots.one_in(2)) add("first_blend: [{t: 0, value: 1}, {t: 0.3, value: 0.4}]");
    if (lots.one_in(2)) add("second_blend: [{t: 0.1, value: 0.2}, {t: 0.4, value: 0.9}]");
  }
  return text.empty() ? "" : ", shading: {" + text + "}";
}

std::string fade(Lots& lots) {
  if (!lots.one_in(4)) return {};
  return ", fade: [{t: 0.1, value: 1}, {t: 0.4, value: " + std::string(lots.one_in(3) ? "0" : "0.3") + "}]";
}

struct Written {
  bool extended = false;  ///< the compositor has more than `over`
  std::string shapes, lights, layers;
};

void write_floor(Lots& lots, Written& text) {
  const bool two_textures = lots.one_in(4);
  const std::string ground =
      two_textures ? ", texture: checker.ppm, texture2: checker.ppm, texture_blend: [0.7, 0.3]" : "";
  text.shapes += "  - {id: floor, plane: " + list(lots.between(5, 9), lots.between(5, 9)) +
                 ", segments: " + std::to_string(lots.whole(1, 6)) + ", color: " + color(lots, 0.5, 1) +
                 ground + (lots.one_in(4) ? ", reflectivity: 0.3" : "") +
                 (lots.one_in(4) ? ", specular: [0.4, 0.4, 0.4], shininess: 30" : "") +
                 (lots.one_in(5) ? ", spin: {deg_per_s: 20}" : "") + "}\n";
  text.layers += "  - {name: floor, parts: [floor]" +
                 std::string(lots.one_in(4) ? "" : ", group: background") +
                 shading(lots, text.extended, two_textures) + fade(lots) + "}\n";
}

void write_body(Lots& lots, int number, Place place, Written& text) {
  const std::string id = "body" + std::to_string(number), far = at({place.x, place.y, 500});
  text.shapes += "  - {id: " + id + ", " + body(lots, 1) + surface(lots) + ", " +
                 standing_or_flying(lots, place, far) + (lots.one_in(5) ? ", spin: {deg_per_s: 90}" : "") +
                 "}\n";
  std::string parts = id;
  const bool has_arm = lots.one_in(2.5);
  if (has_arm) {
    const Place joint{lots.between(-0.5, 0.5), lots.between(-0.2, 0.6), lots.between(-0.5, 0.5)};
    text.shapes += "  - {id: " + id + "_arm, " + body(lots, 0.5) + surface(lots) + ", carried_by: " + id +
                   ", " + flight(lots, joint, moved(lots, joint, 0.4), "[0, 0, 500]") + "}\n";
    parts += ", " + id + "_arm";
  }
  std::string wishes;
  if (has_arm && lots.one_in(2)) wishes = "bound_each_part: true";
  if (lots.one_in(6)) wishes = joined(wishes, "motion_blur: 0.5");
  if (lots.one_in(6)) wishes = joined(wishes, "resolution_scale: 0.5");
  text.layers += "  - {name: " + id + ", parts: [" + parts + "]" +
                 (lots.one_in(6) ? ", group: foreground" : "") + shading(lots, text.extended, false) +
                 fade(lots) + (wishes.empty() ? "" : ", preferences: {" + wishes + "}") +
                 (lots.one_in(8) ? ", casts_shadows: false" : "") + "}\n";
}

void write_bodies(Lots& lots, Written& text) {
  const int count = lots.whole(2, 5);
  std::vector<Place> places;
  for (int k = 0; k < count; ++k) {
    Place place{lots.between(-2, 2), lots.between(0.3, 1.6), lots.between(-1.5, 1.5)};
    if (k > 0 && lots.one_in(3)) place = mix(place, places.back(), 0.8);  // they touch, or nearly
    places.push_back(place);
    write_body(lots, k, place, text);
  }
}

void write_light(Lots& lots, int number, int lights, Written& text) {
  static const char* const kKinds[] = {"directional", "point", "spot"};
  const int kind = lots.whole(0, 2);
  const double most = 1.2 / lights;
  text.lights += "  - {kind: " + std::string(kKinds[kind]) + ", name: light" + std::to_string(number) +
                 ", color: " + color(lots, 0.2 * most, most);
  const Place place{lots.between(-3, 3), lots.between(2.5, 5), lots.between(-2, 3)};
  const std::string ground = list(lots.between(-1, 1), 0, lots.between(-1, 1));
  if (kind == 0)
    text.lights += ", direction: " + list(lots.between(-1, 1), -1, lots.between(-1, 1));
  else if (lots.one_in(2))
    text.lights += ", " + flight(lots, place, moved(lots, place, 1.5), ground);
  else
    text.lights += ", position: " + at(place) + (kind == 2 ? ", look_at: " + ground : "");
  if (kind == 2) text.lights += ", inner_deg: 20, outer_deg: 35";
  if (lots.one_in(1.7)) text.lights += ", casts_shadow: true, shadow_map: {resolution_px: 128}";
  text.lights += "}\n";
}

std::string camera(Lots& lots) {
  const Place eye{lots.between(-3, 3), lots.between(1.5, 5), lots.between(4.5, 7)};
  const std::string middle = list(lots.between(-0.5, 0.5), lots.between(0, 1), 0);
  return "camera: {fov_deg: 45, near_m: 0.1, far_m: 60, " +
         (lots.one_in(2.5) ? flight(lots, eye, moved(lots, eye, 0.6), middle)
                           : "position: " + at(eye) + ", look_at: " + middle) +
         "}\n";
}

constexpr const char* kPicture =
    "P3 4 4 255\n"
    "230 230 230  60 60 60  230 200 230  60 60 90\n"
    "60 60 60  230 230 230  60 90 60  230 230 230\n"
    "230 230 200  60 60 60  230 230 230  90 60 60\n"
    "60 60 60  230 230 230  60 60 60  200 230 230\n";

}  // namespace

std::string random_sequence_text(std::uint32_t seed) {
  Lots lots(seed);
  Written text;
  text.extended = lots.one_in(4);
  write_floor(lots, text);
  write_bodies(lots, text);
  if (!lots.one_in(4)) text.lights += "  - {kind: ambient, color: " + color(lots, 0.05, 0.3) + "}\n";
  const int lights = lots.whole(1, 4);
  for (int k = 0; k < lights; ++k) write_light(lots, k, lights, text);
  std::string head = "name: random_" + std::to_string(seed) + "\nframes: " + std::to_string(kFrames) +
                     "\nfps: 24\ndisplay: [96, 72]\nbackground: " + color(lots, 0, 0.6) + "\n" + camera(lots);
  if (lots.one_in(4)) head += "cycles: keep\n";
  if (text.extended) head += "compositor: extended\n";
  if (lots.one_in(8)) head += "compression: {quality: 85}\n";
  return head + "shapes:\n" + text.shapes + "lights:\n" + text.lights + "layers:\n" + text.layers;
}

std::string write_random_sequence(std::uint32_t seed, const std::string& folder) {
  std::string file = folder + "/random_" + std::to_string(seed) + ".yaml";
  std::ofstream(file) << random_sequence_text(seed);
  write_checker(folder);
  return file;
}

void write_checker(const std::string& folder) { std::ofstream(folder + "/checker.ppm") << kPicture; }

void add_skinned_bar(layers::Scene& scene, layers::dvec3 place) {
  const layers::Scene bar = skinned_bar_scene();
  const int stand_node = static_cast<int>(scene.nodes.size()), shift = stand_node + 1;
  layers::Node stand;
  stand.name = "stand";
  stand.local.translation = place;
  scene.nodes.push_back(stand);
  for (layers::Node node : bar.nodes) {
    node.parent = node.parent < 0 ? stand_node : node.parent + shift;
    scene.nodes.push_back(node);
  }
  layers::Skin skin = bar.skins[0];
  for (int& joint : skin.joints) joint += shift;
  scene.skins.push_back(skin);
  for (layers::Track track : bar.tracks) {
    track.node += shift;
    scene.tracks.push_back(track);
  }
  scene.meshes.push_back(bar.meshes[bar.parts[0].mesh]);
  scene.materials.push_back(bar.materials[bar.parts[0].material]);
  scene.parts.push_back({"bar", bar.parts[0].node + shift, static_cast<int>(scene.meshes.size()) - 1,
                         static_cast<int>(scene.materials.size()) - 1,
                         static_cast<int>(scene.skins.size()) - 1});
}

sequences::Sequence random_sequence(std::uint32_t seed, const std::string& folder) {
  sequences::Sequence sequence = sequences::load_sequence(write_random_sequence(seed, folder));
  if (seed % 3 != 0) return sequence;
  layers::Scene scene = *sequence.scene;
  add_skinned_bar(scene, {-1.6, 0.1, 0});
  sequence.layer_specs.push_back({"bar", {"bar"}, layers::OrderGroup::Normal, {}});
  sequence.layers = layers::factor(scene, sequence.layer_specs);
  sequence.scene = std::make_shared<const layers::Scene>(std::move(scene));
  return sequence;
}

}  // namespace talisman::tests
