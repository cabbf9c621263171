// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/run_identity.h"

#include <map>
#include <optional>

#include <nlohmann/json.hpp>

#include "sequences/content/asset_paths.h"
#include "sequences/files/content_hash.h"
#include "sequences/files/utf8.h"
#include "sequences/results/decision_lines.h"
#include "sequences/results/settings_json.h"

namespace talisman::sequences {

namespace {

using Json = nlohmann::ordered_json;

const char* name_of(FrameFormat format) {
  switch (format) {
    case FrameFormat::Png:
      return "png";
    case FrameFormat::Exr:
      return "exr";
    case FrameFormat::ExrLayers:
      return "exr-layers";
    case FrameFormat::None:
      return "none";
  }
  return "";
}

Json content_json(const Sequence& sequence) {
  std::map<std::string, std::string>
      hashes;  // sorted: the order in which files are opened is nobody's concern
  for (const std::string& file : sequence.content_files)
    if (std::string& hash = hashes[content_name(file, sequence.file)]; hash.empty()) {
      const std::optional<ContentHash> content = hash_of_file(file);
      if (!content) throw InputError("cannot be read", file);
      hash = content->hex();
    }
  std::map<std::string, std::string> named;
  for (const auto& [file, hash] : hashes) {
    std::string name = utf8_from(file);
    while (named.contains(name)) name += "'";  // two names that are one in UTF-8
    named[name] = hash;
  }
  return named;
}

std::string was(const Json* value) { return value ? value->dump() : "absent"; }

const Json* find(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  return found == json.end() ? nullptr : &*found;
}

/// First key in which two objects differ, as "KEY was X, is Y".
std::string difference_of_values(const Json& before, const Json& now) {
  for (const auto& [key, value] : now.items()) {
    const Json* old = find(before, key);
    if (!old || *old != value) return key + " was " + was(old) + ", is " + value.dump();
  }
  for (const auto& [key, value] : before.items())
    if (!find(now, key)) return key + " was " + value.dump() + ", is absent";
  return {};
}

std::string difference_of_content(const Json& before, const Json& now) {
  for (const auto& [file, hash] : now.items()) {
    const Json* old = find(before, file);
    if (!old) return "content file " + file + " is new";
    if (*old != hash) return "content file " + file + " has changed";
  }
  for (const auto& [file, hash] : before.items())
    if (!find(now, file)) return "content file " + file + " is no longer read";
  return {};
}

/// The entries that are not compared as a part of their own.
Json outer(const Json& json) {
  Json rest = json;
  for (const char* part : {"identity", "settings", "content", "options"}) rest.erase(part);
  return rest;
}

const Json& part(const Json& json, const char* name) {
  static const Json none = Json::object();
  const Json* found = find(json, name);
  return found && found->is_object() ? *found : none;
}

/// What was asked for on the command line and changes the picture.
Json asked_of_content(const ContentOptions& options) {
  Json asked = Json::object();
  if (options.exposure_lx) asked["exposure"] = *options.exposure_lx;
  if (options.turntable_s) asked["turntable"] = *options.turntable_s;
  if (!options.stage) asked["stage"] = false;
  if (options.seam) asked["seam"] = *options.seam == Seam::Auto ? "auto" : "none";
  return asked;
}

}  // namespace

Json run_json(const Sequence& sequence, const Settings& settings, const RunOptions& o) {
  const Json of_settings = json_of(settings), content = content_json(sequence);
  const Json asked = asked_of_content(sequence.content);
  Json identity = {{"version", TALISMAN_VERSION},
                   {"sequence", sequence.name},
                   {"settings", of_settings},
                   {"content", content}};
  if (!asked.empty()) identity["options"] = asked;
  Json run = {{"schema", "talisman.run/2"},  {"identity", ContentHasher().add(identity.dump()).hash().hex()},
              {"version", TALISMAN_VERSION}, {"kind", o.plan_only ? "plan" : "render"},
              {"sequence", sequence.name},   {"frames", {o.first_frame, o.last_frame}},
              {"format", name_of(o.format)}, {"overlay", o.overlay},
              {"separate", o.separate},      {"quality", o.quality},
              {"settings", of_settings},     {"content", content}};
  if (!asked.empty()) run["options"] = asked;
  if (o.decisions != DecisionLines::All) run["decisions"] = word_of(o.decisions);
  return run;
}

std::string first_difference(const Json& before, const Json& now) {
  if (!before.is_object()) return "run.json holds no run, --resume must continue one";
  std::string difference = difference_of_values(outer(before), outer(now));
  for (const char* name : {"settings", "options"})
    if (difference.empty()) difference = difference_of_values(part(before, name), part(now, name));
  if (!difference.empty()) return difference + ", --resume must continue with the same options";
  difference = difference_of_content(part(before, "content"), part(now, "content"));
  return difference.empty() ? difference : difference + ", --resume must continue with the same content";
}

}  // namespace talisman::sequences
