// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a reader asked of the file system, so that it can be found out later whether it would get the same
/// answers: the content of files, the absence of others ("a texture that is missing"), the names in a folder
/// that it searched, and the program and libraries that did the reading.

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sequences/files/content_hash.h"

namespace talisman::sequences {

struct FileUse {
  enum class Kind : std::uint8_t { Content, Missing, Names, Code };
  Kind kind = Kind::Content;
  std::string path;  ///< as the reader wrote it: a relative one means another file in another folder
  std::int64_t bytes = 0, changed_ns = 0;  ///< size and time of change (ctime) just before it was used
  bool settled = false;  ///< it had not changed for so long that a change since then shows in the time
};

/// Records uses, each path once. To be called before the file is opened.
class FileUses {
 public:
  void look_for(const std::string& path);  ///< and read it, if it is a regular file
  void list(const std::string& folder);    ///< the names of what is in it
  void add_code();                         ///< of this process: loaded_code.h
  std::vector<FileUse> take() { return std::move(uses_); }

 private:
  void add(FileUse::Kind kind, const std::string& path);
  std::vector<FileUse> uses_;
  std::set<std::string> files_, folders_;
};

/// Is what was used certainly still what it was when it was used?
bool is_unchanged(const FileUse& use);

/// What a reader would see now: the hash of a content or of names, the stamp of code, the hash of nothing for a
/// file that is still missing. Empty if it is not of that kind any more.
std::optional<ContentHash> seen_now(const FileUse& use);

}  // namespace talisman::sequences
