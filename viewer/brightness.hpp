#pragma once

namespace yuragi::viewer {

/// How bright the picture is, 0 (black) to 1, on its way to what is wanted: it never jumps. Pure: time is a parameter.
/// Thread-safe: no.
class Brightness {
 public:
  /// It goes most of the way in this time: the daemon says twice a second how bright it should be.
  static constexpr double kTime_s = 0.5;

  explicit Brightness(double value) : value_(value) {}

  void advance(double wanted, double passed_s);

  double value() const { return value_; }

 private:
  double value_;
};

}  // namespace yuragi::viewer
