// SPDX-License-Identifier: Apache-2.0
#include "sequences/commands/inspect/inspect_parts.h"

#include <filesystem>

#include <nlohmann/json.hpp>

#include "sequences/content/parts/axes_picture.h"
#include "sequences/content/starter/starter.h"
#include "sequences/content/value_type.h"
#include "sequences/files/errors.h"
#include "sequences/files/folders.h"
#include "sequences/files/how_many.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const layers::WorldBounds& bounds) {
  if (bounds.empty()) return nullptr;
  return {{"from_m", {bounds.lo.x, bounds.lo.y, bounds.lo.z}},
          {"to_m", {bounds.hi.x, bounds.hi.y, bounds.hi.z}}};
}

Json json_of(const PartTree& tree, const PartRow& part) {
  Json textures = Json::array();
  for (const int texture : part.textures) textures.push_back(tree.textures[texture].name);
  return {{"name", part.name},
          {"node", part.node},
          {"polygons", part.polygons},
          {"bounds", json_of(part.bounds)},
          {"layer", part.layer.empty() ? Json(nullptr) : Json(part.layer)},
          {"material", part.material},
          {"textures", textures}};
}

std::size_t polygons_of(const PartTree& tree) {
  std::size_t polygons = 0;
  for (const PartRow& part : tree.parts) polygons += static_cast<std::size_t>(part.polygons);
  return polygons;
}

}  // namespace

std::string parts_text(const Sequence& sequence, const PartTree& tree, const std::string& id,
                       const std::string& picture) {
  std::string text = sequence.name + " (" + sequence.file + ")\n  " + how_many(tree.parts.size(), "part") +
                     ", " + how_many(polygons_of(tree), "polygon") + ", " +
                     how_many(sequence.layers.layers.size(), "layer") + "\n";
  if (!tree.bounds.empty())
    text += "  " + size_text(tree.bounds) + " m along x, y and z, from " + place_text(tree.bounds.lo) +
            " to " + place_text(tree.bounds.hi) + "\n";
  text += "  a flight and look_at point -z ahead: " + picture + "\n\n" + text_of(tree);
  if (!id.empty() && !tree.parts.empty())
    text += "\n  in a sequence the names begin with the id of the model: '" + id + "/" +
            tree.parts.front().name + "'\n";
  return text;
}

std::string parts_json(const Sequence& sequence, const PartTree& tree, const std::string& picture) {
  Json nodes = Json::array(), parts = Json::array(), textures = Json::array();
  for (const NodeRow& node : tree.nodes)
    nodes.push_back({{"name", node.name}, {"depth", node.depth}, {"moves", node.moves}});
  for (const PartRow& part : tree.parts) parts.push_back(json_of(tree, part));
  for (const TextureRow& texture : tree.textures)
    textures.push_back({{"name", texture.name},
                        {"texels", {texture.width, texture.height}},
                        {"file", texture.file.empty() ? Json(nullptr) : Json(texture.file)}});
  const Json json = {{"schema", "talisman.parts/1"},
                     {"sequence", sequence.name},
                     {"file", sequence.file},
                     {"bounds", json_of(tree.bounds)},
                     {"nodes", nodes},
                     {"other_nodes", tree.other_nodes},
                     {"parts", parts},
                     {"textures", textures},
                     {"not_drawn", tree.not_drawn},
                     {"picture", picture}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string inspect_parts(const Sequence& sequence, const std::string& out, bool json) {
  const std::string picture = out.empty() ? "out/" + sequence.name + "-parts.png" : out;
  if (std::filesystem::path(picture).extension() != ".png")
    throw InputError("--out is '" + picture + "', must be a .png file");
  const PartTree tree = part_tree(sequence);
  const Image8 image = axes_picture(sequence);
  if (const std::string folder = std::filesystem::path(picture).parent_path().string(); !folder.empty())
    create_folder(folder);
  write_png(picture, image);
  const std::string extension = std::filesystem::path(sequence.file).extension().string();
  const bool is_model = extension != ".yaml" && extension != ".yml";
  return json ? parts_json(sequence, tree, picture)
              : parts_text(sequence, tree, is_model ? id_of_model(sequence.file) : "", picture);
}

}  // namespace talisman::sequences
