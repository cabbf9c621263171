#include "tests/chunker/render_support.h"
#include "tests/support/scenes.h"
namespace talisman::chunker::tests {
TEST(Render, Pic) {
  dump_picture("sphere", render_all(talisman::tests::sphere_scene(), {640,480}).sprite);
  dump_picture("moving", render_all(talisman::tests::moving_scene(), {640,480}).sprite);
  dump_picture("ball", render_all(talisman::tests::displaced_sphere_scene(70000), {640,480}).sprite);
  for (auto s : {talisman::tests::sphere_scene(), talisman::tests::moving_scene()}) {
    auto a = render_all(s, {80,60}, exact_options()).sprite;
    auto b = render_reference(s, {80,60}, exact_options());
    auto d = difference(a,b);
    EXPECT_EQ(d.texels, 0) << d.largest << " " << d.where.x << " " << d.where.y;
  }
}
}
