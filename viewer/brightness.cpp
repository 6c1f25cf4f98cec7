#include "viewer/brightness.hpp"

#include <algorithm>

namespace yuragi::viewer {
namespace {

constexpr double kDarkest = 1.0 / 512;  // less than a step of a pixel's value

}  // namespace

void Brightness::advance(double wanted, double passed_s) {
  value_ += std::clamp(passed_s / kTime_s, 0.0, 1.0) * (wanted - value_);
  if (wanted == 0.0 && value_ < kDarkest) value_ = 0.0;
}

}  // namespace yuragi::viewer
