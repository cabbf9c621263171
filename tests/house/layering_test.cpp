// The house rules that a compiler does not check: includes go one way, folders that touch no files stay that way, and files,
// functions and rooms stay small enough to be read.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::vector<std::string>> kMayInclude = {
    {"layers", {"layers"}},
    {"warp", {"layers", "warp"}},
    {"fiducials", {"layers", "warp", "fiducials"}},
    {"regulator", {"layers", "warp", "fiducials", "regulator"}},
    {"chunker", {"layers", "warp", "chunker"}},
    {"sequences", {"layers", "warp", "fiducials", "regulator", "chunker", "sequences"}},
};

/// The rooms inside sequences/: each may include itself and those before it.
const std::vector<std::string> kRooms = {"pipeline", "files",       "pictures", "import",   "content",
                                         "results",  "experiments", "view",     "commands", "python"};

struct SourceFile {
  std::string folder;
  fs::path path;
  std::vector<std::string> lines;
};

std::vector<SourceFile> sources_of(const std::vector<std::string>& folders) {
  std::vector<SourceFile> files;
  for (const auto& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(TALISMAN_SOURCE_DIR) / folder)) {
      const auto extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      SourceFile file{folder, entry.path(), {}};
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line);) file.lines.push_back(line);
      files.push_back(std::move(file));
    }
  }
  return files;
}

std::vector<std::string> all_folders() {
  std::vector<std::string> names;
  for (const auto& [name, allowed] : kMayInclude) names.push_back(name);
  return names;
}

TEST(House, IncludesGoOneWay) {
  const std::regex include(R"re(^\s*#\s*include\s*[<"]([a-z]+)/[^>"]+[>"])re");
  int project_includes = 0;
  for (const auto& file : sources_of(all_folders())) {
    const auto& allowed = kMayInclude.at(file.folder);
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      std::smatch match;
      if (!std::regex_search(file.lines[i], match, include)) continue;
      const std::string target = match[1];
      if (kMayInclude.count(target) == 0) continue;
      ++project_includes;
      EXPECT_NE(std::find(allowed.begin(), allowed.end(), target), allowed.end())
          << file.path << ":" << i + 1 << ": " << file.folder << " may not include " << target;
    }
  }
  EXPECT_GT(project_includes, 20) << "the scan found almost nothing: is the pattern still right?";
}

TEST(House, RoomsOfSequencesIncludeOnlyThoseBeforeThem) {
  const auto rank_of = [](const std::string& room) {
    return std::find(kRooms.begin(), kRooms.end(), room) - kRooms.begin();
  };
  const std::regex include(R"re(^\s*#\s*include\s*"sequences/([a-z_]+)/[^"]+")re");
  int between_rooms = 0;
  for (const auto& file : sources_of({"sequences"})) {
    const std::string room =
        (*fs::relative(file.path, fs::path(TALISMAN_SOURCE_DIR) / "sequences").begin()).string();
    ASSERT_LT(rank_of(room), static_cast<std::ptrdiff_t>(kRooms.size())) << file.path << " is in no room";
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      std::smatch match;
      if (!std::regex_search(file.lines[i], match, include)) continue;
      between_rooms += match[1] != room;
      EXPECT_LE(rank_of(match[1]), rank_of(room))
          << file.path << ":" << i + 1 << ": " << room << " may not include " << match[1];
    }
  }
  EXPECT_GT(between_rooms, 20) << "the scan found almost nothing: is the pattern still right?";
}

TEST(House, OnlySequencesTouchesFiles) {
  const std::regex file_io(
      R"re(^\s*#\s*include\s*<(fstream|filesystem|OpenImageIO/.*|opencv2/.*|assimp/.*|yaml-cpp/.*)>)re");
  for (const auto& file :
       sources_of({"layers", "warp", "fiducials", "regulator", "chunker", "sequences/pipeline"}))
    for (std::size_t i = 0; i < file.lines.size(); ++i)
      EXPECT_FALSE(std::regex_search(file.lines[i], file_io))
          << file.path << ":" << i + 1 << ": " << file.lines[i];
}

TEST(House, EigenAndCeresStayInsideWarpSources) {
  const std::regex solver(R"re(^\s*#\s*include\s*<(ceres|Eigen)/)re");
  for (const auto& file : sources_of(all_folders())) {
    if (file.folder == "warp" && file.path.extension() == ".cpp") continue;
    for (std::size_t i = 0; i < file.lines.size(); ++i)
      EXPECT_FALSE(std::regex_search(file.lines[i], solver)) << file.path << ":" << i + 1;
  }
}

/// Who links the libraries needs the headers of the standard library and of GLM, and no others.
TEST(House, HeadersOfTheLibrariesIncludeOnlyGlmAndTheStandardLibrary) {
  const std::regex include(R"re(^\s*#\s*include\s*([<"][^>"]+[>"]))re");
  const std::regex allowed(R"re(<(glm/[a-z0-9_/]+\.hpp|[a-z_]+|[a-z]+\.h)>|"(.*/)?[a-z0-9_]+\.h")re");
  int includes = 0;
  for (const auto& file :
       sources_of({"layers", "warp", "fiducials", "regulator", "chunker", "sequences/pipeline"})) {
    if (file.path.extension() != ".h") continue;
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      std::smatch match;
      if (!std::regex_search(file.lines[i], match, include)) continue;
      ++includes;
      const std::string what = match[1];
      EXPECT_TRUE(std::regex_match(what, allowed)) << file.path << ":" << i + 1 << ": " << what;
      EXPECT_NE(what, "<filesystem>") << file.path << ":" << i + 1;
    }
  }
  EXPECT_GT(includes, 100) << "the scan found almost nothing: is the pattern still right?";
}

TEST(House, FilesAreShortEnoughToRead) {
  auto folders = all_folders();
  folders.push_back("tests");
  for (const auto& file : sources_of(folders)) EXPECT_LE(file.lines.size(), 500u) << file.path;
}

/// Lines from the signature to the closing brace of every function, by the line where it begins: a block at the
/// indentation of a namespace or a class whose first line ends with the parameters' (or the initialisers')
/// parenthesis and a brace. How the formatter sets code makes this enough.
std::map<std::size_t, std::size_t> function_lengths(const std::vector<std::string>& lines) {
  std::map<std::size_t, std::size_t> lengths;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string& line = lines[i];
    const std::size_t indent = line.find_first_not_of(' ');
    if (line.empty() || line.back() != '{' || (indent != 0 && indent != 2) || line[indent] == '/') continue;
    const std::size_t parenthesis = line.find_last_of(')');
    if (parenthesis == std::string::npos || line.find_first_of(";={", parenthesis) != line.size() - 1)
      continue;
    std::size_t end = i + 1;
    while (end < lines.size() && lines[end].rfind(line.substr(0, indent) + "}", 0) != 0) ++end;
    lengths[i + 1] = end - i + 1;
  }
  return lengths;
}

TEST(House, FunctionsAreShortEnoughToRead) {
  EXPECT_EQ(function_lengths(
                {"int f(int a) {", "  return a;", "}", "struct S {", "  void g() const {", "  }", "};"}),
            (std::map<std::size_t, std::size_t>{{1, 3}, {5, 2}}));
  auto folders = all_folders();
  folders.push_back("tests");
  std::size_t functions = 0;
  for (const auto& file : sources_of(folders))
    for (const auto& [line, length] : function_lengths(file.lines)) {
      ++functions;
      EXPECT_LE(length, 45u) << file.path << ":" << line;
    }
  EXPECT_GT(functions, 1000u) << "the scan found almost nothing: is the pattern still right?";
}

TEST(House, RoomsAreSmallEnoughToKnow) {
  std::map<std::string, int> sources;
  for (const auto& file : sources_of({"sequences"}))
    if (file.path.extension() == ".cpp") ++sources[file.path.parent_path().string()];
  for (const auto& [room, count] : sources) EXPECT_LE(count, 30) << room;
}

}  // namespace
