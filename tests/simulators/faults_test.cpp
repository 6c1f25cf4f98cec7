#include "simulators/faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::sim {
namespace {

using testing::HasSubstr;

TEST(Fault, IsReadFromKindStartAndDuration) {
  const auto fault = parse_fault("wrong-id@10.5+2");
  ASSERT_TRUE(fault.has_value());
  EXPECT_EQ(fault->kind, FaultKind::kWrongId);
  EXPECT_EQ(fault->start_s, 10.5);
  EXPECT_EQ(fault->duration_s, 2.0);
}

TEST(Fault, ThatCannotBeReadSaysWhatIsAllowed) {
  for (const auto* text : {"", "silence", "silence@", "silence@1", "silence@1+", "silence@1+x", "silence@-1+2",
                           "silence@1+-2", "silence@1+inf", "noise@1+2", "silence+1@2", "silence@1 +2"}) {
    const auto fault = parse_fault(text);
    ASSERT_FALSE(fault.has_value()) << text;
    EXPECT_THAT(fault.error().message, HasSubstr("allowed: KIND@START+DURATION")) << text;
  }
}

TEST(Faults, HoldFromTheirStartForTheirDuration) {
  Faults faults;
  faults.add({FaultKind::kSilence, 10.0, 5.0});
  EXPECT_EQ(faults.at(9.999), std::nullopt);
  EXPECT_EQ(faults.at(10.0), FaultKind::kSilence);
  EXPECT_EQ(faults.at(14.999), FaultKind::kSilence);
  EXPECT_EQ(faults.at(15.0), std::nullopt);
}

TEST(Faults, ThatBeganLastCoverOthers) {
  Faults faults;
  faults.add({FaultKind::kShort, 5.0, 2.0});
  faults.add({FaultKind::kSilence, 0.0, 20.0});
  EXPECT_EQ(faults.at(4.0), FaultKind::kSilence);
  EXPECT_EQ(faults.at(6.0), FaultKind::kShort);
  EXPECT_EQ(faults.at(8.0), FaultKind::kSilence);
}

TEST(Faults, ObeyWhatIsTyped) {
  Faults faults;
  EXPECT_EQ(obey(faults, "exception 2.5", 100.0), "exception for 2.5 s");
  EXPECT_EQ(faults.at(102.4), FaultKind::kException);
  EXPECT_EQ(faults.at(102.5), std::nullopt);

  EXPECT_EQ(obey(faults, "drop", 200.0), "drop for 3 s");
  EXPECT_EQ(faults.at(202.9), FaultKind::kDrop);
  EXPECT_EQ(obey(faults, "clear", 201.0), "no faults");
  EXPECT_EQ(faults.at(202.9), std::nullopt);
}

TEST(Faults, AnswerHelpToHelpAndToWhatTheyDoNotKnow) {
  Faults faults;
  for (const auto* line : {"help", "explode", "silence soon"}) {
    EXPECT_THAT(obey(faults, line, 0.0),
                HasSubstr("one of silence, exception, wrong-id, wrong-transaction, short, garbage, drop"));
  }
  EXPECT_EQ(obey(faults, "", 0.0), "");
  EXPECT_EQ(faults.at(0.0), std::nullopt);
}

}  // namespace
}  // namespace yuragi::sim
