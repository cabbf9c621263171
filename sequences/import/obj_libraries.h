// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where are the materials that an OBJ file uses? Its lines "mtllib NAME [NAME ...]" name libraries; a name may have
/// spaces, as exporters write it. A library that is missing and a material that is in none are losses: what is
/// drawn instead is a plain grey.
///
/// Where a library is missing, one with the model's own name (thing.mtl for thing.obj) takes its place.

#include <set>
#include <string>
#include <vector>

#include "sequences/import/texture_search.h"

namespace talisman::sequences {

class ObjLibraries {
 public:
  /// `written`: what is behind each "mtllib".
  ObjLibraries(const ModelPlace& place, const std::vector<std::string>& written, FileUses& files);

  /// "mtllib NAME" of each that is there.
  const std::string& lines() const { return lines_; }
  /// "material library 'gone.mtl' is missing", of each that is not.
  const std::vector<std::string>& missing() const { return missing_; }
  /// "material 'red' is in no library", of those among `used`; empty if there is none.
  std::string unknown(const std::vector<std::string>& used) const;

 private:
  void add_line(const std::string& names);
  bool add(const std::string& name);
  void add_missing(const std::string& name);

  const ModelPlace& place_;
  FileUses& files_;
  std::string lines_;
  std::vector<std::string> missing_;
  std::set<std::string> materials_;
};

/// What is in `line` from there on, without the space around it.
std::string rest_of_line(const std::string& line, std::size_t from);

}  // namespace talisman::sequences
