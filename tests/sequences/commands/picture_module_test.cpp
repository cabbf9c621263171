// SPDX-License-Identifier: Apache-2.0
// Picture files are read by a module that is loaded when the first one is: who reads no picture does not wait for it,
// frames are written without it, and where it is missing the tool says so.
#include "sequences/files/image_io.h"
#include "sequences/files/loaded_code.h"
#include "tests/sequences/commands/tool.h"

namespace talisman {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

using PictureModule = Tool;

TEST_F(PictureModule, ToolAndImporterDoNotWaitForPictureLibraries) {
  for (const std::string& program : {tool(), tool() + "_import"}) {
    const Outcome linked = run_shell("LD_TRACE_LOADED_OBJECTS=1 '" + program + "'");
    EXPECT_THAT(linked.output, HasSubstr("libstdc++")) << "the list of libraries is no list";
    EXPECT_THAT(linked.output, Not(HasSubstr("OpenImageIO"))) << program;
  }
}

TEST_F(PictureModule, IsLoadedByTheFirstPicture) {
  sequences::write_png(path("a.png"), {1, 1, {1, 2, 3}});
  (void)sequences::read_image(path("a.png"));
  std::string loaded;
  for (const std::string& file : sequences::loaded_code()) loaded += file + "\n";
  EXPECT_THAT(loaded, HasSubstr("talisman_pictures.so"));
  EXPECT_THAT(loaded, HasSubstr("OpenImageIO"));
}

TEST_F(PictureModule, ThatIsMissingIsSaidAndTheRestWorks) {
  sequences::write_png(path("a.png"), {1, 1, {1, 2, 3}});
  std::filesystem::copy_file(tool(), path("talisman"));
  EXPECT_EQ(run_shell("env -u TALISMAN_HOME ./talisman --version").exit_code, 0);
  const Outcome compared = run_shell("env -u TALISMAN_HOME ./talisman diff a.png a.png");
  EXPECT_EQ(compared.exit_code, 1);
  EXPECT_THAT(compared.output, HasSubstr("error: pictures cannot be read or written: "));
  EXPECT_THAT(compared.output, HasSubstr("talisman_pictures.so"));
}

TEST_F(PictureModule, IsNotNeededByFramesOfShapes) {
  write("ball.yaml", "frames: 1\nshapes: [{id: ball, sphere: 1, color: '#ff8000', unlit: true}]\n");
  std::filesystem::copy_file(tool(), path("talisman"));
  const std::string render =
      "env -u TALISMAN_HOME ./talisman render ball.yaml --size 16x16 --progress none --out ";
  EXPECT_EQ(run_shell(render + "png").exit_code, 0);
  const sequences::Image8 frame = sequences::read_image(path("png/frames/0000.png"));
  const std::size_t middle = 3 * (8 * 16 + 8);
  EXPECT_THAT(std::vector(&frame.rgb[middle], &frame.rgb[middle] + 3), ::testing::ElementsAre(255, 128, 0));
  const Outcome exr = run_shell(render + "exr --format exr");
  EXPECT_EQ(exr.exit_code, 1);
  EXPECT_THAT(exr.output, HasSubstr("talisman_pictures.so"));
}

}  // namespace
}  // namespace talisman
