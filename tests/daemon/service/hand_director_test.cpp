#include "daemon/service/hand_director.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::service {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using wire::HandCommand;
using wire::HandPart;

constexpr MonoTime kBegin{1h};

HandCommand west_wind(double for_s = 60.0) {
  return {.part = HandPart::kWind, .for_s = for_s, .speed_m_s = 8.0, .direction_deg = 270.0};
}

class HandDirectorTest : public testing::Test {
 protected:
  std::string refusal(const HandCommand& command, bool is_local = true) {
    const wire::ControlReply reply = hand_.handle(command, is_local, kBegin);
    EXPECT_FALSE(reply.done) << reply.message;
    EXPECT_EQ(reply.by_hand, wire::ByHand{}) << "nothing was set";
    return reply.message;
  }

  HandDirector hand_{settings::ControlPermission::kLoopback, {"gate", "pond"}};
};

TEST_F(HandDirectorTest, NothingIsSetAtFirst) {
  EXPECT_EQ(hand_.status(kBegin), wire::ByHand{});
  EXPECT_FALSE(hand_.shaping(kBegin).wind);
  EXPECT_FALSE(hand_.shaping(kBegin).is_dark);
  EXPECT_EQ(hand_.camera(kBegin), std::nullopt);
  EXPECT_EQ(hand_.take_ended(kBegin), std::vector<std::string>{});
  EXPECT_EQ(by_hand_text(hand_.status(kBegin)), "");
}

TEST_F(HandDirectorTest, AWindEndsByItselfAndIsReportedOnce) {
  const wire::ControlReply reply = hand_.handle(west_wind(), true, kBegin);
  EXPECT_TRUE(reply.done);
  EXPECT_EQ(reply.message, "the wind is 8 m/s from 270 degrees by hand, for 1 min");
  ASSERT_TRUE(reply.by_hand && reply.by_hand->wind);
  EXPECT_EQ(reply.by_hand->wind->left_s, 60.0);
  EXPECT_EQ(by_hand_text(hand_.status(kBegin + 18s)), "by hand: 8 m/s from 270 degrees, 42 s left");
  EXPECT_EQ(hand_.shaping(kBegin + 59s).wind->speed_m_s, 8.0);
  EXPECT_EQ(hand_.take_ended(kBegin + 59s).size(), 0U);
  EXPECT_FALSE(hand_.shaping(kBegin + 60s).wind);
  EXPECT_EQ(hand_.status(kBegin + 60s), wire::ByHand{});
  EXPECT_EQ(hand_.take_ended(kBegin + 60s), std::vector<std::string>{"the scenes have the real wind again"});
  EXPECT_EQ(hand_.take_ended(kBegin + 61s).size(), 0U);
}

TEST_F(HandDirectorTest, AnotherWindReplacesIt) {
  hand_.handle(west_wind(), true, kBegin);
  HandCommand other = west_wind(10.0);
  other.direction_deg = 90.0;
  hand_.handle(other, true, kBegin + 50s);
  EXPECT_EQ(hand_.shaping(kBegin + 55s).wind->direction_deg, 90.0);
  EXPECT_FALSE(hand_.shaping(kBegin + 60s).wind);
}

TEST_F(HandDirectorTest, AReleaseEndsItsPartAlone) {
  hand_.handle(west_wind(), true, kBegin);
  hand_.handle({.part = HandPart::kBlackout, .for_s = 3600.0}, true, kBegin);
  EXPECT_TRUE(hand_.shaping(kBegin).is_dark);
  EXPECT_EQ(hand_.handle({.part = HandPart::kWind, .is_release = true}, true, kBegin + 1s).message,
            "the scenes have the real wind again");
  EXPECT_FALSE(hand_.shaping(kBegin + 1s).wind);
  EXPECT_TRUE(hand_.shaping(kBegin + 1s).is_dark);
  EXPECT_EQ(hand_.handle({.part = HandPart::kWind, .is_release = true}, true, kBegin + 2s).message,
            "nothing was set by hand");
}

TEST_F(HandDirectorTest, ABlackoutWithoutATimeLastsUntilItIsReleased) {
  hand_.handle({.part = HandPart::kBlackout}, true, kBegin);
  EXPECT_TRUE(hand_.shaping(kBegin + 24h * 400).is_dark);
  ASSERT_TRUE(hand_.status(kBegin).blackout);
  EXPECT_EQ(hand_.status(kBegin).blackout->left_s, std::nullopt);
  hand_.handle({.part = HandPart::kBlackout, .is_release = true}, true, kBegin + 1s);
  EXPECT_FALSE(hand_.shaping(kBegin + 1s).is_dark);
}

TEST_F(HandDirectorTest, ACameraByItsNameAsLongAsThereIsOneOfThatName) {
  hand_.handle({.part = HandPart::kCamera, .camera = "pond"}, true, kBegin);
  EXPECT_EQ(hand_.camera(kBegin), 1U);
  hand_.set_cameras({"pond"});
  EXPECT_EQ(hand_.camera(kBegin), 0U);
  hand_.set_cameras({"gate"});
  EXPECT_EQ(hand_.camera(kBegin), std::nullopt);
  EXPECT_THAT(refusal({.part = HandPart::kCamera, .camera = "pond"}), HasSubstr("there are: gate"));
  hand_.set_cameras({});
  EXPECT_THAT(refusal({.part = HandPart::kCamera, .camera = "pond"}), HasSubstr("no [[camera]]"));
}

TEST_F(HandDirectorTest, HostileNumbersAreRefusedWithTheReason) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300, -1.0, 60.01}) {
    HandCommand command = west_wind();
    command.speed_m_s = bad;
    EXPECT_THAT(refusal(command), HasSubstr("the speed must be from 0 to 60 m/s")) << bad;
  }
  for (const double bad : {kNaN, kInfinity, 1e300, -1.0, 360.01}) {
    HandCommand command = west_wind();
    command.direction_deg = bad;
    EXPECT_THAT(refusal(command), HasSubstr("the direction must be from 0 to 360 degrees")) << bad;
  }
  for (const double bad : {kNaN, kInfinity, 1e300, -1.0, 0.0, 3600.5}) {
    EXPECT_THAT(refusal(west_wind(bad)), HasSubstr("the time must be from 1 to 3600 s")) << bad;
  }
  for (const double bad : {kNaN, kInfinity, 1e300, -1.0, 0.0, 86401.0}) {
    EXPECT_THAT(refusal({.part = HandPart::kBlackout, .for_s = bad}), HasSubstr("from 1 to 86400 s")) << bad;
  }
  HandCommand endless = west_wind();
  endless.for_s.reset();
  EXPECT_THAT(refusal(endless), HasSubstr("needs its time"));
}

TEST_F(HandDirectorTest, OnlyThoseWhoMayControlSetOrEndSomething) {
  EXPECT_THAT(refusal(west_wind(), false), HasSubstr("[stream] control = \"loopback\""));
  hand_.handle(west_wind(), true, kBegin);
  EXPECT_FALSE(hand_.handle({.part = HandPart::kWind, .is_release = true}, false, kBegin).done);
  EXPECT_TRUE(hand_.handle({}, false, kBegin).done) << "a report is for all";
  EXPECT_TRUE(hand_.shaping(kBegin).wind);
  hand_.allow(settings::ControlPermission::kAnywhere);
  EXPECT_TRUE(hand_.handle({.part = HandPart::kWind, .is_release = true}, false, kBegin).done);
}

}  // namespace
}  // namespace yuragi::daemon::service
