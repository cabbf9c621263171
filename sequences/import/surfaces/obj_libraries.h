// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where are the materials that an OBJ file uses? Its lines "mtllib NAME [NAME ...]" name libraries; a name may have
/// spaces, as exporters write it. A library that is missing and a material that is in none are losses: what is
/// drawn instead is a plain grey.
///
/// Where a library is missing, one with the model's own name (thing.mtl for thing.obj) takes its place. Of materials of
/// one name in several libraries that of the first counts.

#include <map>
#include <string>
#include <vector>

#include "sequences/import/surfaces/obj_materials.h"
#include "sequences/import/texture_search.h"

namespace talisman::sequences {

class ObjLibraries {
 public:
  /// `written`: what is behind each "mtllib".
  ObjLibraries(const ModelPlace& place, const std::vector<std::string>& written, FileUses& files);

  /// Null where no library has it.
  const ObjMaterial* find(const std::string& name) const;
  /// "material library 'gone.mtl' is missing", of each that is not there.
  const std::vector<std::string>& missing() const { return missing_; }
  /// "material 'red' is in no library", of those among `used`; empty if there is none.
  std::string unknown(const std::vector<std::string>& used) const;

 private:
  void add_line(const std::string& names);
  bool add(const std::string& name);
  void add_missing(const std::string& name);

  const ModelPlace& place_;
  FileUses& files_;
  std::vector<std::string> missing_;
  std::map<std::string, ObjMaterial> materials_;
};

}  // namespace talisman::sequences
