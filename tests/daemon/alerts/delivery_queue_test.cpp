#include "daemon/alerts/delivery_queue.hpp"

#include <chrono>
#include <future>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::alerts {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto kHang = 60s;  // so long waits only who waits for something that hangs

AlertNews news_of(std::string alert, bool has_begun = true) {
  return {.alert = std::move(alert), .has_begun = has_begun};
}

/// What was delivered or reported, in order, for a test that waits for it.
class Log {
 public:
  void add(std::string line) {
    const std::lock_guard lock(mutex_);
    lines_.push_back(std::move(line));
    changed_.notify_all();
  }
  std::vector<std::string> wait_for(std::size_t count) {
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(changed_.wait_for(lock, kHang, [&] { return lines_.size() >= count; }));
    return lines_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> lines_;
};

std::string text_of(const AlertNews& news) {
  return news.alert + (news.has_begun ? " began" : " ended");
}

TEST(DeliveryQueue, ADeliveryThatThrowsIsTriedAgainAndHoldsUpNoOther) {
  Log log;
  DeliveryQueue queue(
      [&](const AlertNews& news, const std::stop_token&) -> Result<void, Failure> {
        if (news.alert == "faulty") throw std::runtime_error("of the program");
        log.add(text_of(news));
        return {};
      },
      [&](auto alert, auto what) { log.add(std::string(alert) + ": " + std::string(what)); }, {});
  queue.push(news_of("faulty"));
  queue.push(news_of("b"));
  EXPECT_THAT(log.wait_for(2), ElementsAre(HasSubstr("faulty: delivering it failed"), "b began"));
}

TEST(DeliveryQueue, DeliversInOrder) {
  Log log;
  DeliveryQueue queue(
      [&](const AlertNews& news, const std::stop_token&) -> Result<void, Failure> {
        log.add(text_of(news));
        return {};
      },
      [](auto, auto) {}, {});
  queue.push(news_of("a"));
  queue.push(news_of("a", false));
  queue.push(news_of("b"));
  EXPECT_THAT(log.wait_for(3), ElementsAre("a began", "a ended", "b began"));
}

TEST(DeliveryQueue, TriesAgainAndLetsNoEndOvertakeItsBeginning) {
  Log log;
  int failures = 3;
  DeliveryQueue queue(
      [&](const AlertNews& news, const std::stop_token&) -> Result<void, Failure> {
        if (news.alert == "a" && failures-- > 0) return Failure{"nobody is there"};
        log.add(text_of(news));
        return {};
      },
      [&](std::string_view alert, std::string_view what) { log.add(std::string(alert) + ": " + std::string(what)); },
      {.first = 1ms, .longest = 2ms, .give_up = 1h});
  queue.push(news_of("a"));
  queue.push(news_of("a", false));
  const auto lines = log.wait_for(4);
  EXPECT_THAT(lines, ElementsAre("a: nobody is there; it is tried again", "a began", "a: was told at last", "a ended"));
}

TEST(DeliveryQueue, OthersDoNotWaitForOneThatIsTriedAgain) {
  Log log;
  DeliveryQueue queue(
      [&](const AlertNews& news, const std::stop_token&) -> Result<void, Failure> {
        if (news.alert == "a") return Failure{"nobody is there"};
        log.add(text_of(news));
        return {};
      },
      [](auto, auto) {}, {.first = 1h, .longest = 1h, .give_up = 24h});
  queue.push(news_of("a"));
  queue.push(news_of("b"));
  EXPECT_THAT(log.wait_for(1), ElementsAre("b began"));
}

/// Each that comes moves those that wait, while the thread waits until one of them is due (thread sanitizer).
TEST(DeliveryQueue, ManyComeWhileItWaitsToTryAgain) {
  Log log;
  DeliveryQueue queue([](const AlertNews&, const std::stop_token&) -> Result<void, Failure> { return Failure{"no"}; },
                      [&](std::string_view, std::string_view what) { log.add(std::string(what)); },
                      {.first = 1h, .longest = 1h, .give_up = 24h});
  for (std::size_t i = 0; i < 40; ++i) {
    queue.push(news_of(std::to_string(i)));
    log.wait_for(i + 1);
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(log.wait_for(40).size(), 40U);
}

TEST(DeliveryQueue, TriesOnceWhereThatIsAsked) {
  Log log;
  DeliveryQueue queue([](const AlertNews&, const std::stop_token&) -> Result<void, Failure> { return Failure{"no"}; },
                      [&](std::string_view, std::string_view what) { log.add(std::string(what)); }, {});
  queue.push(news_of("a"));
  queue.push(news_of("b"));
  EXPECT_THAT(log.wait_for(2), ElementsAre("no", "no"));
}

TEST(DeliveryQueue, HoldsOnlySoMany) {
  Log log;
  std::promise<void> is_busy;
  std::promise<void> may_go_on;
  bool is_first = true;
  DeliveryQueue queue(
      [&](const AlertNews& news, const std::stop_token&) -> Result<void, Failure> {
        if (std::exchange(is_first, false)) {
          is_busy.set_value();
          may_go_on.get_future().wait();
        }
        log.add(news.alert);
        return {};
      },
      [&](std::string_view, std::string_view what) { log.add(std::string(what)); }, {});
  queue.push(news_of("first"));
  is_busy.get_future().wait();
  for (std::size_t i = 0; i < DeliveryQueue::kMostWaiting + 3; ++i) queue.push(news_of(std::to_string(i)));
  may_go_on.set_value();
  const auto lines = log.wait_for(DeliveryQueue::kMostWaiting + 2);
  EXPECT_EQ(lines[0], "first");
  EXPECT_THAT(lines[1], HasSubstr("3 alerts not told"));
  EXPECT_EQ(lines[2], "3") << "the oldest gave way";
}

TEST(DeliveryQueue, ItsEndWaitsForNoRetry) {
  Log log;
  std::optional<DeliveryQueue> queue;
  queue.emplace([](const AlertNews&, const std::stop_token&) -> Result<void, Failure> { return Failure{"no"}; },
                [&](std::string_view, std::string_view what) { log.add(std::string(what)); },
                RetryTimes{.first = 1h, .longest = 1h, .give_up = 24h});
  queue->push(news_of("a"));
  log.wait_for(1);
  queue.reset();  // the test would hang
}

}  // namespace
}  // namespace yuragi::daemon::alerts
