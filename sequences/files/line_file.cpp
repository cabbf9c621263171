// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/line_file.h"

#include <fcntl.h>

#include <algorithm>
#include <fstream>
#include <optional>

#include "sequences/files/file_text.h"

namespace talisman::sequences {

LineFile::LineFile(std::string path, const std::vector<std::string>& lines)
    : path_(std::move(path)), partial_(path_ + ".partial") {
  // The lines kept from an earlier run are in place before the old partial file is given up.
  const std::string fresh = partial_ + ".new";
  file_.emplace(fresh, partial_, O_WRONLY | O_CREAT | O_TRUNC);
  std::string kept;
  for (const std::string& line : lines) kept.append(line).append("\n");
  file_->write(kept);
  rename_file(fresh, partial_, partial_);
}

void LineFile::write(const std::string& line) { file_->write(line + "\n"); }

void LineFile::finish() {
  file_->flush();
  file_->close();
  rename_file(partial_, path_, path_);
}

std::vector<std::string> lines_written(const std::string& path) {
  std::optional<std::string> found = text_of_file(path + ".partial");
  if (!found) found = text_of_file(path);
  const std::string text = found.value_or("");
  std::vector<std::string> lines;
  for (std::size_t start = 0, end; (end = text.find('\n', start)) != std::string::npos; start = end + 1)
    lines.push_back(text.substr(start, end - start));
  return lines;
}

std::size_t count_lines_written(const std::string& path) {
  std::ifstream in(path + ".partial", std::ios::binary);
  if (!in) in.open(path, std::ios::binary);
  std::vector<char> block(1 << 16);
  std::size_t lines = 0;
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0)
    lines += static_cast<std::size_t>(std::count(block.begin(), block.begin() + in.gcount(), '\n'));
  return lines;
}

}  // namespace talisman::sequences
