// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/line_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace talisman::sequences {

LineFile::LineFile(std::string path, const std::vector<std::string>& lines)
    : path_(std::move(path)), partial_(path_ + ".partial") {
  // The lines kept from an earlier run are in place before the old partial file is given up.
  const std::string fresh = partial_ + ".new";
  file_ = std::fopen(fresh.c_str(), "wb");
  if (!file_) throw OutputError(partial_ + ": cannot be written: " + std::strerror(errno));
  for (const std::string& line : lines) write(line);
  if (std::rename(fresh.c_str(), partial_.c_str()) != 0) fail("cannot be renamed");
}

LineFile::~LineFile() {
  if (file_) std::fclose(file_);
}

void LineFile::fail(const char* what) const {
  throw OutputError(partial_ + ": " + what + ": " + std::strerror(errno));
}

void LineFile::write(const std::string& line) {
  const std::string text = line + "\n";
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size() || std::fflush(file_) != 0)
    fail("cannot be written");
}

void LineFile::finish() {
  if (fsync(fileno(file_)) != 0) fail("cannot be written");
  const int closed = std::fclose(file_);
  file_ = nullptr;
  if (closed != 0) fail("cannot be written");
  if (std::rename(partial_.c_str(), path_.c_str()) != 0) fail("cannot be renamed");
}

std::vector<std::string> lines_written(const std::string& path) {
  const std::string partial = path + ".partial";
  std::ifstream in(std::filesystem::exists(partial) ? partial : path, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  std::vector<std::string> lines;
  for (std::size_t start = 0, end; (end = text.find('\n', start)) != std::string::npos; start = end + 1)
    lines.push_back(text.substr(start, end - start));
  return lines;
}

}  // namespace talisman::sequences
