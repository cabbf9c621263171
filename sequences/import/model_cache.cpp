// SPDX-License-Identifier: Apache-2.0
#include "sequences/import/model_cache.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <vector>

#include "sequences/files/cache.h"
#include "sequences/import/scene_stream.h"

namespace talisman::sequences {
namespace {

constexpr const char* kModelKind = "model";

std::optional<ContentHash> key_of(const std::string& path, const ImportLimits& limits,
                                  const std::string& reader, const std::vector<std::string>& folders) {
  const auto model = hash_of_file(path), code = hash_of_file(reader);
  if (!model || !code) return std::nullopt;
  ContentHasher hasher;
  hasher.add(kModelKind).add(path).add(std::filesystem::absolute(path).string());
  hasher.add(*model).add(*code).add(limits.seconds).add(limits.megabytes);
  for (const std::string& folder : folders) hasher.add(std::filesystem::absolute(folder).string());
  return hasher.hash();
}

/// Where the stream begins behind `files` hashes.
std::size_t stream_offset(std::uint64_t files) { return sizeof files + files * sizeof(ContentHash); }

/// Every file is what it was when the model was read.
bool is_current(std::span<const std::uint8_t> hashes, const std::vector<FileUse>& files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    ContentHash then;
    std::memcpy(&then, hashes.data() + i * sizeof then, sizeof then);
    const auto now = seen_now(files[i]);
    if (!now || !(*now == then)) return false;
  }
  return true;
}

}  // namespace

CachedModel::CachedModel(std::string path, const ImportLimits& limits, const std::string& reader,
                         const std::vector<std::string>& folders)
    : path_(std::move(path)) {
  if (program_cache().is_on()) key_ = key_of(path_, limits, reader, folders);
}

std::optional<ImportedModel> CachedModel::find() const {
  if (!key_) return std::nullopt;
  const auto content = program_cache().load(kModelKind, *key_);
  std::uint64_t files = 0;
  if (!content || content->size() < sizeof files) return std::nullopt;
  std::memcpy(&files, content->data(), sizeof files);
  if (files > content->size() / sizeof(ContentHash) || stream_offset(files) > content->size())
    return std::nullopt;
  try {
    const std::span<const std::uint8_t> all(*content);
    ImportedModel model = model_from_bytes(all.subspan(stream_offset(files)));
    const bool current = model.files.size() == files && is_current(all.subspan(sizeof files), model.files);
    return current ? std::optional(std::move(model)) : std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;  // another version of the stream
  }
}

void CachedModel::keep(std::span<const std::uint8_t> stream, const ImportedModel& model) const {
  const bool is_recorded = std::any_of(model.files.begin(), model.files.end(), [this](const FileUse& use) {
    return use.kind == FileUse::Kind::Content && use.path == path_;
  });
  if (!key_ || !is_recorded) return;
  const std::uint64_t files = model.files.size();
  std::vector<std::uint8_t> content(stream_offset(files));
  std::memcpy(content.data(), &files, sizeof files);
  std::uint8_t* to = content.data() + sizeof files;
  for (const FileUse& use : model.files) {
    const auto now = seen_now(use);
    if (!now || !is_unchanged(use)) return;  // in this order: it may change while it is looked at
    std::memcpy(to, &*now, sizeof *now);
    to += sizeof *now;
  }
  content.insert(content.end(), stream.begin(), stream.end());
  program_cache().store(kModelKind, *key_, content);
}

}  // namespace talisman::sequences
