// SPDX-License-Identifier: Apache-2.0
#include "sequences/results/shards/shard_file.h"

#include <filesystem>
#include <stdexcept>

#include "sequences/files/atomic_file.h"
#include "sequences/files/content_hash.h"
#include "sequences/files/file_text.h"
#include "sequences/results/shards/summary_parts.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "talisman.shard/1";

bool is_of_shard(const std::string& name) {
  return name != ".lock" && name != "shard.json" && name.rfind(".tmp-", 0) != 0;
}

std::map<std::string, std::string> hashes_of(const std::string& folder) {
  std::map<std::string, std::string> hashes;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || !is_of_shard(entry.path().filename().string())) continue;
    const auto hash = hash_of_file(entry.path().string());
    if (!hash) throw OutputError(entry.path().string() + ": cannot be read again");
    hashes[fs::relative(entry.path(), folder).generic_string()] = hash->hex();
  }
  return hashes;
}

}  // namespace

void write_shard_file(const std::string& folder, const Shard& shard, const FrameRange& range, const Json& run,
                      const Summary& summary, const ShardWishes& wishes) {
  const bool is_empty = range.last < range.first;
  const Json json = {{"schema", kSchema},
                     {"version", TALISMAN_VERSION},
                     {"shard", {shard.index, shard.of}},
                     {"frames", is_empty ? Json(nullptr) : Json({range.first, range.last})},
                     {"run", run},
                     {"summary", parts_json(summary)},
                     {"what_if", wishes.what_if},
                     {"report", wishes.report},
                     {"thumbnails", wishes.thumbnails},
                     {"video", wishes.video},
                     {"fps", wishes.fps},
                     {"files", hashes_of(folder)}};
  write_text_atomically(folder + "/shard.json", json.dump() + "\n");
}

std::optional<ShardFile> read_shard_file(const std::string& folder) try {
  const Json json = Json::parse(text_of_file(folder + "/shard.json").value_or(""));
  if (json.at("schema") != kSchema) return std::nullopt;
  ShardFile file;
  json.at("version").get_to(file.version);
  file.shard = {json.at("shard").at(0), json.at("shard").at(1)};
  file.range = {0, -1};
  if (!json.at("frames").is_null()) file.range = {json.at("frames").at(0), json.at("frames").at(1)};
  file.run = json.at("run");
  file.summary = summary_from(json.at("summary"));
  file.wishes = {json.at("report"), json.at("thumbnails"), json.at("video"), json.at("fps"),
                 json.at("what_if")};
  json.at("files").get_to(file.files);
  return file.run.is_object() ? std::optional(file) : std::nullopt;
} catch (const InputError&) {
  return std::nullopt;
} catch (const nlohmann::json::exception&) {
  return std::nullopt;
} catch (const std::invalid_argument&) {
  return std::nullopt;
}

std::string first_damaged(const std::string& folder, const ShardFile& shard) {
  for (const auto& [name, hash] : shard.files) {
    const auto now = hash_of_file(folder + "/" + name);
    if (!now || now->hex() != hash) return name;
  }
  return {};
}

}  // namespace talisman::sequences
