#include "viewer/wall/window_map.hpp"

#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/viewer/wall/blend_light.hpp"

namespace yuragi::viewer::wall {
namespace {

constexpr double kSmall = 1e-9;

glm::dvec2 on(const output::Place& place) {
  return {place.x, place.y};
}

void expect_near(const glm::dvec2& place, const glm::dvec2& expected) {
  EXPECT_NEAR(place.x, expected.x, kSmall);
  EXPECT_NEAR(place.y, expected.y, kSmall);
}

constexpr output::Corners kAslant{{{0.1, 0.05}, {0.95, 0.0}, {0.8, 0.9}, {0.0, 1.0}}};

TEST(SquareTo, TakesTheCornersOfTheSquareToTheGivenOnes) {
  const glm::dmat3 map = square_to(kAslant);
  expect_near(mapped(map, {0, 0}), on(kAslant[0]));
  expect_near(mapped(map, {1, 0}), on(kAslant[1]));
  expect_near(mapped(map, {1, 1}), on(kAslant[2]));
  expect_near(mapped(map, {0, 1}), on(kAslant[3]));
}

TEST(SquareTo, IsNothingForTheSquareItself) {
  const glm::dmat3 map = square_to(output::kWholeMonitor);
  for (const glm::dvec2 place : {glm::dvec2(0.3, 0.7), glm::dvec2(0, 1), glm::dvec2(0.9, 0.1)}) {
    expect_near(mapped(map, place), place);
  }
}

/// What makes it right for a projector: the middle of the square is where the diagonals of the corners cross.
TEST(SquareTo, KeepsLinesStraight) {
  const glm::dvec2 middle = mapped(square_to(kAslant), {0.5, 0.5});
  const auto off_line = [&middle](const output::Place& from, const output::Place& to) {
    return (to.x - from.x) * (middle.y - from.y) - (to.y - from.y) * (middle.x - from.x);
  };
  EXPECT_NEAR(off_line(kAslant[0], kAslant[2]), 0.0, kSmall);
  EXPECT_NEAR(off_line(kAslant[1], kAslant[3]), 0.0, kSmall);
}

TEST(MonitorToCrop, UndoesTheCorners) {
  const output::Window window{.corners = kAslant};
  const glm::dmat3 map = monitor_to_crop(window);
  expect_near(mapped(map, on(kAslant[0])), {0, 0});
  expect_near(mapped(map, on(kAslant[2])), {1, 1});
  for (const double x : {0.0, 0.3, 1.0}) {
    for (const double y : {0.0, 0.6, 1.0}) {
      const glm::dvec2 seen = mapped(square_to(kAslant), {x, y});
      EXPECT_GT((map * glm::dvec3(seen, 1.0)).z, 0.0);
      expect_near(mapped(map, seen), {x, y});
    }
  }
}

/// On a monitor that hangs with its right side up, the picture's upper left corner is at the monitor's upper right.
TEST(MonitorToCrop, TurnsThePictureClockwise) {
  const auto shown_at = [](int rotation_deg, const glm::dvec2& place) {
    return mapped(monitor_to_crop(output::Window{.rotation_deg = rotation_deg}), place);
  };
  expect_near(shown_at(90, {1, 0}), {0, 0});
  expect_near(shown_at(90, {1, 1}), {1, 0});
  expect_near(shown_at(180, {1, 1}), {0, 0});
  expect_near(shown_at(180, {0, 1}), {1, 0});
  expect_near(shown_at(270, {0, 1}), {0, 0});
  expect_near(shown_at(270, {0, 0}), {1, 0});
}

TEST(BlendLight, OfTwoNeighboursIsOneEverywhere) {
  // Two crops of 0.55 of the picture, which have 0.1 of it in common.
  const output::Window left{.crop = {0.0, 0.0, 0.55, 1.0}, .blend = {.right = 0.1}};
  const output::Window right{.crop = {0.45, 0.0, 0.55, 1.0}, .blend = {.left = 0.1}};
  for (double x = 0.0; x <= 1.0; x += 0.01) {
    double light = 0.0;
    for (const output::Window& window : {left, right}) {
      const glm::dvec2 at((x - window.crop.x) / window.crop.width, 0.5);
      if (at.x >= 0.0 && at.x <= 1.0) light += blend_light(at, blend_of_crop(window));
    }
    EXPECT_NEAR(light, 1.0, 1e-6) << x;
  }
}

TEST(BlendLight, FallsToNothingAtTheSideAndIsWholeWithin) {
  const output::Sides blend{.left = 0.2, .bottom = 0.4};
  EXPECT_EQ(blend_light({0.0, 0.3}, blend), 0.0);
  EXPECT_NEAR(blend_light({0.1, 0.3}, blend), 0.5, kSmall);
  EXPECT_EQ(blend_light({0.2, 0.3}, blend), 1.0);
  EXPECT_EQ(blend_light({1.0, 0.3}, blend), 1.0);
  EXPECT_NEAR(blend_light({0.1, 0.8}, blend), 0.25, kSmall);
}

TEST(PictureSize, HasAPixelForEachPixelOfTheFinestWindow) {
  output::Output output{.windows = {{.crop = {0, 0, 0.5, 1}}, {.crop = {0.5, 0, 0.5, 1}}}};
  EXPECT_EQ(picture_size(output, std::array{output::Size{1920, 1080}, output::Size{1280, 720}}),
            (output::Size{3840, 1080}));
  EXPECT_EQ(picture_size(output, std::array{output::Size{}, output::Size{1280, 720}}), (output::Size{2560, 720}));
  EXPECT_EQ(picture_size(output, std::array{output::Size{}, output::Size{}}), output::Size{});
  output.windows = {{.rotation_deg = 90}};
  EXPECT_EQ(picture_size(output, std::array{output::Size{1920, 1080}}), (output::Size{1080, 1920}));
  output.windows = {{.crop = {0, 0, 0.333333, 1}}};
  EXPECT_EQ(picture_size(output, std::array{output::Size{1920, 1080}}), (output::Size{5760, 1080}));
  output.size = output::Size{640, 360};
  EXPECT_EQ(picture_size(output, std::array{output::Size{1920, 1080}}), (output::Size{640, 360}));
}

}  // namespace
}  // namespace yuragi::viewer::wall
