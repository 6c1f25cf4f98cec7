#include "viewer/picture/camera_view.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>

namespace yuragi::viewer::picture {

std::optional<CameraView> read_camera_view(std::string_view text) {
  std::array<double, 3> numbers{};
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return std::nullopt;
    const auto read = std::from_chars(at, end, numbers.at(i));
    if (read.ec != std::errc{} || !std::isfinite(numbers.at(i))) return std::nullopt;
    at = read.ptr;
  }
  if (at != end) return std::nullopt;
  return CameraView{numbers[0], numbers[1], numbers[2]};
}

}  // namespace yuragi::viewer::picture
