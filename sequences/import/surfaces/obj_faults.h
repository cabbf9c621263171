// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where in an OBJ file is what it is refused for? Asked only then: the file is read once more.

#include <string>

namespace talisman::sequences {

/// "line 12: ", the first that holds `statement`; empty where it is nowhere as a whole.
std::string line_of(const std::string& path, const std::string& statement);

/// "line 12: 'f 1 2 9' names vertex 9, rule: from 1 to 8, …", of the first face that names a vertex which is not
/// there; empty where none does.
std::string bad_face(const std::string& path);

}  // namespace talisman::sequences
