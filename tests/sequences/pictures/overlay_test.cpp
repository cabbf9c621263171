// SPDX-License-Identifier: Apache-2.0
#include "sequences/pictures/overlay.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace talisman::sequences {
namespace {

using layers::dmat3;
using Rgb = std::array<std::uint8_t, 3>;
constexpr Rgb kGround{40, 50, 60};

Image8 blank(int width, int height) {
  Image8 image{width, height, {}};
  for (int i = 0; i < width * height; ++i) image.rgb.insert(image.rgb.end(), kGround.begin(), kGround.end());
  return image;
}

Rgb pixel_at(const Image8& image, int x, int y) {
  const auto* p = image.rgb.data() + (static_cast<std::size_t>(y) * image.width + x) * 3;
  return {p[0], p[1], p[2]};
}

int changed_pixels(const Image8& image) {
  int n = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) n += pixel_at(image, x, y) != kGround;
  return n;
}

/// Column-major as GLM: x' = a x + c y + tx, y' = b x + d y + ty, w' = g x + h y + k.
dmat3 matrix(double a, double c, double tx, double b, double d, double ty, double g = 0, double h = 0,
             double k = 1) {
  return {a, b, g, c, d, h, tx, ty, k};
}

dmat3 shift(double x, double y) { return matrix(1, 0, x, 0, 1, y); }

Image8 drawn(const Outline& outline, int width = 200, int height = 150) {
  Image8 image = blank(width, height);
  draw_outlines(image, {outline});
  return image;
}

TEST(AgeColor, FreshIsWhiteThenGreenYellowRed) {
  EXPECT_EQ(age_color(0, 24), (Rgb{255, 255, 255}));
  const Rgb young = age_color(1, 24), middle = age_color(13, 25), old = age_color(24, 24);
  EXPECT_GT(young[1], 2 * young[0]);
  EXPECT_GT(middle[0], 200);
  EXPECT_GT(middle[1], 200);
  EXPECT_GT(old[0], 3 * old[1]);
  EXPECT_EQ(age_color(1000000, 24), old);
  EXPECT_EQ(age_color(5, 1), old);  // everything that is not fresh is old
  EXPECT_EQ(age_color(-3, 24), age_color(0, 24));
}

/// How much of a white line a row of pixels shows, in pixels.
double white_in_row(const Image8& image, int y, int first, int last) {
  double sum = 0;
  for (int x = first; x <= last; ++x) sum += (pixel_at(image, x, y)[0] - kGround[0]) / (255.0 - kGround[0]);
  return sum;
}

// An edge at x = 50 is bright in the two columns beside it, and gone three pixels away.
TEST(DrawOutlines, EdgeCoversThePixelsBesideIt) {
  const Image8 image = drawn({shift(50, 40), {60, 30}, 0, ""});
  for (const int x : {49, 50}) EXPECT_GT(pixel_at(image, x, 55)[0], 200) << x;
  for (const int y : {39, 40, 69, 70}) EXPECT_GT(pixel_at(image, 80, y)[0], 200) << y;
  for (const int x : {46, 53, 80}) EXPECT_EQ(pixel_at(image, x, 55), kGround) << x;
  EXPECT_NEAR(white_in_row(image, 55, 40, 60), 3.4, 0.25);
}

// Between pixels, too, the line lies where the edge is: its centre of light moves with it.
TEST(DrawOutlines, EdgeBetweenPixelsIsAntialiased) {
  for (const double edge : {50.0, 50.25, 50.5, 50.75}) {
    const Image8 image = drawn({shift(edge, 40), {60, 30}, 0, ""});
    double light = 0, moment = 0;
    for (int x = 40; x < 60; ++x) {
      const double here = white_in_row(image, 55, x, x);
      light += here;
      moment += here * (x + 0.5);
    }
    EXPECT_NEAR(moment / light, edge, 0.15) << edge;
  }
}

// Every visible pixel of an affine outline lies near a true edge, and every true edge point in the picture is
// marked.
TEST(DrawOutlines, RandomAffineOutlinesLieOnTheirEdges) {
  constexpr unsigned kSeed = 20;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 40; ++trial) {
    const dmat3 m = matrix(unit(random), unit(random), 100 + 80 * unit(random), unit(random), unit(random),
                           75 + 60 * unit(random));
    const Image8 image = drawn({m, {120, 90}, 0, ""});
    const double corners[5][2] = {{0, 0}, {120, 0}, {120, 90}, {0, 90}, {0, 0}};
    for (int e = 0; e < 4; ++e)
      for (int i = 0; i <= 200; ++i) {
        const double t = i / 200.0;
        const auto p = m * layers::dvec3(corners[e][0] * (1 - t) + corners[e + 1][0] * t,
                                         corners[e][1] * (1 - t) + corners[e + 1][1] * t, 1);
        if (p.x < 0 || p.y < 0 || p.x >= image.width || p.y >= image.height) continue;
        ASSERT_GT(pixel_at(image, static_cast<int>(p.x), static_cast<int>(p.y))[0], 120)
            << "seed " << kSeed << " trial " << trial;
      }
  }
}

// Steep perspective: the far corners lie behind the viewer. What is drawn must agree with points of the edges
// that have a denominator above 0, and nothing may appear elsewhere (mirrored through the horizon).
TEST(DrawOutlines, EdgesBehindTheViewerAreCut) {
  const dmat3 m = matrix(1, 0, 60, 0, 1, 40, -0.01, 0, 1);
  const Image8 image = drawn({m, {200, 60}, 0, ""});
  EXPECT_GT(changed_pixels(image), 50);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < 55; ++x)
      ASSERT_EQ(pixel_at(image, x, y), kGround) << x << ", " << y;  // all is right of x = 60
}

TEST(DrawOutlines, WhollyBehindTheViewerDrawsNothing) {
  EXPECT_EQ(changed_pixels(drawn({matrix(1, 0, 60, 0, 1, 40, 0, 0, -1), {50, 50}, 0, "behind"})), 0);
}

TEST(DrawOutlines, DegenerateAndNotFiniteMapsAreHarmless) {
  const double nan = std::nan(""), inf = HUGE_VAL, huge = 1e300;
  for (const dmat3& m :
       {matrix(nan, 0, 0, 0, 1, 0), matrix(1, 0, inf, 0, 1, 0), matrix(huge, huge, -huge, huge, -huge, huge),
        matrix(1, 0, 50, 0, 1, 50, nan, 0, 1), matrix(1, 0, 50, 0, 1, 50, 0, 0, 0),
        matrix(0, 0, 0, 0, 0, 0, 0, 0, 0), matrix(1, 0, 50, 0, 1, 50, 1e-320, 0, 1e-320),
        matrix(huge, 0, -huge, 0, huge, -huge, huge, huge, huge)})
    drawn({m, {100, 100}, 3, "label"});
  // A singular map collapses the sprite to a point or a line inside the picture: that much may be drawn, and
  // no more.
  EXPECT_LT(changed_pixels(drawn({matrix(0, 0, 50, 0, 0, 50), {100, 100}, 3, ""})), 40);
  EXPECT_EQ(changed_pixels(drawn({matrix(nan, 0, 0, 0, 1, 0), {100, 100}, 3, "label"})), 0);
  EXPECT_LT(changed_pixels(drawn({shift(50, 50), {0, 0}, 3, ""})), 40);
}

// A sprite a billion pixels wide: its one edge in view is exact although its corners are far away.
TEST(DrawOutlines, HugeCoordinatesAreClippedExactly) {
  const Image8 image = drawn({matrix(1e9, 0, 100, 0, 1e9, -5e9), {10, 10}, 0, ""});
  for (int y = 0; y < image.height; ++y) {
    EXPECT_GT(pixel_at(image, 99, y)[0], 200);
    EXPECT_GT(pixel_at(image, 100, y)[0], 200);
    EXPECT_EQ(pixel_at(image, 96, y), kGround);
    EXPECT_EQ(pixel_at(image, 103, y), kGround);
  }
}

TEST(DrawOutlines, OutsideThePictureDrawsNothing) {
  for (const auto& m : {shift(500, 0), shift(-500, 0), shift(0, 500), shift(0, -500)})
    EXPECT_EQ(changed_pixels(drawn({m, {100, 100}, 0, "outside"})), 0);
}

TEST(DrawOutlines, EmptyPictureAndNoOutlines) {
  Image8 empty;
  draw_outlines(empty, {{shift(0, 0), {10, 10}, 0, "x"}});
  EXPECT_TRUE(empty.rgb.empty());
  Image8 image = blank(20, 20);
  draw_outlines(image, {});
  EXPECT_EQ(changed_pixels(image), 0);
}

// The label of a sprite whose top-left corner is outside goes to a corner in view; one that covers the
// picture keeps its label too.
TEST(DrawOutlines, LabelsStayInView) {
  const Outline plain{shift(-50, -50), {100, 100}, 0, ""};
  Outline labelled = plain;
  labelled.label = "7";
  EXPECT_GT(changed_pixels(drawn(labelled)), changed_pixels(drawn(plain)) + 20);
  EXPECT_EQ(changed_pixels(drawn({shift(-500, -500), {2000, 2000}, 0, ""})), 0);
  EXPECT_GT(changed_pixels(drawn({shift(-500, -500), {2000, 2000}, 0, "all"})), 100);
  EXPECT_GT(changed_pixels(drawn({shift(195, 145), {100, 100}, 0, "lower right corner"})), 900);
}

// Wider than the picture: shown from its beginning, cut at the end.
TEST(DrawOutlines, LabelWiderThanThePictureIsCut) {
  const Image8 image = drawn({shift(10, 10), {20, 20}, 0, std::string(100, 'M')}, 60, 40);
  EXPECT_NE(pixel_at(image, 1, 13), kGround);
}

// Many layers at rest share one corner; their labels must not hide each other.
TEST(DrawOutlines, LabelsAtOneCornerStepAside) {
  const Outline outline{shift(20, 20), {150, 100}, 0, "888"};
  Image8 one = blank(200, 150), three = blank(200, 150);
  draw_outlines(one, {outline});
  draw_outlines(three, {outline, outline, outline});
  const int lines = changed_pixels(drawn({shift(20, 20), {150, 100}, 0, ""}));
  EXPECT_GT(changed_pixels(three) - lines, 5 * (changed_pixels(one) - lines) / 2);
}

// More labels than the picture has room for: the rest overlap, nothing hangs.
TEST(DrawOutlines, MoreLabelsThanRoom) {
  Image8 image = blank(40, 30);
  draw_outlines(image, std::vector<Outline>(100, {shift(1, 1), {10, 10}, 2, "LAYER"}));
  EXPECT_GT(changed_pixels(image), 100);
}

/// Upper left corner of what a labelled picture has and the same without labels has not.
layers::ivec2 label_corner(Outline outline, int width, int height) {
  const Image8 with = drawn(outline, width, height);
  outline.label.clear();
  const Image8 without = drawn(outline, width, height);
  layers::ivec2 corner(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (pixel_at(with, x, y) != pixel_at(without, x, y))
        corner = {std::min(corner.x, x), std::min(corner.y, y)};
  return corner;
}

// A box that leaves the picture over every border, by a pixel a frame: the label keeps up, and jumps nowhere.
TEST(DrawOutlines, LabelsDoNotJump) {
  for (const layers::dvec2 step : {layers::dvec2{1, 0}, layers::dvec2{-1, 0}, layers::dvec2{0, 1},
                                   layers::dvec2{0, -1}, layers::dvec2{-1, -1}, layers::dvec2{1, 1}}) {
    layers::ivec2 before(-1, -1);
    for (int frame = 0; frame < 120; ++frame) {
      const Outline outline{shift(70 + frame * step.x, 50 + frame * step.y), {60, 40}, 0, "leader"};
      const layers::ivec2 at = label_corner(outline, 200, 150);
      if (at.x == 200) break;  // out of view
      if (frame > 0) {
        EXPECT_LE(std::abs(at.x - before.x), 1) << frame;
        EXPECT_LE(std::abs(at.y - before.y), 1) << frame;
      }
      before = at;
    }
  }
}

TEST(OutlineLabel, SaysTheAgeInFrames) {
  EXPECT_EQ(outline_label("leader", 0), "leader · new");
  EXPECT_EQ(outline_label("leader", 1), "leader · 1 frame");
  EXPECT_EQ(outline_label("leader", 12), "leader · 12 frames");
}

TEST(DrawLegend, StandsInTheLowerLeftCornerAndShowsEveryColor) {
  Image8 image = blank(512, 384);
  draw_legend(image);
  const auto place = legend_place(image);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->x0, 0);
  EXPECT_EQ(place->y1, 384);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (x >= place->x1 || y < place->y0) {
        ASSERT_EQ(pixel_at(image, x, y), kGround) << x << ", " << y;
      }
  for (const int age : {0, 1, 12, kOldestFrames}) {
    int shown = 0;
    for (int y = place->y0; y < place->y1; ++y)
      for (int x = 0; x < place->x1; ++x) {
        const Rgb a = pixel_at(image, x, y), b = age_color(age, kOldestFrames);
        shown += std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) < 25;
      }
    EXPECT_GT(shown, 5) << age;
  }
}

TEST(DrawLegend, SmallPicturesHaveNone) {
  for (const auto& [width, height] : {std::pair{60, 40}, std::pair{320, 60}, std::pair{0, 0}}) {
    Image8 image = blank(width, height);
    EXPECT_FALSE(legend_place(image));
    draw_legend(image);
    EXPECT_EQ(changed_pixels(image), 0);
  }
  EXPECT_TRUE(legend_place(blank(320, 240)));
}

// Labels of boxes behind the legend stand beside it.
TEST(DrawOverlay, LabelsAreClearOfTheLegend) {
  const std::vector<Outline> outlines(5, {shift(5, 220), {100, 40}, 2, "leader · 2 frames"});
  Image8 with = blank(320, 240), lines = blank(320, 240);
  draw_overlay(with, outlines);
  draw_outlines(lines, std::vector<Outline>(5, {shift(5, 220), {100, 40}, 2, ""}));
  draw_legend(lines);
  const auto place = legend_place(with);
  ASSERT_TRUE(place);
  for (int y = place->y0; y < place->y1; ++y)
    for (int x = 0; x < place->x1; ++x)
      ASSERT_EQ(pixel_at(with, x, y), pixel_at(lines, x, y)) << x << ", " << y;
  EXPECT_GT(changed_pixels(with), changed_pixels(lines) + 5000);
}

TEST(DrawOutlinesDeathTest, OldestFramesMustBePositive) {
  Image8 image = blank(4, 4);
  EXPECT_DEATH(draw_outlines(image, {}, 0), "oldest_frames");
}

}  // namespace
}  // namespace talisman::sequences
