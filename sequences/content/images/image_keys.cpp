// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include "layers/glob.h"
#include "layers/layer.h"
#include "sequences/content/asset_paths.h"
#include "sequences/content/images/image_recipe.h"

namespace talisman::sequences {

namespace {

namespace fs = std::filesystem;

/// "https" of "https://…", "concat" of "concat:a|b"; empty for what can only be a file.
std::string protocol_of(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || colon < 2 || text.find('/') < colon) return {};
  const bool is_package = text.compare(colon, 2, ":/") == 0 && text.compare(colon, 3, "://") != 0;
  return is_package ? "" : text.substr(0, colon);
}

void read_video_key(const YamlValue& value, ImageRecipe& image) {
  if (!protocol_of(value.text()).empty()) value.fail("a file on this machine, not a URL");
  image.video_file = resolve_asset(value.text(), value.file(), value.line());
}

/// The pictures of one folder whose names match, in the order of the names.
void read_pictures_key(const YamlValue& value, ImageRecipe& image) {
  image.pattern = value.text();
  const std::size_t slash = image.pattern.rfind('/');
  const std::string folder = slash == std::string::npos ? "" : image.pattern.substr(0, slash);
  const std::string names = image.pattern.substr(slash == std::string::npos ? 0 : slash + 1);
  if (folder.find_first_of("*?") != std::string::npos) value.fail("globs in the file's name alone");
  const std::string where = resolve_folder(folder, value.file(), value.line());
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(where, error))
    if (entry.is_regular_file() && layers::glob_matches(names, entry.path().filename().string()))
      image.picture_files.push_back(entry.path().string());
  if (image.picture_files.empty()) value.fail("a glob that matches at least one file");
  std::sort(image.picture_files.begin(), image.picture_files.end());
}

void read_screen_key(const YamlValue& value, ImageRecipe& image) {
  const char* rule = "[left, top, width, height], width and height above 0";
  const std::vector<YamlValue> items = value.items(4);
  if (items.size() != 4) value.fail(rule);
  image.screen_px.emplace();
  for (int k = 0; k < 4; ++k) (*image.screen_px)[k] = items[k].number({-1e6, 1e6});
  if (!(image.screen_px->z > 0 && image.screen_px->w > 0)) value.fail(rule);
}

void add_sources(Table<ImageRecipe>& table) {
  table.key("file", &ImageRecipe::picture_file, asset(), "", "a picture")
      .custom("files", with_rule(text().type, "a glob that matches at least one file"), read_pictures_key, "",
              "a sequence of pictures: a glob over the names in one folder, in the order of the names")
      .custom("video", with_rule(text().type, "a file that is there, no playlist and no URL"), read_video_key,
              "", "a video: what ffmpeg reads; times, colours and rotation are those that it states")
      .exactly_one_of({"file", "files", "video"})
      .key("fps", &ImageRecipe::fps, number({kLeast, 1000}), "frames/s", "of the pictures")
      .otherwise("that of the sequence")
      .only_with("files")
      .key("start_s", &ImageRecipe::start_s, number({-1e6, 1e6}), "s",
           "when its first frame begins, which is shown before, too")
      .key("loop", &ImageRecipe::loop, truth(), "", "begins again at its end; else its last frame holds");
}

}  // namespace

const Table<ImageRecipe>& image_keys() {
  using I = ImageRecipe;
  static const Table<I> table = [] {
    Table<I> t("image");
    t.placed([](I& image, const YamlValue& self) {
       image.file = self.file();
       image.line = self.line();
     })
        .key("id", &I::id, with_rule(text(), "given to one shape or image only"), "",
             "of its part and its layer")
        .required();
    add_sources(t);
    return t
        .custom("screen_px", list_type(number_type({-1e6, 1e6}), 4, 4), read_screen_key, "px",
                "on the screen: left, top, width, height, in pixels of `display`; with another `--size` it "
                "keeps its place about the middle, and grows with the height")
        .key("behind", &I::behind, truth(), "", "behind everything instead of before it")
        .only_with("screen_px")
        .key("size_m", &I::size_m, pair(kPositive), "m",
             "in the world: width and height, in its own x-y plane, facing +z, seen from both sides")
        .key("on", &I::part_globs, with_rule(texts(1), "each matches a part with texture coordinates"), "",
             "in place of the texture of these parts: globs over their names")
        .exactly_one_of({"screen_px", "size_m", "on"})
        .key("opacity", &I::opacity, number({0, 1}), "", "1: as opaque as the picture is")
        .when(has({"size_m"}), Table<I>().include(&I::motion, motion_keys()));
  }();
  return table;
}

}  // namespace talisman::sequences
