#pragma once

#include <functional>
#include <string>

namespace yuragi::daemon::feeds {

/// What feeds get of the daemon besides moments.
struct Surroundings {
  std::string page_url = {};     ///< of the page; empty: there is none
  std::string page_listen = {};  ///< where it listens, ADDRESS:PORT; empty: there is none
  /// Shows or hides a scene, for feeds that take commands; called on their thread. Empty: no scene can be.
  std::function<void(const std::string& scene, bool shown)> show_scene = {};
};

}  // namespace yuragi::daemon::feeds
