// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/collada_maps.h"

#include <iterator>
#include <set>
#include <string_view>

#include <pugixml.hpp>

namespace talisman::sequences {

namespace {

/// What "#id" names among the children of a library.
pugi::xml_node named(const pugi::xml_node& library, std::string_view url) {
  for (const pugi::xml_node& child : library.children())
    if (!url.empty() && url.substr(url[0] == '#' ? 1 : 0) == child.attribute("id").value()) return child;
  return {};
}

layers::Wrap wrap_in(const pugi::xml_node& sampler, const char* element) {
  const std::string_view word = sampler.child(element).text().get();
  if (word == "MIRROR") return layers::Wrap::Mirror;
  return word == "CLAMP" || word == "BORDER" || word == "NONE" ? layers::Wrap::Clamp : layers::Wrap::Repeat;
}

pugi::xml_node sampler_of(const pugi::xml_node& effect, std::string_view sid) {
  for (const pugi::xpath_node& found : effect.select_nodes(".//newparam"))
    if (sid == found.node().attribute("sid").value()) return found.node().child("sampler2D");
  return {};
}

/// Of the coordinates in the file, from 0.
std::set<int> sets_in(const pugi::xml_document& document) {
  std::set<int> sets;
  for (const pugi::xpath_node& input : document.select_nodes("//mesh/*/input[@semantic='TEXCOORD']"))
    sets.insert(input.node().attribute("set").as_int(0));
  return sets;
}

/// Where the material is used first.
int set_of(const pugi::xml_document& document, std::string_view material, std::string_view semantic,
           const std::set<int>& sets) {
  for (const pugi::xpath_node& found : document.select_nodes("//instance_material/bind_vertex_input")) {
    const pugi::xml_node bind = found.node();
    const std::string_view target = bind.parent().attribute("target").value();
    if (target.empty() || target.substr(1) != material || semantic != bind.attribute("semantic").value())
      continue;
    const auto at = sets.find(bind.attribute("input_set").as_int(0));
    return at == sets.end() ? 0 : static_cast<int>(std::distance(sets.begin(), at));
  }
  return 0;
}

}  // namespace

std::map<std::string, ColladaMap> collada_maps(const std::string& text) {
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size())) return {};
  const std::set<int> sets = sets_in(document);
  const pugi::xml_node root = document.document_element();
  std::map<std::string, ColladaMap> maps;
  for (const pugi::xml_node& material : root.child("library_materials").children("material")) {
    const pugi::xml_node effect =
        named(root.child("library_effects"), material.child("instance_effect").attribute("url").value());
    const pugi::xml_node texture = effect.select_node(".//diffuse/texture").node();
    if (!texture) continue;
    const pugi::xml_node sampler = sampler_of(effect, texture.attribute("texture").value());
    const ColladaMap map = {
        set_of(document, material.attribute("id").value(), texture.attribute("texcoord").value(), sets),
        wrap_in(sampler, "wrap_s"), wrap_in(sampler, "wrap_t")};
    for (const char* attribute : {"id", "name"})
      if (const std::string key = material.attribute(attribute).value(); !key.empty()) maps.emplace(key, map);
  }
  return maps;
}

}  // namespace talisman::sequences
