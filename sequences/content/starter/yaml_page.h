// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A YAML text for people: a key per line, what it means beside it.
///
///   YamlPage page;
///   page.key("", "fps", "24", "frames/s: how fast");
///   page.key("  - ", "name", yaml_text("arm: left"), "of the layer");
///
///   fps: 24                         # frames/s: how fast
///     - name: "arm: left"           # of the layer

#include <string>
#include <vector>

#include "layers/geometry2.h"

namespace talisman::sequences {

/// As a scalar that reads back as this text: quoted where YAML would take it for something else. What is not UTF-8
/// becomes question marks.
std::string yaml_text(const std::string& text);
/// The shortest number that reads back to the same bits.
std::string yaml_number(double value);
std::string yaml_number(float value);
std::string yaml_vector(const layers::dvec3& v);
std::string yaml_color(const layers::vec3& color);
/// "[a, b]" of items that are written already.
std::string yaml_list(const std::vector<std::string>& items);

class YamlPage {
 public:
  /// `prefix`: what stands before the key, "  - " or "    # ". An empty value: a map or a list follows.
  void key(const std::string& prefix, const std::string& key, const std::string& value,
           const std::string& comment = "");
  /// Lines of their own, wrapped.
  void comment(const std::string& prefix, const std::string& text);
  /// As it is.
  void line(const std::string& text) { text_ += text + "\n"; }
  /// The key with its items in brackets, or below it where that is too long.
  void list(const std::string& indent, const std::string& key, const std::vector<std::string>& items,
            const std::string& comment = "");

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace talisman::sequences
