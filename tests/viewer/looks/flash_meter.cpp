#include "tests/viewer/looks/flash_meter.hpp"

#include <algorithm>
#include <cmath>

namespace yuragi::viewer {
namespace {

constexpr float kChange = 0.1F;
constexpr float kBrightest = 0.8F;
constexpr float kRedChange = 20.0F / 320.0F;
constexpr double kShare = 0.25;
constexpr double kSecond_s = 1.0 - 1e-6;  // times are rounded

float linear(std::uint8_t value) {
  static const std::array<float, 256> kTable = [] {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
      const double c = static_cast<double>(i) / 255.0;
      table[i] = static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    return table;
  }();
  return kTable[value];
}

}  // namespace

void FlashCounter::add(float value, double time_s, bool is_marked) {
  if (value < low_) {
    low_ = value;
    is_low_marked_ = is_marked;
  }
  if (value > high_) {
    high_ = value;
    is_high_marked_ = is_marked;
  }
  const bool is_up = way_ <= 0 && value - low_ >= change_ && low_ < brightest_ && (is_marked || is_low_marked_);
  const bool is_down = way_ >= 0 && high_ - value >= change_ && value < brightest_ && (is_marked || is_high_marked_);
  if (!is_up && !is_down) return;
  way_ = is_up ? 1 : -1;
  low_ = high_ = value;
  is_low_marked_ = is_high_marked_ = is_marked;
  times_s_[changes_ % times_s_.size()] = time_s;
  ++changes_;
  if (changes_ >= times_s_.size() && time_s - times_s_[changes_ % times_s_.size()] < kSecond_s) too_much_s_ = time_s;
}

FlashMeter::FlashMeter(int width_px, int height_px)
    : width_px_(static_cast<std::size_t>(width_px)),
      height_px_(static_cast<std::size_t>(height_px)),
      field_width_px_(width_px_ * 341 / 1024),
      field_height_px_(height_px_ * 256 / 768),
      general_(width_px_ * height_px_, FlashCounter(kChange, kBrightest)),
      red_(width_px_ * height_px_, FlashCounter(kRedChange, 1e9F)),
      luminance_(width_px_ * height_px_) {}

void FlashMeter::add(std::span<const std::uint8_t> rgb, double time_s) {
  for (std::size_t i = 0; i < luminance_.size(); ++i) {
    const float red = linear(rgb[3 * i]);
    const float green = linear(rgb[3 * i + 1]);
    const float blue = linear(rgb[3 * i + 2]);
    luminance_[i] = 0.2126F * red + 0.7152F * green + 0.0722F * blue;
    general_[i].add(luminance_[i], time_s);
    red_[i].add(std::max(red - green - blue, 0.0F), time_s, red >= 0.8F * (red + green + blue));
  }
  const std::vector<double> means = field_means([this](std::size_t i) { return luminance_[i]; });
  if (fields_.empty()) fields_.assign(means.size(), FlashCounter(static_cast<float>(kShare) * kChange, kBrightest));
  for (std::size_t i = 0; i < means.size(); ++i) {
    fields_[i].add(static_cast<float>(means[i]), time_s);
    has_field_that_flashes_ = has_field_that_flashes_ || fields_[i].is_too_much(time_s);
  }
  general_share_ = std::max(general_share_, largest_share(general_, time_s));
  red_share_ = std::max(red_share_, largest_share(red_, time_s));
}

double FlashMeter::largest_share(const std::vector<FlashCounter>& pixels, double time_s) const {
  const std::vector<double> shares =
      field_means([&](std::size_t i) { return pixels[i].is_too_much(time_s) ? 1.0 : 0.0; });
  return *std::ranges::max_element(shares);
}

template <class Value>
std::vector<double> FlashMeter::field_means(const Value& value_of) const {
  // sums[y][x]: of all pixels above and to the left of it.
  std::vector<double> sums((width_px_ + 1) * (height_px_ + 1));
  const auto at = [&](std::size_t x, std::size_t y) -> double& { return sums[y * (width_px_ + 1) + x]; };
  for (std::size_t y = 0; y < height_px_; ++y) {
    for (std::size_t x = 0; x < width_px_; ++x) {
      at(x + 1, y + 1) = at(x, y + 1) + at(x + 1, y) - at(x, y) + static_cast<double>(value_of(y * width_px_ + x));
    }
  }
  std::vector<double> means;
  const auto area = static_cast<double>(field_width_px_ * field_height_px_);
  for (std::size_t y = 0; y + field_height_px_ <= height_px_; ++y) {
    for (std::size_t x = 0; x + field_width_px_ <= width_px_; ++x) {
      const std::size_t right = x + field_width_px_;
      const std::size_t low = y + field_height_px_;
      means.push_back((at(right, low) - at(x, low) - at(right, y) + at(x, y)) / area);
    }
  }
  return means;
}

}  // namespace yuragi::viewer
