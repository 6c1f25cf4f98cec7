#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string_view>
#include <thread>

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

/// Delivers the news of one alert by one way, in their order, on a thread of its own: only later news of the same alert
/// waits for a slow or repeated delivery. Its destructor drops waiting news. Thread-safe: yes.
class DeliveryQueue {
 public:
  struct Calls {
    /// Called on the queue's thread. May wait, but not for long after a stop was requested.
    std::function<Result<void, Failure>(const News&, const std::stop_token&)> deliver;
    /// Called on the queue's thread with the alert's name and a sentence. Must not throw.
    std::function<void(std::string_view alert, std::string_view what)> report;
    /// Called when news is delivered or given up, except when the queue ends. Must not throw.
    std::function<void(const News&)> settle = [](const News&) {};
  };

  /// Drops the oldest if too many wait.
  static constexpr std::size_t kMaxWaiting = 64;

  DeliveryQueue(Calls calls, const RetryTimes& times);
  ~DeliveryQueue();
  DeliveryQueue(const DeliveryQueue&) = delete;
  DeliveryQueue& operator=(const DeliveryQueue&) = delete;

  /// Does not wait.
  void push(News news);

  /// Returns true if nothing waits and nothing is being delivered.
  bool is_idle() const;

  /// Ends the thread soon; the destructor waits for that.
  void request_stop() { thread_.request_stop(); }

 private:
  void work(const std::stop_token& stop);
  /// Tries until it is delivered, given up, or a stop is requested.
  void deliver(const News& news, const std::stop_token& stop);
  Result<void, Failure> try_once(const News& news, const std::stop_token& stop) const;

  Calls calls_;
  RetryTimes times_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<News> waiting_;
  bool is_delivering_ = false;
  std::size_t given_up_ = 0;  ///< because there was no room; not yet reported
  std::jthread thread_;
};

}  // namespace yuragi::daemon::alerts
