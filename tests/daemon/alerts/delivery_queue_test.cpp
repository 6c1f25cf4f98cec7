#include "daemon/alerts/delivery_queue.hpp"

#include <chrono>
#include <future>
#include <optional>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::alerts {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto kHang = 60s;  // so long waits only who waits for something that hangs

News news_of(std::string alert, bool has_begun = true) {
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

std::string text_of(const News& news) {
  return news.alert + (news.has_begun ? " began" : " ended");
}

DeliveryQueue::Calls failing(Log& log) {
  return {.deliver = [](const News&, const std::stop_token&) -> Result<void, Failure> { return Failure{"no"}; },
          .report = [&log](std::string_view, std::string_view what) { log.add(std::string(what)); },
          .settle = [&log](const News& news) { log.add("settled: " + news.alert); }};
}

TEST(DeliveryQueue, DeliversInOrder) {
  Log log;
  DeliveryQueue queue({.deliver = [&](const News& news, const std::stop_token&) -> Result<void, Failure> {
                         log.add(text_of(news));
                         return {};
                       },
                       .report = [](auto, auto) {},
                       .settle = [&](const News& news) { log.add("settled: " + text_of(news)); }},
                      {});
  queue.push(news_of("a"));
  queue.push(news_of("a", false));
  EXPECT_THAT(log.wait_for(4), ElementsAre("a began", "settled: a began", "a ended", "settled: a ended"));
}

TEST(DeliveryQueue, TriesAgainAndLetsNoEndOvertakeItsBeginning) {
  Log log;
  int failures = 3;
  DeliveryQueue queue(
      {.deliver = [&](const News& news, const std::stop_token&) -> Result<void, Failure> {
         if (failures-- > 0) return Failure{"nobody is there"};
         log.add(text_of(news));
         return {};
       },
       .report = [&](std::string_view alert,
                     std::string_view what) { log.add(std::string(alert) + ": " + std::string(what)); }},
      {.first = 1ms, .longest = 2ms, .give_up = 1h});
  queue.push(news_of("a"));
  queue.push(news_of("a", false));
  const auto lines = log.wait_for(4);
  EXPECT_THAT(lines,
              ElementsAre("a: nobody is there; it is tried again", "a began", "a: was sent after all", "a ended"));
}

TEST(DeliveryQueue, TriesOnceWhereThatIsAsked) {
  Log log;
  DeliveryQueue queue(failing(log), {});
  queue.push(news_of("a"));
  queue.push(news_of("b"));
  EXPECT_THAT(log.wait_for(4), ElementsAre("no", "settled: a", "no", "settled: b"));
}

TEST(DeliveryQueue, AnExceptionIsAFailure) {
  Log log;
  auto calls = failing(log);
  calls.deliver = [](const News&, const std::stop_token&) -> Result<void, Failure> {
    throw std::runtime_error("no memory");
  };
  DeliveryQueue queue(calls, {});
  queue.push(news_of("a"));
  EXPECT_THAT(log.wait_for(2), ElementsAre("no memory", "settled: a"));
}

TEST(DeliveryQueue, HoldsOnlySoMany) {
  Log log;
  std::promise<void> is_busy;
  std::promise<void> may_go_on;
  bool is_first = true;
  auto calls = failing(log);
  calls.deliver = [&](const News& news, const std::stop_token&) -> Result<void, Failure> {
    if (std::exchange(is_first, false)) {
      is_busy.set_value();
      may_go_on.get_future().wait();
    }
    log.add(news.alert);
    return {};
  };
  DeliveryQueue queue(calls, {});
  queue.push(news_of("first"));
  is_busy.get_future().wait();
  for (std::size_t i = 0; i < DeliveryQueue::kMaxWaiting + 3; ++i) queue.push(news_of(std::to_string(i)));
  EXPECT_THAT(log.wait_for(3), ElementsAre("settled: 0", "settled: 1", "settled: 2")) << "the oldest gave way";
  EXPECT_FALSE(queue.is_idle());
  may_go_on.set_value();
  const auto lines = log.wait_for(7);
  EXPECT_EQ(lines[3], "first");
  EXPECT_THAT(lines[5], HasSubstr("3 messages not sent"));
  EXPECT_EQ(lines[6], "3");
}

TEST(DeliveryQueue, ItsEndWaitsForNoRetryAndSettlesNothing) {
  Log log;
  std::optional<DeliveryQueue> queue;
  queue.emplace(failing(log), RetryTimes{.first = 1h, .longest = 1h, .give_up = 24h});
  queue->push(news_of("a"));
  log.wait_for(1);
  // Those that come while it waits to try again do not end that (thread sanitizer: push() beside the wait).
  for (int i = 0; i < 40; ++i) queue->push(news_of("b"));
  queue.reset();  // the test would hang
  EXPECT_THAT(log.wait_for(1), ElementsAre(HasSubstr("it is tried again")));
}

}  // namespace
}  // namespace yuragi::daemon::alerts
