#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "daemon/alerts/alert_news.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::alerts {

/// When a delivery that has failed is tried again.
struct RetryTimes {
  Nanoseconds first{0};    ///< then twice as long each time, ...
  Nanoseconds longest{0};  ///< ... up to this
  Nanoseconds give_up{0};  ///< no more, counted from the first try; 0: there is only one
};

/// Delivers news on a thread of its own, so that nobody waits for whom they are for. Those of one alert go in their
/// order: the end does not overtake a beginning that is tried again. Its end gives up what waits. Thread-safe: push().
class DeliveryQueue {
 public:
  /// Called on the queue's thread. May wait, but not for long after a stop was requested.
  using Deliver = std::function<Result<void, Failure>(const AlertNews&, const std::stop_token&)>;
  /// Called on the queue's thread with the alert's name and a sentence. Must not throw.
  using Report = std::function<void(std::string_view alert, std::string_view what)>;

  /// The oldest gives way where more would wait.
  static constexpr std::size_t kMostWaiting = 200;

  DeliveryQueue(Deliver deliver, Report report, const RetryTimes& times);
  ~DeliveryQueue();
  DeliveryQueue(const DeliveryQueue&) = delete;
  DeliveryQueue& operator=(const DeliveryQueue&) = delete;

  /// Does not wait.
  void push(AlertNews news);

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    AlertNews news;
    Clock::time_point first_try{};
    Clock::time_point due{};
    Nanoseconds pause{0};  ///< before the last try; 0: there was none yet
  };

  void work(const std::stop_token& stop);
  /// The one to try soonest: the first of its alert. end() where none waits.
  std::vector<Waiting>::iterator soonest();
  /// Nothing is left of it, or it is to wait for its next try.
  bool is_done(Waiting& one, const std::stop_token& stop);

  Deliver deliver_;
  Report report_;
  RetryTimes times_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::vector<Waiting> waiting_;  ///< in the order of their push
  bool has_changed_ = false;
  std::size_t given_up_ = 0;  ///< for want of room, not yet reported
  std::jthread thread_;
};

}  // namespace yuragi::daemon::alerts
