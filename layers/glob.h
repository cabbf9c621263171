// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Names by pattern: '*' is any run of characters, "/" and none included, '?' is one, and "\*" and "\?" are a star and
/// a question mark. A backslash before anything else is itself.

#include <string>

namespace talisman::layers {

/// True if `text` matches `glob`. Cost: O(glob · text).
bool glob_matches(const std::string& glob, const std::string& text);

/// Does it match one text only? That is `name_of_glob(glob)`.
bool has_wildcard(const std::string& glob);
std::string name_of_glob(const std::string& glob);

/// The glob that matches this name and no other.
std::string glob_of_name(const std::string& name);

}  // namespace talisman::layers
