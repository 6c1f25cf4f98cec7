#include "daemon/alerts/delivery_queue.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "engine/base/contain.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::alerts {

DeliveryQueue::DeliveryQueue(Deliver deliver, Report report, const RetryTimes& times)
    : deliver_(std::move(deliver)),
      report_(std::move(report)),
      times_(times),
      thread_([this](const std::stop_token& stop) { contain("delivering alerts", [&] { work(stop); }); }) {}

DeliveryQueue::~DeliveryQueue() = default;

void DeliveryQueue::push(AlertNews news) {
  const auto now = Clock::now();
  const std::lock_guard lock(mutex_);
  if (waiting_.size() == kMostWaiting) {
    waiting_.erase(waiting_.begin());
    ++given_up_;
  }
  waiting_.push_back({.news = std::move(news), .first_try = now, .due = now});
  has_changed_ = true;
  changed_.notify_one();
}

std::vector<DeliveryQueue::Waiting>::iterator DeliveryQueue::soonest() {
  auto found = waiting_.end();
  for (auto one = waiting_.begin(); one != waiting_.end(); ++one) {
    const auto is_of_same = [&](const Waiting& other) { return other.news.alert == one->news.alert; };
    const bool is_first = std::find_if(waiting_.begin(), one, is_of_same) == one;
    if (is_first && (found == waiting_.end() || one->due < found->due)) found = one;
  }
  return found;
}

void DeliveryQueue::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    has_changed_ = false;
    if (const std::size_t count = std::exchange(given_up_, 0); count > 0) {
      report_({}, fmt::format("{} not told: too many wait", count_text(count, "alert")));
    }
    const auto next = soonest();
    if (next == waiting_.end()) {
      changed_.wait(lock, stop, [this] { return has_changed_; });
      continue;
    }
    // A copy: it is read without the lock while it is waited for, and push() moves those that wait.
    if (const auto due = next->due; due > Clock::now()) {
      changed_.wait_until(lock, stop, due, [this] { return has_changed_; });
      continue;
    }
    Waiting one = std::move(*next);
    waiting_.erase(next);
    lock.unlock();
    const bool done = is_done(one, stop);
    lock.lock();
    // In front of those of its alert that came after it.
    if (!done) waiting_.insert(waiting_.begin(), std::move(one));
  }
}

bool DeliveryQueue::is_done(Waiting& one, const std::stop_token& stop) {
  Result<void, Failure> delivered = Failure{"delivering it failed, which is a fault of the program"};
  contain("delivering an alert", [&] { delivered = deliver_(one.news, stop); });
  const bool is_first_try = one.pause == Nanoseconds::zero();
  if (delivered) {
    if (!is_first_try) report_(one.news.alert, "was told at last");
    return true;
  }
  if (stop.stop_requested()) return true;
  const std::string& why = delivered.error().message;
  one.pause = is_first_try ? times_.first : std::min(2 * one.pause, times_.longest);
  one.due = Clock::now() + one.pause;
  if (one.due - one.first_try > times_.give_up) {
    report_(one.news.alert, why);
    return true;
  }
  if (is_first_try) report_(one.news.alert, why + "; it is tried again");
  return false;
}

}  // namespace yuragi::daemon::alerts
