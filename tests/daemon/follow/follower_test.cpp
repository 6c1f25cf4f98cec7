// A leader and a follower with a network between them that loses, delays, doubles and exchanges messages, tick by tick,
// without a clock.

#include "daemon/follow/follower.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/animation/animation.hpp"
#include "daemon/follow/leader.hpp"
#include "engine/pose/pose_hash.hpp"
#include "tests/support/gusty_wind.hpp"
#include "tests/support/measured_wind.hpp"

namespace yuragi::daemon::follow {
namespace {

constexpr double kRate_hz = 60.0;
const Nanoseconds kPeriod = from_seconds(1.0 / kRate_hz);
constexpr Nanoseconds kDelay = std::chrono::milliseconds(300);
constexpr std::size_t kScenes = 3;

settings::Config installation(const std::string& more = "") {
  return settings::parse_config("seed = 2\n[wind]\nlead = \"nats://127.0.0.1:4222\"\n" + more + R"(
[[scene]]
name = "meadow"
kind = "grass"
blades_across = 12
blades_deep = 8
[[scene]]
name = "cloth"
kind = "flag"
columns = 16
rows = 10
[[scene]]
name = "fire"
kind = "flame"
columns = 16
rows = 16
)",
                                "test.toml");
}

/// The scenes of a daemon, and the poses that they had after each number.
struct Wall {
  explicit Wall(const settings::Config& config) : animation(config, shared_gusts()) {}

  void step(MonoTime now, std::uint64_t periods = 1) {
    const auto stepped = steps.step(animation, own, now, periods);
    if (!stepped.is_new) return;
    std::uint64_t hash = pose::kPoseHashSeed;
    for (const pose::Pose* pose : animation.poses()) hash = pose::pose_hash(hash, *pose);
    hashes[stepped.number] = hash;
  }
  std::uint64_t hash() const { return hashes.rbegin()->second; }

  animation::Animation animation;
  animation::LedSteps steps{1'000, kRate_hz, kDelay};
  wind::ground::DrivingWind own{.state = {.wind = {-3.0, 1.0}}, .ground = wind::Vector{-3.0, 1.0}};
  std::map<std::uint64_t, std::uint64_t> hashes;
};

/// Carries messages with what a network does to them.
class Network {
 public:
  using Take = std::function<void(const Bytes&)>;
  void send(const Bytes& bytes, MonoTime now, bool is_tick, const Take& take) {
    ++sent_;
    sent_bytes_ += bytes.size();
    if (is_cut || (is_tick && std::bernoulli_distribution(loss_of_ticks)(random_))) return;
    const int copies = std::bernoulli_distribution(doubled)(random_) ? 2 : 1;
    for (int copy = 0; copy < copies; ++copy) {
      const double late_s = std::uniform_real_distribution<double>(0.001, longest_s)(random_);
      on_their_way_.emplace(now + from_seconds(late_s), std::pair(bytes, take));
    }
  }
  void deliver(MonoTime now) {
    while (!on_their_way_.empty() && on_their_way_.begin()->first <= now) {
      const auto [bytes, take] = on_their_way_.extract(on_their_way_.begin()).mapped();
      take(bytes);
    }
  }

  double loss_of_ticks = 0.0, doubled = 0.0, longest_s = 0.005;
  bool is_cut = false;
  int sent() const { return sent_; }
  std::size_t sent_bytes() const { return sent_bytes_; }

 private:
  std::mt19937 random_{7};
  std::multimap<MonoTime, std::pair<Bytes, Take>> on_their_way_;
  int sent_ = 0;
  std::size_t sent_bytes_ = 0;
};

class FollowerTest : public ::testing::Test {
 protected:
  FollowerTest() { begin_to_lead(); }

  static UtcTime utc_at(MonoTime now) { return UtcTime(std::chrono::seconds(1'800'000'000) + now.time_since_epoch()); }

  void begin_to_lead() { leader_.begin_epoch(utc_at(now_), 0, 0); }

  /// Goes on by ticks of all.
  void run(int ticks) {
    for (int tick = 0; tick < ticks; ++tick) {
      now_ += kPeriod;
      network_.deliver(now_);
      if (is_leading_) {
        leader_.make_ticks(measured_.step(), {.mono = now_, .utc = utc_at(now_)}, 1);
        leader_.advance(now_);
        leaders_.step(now_);
      }
      follower_.advance(now_);
      followers_.step(now_ + std::chrono::milliseconds(5));
    }
  }

  /// Of the last second of ticks, how many poses of both are the same.
  double same_share() const {
    int same = 0, all = 0;
    for (auto at = followers_.hashes.rbegin(); at != followers_.hashes.rend() && all < 60; ++at) {
      const auto there = leaders_.hashes.find(at->first);
      ++all;
      if (there != leaders_.hashes.end() && there->second == at->second) ++same;
    }
    return static_cast<double>(same) / all;
  }

  settings::Config config_ = installation();
  MonoTime now_{std::chrono::hours(2)};
  MeasuredWind measured_{shared_gusts(), {6.0, 3.0}};
  Network network_;
  bool is_leading_ = true;
  Wall leaders_{config_}, followers_{config_};
  std::vector<std::uint8_t> shown_;
  Follower follower_{makeup_of(config_),
                     kDelay,
                     followers_.steps,
                     [this](const Bytes& question) {
                       network_.send(question, now_, false, [this](const Bytes& bytes) {
                         if (is_leading_) leader_.answer(bytes, "_INBOX.follower", now_);
                       });
                     },
                     {.loaded = [this](const auto& shown) { shown_ = shown; },
                      .cued = [this](const animation::SceneCue& cue) { shown_.at(cue.scene) = cue.shown ? 1 : 0; }}};
  Leader leader_{makeup_of(config_),
                 kRate_hz,
                 kDelay,
                 0,
                 {.ticks = "wind.tick", .states = "wind.state"},
                 leaders_.steps,
                 [this](const std::string& subject, const Bytes& bytes) {
                   const bool is_tick = subject == "wind.tick";
                   network_.send(bytes, now_, is_tick, [this, is_tick](const Bytes& arrived) {
                     is_tick ? follower_.take_tick(arrived, now_) : follower_.take_reply(arrived, now_);
                   });
                 }};
};

TEST_F(FollowerTest, ALateOneHasTheSamePosesAfterAMoment) {
  network_.is_cut = true;
  run(300);
  EXPECT_EQ(follower_.phase(now_), Follower::Phase::kNoLeader);
  network_.is_cut = false;
  run(120);
  EXPECT_EQ(follower_.phase(now_), Follower::Phase::kSamePicture);
  EXPECT_EQ(follower_.counts().states, 1U);
  EXPECT_EQ(shown_, std::vector<std::uint8_t>(kScenes, 1));
  run(60);
  EXPECT_EQ(same_share(), 1.0);
  EXPECT_EQ(leaders_.steps.position().number, followers_.steps.position().number) << "and at the same time";
}

TEST_F(FollowerTest, LostLateDoubledAndExchangedTicksAreAllPlayed) {
  run(120);
  ASSERT_EQ(follower_.phase(now_), Follower::Phase::kSamePicture);
  network_.loss_of_ticks = 0.15;
  network_.doubled = 0.05;
  network_.longest_s = 0.04;
  const std::uint64_t before = followers_.steps.position().without_tick;
  for (int second = 0; second < 10; ++second) {
    run(60);
    EXPECT_EQ(same_share(), 1.0) << second;
  }
  EXPECT_EQ(followers_.steps.position().without_tick, before);
  EXPECT_GT(follower_.counts().repaired, 50U);
  EXPECT_EQ(follower_.counts().states, 1U);
}

TEST_F(FollowerTest, WithoutALeaderTheOwnWindTakesOverAndTheLeadersPictureComesBack) {
  run(120);
  network_.is_cut = true;
  run(60);
  EXPECT_TRUE(followers_.steps.position().is_led) << "the last wind goes on";
  EXPECT_FALSE(followers_.steps.position().is_exact);
  run(120);
  EXPECT_EQ(follower_.phase(now_), Follower::Phase::kSilent);
  EXPECT_FALSE(followers_.steps.position().is_led);
  EXPECT_EQ(follower_.wind(), nullptr);
  network_.is_cut = false;
  run(180);
  EXPECT_EQ(follower_.phase(now_), Follower::Phase::kSamePicture);
  run(60);
  EXPECT_EQ(same_share(), 1.0);
}

TEST_F(FollowerTest, AfterALongSilenceItFollowsAgainFromTheNewNumbersOn) {
  run(120);
  network_.is_cut = true;
  run(20 * 60);
  network_.is_cut = false;
  run(240);
  EXPECT_EQ(follower_.phase(now_), Follower::Phase::kSamePicture);
  EXPECT_EQ(same_share(), 1.0);
}

TEST_F(FollowerTest, AnotherEpochIsJoinedAndAnOlderOneNeverCountsAgain) {
  run(120);
  const std::uint64_t first_epoch = leader_.epoch();
  leader_.begin_epoch(utc_at(now_), leader_.epoch(), leader_.number());
  EXPECT_GT(leader_.epoch(), first_epoch);
  run(180);
  EXPECT_EQ(follower_.phase(now_), Follower::Phase::kSamePicture);
  EXPECT_EQ(follower_.latest_epoch(), leader_.epoch());
  EXPECT_EQ(same_share(), 1.0);

  const std::uint64_t refused = follower_.counts().refused;
  follower_.take_tick(encode(wire::lead::WindTick{.epoch = first_epoch, .number = leader_.number() + 1}), now_);
  EXPECT_EQ(follower_.counts().refused, refused + 1);
  run(30);
  EXPECT_EQ(same_share(), 1.0);
}

// After a loss of power, say.
TEST_F(FollowerTest, ALeaderThatIsStartedAgainWithAWrongClockIsFollowed) {
  run(120);
  const std::uint64_t first_epoch = leader_.epoch();
  leader_.begin_epoch(UtcTime(std::chrono::hours(1)), 0, 0);
  ASSERT_LT(leader_.epoch(), first_epoch);
  run(60);
  EXPECT_GT(follower_.counts().refused, 30U) << "it may be a replay, as long as the leader of before may come back";
  run(240);
  EXPECT_EQ(follower_.phase(now_), Follower::Phase::kSamePicture);
  EXPECT_EQ(same_share(), 1.0);
}

// Its sender does not answer: it is not the leader.
TEST_F(FollowerTest, ATickOfALaterEpochThatNobodyStandsForChangesNothing) {
  run(120);
  for (int second = 0; second < 5; ++second) {
    follower_.take_tick(encode(wire::lead::WindTick{.epoch = ~std::uint64_t{0}, .number = 5'000}), now_);
    run(60);
    EXPECT_EQ(same_share(), 1.0);
  }
  run(240);
  EXPECT_EQ(follower_.latest_epoch(), leader_.epoch()) << "it is forgotten";
}

TEST_F(FollowerTest, GarbageChangesNothing) {
  run(120);
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    Bytes garbage(random() % 200);
    std::ranges::generate(garbage, [&] { return static_cast<std::uint8_t>(random()); });
    follower_.take_tick(garbage, now_);
    follower_.take_reply(garbage, now_);
    leader_.answer(garbage, "_INBOX.someone", now_);
    run(1);
  }
  EXPECT_EQ(same_share(), 1.0);
  EXPECT_EQ(leader_.counts().refused, 300U);
}

TEST_F(FollowerTest, AStateOfOtherScenesOrWithALostPartIsNotLoaded) {
  network_.is_cut = true;
  run(60);
  network_.is_cut = false;
  const StatePart part{.epoch = leader_.epoch(),
                       .number = leader_.number(),
                       .made_of = makeup_of(config_).hash(),
                       .total_bytes = 300'000,
                       .first_byte = 0,
                       .bytes = Bytes(100'000)};
  follower_.take_reply(encode(part), now_);
  StatePart last = part;
  last.first_byte = 200'000;
  follower_.take_reply(encode(last), now_);
  StatePart other = part;
  other.made_of += 1;
  other.total_bytes = other.bytes.size();
  follower_.take_reply(encode(other), now_);
  run(200);
  EXPECT_EQ(follower_.counts().states, 1U);
  EXPECT_EQ(same_share(), 1.0);
}

TEST_F(FollowerTest, ACueIsCarriedOutOnAllWallsAtTheSameTick) {
  run(150);
  ASSERT_EQ(follower_.phase(now_), Follower::Phase::kSamePicture);
  ASSERT_TRUE(leader_.cue({.scene = 1, .shown = false, .hide_others = false, .over_s = 0.5}));
  run(60);
  EXPECT_EQ(shown_, (std::vector<std::uint8_t>{1, 0, 1}));
  EXPECT_EQ(followers_.animation.opacities()[1], 0.0F);
  EXPECT_EQ(same_share(), 1.0);
  EXPECT_EQ(follower_.counts().states, 1U);
}

TEST_F(FollowerTest, ALeaderThatIsHaltedForLessThanTheDelayIsNotSeen) {
  run(150);
  for (int time = 0; time < 5; ++time) {
    now_ += 6 * kPeriod;
    network_.deliver(now_);
    leader_.make_ticks(measured_.step(), {.mono = now_, .utc = utc_at(now_)}, 6);
    run(50);
  }
  EXPECT_EQ(follower_.phase(now_), Follower::Phase::kSamePicture);
  EXPECT_EQ(same_share(), 1.0);
}

// A stand-by that loads a state when it begins to lead, and one that saves a state when it gives way.
TEST_F(FollowerTest, AStateThatItsOwnerGaveUpIsInNobodysWay) {
  run(20);
  auto forgotten = std::make_unique<animation::StateOrder>();
  ASSERT_TRUE(leaders_.steps.order(forgotten));
  run(30);
  run(120);
  EXPECT_EQ(follower_.phase(now_), Follower::Phase::kSamePicture);
  EXPECT_EQ(same_share(), 1.0);
}

TEST_F(FollowerTest, ItsQuestionsAreFewWhileNobodyAnswers) {
  run(120);
  is_leading_ = false;
  const int before = network_.sent();
  for (int second = 0; second < 20; ++second) {
    follower_.take_tick(encode(wire::lead::WindTick{.epoch = ~std::uint64_t{0}, .number = 7}), now_);
    run(60);
  }
  EXPECT_LT(network_.sent() - before, 25);
}

/// A follower that was made of another configuration.
class OtherFollowerTest : public FollowerTest {
 protected:
  void follow_with(const std::string& more, const std::function<void(settings::Config&)>& change = {}) {
    settings::Config other = installation(more);
    if (change) change(other);
    follower_.set_makeup(makeup_of(other));
    run(200);
  }
};

TEST_F(OtherFollowerTest, OfAnotherSeedItIsRefusedWithTheReason) {
  follow_with("evolving = false\n");
  EXPECT_EQ(follower_.phase(now_), Follower::Phase::kDiffers);
  EXPECT_EQ(follower_.differences(), std::vector<std::string>{"its seed or its [wind] evolving is another one"});
  EXPECT_FALSE(followers_.steps.position().is_led);
  EXPECT_EQ(follower_.wind(), nullptr);
}

TEST_F(OtherFollowerTest, WithAnotherSceneItHasTheWindAndNamesTheScene) {
  follow_with("", [](settings::Config& config) { config.scenes.at(1).name = "banner"; });
  EXPECT_EQ(follower_.phase(now_), Follower::Phase::kSameWind);
  EXPECT_EQ(follower_.differences(),
            (std::vector<std::string>{"scene banner is only here", "scene cloth is only there"}));
  EXPECT_TRUE(followers_.steps.position().is_led);
  EXPECT_EQ(follower_.counts().states, 0U);
  ASSERT_NE(follower_.wind(), nullptr);
  EXPECT_GT(speed_of(follower_.wind()->state.wind), 4.0);
}

TEST_F(FollowerTest, AMessageForASubjectThatIsNoInboxIsNotAnswered) {
  run(10);
  const int before = network_.sent();
  leader_.answer(encode(Question{}), "wind.tick", now_);
  leader_.answer(encode(Question{}), "", now_);
  EXPECT_EQ(network_.sent(), before);
  leader_.answer(encode(Question{}), "_INBOX.somebody", now_);
  EXPECT_EQ(network_.sent(), before + 1);
}

// Some followers ask, all get it: a hundred that lose their leader need one state, and no tick is late for it.
TEST_F(FollowerTest, WhatSeveralWaitForIsSentOnce_APartATick) {
  run(60);
  const int before = network_.sent();
  for (int follower = 0; follower < 100; ++follower)
    leader_.answer(encode(Question{.about = Question::About::kState, .epoch = leader_.epoch()}),
                   "_INBOX." + std::to_string(follower), now_);
  run(120);
  EXPECT_LE(network_.sent() - before, 240);
  EXPECT_EQ(follower_.phase(now_), Follower::Phase::kSamePicture);
}

// They would fill the link, and the leader's own ticks would be lost.
TEST_F(FollowerTest, AFloodOfQuestionsForTicksIsBoundedAndDelaysNobody) {
  run(150);
  const std::size_t before = network_.sent_bytes();
  const Question all{.about = Question::About::kTicks, .epoch = leader_.epoch(), .from = 0, .to = ~std::uint64_t{0}};
  for (int tick = 0; tick < 60; ++tick) {
    for (int question = 0; question < 50; ++question) leader_.answer(encode(all), "_INBOX.nobody", now_);
    run(1);
  }
  EXPECT_LT(static_cast<double>(network_.sent_bytes() - before), 2.5 * Leader::kMaxReplies_bytes_s);
  EXPECT_EQ(same_share(), 1.0);
}

TEST_F(FollowerTest, StatesAreSavedAtMostOnceASecondHoweverManyAsk) {
  run(60);
  const std::uint64_t before = leader_.counts().states;
  for (int tick = 0; tick < 180; ++tick) {
    for (int follower = 0; follower < 100; ++follower)
      leader_.answer(encode(Question{.about = Question::About::kState, .epoch = leader_.epoch()}),
                     "_INBOX." + std::to_string(follower), now_);
    run(1);
  }
  EXPECT_LE(leader_.counts().states - before, 4U);
  EXPECT_GE(leader_.counts().states - before, 2U);
}

}  // namespace
}  // namespace yuragi::daemon::follow
