// The last pass on a real driver, without a display: every pixel against what window_map.hpp says on paper.

#include "viewer/wall/wall_pass.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/viewer/wall/blend_light.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/wall/test_card.hpp"
#include "viewer/wall/window_map.hpp"

namespace yuragi::viewer::wall {
namespace {

constexpr output::Size kPicture{320, 180};

/// Pixels as RenderTarget::read_rgb() gives them.
struct Pixels {
  output::Size size;
  std::vector<std::uint8_t> bytes;

  int at(int x, int y, int channel) const {
    const int column = std::clamp(x, 0, size.width_px - 1);
    const int row = std::clamp(y, 0, size.height_px - 1);
    const auto pixel =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(size.width_px) + static_cast<std::size_t>(column);
    return bytes[3 * pixel + static_cast<std::size_t>(channel)];
  }
  /// Between four pixels; x and y are parts of the picture.
  double between(const glm::dvec2& place, int channel) const {
    const double x = place.x * size.width_px - 0.5;
    const double y = place.y * size.height_px - 0.5;
    const int left = static_cast<int>(std::floor(x));
    const int top = static_cast<int>(std::floor(y));
    const auto mixed = [&](int row) {
      return at(left, row, channel) + (x - left) * (at(left + 1, row, channel) - at(left, row, channel));
    };
    return mixed(top) + (y - top) * (mixed(top + 1) - mixed(top));
  }
};

class WallPassTest : public testing::Test {
 protected:
  void SetUp() override {
    context_ = std::make_unique<gl::HeadlessContext>(gl::HeadlessOptions{.is_software = true, .has_messages = true});
    gl::report_gl_errors();
    errors_before_ = gl::gl_error_count();
    card_ = std::make_unique<gl::RenderTarget>(kPicture.width_px, kPicture.height_px, 1);
    card_->bind_resolved();
    TestCard().draw(kPicture);
    picture_ = {kPicture, card_->read_rgb()};
    vertex_array_ = std::make_unique<gl::VertexArray>();
  }
  void TearDown() override { EXPECT_EQ(gl::gl_error_count(), errors_before_); }

  Pixels shown(const output::Window& window, const output::Size& monitor, bool is_marked = false) {
    Pass pass;
    pass.take(*card_);
    gl::RenderTarget target(monitor.width_px, monitor.height_px, 1);
    target.bind_resolved();
    pass.draw(window, monitor, vertex_array_->name(), is_marked);
    return {monitor, target.read_rgb()};
  }

  /// How many pixels are not as computed, of those that are not at the picture's border, where a pixel is half in it.
  int wrong_pixels(const output::Window& window, const Pixels& pixels) const {
    const glm::dmat3 to_crop = monitor_to_crop(window);
    const output::Sides blend = blend_of_crop(window);
    int wrong = 0;
    for (int y = 0; y < pixels.size.height_px; ++y) {
      for (int x = 0; x < pixels.size.width_px; ++x) {
        const glm::dvec2 place((x + 0.5) / pixels.size.width_px, (y + 0.5) / pixels.size.height_px);
        const glm::dvec2 in_crop = mapped(to_crop, place);
        const double inside = std::min({in_crop.x, 1.0 - in_crop.x, in_crop.y, 1.0 - in_crop.y});
        if (std::abs(inside) < 0.01) continue;
        const output::Crop& crop = window.crop;
        const glm::dvec2 in_picture(crop.x + in_crop.x * crop.width, crop.y + in_crop.y * crop.height);
        const double light = inside < 0.0 ? 0.0 : std::pow(blend_light(in_crop, blend), 1.0 / window.gamma);
        for (int channel = 0; channel < 3; ++channel) {
          const double expected = light * picture_.between(in_picture, channel);
          // A driver mixes texels in steps of 1/256.
          if (std::abs(pixels.at(x, y, channel) - expected) > 2.5) ++wrong;
        }
      }
    }
    return wrong;
  }

  std::unique_ptr<gl::HeadlessContext> context_;
  std::unique_ptr<gl::RenderTarget> card_;
  std::unique_ptr<gl::VertexArray> vertex_array_;
  Pixels picture_;
  int errors_before_ = 0;
};

TEST_F(WallPassTest, ShowsThePictureAsItIsWhereNothingIsSaid) {
  EXPECT_EQ(shown({}, kPicture).bytes, picture_.bytes);
}

TEST_F(WallPassTest, CropsMeetToThePixel) {
  const output::Size half{kPicture.width_px / 2, kPicture.height_px};
  const Pixels left = shown({.crop = {0.0, 0.0, 0.5, 1.0}}, half);
  const Pixels right = shown({.crop = {0.5, 0.0, 0.5, 1.0}}, half);
  int wrong = 0;
  for (int y = 0; y < kPicture.height_px; ++y) {
    for (int x = 0; x < kPicture.width_px; ++x) {
      for (int channel = 0; channel < 3; ++channel) {
        const int seen = x < half.width_px ? left.at(x, y, channel) : right.at(x - half.width_px, y, channel);
        if (seen != picture_.at(x, y, channel)) ++wrong;
      }
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST_F(WallPassTest, TurnsThePictureWithoutChangingAPixel) {
  const Pixels turned = shown({.rotation_deg = 90}, {kPicture.height_px, kPicture.width_px});
  const Pixels half = shown({.rotation_deg = 180}, kPicture);
  const Pixels back = shown({.rotation_deg = 270}, {kPicture.height_px, kPicture.width_px});
  int wrong = 0;
  for (int y = 0; y < kPicture.height_px; ++y) {
    for (int x = 0; x < kPicture.width_px; ++x) {
      const int from_right = kPicture.width_px - 1 - x;
      const int from_below = kPicture.height_px - 1 - y;
      for (int channel = 0; channel < 3; ++channel) {
        const int expected = picture_.at(x, y, channel);
        wrong += turned.at(from_below, x, channel) == expected ? 0 : 1;
        wrong += half.at(from_right, from_below, channel) == expected ? 0 : 1;
        wrong += back.at(y, from_right, channel) == expected ? 0 : 1;
      }
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST_F(WallPassTest, StraightensAndBlendsAsComputed) {
  const output::Window window{.crop = {0.1, 0.0, 0.7, 0.9},
                              .rotation_deg = 90,
                              .corners = {{{0.1, 0.05}, {0.95, 0.0}, {0.8, 0.9}, {0.0, 1.0}}},
                              .blend = {.left = 0.2, .bottom = 0.3},
                              .gamma = 2.4};
  const Pixels pixels = shown(window, {260, 400});
  EXPECT_LT(wrong_pixels(window, pixels), 260 * 400 / 1000);
  output::Window other = window;
  other.gamma = 1.8;
  EXPECT_GT(wrong_pixels(other, pixels), 260 * 400 / 100) << "a wrong gamma is not noticed";
  other = window;
  other.corners[2].x += 0.02;
  EXPECT_GT(wrong_pixels(other, pixels), 260 * 400 / 100) << "a wrong corner is not noticed";
}

TEST_F(WallPassTest, IsBlackWhereThePictureIsNot) {
  const Pixels pixels = shown({.corners = {{{0.5, 0.5}, {0.9, 0.5}, {0.9, 0.9}, {0.5, 0.9}}}}, {200, 200});
  for (const auto& [x, y] : {std::pair{0, 0}, {199, 0}, {95, 150}, {150, 95}, {185, 150}, {199, 199}}) {
    EXPECT_EQ(pixels.at(x, y, 0) + pixels.at(x, y, 1) + pixels.at(x, y, 2), 0) << x << ", " << y;
  }
  EXPECT_GT(pixels.at(140, 140, 0), 0);
}

TEST_F(WallPassTest, MarksBordersAndStripsForATestCard) {
  const output::Window window{.blend = {.left = 0.25}};
  const Pixels marked = shown(window, kPicture, true);
  EXPECT_GT(marked.at(0, 90, 0), 200);  // the border is red
  EXPECT_LT(marked.at(0, 90, 2), 60);
  EXPECT_GT(marked.at(80, 20, 0), 200);  // the strip ends in yellow
  EXPECT_GT(marked.at(80, 20, 1), 150);
  EXPECT_LT(marked.at(80, 20, 2), 60);
}

}  // namespace
}  // namespace yuragi::viewer::wall
