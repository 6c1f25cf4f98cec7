#pragma once

#include <memory>
#include <vector>

#include "daemon/feeds/feed.hpp"
#include "daemon/feeds/surroundings.hpp"
#include "daemon/settings/feeds/feeds.hpp"
#include "daemon/values/moment.hpp"

namespace yuragi::daemon::feeds {

/// All feeds of an installation, on a thread of their own: publish() hands a pointer over and goes on. If the thread is
/// late, older moments are lost. The thread starts when the first feed is configured. Thread-safe: no; all calls come
/// from the I/O thread.
class Feeds {
 public:
  explicit Feeds(const settings::feeds::Config& config, Surroundings around = {});
  /// Sends what has to be sent last, for at most a second.
  ~Feeds();
  Feeds(const Feeds&) = delete;
  Feeds& operator=(const Feeds&) = delete;

  /// Is anything sent?
  bool is_empty() const noexcept;

  void publish(std::shared_ptr<const values::Moment> moment);

  /// Feeds whose configuration is the same go on; the others end, and new ones begin.
  void change(const settings::feeds::Config& config);

  /// As of at most half a second ago.
  std::vector<Status> status() const;

 private:
  class Thread;
  struct Gate;
  Surroundings around_;
  std::shared_ptr<Gate> gate_;
  std::unique_ptr<Thread> thread_;  ///< null: nothing is configured
};

}  // namespace yuragi::daemon::feeds
