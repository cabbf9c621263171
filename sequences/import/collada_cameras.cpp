// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/collada_cameras.h"

#include <cmath>
#include <numbers>
#include <string_view>

#include <pugixml.hpp>

namespace talisman::sequences {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// A number that stands in an element; nothing where there is none.
std::optional<double> number_in(const pugi::xml_node& of, const char* element) {
  const pugi::xml_text text = of.child(element).text();
  const double value = text.as_double(NAN);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

bool is_angle(const std::optional<double>& degrees) { return degrees && *degrees > 0 && *degrees < 180; }

double fov_y_of(const pugi::xml_node& perspective) {
  const auto x = number_in(perspective, "xfov"), y = number_in(perspective, "yfov"),
             aspect = number_in(perspective, "aspect_ratio");
  if (is_angle(y)) return *y * kDegree;
  if (!is_angle(x)) return 0;
  return 2 * std::atan(std::tan(*x * kDegree / 2) / (aspect && *aspect > 0 ? *aspect : 1));
}

ColladaCamera camera_of(const pugi::xml_node& camera) {
  const pugi::xml_node technique = camera.child("optics").child("technique_common");
  const pugi::xml_node perspective = technique.child("perspective");
  ColladaCamera result;
  result.is_orthographic = !perspective && technique.child("orthographic");
  result.fov_y_rad = fov_y_of(perspective);
  result.near_m = number_in(perspective, "znear"), result.far_m = number_in(perspective, "zfar");
  return result;
}

std::string name_of_node(const pugi::xml_node& node) {
  for (const char* attribute : {"id", "sid", "name"})
    if (const pugi::xml_attribute name = node.attribute(attribute); !std::string_view(name.value()).empty())
      return name.value();
  return {};
}

}  // namespace

std::vector<ColladaCamera> collada_cameras(const std::string& text) {
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size())) return {};
  std::vector<ColladaCamera> cameras;
  for (const pugi::xpath_node& found : document.select_nodes("//node/instance_camera")) {
    const std::string url = found.node().attribute("url").value();
    if (url.empty() || url[0] != '#') continue;
    for (const pugi::xml_node& camera :
         document.document_element().child("library_cameras").children("camera"))
      if (url.substr(1) == camera.attribute("id").value()) {
        cameras.push_back(camera_of(camera));
        cameras.back().node = name_of_node(found.node().parent());
      }
  }
  return cameras;
}

}  // namespace talisman::sequences
