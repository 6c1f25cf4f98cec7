#pragma once

#include <optional>

#include "viewer/window.hpp"

namespace yuragi::viewer {

/// One black picture is like the next: while all is black only the first is shown, and another now and then for a
/// monitor that has come back. Pure: time is a parameter. Thread-safe: no.
class BlackRest {
 public:
  static constexpr double kAgain_s = 0.5;

  /// Before each picture: may it be left out, since the monitors show the same already?
  bool may_rest(bool is_black, const PixelSize& size, double now_s) {
    if (is_black && shown_s_ && size == size_ && now_s - *shown_s_ < kAgain_s) return true;
    shown_s_ = is_black ? std::optional(now_s) : std::nullopt;
    size_ = size;
    return false;
  }

 private:
  std::optional<double> shown_s_;  // when the last picture was shown, if it was black
  PixelSize size_;
};

}  // namespace yuragi::viewer
