#pragma once

#include <optional>
#include <string_view>

namespace yuragi::viewer::picture {

/// A camera's position, from the text "HEADING,PITCH,DISTANCE".
struct CameraView {
  double heading_deg = 0.0;
  double pitch_deg = 0.0;
  double distance_m = 0.0;
};
std::optional<CameraView> read_camera_view(std::string_view text);

}  // namespace yuragi::viewer::picture
