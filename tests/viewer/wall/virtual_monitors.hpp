#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/viewer/x_server.hpp"

namespace yuragi::viewer {

/// An X server with virtual monitors, DUMMY0 to DUMMY15, which come and go by RandR as real ones do (Xorg with its
/// driver `dummy`; Xvfb has only one). Xorg wants to be root.
class VirtualMonitors : public XServer {
 public:
  /// `folder`: for its files; must outlive this.
  explicit VirtualMonitors(const std::filesystem::path& folder);

  /// xrandr with these words: "--output DUMMY1 --off". False where it fails.
  bool arrange(std::vector<std::string> words) const;

 private:
  bool xrandr(std::vector<std::string> words) const;
};

}  // namespace yuragi::viewer
