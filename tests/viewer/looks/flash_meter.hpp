#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace yuragi::viewer {

/// How often a value goes up and down by at least `change`. A flash is two opposite changes.
class FlashCounter {
 public:
  /// Changes whose lower end is at `brightest` or above do not count, nor those neither of whose ends is marked.
  FlashCounter(float change, float brightest) : change_(change), brightest_(brightest) {}
  void add(float value, double time_s, bool is_marked = true);
  /// Did a second with more than three flashes, seven changes and more, end at most a second before this time?
  bool is_too_much(double time_s) const { return time_s - too_much_s_ < 1.0; }

 private:
  float change_, brightest_;
  float low_ = 1e9F, high_ = -1e9F;  // since the last change
  bool is_low_marked_ = false, is_high_marked_ = false;
  int way_ = 0;  // of the last change: 1 up, -1 down
  std::array<double, 7> times_s_;
  std::size_t changes_ = 0;
  double too_much_s_ = -1e9;  // when such a second last ended
};

/// Judges pictures by the general flash and red flash thresholds of WCAG 2.2 (W3C, success criterion 2.3.1), more
/// strictly than they are: flashes in the same second count as one area, whether at the same time or not.
///
///   general   relative luminance changes by 0.1 and more, the darker one below 0.80
///   red       (R - G - B) x 320 changes by more than 20, below 0 taken as 0, where R / (R + G + B) is 0.8 or more in
///   one of
///             both; R, G, B linear (the working definition of WCAG 2.0 and 2.1: G. Harding and C. Binnie 2002)
///   field     of 10 degrees: 341 x 256 of 1024 x 768 pixels, anywhere; a quarter of it (21,824 pixels) may flash
///
/// A picture is seen at the same size, however few pixels it has.
class FlashMeter {
 public:
  FlashMeter(int width_px, int height_px);
  /// sRGB, 3 bytes a pixel.
  void add(std::span<const std::uint8_t> rgb, double time_s);

  /// The largest share of any field whose pixels ever flashed more than three times in one second. 0.25 and less
  /// passes.
  double general_share() const { return general_share_; }
  double red_share() const { return red_share_; }
  /// Did any field as a whole, by a quarter of its area's change, ever flash more often than that?
  bool has_field_that_flashes() const { return has_field_that_flashes_; }

 private:
  double largest_share(const std::vector<FlashCounter>& pixels, double time_s) const;
  /// The sums over the corners of fields need no more than this: a picture's running sums.
  template <class Value>
  std::vector<double> field_means(const Value& value_of) const;

  std::size_t width_px_, height_px_, field_width_px_, field_height_px_;
  std::vector<FlashCounter> general_, red_, fields_;
  std::vector<float> luminance_;
  double general_share_ = 0.0, red_share_ = 0.0;
  bool has_field_that_flashes_ = false;
};

}  // namespace yuragi::viewer
