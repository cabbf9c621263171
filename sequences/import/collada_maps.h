// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How is the colour map of a COLLADA material looked up? assimp hands on neither of these:
///
///   <sampler2D> <wrap_s>, <wrap_t>     WRAP, MIRROR, CLAMP; BORDER and NONE are taken for CLAMP
///   <bind_vertex_input semantic=S input_semantic="TEXCOORD" input_set=N>, S as <texture texcoord=S> says
///
/// Source: COLLADA 1.4.1, 5-37 and 8-30 (Khronos, 2008).

#include <map>
#include <string>

#include "layers/scene.h"

namespace talisman::sequences {

struct ColladaMap {
  int set = 0;  ///< as assimp numbers them: without those that no mesh of the file has
  layers::Wrap wrap_u = layers::Wrap::Repeat, wrap_v = layers::Wrap::Repeat;
};

/// Those of materials whose diffuse colour is a picture, by id and by name; empty for what is no XML.
std::map<std::string, ColladaMap> collada_maps(const std::string& text);

}  // namespace talisman::sequences
