#include "daemon/service/reload.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <semaphore>
#include <stdexcept>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/daemon/service/work_queue.hpp"

namespace yuragi::daemon::service {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class ReloadTest : public ::testing::Test {
 protected:
  ReloadParts parts() {
    return {.post = [this](std::function<void()> work) { queue_.post(std::move(work)); },
            .file = "/etc/wall.toml",
            .read =
                [this] {
                  ++reads_;
                  if (before_read_) before_read_();
                  return settings::parse_config(text_, "wall.toml");
                },
            .make_scenes = {},
            .apply = [this](const settings::ReloadPlan& plan) { applied_.push_back(plan.next); }};
  }
  Reload::Reply reply() {
    return [this](const wire::ReloadReport& report) { reports_.push_back(report); };
  }

  /// A disk whose reads hang until it answers; owned by those who read.
  struct HangingDisk {
    std::atomic<bool> hangs = true;
    std::counting_semaphore<> asked{0};
    std::promise<void> answers;
    std::shared_future<void> answered = answers.get_future().share();
  };
  ReloadParts hanging_parts(const std::shared_ptr<HangingDisk>& disk) {
    ReloadParts hanging = parts();
    hanging.read = [disk, text = text_] {
      const bool hangs = disk->hangs;
      disk->asked.release();
      if (hangs) std::shared_future(disk->answered).wait();
      return settings::parse_config(text, "wall.toml");
    };
    return hanging;
  }
  static constexpr MonoTime kStart{std::chrono::hours(1)};

  WorkQueue queue_;
  std::string text_ = "[shaping]\nfloor = 2.0\n";
  std::function<void()> before_read_;
  std::atomic<int> reads_ = 0;
  std::vector<settings::Config> applied_;
  std::vector<wire::ReloadReport> reports_;
};

TEST_F(ReloadTest, WarnsOfTheNextStartAndAppliesAllTheSame) {
  ReloadParts warning = parts();
  warning.rehearse = [](const settings::Config&, const settings::Config& next) {
    if (next.seed == 2) throw std::runtime_error("a disk that is gone");
    return std::vector<std::string>{"at the next start: no folder"};
  };
  Reload reload(settings::default_config(), warning);
  reload.request({}, reply());
  queue_.do_one();
  ASSERT_EQ(reports_.size(), 1U);
  EXPECT_EQ(reports_.at(0).outcome, wire::ReloadOutcome::kDone);
  EXPECT_THAT(reports_.at(0).mistakes, ElementsAre("at the next start: no folder"));
  EXPECT_EQ(applied_.size(), 1U);
  text_ = "seed = 2\n[shaping]\nfloor = 3.0\n";
  reload.request({}, reply());
  queue_.do_one();
  ASSERT_EQ(reports_.size(), 2U);
  EXPECT_EQ(reports_.at(1).outcome, wire::ReloadOutcome::kDone) << "a rehearsal that fails is no mistake of the file";
  EXPECT_EQ(applied_.size(), 2U);
}

TEST_F(ReloadTest, AppliesWhatHasChangedOnceAndSaysSo) {
  Reload reload(settings::default_config(), parts());
  reload.request({}, reply());
  EXPECT_TRUE(reload.is_under_way());
  EXPECT_THAT(applied_, IsEmpty()) << "not before the I/O thread comes to it";
  queue_.do_one();
  EXPECT_FALSE(reload.is_under_way());
  ASSERT_EQ(applied_.size(), 1U);
  EXPECT_EQ(applied_[0].shaping.settings.floor_m_s, 2.0);
  ASSERT_EQ(reports_.size(), 1U);
  EXPECT_EQ(reports_[0].outcome, wire::ReloadOutcome::kDone);
  EXPECT_THAT(reports_[0].applied, ElementsAre("[shaping] floor: 0.0 -> 2.0"));

  reload.request("/etc/wall.toml", reply());
  queue_.do_one();
  EXPECT_EQ(applied_.size(), 1U) << "it is what runs";
  EXPECT_THAT(reports_[1].applied, IsEmpty());
}

TEST_F(ReloadTest, AMistakeChangesNothingAndIsToldLineByLine) {
  Reload reload(settings::default_config(), parts());
  text_ = "[shaping]\nfloor = -1\nroof = 3\n";
  reload.request({}, reply());
  queue_.do_one();
  EXPECT_THAT(applied_, IsEmpty());
  EXPECT_EQ(reports_.at(0).outcome, wire::ReloadOutcome::kMistake);
  EXPECT_THAT(reports_[0].mistakes,
              ElementsAre(HasSubstr("wall.toml:2:9: shaping.floor: "), HasSubstr("wall.toml:3:8: shaping.roof: ")));

  before_read_ = [] { throw std::runtime_error("no memory"); };
  reload.request({}, reply());
  queue_.do_one();
  EXPECT_EQ(reports_.at(1).outcome, wire::ReloadOutcome::kFailed);
  EXPECT_THAT(reports_[1].mistakes, ElementsAre("no memory"));
}

TEST_F(ReloadTest, AThousandRequestsDuringOneMakeOneMore) {
  std::promise<void> go_on;
  before_read_ = [&, gate = go_on.get_future().share()] { gate.wait(); };
  Reload reload(settings::default_config(), parts());
  reload.request({}, reply());
  for (int i = 0; i < 1000; ++i) reload.request();
  reload.request({}, reply());
  go_on.set_value();
  queue_.do_one();
  EXPECT_EQ(reports_.size(), 1U) << "the second asked after the file had been looked at, perhaps";
  EXPECT_TRUE(reload.is_under_way());
  queue_.do_one();
  EXPECT_EQ(reports_.size(), 2U);
  EXPECT_FALSE(reload.is_under_way());
  EXPECT_EQ(reads_, 2);
}

TEST_F(ReloadTest, WaitsUntilTheLastOneHasBeenCarriedOut) {
  bool is_settling = false;
  ReloadParts with_scenes = parts();
  with_scenes.is_settling = [&] { return is_settling; };
  Reload reload(settings::default_config(), std::move(with_scenes));
  reload.request({}, reply());
  queue_.do_one();
  ASSERT_EQ(reports_.size(), 1U);

  is_settling = true;
  text_ = "[shaping]\nfloor = 3.0\n";
  reload.request({}, reply());
  reload.request({}, reply());
  reload.go_on();
  EXPECT_TRUE(reload.is_under_way());
  EXPECT_EQ(reads_, 1) << "the file is read when its turn has come";
  is_settling = false;
  reload.go_on();
  reload.go_on();
  queue_.do_one();
  EXPECT_EQ(reads_, 2);
  EXPECT_EQ(reports_.size(), 3U);
  EXPECT_EQ(applied_.back().shaping.settings.floor_m_s, 3.0);
  EXPECT_FALSE(reload.is_under_way());
}

TEST_F(ReloadTest, AsManyClientsAsLikeCannotMakeItKeepThemAll) {
  std::promise<void> go_on;
  before_read_ = [&, gate = go_on.get_future().share()] { gate.wait(); };
  Reload reload(settings::default_config(), parts());
  for (std::size_t i = 0; i < Reload::kMaxWaiting + 10; ++i) reload.request({}, reply());
  EXPECT_EQ(reports_.size(), 9U);
  EXPECT_EQ(reports_.front().outcome, wire::ReloadOutcome::kFailed);
  go_on.set_value();
  queue_.do_one();
  queue_.do_one();
  EXPECT_EQ(reports_.size(), Reload::kMaxWaiting + 10);
}

TEST_F(ReloadTest, WithoutAFileOrWithAnotherOneItSaysSo) {
  Reload reload(settings::default_config(), parts());
  reload.request("/home/anna/wall.toml", reply());
  EXPECT_EQ(reports_.at(0).outcome, wire::ReloadOutcome::kNoFile);
  EXPECT_THAT(reports_[0].mistakes, ElementsAre("the daemon runs with /etc/wall.toml, not with /home/anna/wall.toml"));

  ReloadParts none = parts();
  none.read = {};
  Reload without(settings::default_config(), none);
  without.request({}, reply());
  EXPECT_EQ(reports_.at(1).outcome, wire::ReloadOutcome::kNoFile);
  EXPECT_THAT(reports_[1].mistakes, ElementsAre(HasSubstr("started without --config")));
  EXPECT_FALSE(without.is_under_way());
}

TEST_F(ReloadTest, ScenesAreMadeBeforeAnythingChangesAndAdoptedLast) {
  text_ += "[[scene]]\nkind = \"flag\"\n";
  std::vector<std::string> order;
  bool is_wrong = true;
  ReloadParts with_scenes = parts();
  with_scenes.apply = [&](const settings::ReloadPlan&) { order.emplace_back("apply"); };
  with_scenes.make_scenes = [&](const settings::Config& next, const std::function<bool()>&) -> ReloadParts::Adopt {
    if (is_wrong) throw settings::ConfigError("[[scene]]: too large");
    return [&order, kind = std::string(next.scenes.at(0).kind->name)] { order.push_back("adopt " + kind); };
  };
  Reload reload(settings::default_config(), with_scenes);
  reload.request({}, reply());
  queue_.do_one();
  EXPECT_THAT(order, IsEmpty()) << "the floor is not applied either";
  EXPECT_THAT(reports_.at(0).mistakes, ElementsAre("[[scene]]: too large"));
  is_wrong = false;
  reload.request({}, reply());
  queue_.do_one();
  EXPECT_THAT(order, ElementsAre("apply", "adopt flag"));
}

TEST_F(ReloadTest, ItsEndDoesNotWaitForADiskThatHangs) {
  // Owned by the thread that is left behind.
  struct Disk {
    std::promise<void> answers, is_asked;
  };
  auto disk = std::make_shared<Disk>();
  ReloadParts hanging = parts();
  hanging.read = [disk]() -> settings::Config {
    disk->is_asked.set_value();
    disk->answers.get_future().wait();
    throw settings::ConfigError("wall.toml:1:1: file: cannot be read");
  };
  {
    Reload reload(settings::default_config(), std::move(hanging));
    reload.request({}, reply());
    disk->is_asked.get_future().wait();
  }
  EXPECT_THAT(reports_, IsEmpty());
  disk->answers.set_value();
  while (disk.use_count() > 1) std::this_thread::yield();
  disk.reset();  // as the last owner: what the thread did is ordered before this
  EXPECT_TRUE(queue_.is_empty()) << "nobody is there who could be told";
}

TEST_F(ReloadTest, AFileThatIsNotReadInTimeHasFailedAndTheNextRequestIsAnswered) {
  auto disk = std::make_shared<HangingDisk>();
  {
    Reload reload(settings::default_config(), hanging_parts(disk));
    reload.request({}, reply());
    disk->asked.acquire();
    reload.give_up_late(kStart);
    reload.request({}, reply());
    reload.give_up_late(kStart + Reload::kMaxRead - Nanoseconds(1));
    EXPECT_THAT(reports_, IsEmpty());
    disk->hangs = false;
    reload.give_up_late(kStart + Reload::kMaxRead);
    ASSERT_EQ(reports_.size(), 1U);
    EXPECT_EQ(reports_[0].outcome, wire::ReloadOutcome::kFailed);
    EXPECT_THAT(reports_[0].mistakes,
                ElementsAre(HasSubstr("/etc/wall.toml: was not read within 20 s; check its disk")));
    EXPECT_TRUE(reload.is_under_way());
    reload.give_up_late(kStart + Reload::kMaxRead);
    queue_.do_one();
    ASSERT_EQ(reports_.size(), 2U) << "the second has its own time";
    EXPECT_EQ(reports_[1].outcome, wire::ReloadOutcome::kDone);
    EXPECT_FALSE(reload.is_under_way());
    disk->answers.set_value();
  }
  while (disk.use_count() > 1) std::this_thread::yield();
  disk.reset();  // as the last owner: what the thread did is ordered before this
  EXPECT_TRUE(queue_.is_empty()) << "the first comes too late";
  EXPECT_EQ(applied_.size(), 1U);
}

TEST_F(ReloadTest, NoMoreThanSomeThreadsAreLeftWithADiskThatHangs) {
  const auto disk = std::make_shared<HangingDisk>();
  Reload reload(settings::default_config(), hanging_parts(disk));
  const auto holders_at_rest = disk.use_count();
  for (std::size_t i = 0; i < Reload::kMaxLeftBehind; ++i) {
    reload.request({}, reply());
    disk->asked.acquire();
    reload.give_up_late(kStart);
    reload.give_up_late(kStart + Reload::kMaxRead);
  }
  ASSERT_EQ(reports_.size(), Reload::kMaxLeftBehind);
  reload.request({}, reply());
  queue_.do_one();
  EXPECT_EQ(reports_.back().outcome, wire::ReloadOutcome::kFailed);
  EXPECT_THAT(reports_.back().mistakes, ElementsAre(HasSubstr("4 earlier attempts to read it have not returned")));
  EXPECT_FALSE(disk->asked.try_acquire());

  disk->hangs = false;
  disk->answers.set_value();
  while (disk.use_count() > holders_at_rest) std::this_thread::yield();
  reload.request({}, reply());
  queue_.do_one();
  EXPECT_EQ(reports_.back().outcome, wire::ReloadOutcome::kDone);
}

TEST_F(ReloadTest, ItsEndWaitsForScenesThatAreBeingMadeAndTellsThemToHurry) {
  text_ = "[[scene]]\nkind = \"flag\"\n";
  std::promise<void> is_making;
  bool was_told = false;
  ReloadParts with_scenes = parts();
  with_scenes.make_scenes = [&](const settings::Config&, const std::function<bool()>& is_given_up) {
    is_making.set_value();
    while (!is_given_up()) std::this_thread::yield();
    was_told = true;
    return ReloadParts::Adopt();
  };
  {
    Reload reload(settings::default_config(), with_scenes);
    reload.request({}, reply());
    is_making.get_future().wait();
  }
  EXPECT_TRUE(was_told);
}

}  // namespace
}  // namespace yuragi::daemon::service
