// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One run per folder at a time.
///
/// The lock is that of the operating system (flock) on the file `.lock` in the folder: it dies with its owner, however
/// that ends, and what a killed run left of it stands in nobody's way. Folders on systems without such locks are not
/// guarded.

#include <string>

namespace talisman::sequences {

class FolderLock {
 public:
  /// Makes the folder if it is not there. Throws OutputError, at once, when another process has it ("… is being
  /// written by another run (process N)"), or when it cannot be written; nothing else in it is touched.
  explicit FolderLock(const std::string& folder);
  /// Removes the file.
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::string path_;
  int fd_ = -1;
};

}  // namespace talisman::sequences
