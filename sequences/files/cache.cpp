// SPDX-License-Identifier: Apache-2.0
#include "sequences/files/cache.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <tuple>
#include <type_traits>

#include "layers/check.h"

namespace talisman::sequences {
namespace {

namespace fs = std::filesystem;

constexpr std::array<char, 8> kCacheMagic{'T', 'L', 'S', 'C', 'A', 'C', 'H', '1'};
constexpr const char* kExtension = ".entry";
constexpr const char* kTemporary = ".tmp-";
constexpr auto kAbandoned = std::chrono::hours(1);  ///< nobody writes one entry for so long

struct Header {
  std::array<char, 8> magic = kCacheMagic;
  ContentHash key, content;
  std::uint64_t bytes = 0;
};
static_assert(sizeof(Header) == 48 && std::is_trivially_copyable_v<Header>);

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

/// The content behind a header that fits it; nothing if the file is anything else.
std::optional<std::vector<std::uint8_t>> whole_content(std::FILE* file, const ContentHash& key) {
  Header header;
  struct stat status {};
  if (::fstat(fileno(file), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  if (std::fread(&header, sizeof header, 1, file) != 1) return std::nullopt;
  if (header.magic != kCacheMagic || !(header.key == key)) return std::nullopt;
  if (header.bytes != static_cast<std::uint64_t>(status.st_size) - sizeof header) return std::nullopt;
  std::vector<std::uint8_t> content(header.bytes);
  if (std::fread(content.data(), 1, content.size(), file) != content.size()) return std::nullopt;
  if (!(hash_of(content) == header.content)) return std::nullopt;
  return content;
}

/// Empty, or why not. Not flushed to the device: after a power failure the hash tells.
std::string write_entry(const std::string& path, const Header& header,
                        std::span<const std::uint8_t> content) {
  const File file(std::fopen(path.c_str(), "wbx"));
  if (!file) return std::strerror(errno);
  const bool written = std::fwrite(&header, sizeof header, 1, file.get()) == 1 &&
                       (content.empty() || std::fwrite(content.data(), content.size(), 1, file.get()) == 1) &&
                       std::fflush(file.get()) == 0;
  return written ? std::string() : std::strerror(errno);
}

/// Another program, or another thread of this one, may write the same entry.
std::string temporary_for(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  const std::string unique = kTemporary + std::to_string(::getpid()) + "-" + std::to_string(counter++) + "-";
  return (path.parent_path() / (unique + path.filename().string())).string();
}

struct Entry {
  fs::file_time_type used;
  fs::path path;
  std::int64_t bytes = 0;
};

/// Of our making, by its name: a folder that was chosen badly keeps what else is in it.
std::vector<Entry> entries_of(const std::string& folder) {
  std::vector<Entry> entries;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    std::error_code gone;  // removed meanwhile by another program
    const auto used = it->last_write_time(gone);
    if (gone || !it->path().has_extension() || it->path().extension() != kExtension) continue;
    if (name.rfind(kTemporary, 0) == 0) {
      if (fs::file_time_type::clock::now() - used > kAbandoned) fs::remove(it->path(), gone);
      continue;
    }
    const auto bytes = static_cast<std::int64_t>(it->file_size(gone));
    if (!gone) entries.push_back({used, it->path(), bytes});
  }
  return entries;
}

std::string absolute_variable(const char* name) {
  const char* value = std::getenv(name);
  return value && value[0] == '/' ? value : "";
}

std::unique_ptr<Cache>& the_cache() {
  static std::unique_ptr<Cache> cache = std::make_unique<Cache>();
  return cache;
}

}  // namespace

std::string default_cache_folder() {
  if (const std::string caches = absolute_variable("XDG_CACHE_HOME"); !caches.empty())
    return caches + "/talisman";
  const std::string home = absolute_variable("HOME");
  return home.empty() ? "" : home + "/.cache/talisman";
}

Cache::Cache(CacheOptions options) : options_(std::move(options)) {
  TALISMAN_CHECK_GE(options_.megabytes, 1);
  if (is_on()) options_.folder = fs::absolute(options_.folder).string();
}

std::string Cache::path_of(const std::string& kind, const ContentHash& key) const {
  return options_.folder + "/" + kind + "-" + key.hex() + kExtension;
}

std::optional<std::vector<std::uint8_t>> Cache::load(const std::string& kind, const ContentHash& key) {
  if (!is_on()) return std::nullopt;
  const std::string path = path_of(kind, key);
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) return std::nullopt;
  auto content = whole_content(file.get(), key);
  if (content)
    ::futimens(fileno(file.get()), nullptr);  // now; if the folder is read-only, the order of age is lost
  else
    ::unlink(path.c_str());
  return content;
}

void Cache::store(const std::string& kind, const ContentHash& key, std::span<const std::uint8_t> content) {
  const auto limit = static_cast<std::uint64_t>(options_.megabytes) << 20;
  if (!is_on() || content.size() + sizeof(Header) > limit) return;
  std::error_code error;
  fs::create_directories(options_.folder, error);
  if (error) return set_trouble(error.message());
  const std::string path = path_of(kind, key), temporary = temporary_for(path);
  const Header header{kCacheMagic, key, hash_of(content), content.size()};
  std::string why = write_entry(temporary, header, content);
  if (why.empty() && ::rename(temporary.c_str(), path.c_str()) != 0) why = std::strerror(errno);
  if (why.empty()) return drop_least_recently_used();
  ::unlink(temporary.c_str());
  set_trouble(why);
}

void Cache::drop_least_recently_used() {
  std::vector<Entry> entries = entries_of(options_.folder);
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.used, a.path) < std::tie(b.used, b.path);
  });
  std::int64_t sum = 0;
  for (const Entry& entry : entries) sum += entry.bytes;
  for (const Entry& entry : entries) {
    if (sum <= options_.megabytes << 20) return;
    std::error_code ignored;
    fs::remove(entry.path, ignored);
    sum -= entry.bytes;
  }
}

void Cache::set_trouble(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  if (trouble_.empty()) trouble_ = options_.folder + ": " + reason;
}

std::string Cache::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

Cache& program_cache() { return *the_cache(); }

void use_cache(const CacheOptions& options) { the_cache() = std::make_unique<Cache>(options); }

}  // namespace talisman::sequences
