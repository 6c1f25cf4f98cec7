#include "daemon/alerts/delivery_queue.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "engine/base/contain.hpp"
#include "engine/base/count_text.hpp"
#include "engine/platform/backoff.hpp"

namespace yuragi::daemon::alerts {

DeliveryQueue::DeliveryQueue(Calls calls, const RetryTimes& times)
    : calls_(std::move(calls)),
      times_(times),
      thread_([this](const std::stop_token& stop) { contain("delivering alerts", [&] { work(stop); }); }) {}

DeliveryQueue::~DeliveryQueue() = default;

void DeliveryQueue::push(News news) {
  std::optional<News> given_up;
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() == kMaxWaiting) {
      given_up = std::move(waiting_.front());
      waiting_.pop_front();
      ++given_up_;
    }
    waiting_.push_back(std::move(news));
    changed_.notify_one();
  }
  if (given_up) calls_.settle(*given_up);
}

bool DeliveryQueue::is_idle() const {
  const std::lock_guard lock(mutex_);
  return waiting_.empty() && !is_delivering_;
}

void DeliveryQueue::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return !waiting_.empty(); }) && !stop.stop_requested()) {
    const News news = std::move(waiting_.front());
    waiting_.pop_front();
    const std::size_t given_up = std::exchange(given_up_, 0);
    is_delivering_ = true;
    lock.unlock();
    if (given_up > 0)
      calls_.report(news.alert, fmt::format("{} not sent: too many are waiting", count_text(given_up, "message")));
    deliver(news, stop);
    lock.lock();
    is_delivering_ = false;
  }
}

void DeliveryQueue::deliver(const News& news, const std::stop_token& stop) {
  using Clock = std::chrono::steady_clock;
  const auto first_try = Clock::now();
  platform::Backoff pauses(times_.first, times_.longest, 1);
  for (bool is_first_try = true;; is_first_try = false) {
    const auto delivered = try_once(news, stop);
    if (delivered) {
      if (!is_first_try) calls_.report(news.alert, "was sent after all");
      return calls_.settle(news);
    }
    if (stop.stop_requested()) return;
    const std::string& why = delivered.error().message;
    const Nanoseconds pause = pauses.next();
    if (Clock::now() + pause - first_try > times_.give_up) {
      calls_.report(news.alert, why);
      return calls_.settle(news);
    }
    if (is_first_try) calls_.report(news.alert, why + "; it is tried again");
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, stop, pause, [] { return false; });
    if (stop.stop_requested()) return;
  }
}

Result<void, Failure> DeliveryQueue::try_once(const News& news, const std::stop_token& stop) const {
  Result<void, Failure> delivered;
  contain(
      "delivering an alert", [&] { delivered = calls_.deliver(news, stop); },
      [&](const char* what) { delivered = Failure{what}; });
  return delivered;
}

}  // namespace yuragi::daemon::alerts
