#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace yuragi::viewer {

/// A real X server with virtual monitors, DUMMY0 to DUMMY15, which come and go by RandR as real ones do (Xorg with its
/// driver `dummy`; Xvfb has only one). Its desktop is white, so that what a viewer leaves uncovered is seen. Xorg wants
/// to be root.
class VirtualMonitors {
 public:
  /// `folder`: for its files; must outlive this.
  explicit VirtualMonitors(const std::filesystem::path& folder);
  ~VirtualMonitors();
  VirtualMonitors(const VirtualMonitors&) = delete;
  VirtualMonitors& operator=(const VirtualMonitors&) = delete;

  bool is_there() const { return !number_.empty(); }

  /// xrandr with these words: "--output DUMMY1 --off". False where it fails.
  bool arrange(std::vector<std::string> words) const;

  /// Our own environment, and DISPLAY.
  std::vector<std::string> environment() const;

  struct Pixels {
    int width_px = 0;
    int height_px = 0;
    std::vector<std::uint32_t> rows;  ///< 0xRRGGBB, from the top down

    std::uint32_t at(int x, int y) const {
      return rows[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x)];
    }
  };
  /// What all monitors show at this moment, as one picture.
  Pixels pixels() const;

 private:
  bool xrandr(std::vector<std::string> words) const;

  std::filesystem::path folder_;
  pid_t server_ = 0;
  std::string number_;
};

}  // namespace yuragi::viewer
