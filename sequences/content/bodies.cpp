// SPDX-License-Identifier: Apache-2.0
#include "sequences/content/bodies.h"

namespace talisman::sequences {

namespace {

using layers::dvec2;
using layers::dvec3;
using layers::Material;

// --- Instances ---

const Table<ModelInstance>& instance_keys() {
  static const Table<ModelInstance> table =
      Table<ModelInstance>("instance")
          .key("name", &ModelInstance::name, text(), "", "of the instance")
          .required()
          .include(&ModelInstance::motion, motion_keys());
  return table;
}

/// What has no list of instances is itself the only one: it is called by its id and has the keys of a motion.
template <typename Body>
ModelInstance& only_instance(Body& body) {
  if (body.instances.empty()) body.instances.emplace_back();
  return body.instances.front();
}

template <typename Body>
Table<Body>& with_instances(Table<Body>& table, const char* meaning) {
  const auto motion = [](Body& body) -> Motion& { return only_instance(body).motion; };
  return table.key("instances", &Body::instances, list_of(instance_keys()), "", meaning)
      .otherwise("one, with the keys of a motion")
      .when(lacks("instances"), Table<Body>().include(motion, motion_keys()));
}

// --- Models ---

std::string& name_of(ModelRecipe& model) { return only_instance(model).name; }

}  // namespace

const Table<ModelRecipe>& model_keys() {
  using M = ModelRecipe;
  static const Table<M> table = [] {
    Table<M> t("model");
    t.key("id", name_of, text(), "", "its name if there are no instances")
        .required()
        .key("file", &M::file, asset(), "", "a model: glTF, COLLADA, FBX, OBJ, 3DS, AC3D …")
        .required()
        .key("parts", &M::parts, with_rule(texts(1), "each matches a part of the file"), "",
             "globs over the paths of its nodes: the rest is left out, of the bounds too")
        .otherwise("all")
        .key("without", &M::without, with_rule(texts(1), "each matches a part of the file"), "",
             "globs of what is left out of those")
        .otherwise("none")
        .key("scale", &M::scale, number(kPositive), "", "factor")
        .key("length_m", &M::length_m, number(kPositive), "m",
             "length of the longest side of the bounds, instead of `scale`")
        .not_with({"scale"})
        .key("turn_deg", &M::turn_deg, vector(), "°", "about x, then y, then z, so that the nose is along -z")
        .key("centered", &M::centered, truth(), "", "the middle of the bounds becomes the origin")
        .key("two_sided", &M::two_sided, truth(), "",
             "no back-face culling, for files with careless windings")
        .key("lights", &M::lights, truth(), "",
             "the file's own lights shine too, each with the fall-off and the exposure that the file gives "
             "it");
    return with_instances(t, "they share geometry; parts are called `instance/path of nodes`");
  }();
  return table;
}

// --- Shapes ---

namespace {

using ShapeKind = ShapeContent::Kind;

void read_id(const YamlValue& value, ShapeRecipe& shape) {
  only_instance(shape).name = shape.content.material.name = value.text();
}

void read_box(const YamlValue& value, ShapeRecipe& shape) {
  shape.content.kind = ShapeKind::Box;
  shape.content.size_m = sides().read(value);
}
void read_sphere(const YamlValue& value, ShapeRecipe& shape) {
  shape.content.kind = ShapeKind::Sphere;
  shape.content.size_m = value.is_list() ? sides().read(value) : dvec3(value.number(kPositive));
}
void read_cylinder(const YamlValue& value, ShapeRecipe& shape) {
  const dvec2 size = value.pair(kPositive);
  shape.content.kind = ShapeKind::Cylinder;
  shape.content.size_m = {size.x, size.y, size.x};
}
void read_plane(const YamlValue& value, ShapeRecipe& shape) {
  const dvec2 size = value.pair(kPositive);
  shape.content.kind = ShapeKind::Plane;
  shape.content.size_m = {size.x, 1, size.y};
}
void read_disc(const YamlValue& value, ShapeRecipe& shape) {
  const double diameter = value.number(kPositive);
  shape.content.kind = ShapeKind::Disc;
  shape.content.size_m = {diameter, 1, diameter};
}

/// A member of the material.
template <typename Member>
auto material(Member Material::*member) {
  return [member](ShapeRecipe& shape) -> Member& { return shape.content.material.*member; };
}

void add_kinds(Table<ShapeRecipe>& table) {
  const ValueType pair_above_0 = pair(kPositive).type;
  table.custom("box", sides().type, read_box, "m", "its sides")
      .custom("sphere", either_type({number_type(kPositive), sides().type}), read_sphere, "m",
              "its diameter, or one along each axis")
      .custom("cylinder", pair_above_0, read_cylinder, "m", "diameter and height, along y")
      .custom("plane", pair_above_0, read_plane, "m", "sides along x and z, in y = 0, facing up")
      .custom("disc", number_type(kPositive), read_disc, "m", "its diameter, in y = 0, facing up")
      .exactly_one_of({"box", "sphere", "cylinder", "plane", "disc"})
      .key("taper", at(&ShapeRecipe::content, &ShapeContent::taper), number({0, 1}), "",
           "of a cylinder: its top over its bottom; 0: a cone")
      .only_with("cylinder");
}

void add_material(Table<ShapeRecipe>& table) {
  table.key("color", material(&Material::base_color), color(), "", "of the surface")
      .key("specular", material(&Material::specular), color(), "", "of its highlights")
      .key("emissive", material(&Material::emissive), color(), "", "what it gives off by itself")
      .key("opacity", material(&Material::opacity), number({0, 1}), "", "1: nothing shows through")
      .key("shininess", material(&Material::shininess), number({0, 1e5}), "", "exponent of its highlights")
      .key("reflectivity", material(&Material::reflectivity), number({0, 1}), "",
           "share of a planar reflection that is added; flat shapes only")
      .key("two_sided", material(&Material::two_sided), truth(), "", "no back-face culling")
      .key("unlit", material(&Material::unlit), truth(), "", "the colour as it is")
      .key("texture", at(&ShapeRecipe::content, &ShapeContent::texture_file), asset(), "",
           "picture: over each face of a box, a plane, the square around a disc, around and along a "
           "cylinder, by longitude and latitude")
      .key("texture2", at(&ShapeRecipe::content, &ShapeContent::second_texture_file), asset(), "",
           "a second picture, T2")
      .when(has({"texture2"}),
            Table<ShapeRecipe>().key("texture_blend", material(&Material::texture_blend), pair({0, 1}), "",
                                     "weights of both: colour · (k1 T1 + k2 T2)"));
}

/// Round things are cut around, flat ones along each side.
Table<ShapeRecipe> segment_keys(int by_default, int fewest, const char* meaning) {
  return Table<ShapeRecipe>()
      .begins([by_default](ShapeRecipe& shape) { shape.content.segments = by_default; })
      .key("segments", at(&ShapeRecipe::content, &ShapeContent::segments), whole(fewest, 512), "", meaning);
}

}  // namespace

const Table<ShapeRecipe>& shape_keys() {
  static const Table<ShapeRecipe> table = [] {
    Table<ShapeRecipe> t("shape");
    t.custom("id", with_rule(text().type, "given to one shape only"), read_id, "",
             "its name if there are no instances; its part is called the same")
        .required();
    add_kinds(t);
    t.when(has({"sphere", "cylinder", "disc"}), segment_keys(32, 3, "around it"))
        .when(has({"box", "plane"}), segment_keys(1, 1, "along each side"));
    add_material(t);
    return with_instances(t, "they share the mesh");
  }();
  return table;
}

}  // namespace talisman::sequences
