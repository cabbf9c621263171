// SPDX-License-Identifier: Apache-2.0
// Any text in the place of a sequence file: every value is asked for in every type, the whole is read as a
// sequence, and only InputError may come out.
#include <cstddef>
#include <cstdint>
#include <string>

#include "sequences/content/sequence_file.h"

namespace {

using talisman::sequences::InputError;
using talisman::sequences::YamlValue;

template <typename Question>
void ask(const Question& question) {
  try {
    question();
  } catch (const InputError&) {
  }
}

void ask_all(const YamlValue& value) {
  ask([&] { value.number(); });
  ask([&] { value.integer(-10, 10); });
  ask([&] { value.boolean(); });
  ask([&] { value.text(); });
  ask([&] { value.vector(); });
  ask([&] { value.color(); });
  ask([&] { value.pair(talisman::sequences::kPositive); });
  ask([&] { value.choice({"a", "b"}); });
  ask([&] { value.map(); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  ask([&] {
    const auto map = talisman::sequences::read_yaml_text(text, "fuzz.yaml");
    for (const char* key : {"name", "frames", "display", "models", "layers"})
      if (const YamlValue* value = map.find(key)) ask_all(*value);
    talisman::sequences::sequence_keys().read(map);
  });
  return 0;
}
