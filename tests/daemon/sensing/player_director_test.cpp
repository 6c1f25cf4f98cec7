#include "daemon/sensing/player_director.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::sensing {
namespace {

using ::testing::HasSubstr;

/// Keeps its orders, and tells what the test wants it to.
struct NotedPlayer final : drivers::recording::Player {
  void begin_early(double) override {}
  std::optional<std::uint64_t> order(const drivers::recording::PlayerOrder& order) override {
    if (is_full) return std::nullopt;
    orders.push_back(order);
    return orders.size();
  }
  drivers::recording::PlayerReport report() const override { return reported; }

  std::vector<drivers::recording::PlayerOrder> orders;
  drivers::recording::PlayerReport reported;
  bool is_full = false;
};

class PlayerDirectorTest : public testing::Test {
 protected:
  PlayerDirector director(settings::ControlPermission control) {
    return {control, {{"roof", &roof_, [this] { ++woken_; }}, {"yard", &yard_, [this] { ++woken_; }}}};
  }

  NotedPlayer roof_, yard_;
  int woken_ = 0;
};

TEST_F(PlayerDirectorTest, GivesOrdersToTheSensorThatIsNamedOrToAll) {
  PlayerDirector here = director(settings::ControlPermission::kLoopback);
  const auto one = here.handle({.action = wire::PlayerAction::kSeek, .sensor = "yard", .place = "+30"}, true);
  EXPECT_TRUE(one.done);
  EXPECT_EQ(one.message, "yard was asked to seek to +30");
  ASSERT_EQ(one.players.size(), 1U);
  EXPECT_EQ(one.players[0].order, 1U);
  EXPECT_TRUE(roof_.orders.empty());
  ASSERT_EQ(yard_.orders.size(), 1U);
  EXPECT_EQ(yard_.orders[0].kind, drivers::recording::PlayerOrder::Kind::kSeek);
  EXPECT_EQ(yard_.orders[0].place, "+30");
  EXPECT_EQ(woken_, 1);

  const auto all = here.handle({.action = wire::PlayerAction::kStep, .count = 7}, true);
  EXPECT_EQ(all.message, "roof, yard was asked to advance by 7 readings");
  EXPECT_EQ(roof_.orders.at(0).count, 7U);
  EXPECT_EQ(yard_.orders.at(1).count, 7U);
  here.handle({.action = wire::PlayerAction::kPause}, true);
  here.handle({.action = wire::PlayerAction::kResume}, true);
  here.handle({.action = wire::PlayerAction::kRate, .rate = 0.5}, true);
  EXPECT_EQ(roof_.orders.at(1).kind, drivers::recording::PlayerOrder::Kind::kPause);
  EXPECT_EQ(roof_.orders.at(2).kind, drivers::recording::PlayerOrder::Kind::kResume);
  EXPECT_EQ(roof_.orders.at(3).rate, 0.5);
}

TEST_F(PlayerDirectorTest, TellsEveryoneHowThingsAreAndChangesNothing) {
  roof_.reported = {.file = "storm.windlog",
                    .position = drivers::windlog::PlayerPosition{.log_time = std::chrono::seconds(90),
                                                                 .length = std::chrono::seconds(3600),
                                                                 .rate = 2.0,
                                                                 .is_paused = true,
                                                                 .rounds = 3},
                    .orders_done = 4,
                    .refusal = "no"};
  const auto reply = director(settings::ControlPermission::kNobody).handle({}, false);
  EXPECT_TRUE(reply.done);
  ASSERT_EQ(reply.players.size(), 2U);
  EXPECT_EQ(reply.players[0].sensor, "roof");
  EXPECT_EQ(reply.players[0].file, "storm.windlog");
  EXPECT_EQ(reply.players[0].position_s, 90.0);
  EXPECT_EQ(reply.players[0].length_s, 3600.0);
  EXPECT_EQ(reply.players[0].rate, 2.0);
  EXPECT_TRUE(reply.players[0].is_paused);
  EXPECT_EQ(reply.players[0].rounds, 3U);
  EXPECT_EQ(reply.players[0].orders_done, 4U);
  EXPECT_EQ(reply.players[0].refusal, "no");
  EXPECT_FALSE(reply.players[1].is_open);
  EXPECT_TRUE(roof_.orders.empty());
}

TEST_F(PlayerDirectorTest, TakesOrdersOnlyFromThoseWhoMay) {
  const wire::PlayerCommand pause{.action = wire::PlayerAction::kPause};
  EXPECT_FALSE(director(settings::ControlPermission::kNobody).handle(pause, true).done);
  EXPECT_FALSE(director(settings::ControlPermission::kLoopback).handle(pause, false).done);
  EXPECT_TRUE(roof_.orders.empty());
  EXPECT_THAT(director(settings::ControlPermission::kLoopback).handle(pause, false).message,
              HasSubstr("[stream] control"));
  EXPECT_TRUE(director(settings::ControlPermission::kAnywhere).handle(pause, false).done);
}

TEST_F(PlayerDirectorTest, SaysWhatThereIsWhereNothingFits) {
  const auto unknown = director(settings::ControlPermission::kLoopback).handle({.sensor = "cellar"}, true);
  EXPECT_FALSE(unknown.done);
  EXPECT_TRUE(unknown.players.empty());
  EXPECT_THAT(unknown.message, HasSubstr("roof, yard"));
  const auto none = PlayerDirector(settings::ControlPermission::kLoopback, {}).handle({}, true);
  EXPECT_FALSE(none.done);
  EXPECT_THAT(none.message, HasSubstr("no sensor of this daemon"));
  roof_.is_full = true;
  const auto full =
      director(settings::ControlPermission::kLoopback).handle({.action = wire::PlayerAction::kPause}, true);
  EXPECT_FALSE(full.done);
  EXPECT_EQ(full.players[0].order, 0U);
}

}  // namespace
}  // namespace yuragi::daemon::sensing
