#include "engine/output/output.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "engine/base/fields.hpp"

namespace yuragi::output {
namespace {

constexpr double kFarthestCorner = 1.0;  // beyond the monitor, in monitors: a projection can be larger than the monitor
constexpr double kMinCrop = 0.001;
constexpr double kFarthestPlace_m = 1000.0;
constexpr double kMinSide_m = 0.01;      // of a screen; also the minimum distance to the eye
constexpr double kMinSquareness = 0.01;  // the most cosine between a screen's sides

/// Numbers separated by spaces or commas. Nullopt if they are not `count` finite ones.
std::optional<std::vector<double>> read_numbers(std::string_view text, std::size_t count) {
  constexpr std::string_view kBetween = " ,\t";
  std::vector<double> numbers;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kBetween), text.size()));
    if (text.empty()) break;
    const std::string_view word = text.substr(0, text.find_first_of(kBetween));
    double number = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(number)) return std::nullopt;
    if (numbers.size() == count) return std::nullopt;
    numbers.push_back(number);
    text.remove_prefix(word.size());
  }
  if (numbers.size() != count) return std::nullopt;
  return numbers;
}

Failure refused(std::string_view text, std::string_view allowed) {
  return {"is \"" + std::string(text) + "\"; allowed: " + std::string(allowed)};
}

Result<Size, Failure> read_size(std::string_view text) {
  const Failure refusal = refused(text, "WIDTHxHEIGHT in pixels, 16 to 16384, such as \"3840x1080\"");
  Size size;
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width_px);
  if (width.ec != std::errc{} || width.ptr == end || *width.ptr != 'x') return refusal;
  const auto height = std::from_chars(width.ptr + 1, end, size.height_px);
  const auto is_possible = [](int side_px) { return side_px >= 16 && side_px <= kMaxSide_px; };
  if (height.ec != std::errc{} || height.ptr != end) return refusal;
  if (!is_possible(size.width_px) || !is_possible(size.height_px)) return refusal;
  return size;
}

Result<Crop, Failure> read_crop(std::string_view text) {
  const Failure refusal = refused(text, "X Y WIDTH HEIGHT within the picture, from 0 to 1, such as \"0.5 0 0.5 1\"");
  const auto numbers = read_numbers(text, 4);
  if (!numbers) return refusal;
  const Crop crop{.x = (*numbers)[0], .y = (*numbers)[1], .width = (*numbers)[2], .height = (*numbers)[3]};
  constexpr double kRounding = 1e-6;
  const bool is_inside = crop.x >= 0.0 && crop.y >= 0.0 && crop.width >= kMinCrop && crop.height >= kMinCrop &&
                         crop.x + crop.width <= 1.0 + kRounding && crop.y + crop.height <= 1.0 + kRounding;
  if (!is_inside) return refusal;
  return crop;
}

/// Corners go around clockwise, and each is convex: otherwise the picture would be mirrored, or lie over itself.
Result<Corners, Failure> read_corners(std::string_view text) {
  const Failure refusal =
      refused(text,
              "X Y of upper left, upper right, lower right, lower left, each corner convex, from -1 to 2, such as "
              "\"0 0 1 0 1 1 0 1\"");
  const auto numbers = read_numbers(text, 8);
  if (!numbers) return refusal;
  Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners.at(i) = {.x = numbers->at(2 * i), .y = numbers->at(2 * i + 1)};
    const auto is_near = [](double part) { return part >= -kFarthestCorner && part <= 1.0 + kFarthestCorner; };
    if (!is_near(corners.at(i).x) || !is_near(corners.at(i).y)) return refusal;
  }
  constexpr double kMinTurn = 1e-4;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Place& before = corners.at(i);
    const Place& at = corners.at((i + 1) % 4);
    const Place& after = corners.at((i + 2) % 4);
    const double turn = (at.x - before.x) * (after.y - at.y) - (at.y - before.y) * (after.x - at.x);
    if (turn < kMinTurn) return refusal;
  }
  return corners;
}

Result<int, Failure> quarter_turns(std::int64_t degrees) {
  if (degrees % 90 != 0) return Failure{"is " + std::to_string(degrees) + "; allowed: 0, 90, 180, 270"};
  return static_cast<int>(degrees);
}

Result<RoomPlace, Failure> read_place(std::string_view text) {
  const auto numbers = read_numbers(text, 3);
  const auto is_far = [](double number_m) { return std::abs(number_m) > kFarthestPlace_m; };
  if (!numbers || std::ranges::any_of(*numbers, is_far)) {
    return refused(text, "X Y Z in meters, such as \"-1.2 0.8 0\"");
  }
  return RoomPlace{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

double dot(const RoomPlace& a, const RoomPlace& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
RoomPlace between(const RoomPlace& from, const RoomPlace& to) {
  return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
}

/// Returns the error in a screen, if any.
std::optional<ParameterError> mistake_of(const Screen& screen) {
  const RoomPlace right = between(screen.lower_left_m, screen.lower_right_m);
  const RoomPlace up = between(screen.lower_left_m, screen.upper_left_m);
  const double width_m = std::sqrt(dot(right, right));
  const double height_m = std::sqrt(dot(up, up));
  if (width_m < kMinSide_m || height_m < kMinSide_m) {
    return ParameterError{"screen_lower_right", "gives a screen without area; measure the corners again"};
  }
  if (std::abs(dot(right, up)) > kMinSquareness * width_m * height_m) {
    return ParameterError{"screen_upper_left", "does not form a rectangle with the other corners; measure them again"};
  }
  const RoomPlace to_front{right[1] * up[2] - right[2] * up[1], right[2] * up[0] - right[0] * up[2],
                           right[0] * up[1] - right[1] * up[0]};
  if (dot(to_front, between(screen.lower_left_m, screen.eye_m)) < kMinSide_m * width_m * height_m) {
    return ParameterError{"eye",
                          "is behind the screen or in its plane; seen from the front the lower left corner is on the "
                          "left, and the axes are right-handed"};
  }
  return std::nullopt;
}

/// The keys of an [[output]].
struct Keys {
  std::optional<Size> size;
  int refreshes = 1;
  std::optional<double> delay_s;
  std::optional<RoomPlace> lower_left_m, lower_right_m, upper_left_m, eye_m;
};

const Fields<Keys>& output_fields() {
  static const Fields<Keys> kFields{
      {{.name = "size",
        .default_value = std::string(),
        .help = "Pixels of the whole picture, WIDTHxHEIGHT, of which each window shows its crop",
        .left_out = "the size of its windows, so that each pixel of the picture is one of a monitor"},
       &Keys::size,
       read_size},
      {{.name = "refreshes",
        .default_value = std::int64_t{1},
        .min = 1,
        .max = 4,
        .help = "Refreshes of the display for each picture: 2 gives an even 30 pictures a second on a display of 60 "
                "Hz, for a machine that is too slow for 60"},
       &Keys::refreshes},
      {{.name = "delay",
        .unit = "s",
        .default_value = 0.0,
        .min = kMinDelay_s,
        .max = kMaxDelay_s,
        .help = "For a wall of several machines: each moment is shown so long after its UTC, on every screen at the "
                "same time. More than the network's longest delay and two frames; the clocks of all machines must be "
                "set by one time server",
        .left_out = "each viewer is as little behind as its network allows"},
       &Keys::delay_s},
      {{.name = "screen_lower_left",
        .default_value = std::string(),
        .help =
            "For a picture that is right for somebody at a fixed place, as if the screen were a window: X Y Z of its "
            "lower left corner, in meters, in any axes of the room. The camera stands where the eye is, and looks at "
            "right angles to the screen",
        .left_out = "the field of view is the camera's"},
       &Keys::lower_left_m,
       read_place},
      {{.name = "screen_lower_right",
        .default_value = std::string(),
        .help = "X Y Z of its lower right corner",
        .left_out = "as above"},
       &Keys::lower_right_m,
       read_place},
      {{.name = "screen_upper_left",
        .default_value = std::string(),
        .help = "X Y Z of its upper left corner",
        .left_out = "as above"},
       &Keys::upper_left_m,
       read_place},
      {{.name = "eye", .default_value = std::string(), .help = "X Y Z of the eye", .left_out = "as above"},
       &Keys::eye_m,
       read_place},
  };
  return kFields;
}

auto of(auto member) {
  return member_of(&Window::blend, member);
}

const Fields<Window>& window_fields() {
  static const Fields<Window> kFields{
      {{.name = "monitor",
        .default_value = std::string(),
        .help = "The monitor that it fills: its name, such as \"HDMI-1\", or its number, from \"0\" on; `yuragi-viewer "
                "--list-monitors` lists them",
        .left_out = "the primary one"},
       &Window::monitor},
      {{.name = "crop",
        .default_value = std::string("0 0 1 1"),
        .help = "The part of the picture that it shows: X Y of the upper left corner, WIDTH, HEIGHT, as parts of the "
                "picture's width and height. \"0.5 0 0.5 1\" is the right half"},
       &Window::crop,
       read_crop},
      {{.name = "rotation",
        .unit = "deg",
        .default_value = std::int64_t{0},
        .min = 0,
        .max = 270,
        .help = "How far the picture is turned clockwise on the monitor: 0, 90, 180 or 270. 90 is for a monitor that "
                "hangs with its right side up"},
       &Window::rotation_deg,
       quarter_turns},
      {{.name = "corners",
        .default_value = std::string("0 0 1 0 1 1 0 1"),
        .help = "Where its corners are on the monitor, as X Y of upper left, upper right, lower right, lower left, as "
                "parts "
                "of the monitor's width and height as one sees them: straightens what a projector throws aslant. See "
                "`yuragi-viewer --test-card`"},
       &Window::corners,
       read_corners},
      {{.name = "blend_left",
        .default_value = 0.0,
        .min = 0.0,
        .max = 1.0,
        .help = "Width of the strip at this side that another projector shows, too, as a part of the picture's width: "
                "the picture fades out in it"},
       of(&Sides::left)},
      {{.name = "blend_right", .default_value = 0.0, .min = 0.0, .max = 1.0, .help = "The same"}, of(&Sides::right)},
      {{.name = "blend_top",
        .default_value = 0.0,
        .min = 0.0,
        .max = 1.0,
        .help = "The same, as part of the picture's height"},
       of(&Sides::top)},
      {{.name = "blend_bottom", .default_value = 0.0, .min = 0.0, .max = 1.0, .help = "The same"}, of(&Sides::bottom)},
      {{.name = "gamma",
        .default_value = 2.2,
        .min = 1.0,
        .max = 4.0,
        .help = "The projector's gamma, for the blend: less if the strip is too bright, more if it is too dark"},
       &Window::gamma},
  };
  return kFields;
}

Result<std::optional<Screen>, ParameterError> screen_of(const Keys& keys) {
  const std::array<std::pair<const char*, const std::optional<RoomPlace>*>, 4> places{
      {{"screen_lower_left", &keys.lower_left_m},
       {"screen_lower_right", &keys.lower_right_m},
       {"screen_upper_left", &keys.upper_left_m},
       {"eye", &keys.eye_m}}};
  const auto is_given = [](const auto& place) { return place.second->has_value(); };
  if (std::ranges::none_of(places, is_given)) return std::optional<Screen>();
  const auto missing = std::ranges::find_if_not(places, is_given);
  if (missing != places.end()) {
    return ParameterError{missing->first,
                          "is missing; a screen takes screen_lower_left, screen_lower_right, screen_upper_left "
                          "and eye"};
  }
  const Screen screen{.lower_left_m = *keys.lower_left_m,
                      .lower_right_m = *keys.lower_right_m,
                      .upper_left_m = *keys.upper_left_m,
                      .eye_m = *keys.eye_m};
  if (auto mistake = mistake_of(screen)) return *mistake;
  return std::optional(screen);
}

}  // namespace

std::span<const Parameter> output_parameters() {
  return output_fields().parameters();
}
std::span<const Parameter> window_parameters() {
  return window_fields().parameters();
}

Result<Output, ParameterError> output_of(std::string name, const ParameterValues& values) {
  Keys keys;
  const std::vector<ParameterError> errors = output_fields().fill(keys, values.all());
  if (!errors.empty()) return errors.front();
  auto screen = screen_of(keys);
  if (!screen) return screen.error();
  return Output{.name = std::move(name),
                .size = keys.size,
                .refreshes = keys.refreshes,
                .delay_s = keys.delay_s,
                .screen = *screen};
}

Result<Window, ParameterError> window_of(const ParameterValues& values) {
  Window window;
  const std::vector<ParameterError> errors = window_fields().fill(window, values.all());
  if (!errors.empty()) return errors.front();
  const auto exceeds = [](double one, double other, double all) { return one + other > all + 1e-6; };
  if (exceeds(window.blend.left, window.blend.right, window.crop.width)) {
    return ParameterError{"blend_right", "is too broad: with blend_left it is more than the crop's width"};
  }
  if (exceeds(window.blend.top, window.blend.bottom, window.crop.height)) {
    return ParameterError{"blend_bottom", "is too broad: with blend_top it is more than the crop's height"};
  }
  return window;
}

}  // namespace yuragi::output
