#include "simulators/core/faults.hpp"

#include <array>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::simulators::core {
namespace {

using testing::HasSubstr;

constexpr std::array kKnown = {FaultKind::kSilence, FaultKind::kException, FaultKind::kWrongId, FaultKind::kPartial,
                               FaultKind::kDisconnect};

TEST(Fault, IsReadFromKindStartAndDuration) {
  const auto fault = Faults(kKnown).parse("wrong-id@10.5+2");
  ASSERT_TRUE(fault.has_value());
  EXPECT_EQ(fault->kind, FaultKind::kWrongId);
  EXPECT_EQ(fault->start_s, 10.5);
  EXPECT_EQ(fault->duration_s, 2.0);
}

TEST(Fault, TakesDurationsWithTheirUnits) {
  const auto fault = Faults(kKnown).parse("silence@5min+500ms");
  ASSERT_TRUE(fault.has_value());
  EXPECT_EQ(fault->start_s, 300.0);
  EXPECT_EQ(fault->duration_s, 0.5);
}

TEST(Fault, ThatCannotBeReadSaysWhatIsAllowed) {
  for (const auto* text : {"", "silence", "silence@", "silence@1", "silence@1+", "silence@1+x", "silence@-1+2",
                           "silence@1+-2", "silence@1+inf", "noise@1+2", "silence+1@2", "silence@1 +2", "unplug@1+2"}) {
    const auto fault = Faults(kKnown).parse(text);
    ASSERT_FALSE(fault.has_value()) << text;
    EXPECT_THAT(fault.error().message, HasSubstr("allowed: KIND@START+DURATION")) << text;
  }
}

TEST(Faults, HoldFromTheirStartForTheirDuration) {
  Faults faults(kKnown);
  faults.add(Fault{FaultKind::kSilence, 10.0, 5.0});
  EXPECT_EQ(faults.at(9.999), std::nullopt);
  EXPECT_EQ(faults.at(10.0), FaultKind::kSilence);
  EXPECT_EQ(faults.at(14.999), FaultKind::kSilence);
  EXPECT_EQ(faults.at(15.0), std::nullopt);
}

TEST(Faults, ThatBeganLastCoverOthers) {
  Faults faults(kKnown);
  faults.add(Fault{FaultKind::kPartial, 5.0, 2.0});
  faults.add(Fault{FaultKind::kSilence, 0.0, 20.0});
  EXPECT_EQ(faults.at(4.0), FaultKind::kSilence);
  EXPECT_EQ(faults.at(6.0), FaultKind::kPartial);
  EXPECT_EQ(faults.at(8.0), FaultKind::kSilence);
}

TEST(Faults, ObeyWhatIsTyped) {
  Faults faults(kKnown);
  EXPECT_EQ(faults.obey("exception 2.5", 100.0), "exception for 2.5 s");
  EXPECT_EQ(faults.at(102.4), FaultKind::kException);
  EXPECT_EQ(faults.at(102.5), std::nullopt);

  EXPECT_EQ(faults.obey("disconnect", 200.0), "disconnect for 3 s");
  EXPECT_EQ(faults.at(202.9), FaultKind::kDisconnect);
  EXPECT_EQ(faults.obey("clear", 201.0), "no faults");
  EXPECT_EQ(faults.at(202.9), std::nullopt);
}

TEST(Faults, AnswerHelpToHelpAndToWhatTheyDoNotKnow) {
  Faults faults(kKnown);
  for (const auto* line : {"help", "explode", "silence soon"}) {
    EXPECT_THAT(faults.obey(line, 0.0), HasSubstr("one of silence, exception, wrong-id, partial, disconnect"));
  }
  EXPECT_EQ(faults.obey("", 0.0), "");
  EXPECT_EQ(faults.at(0.0), std::nullopt);
}

TEST(Faults, AtRandomComeOnceInEachStretchAndFollowTheirSeed) {
  Faults faults(kKnown);
  faults.add(RandomFaults{.every_s = 10.0, .duration_s = 2.0, .seed = 3});
  Faults others(kKnown);
  others.add(RandomFaults{.every_s = 10.0, .duration_s = 2.0, .seed = 4});
  std::set<FaultKind> seen;
  int differing = 0;
  for (int stretch = 0; stretch < 100; ++stretch) {
    int faulty = 0;
    for (int tenth = 0; tenth < 100; ++tenth) {
      const double time_s = 10.0 * stretch + 0.1 * tenth;
      const auto fault = faults.at(time_s);
      EXPECT_EQ(fault, faults.at(time_s));
      if (fault) seen.insert(*fault);
      faulty += fault ? 1 : 0;
      differing += fault != others.at(time_s) ? 1 : 0;
    }
    EXPECT_NEAR(faulty, 20, 1) << stretch;
  }
  EXPECT_EQ(seen.size(), kKnown.size());
  EXPECT_GT(differing, 1000);
}

}  // namespace
}  // namespace yuragi::simulators::core
