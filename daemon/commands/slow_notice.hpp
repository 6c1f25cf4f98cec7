#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "engine/base/contain.hpp"

namespace yuragi::daemon::commands {

/// Prints a line on standard error if the announced work takes longer than a second: it is constructed before the work,
/// and destroyed after it. A person then knows the reason for the wait. Prints nothing if no thread can be started.
class SlowNotice {
 public:
  explicit SlowNotice(std::string text) {
    contain("starting a notice of slow work", [&] {
      thread_ = std::jthread([this, text = std::move(text)](const std::stop_token& stop) {
        contain("a notice of slow work", [&] {
          std::unique_lock lock(mutex_);
          ended_.wait_for(lock, stop, kPatience, [] { return false; });
          if (!stop.stop_requested()) fmt::print(stderr, "{}\n", text);
        });
      });
    });
  }
  SlowNotice(const SlowNotice&) = delete;
  SlowNotice& operator=(const SlowNotice&) = delete;

 private:
  static constexpr auto kPatience = std::chrono::seconds(1);

  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace yuragi::daemon::commands
