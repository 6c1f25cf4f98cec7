#include "viewer/meshes/sway_history.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace yuragi::viewer::meshes {
namespace {

constexpr glm::vec2 kEastward_m_s{5.0F, 0.0F};

TEST(SwayHistory, AGustReachesOneTreeAfterTheOther) {
  SwayHistory history;
  EXPECT_EQ(history.sway_m(1.0), glm::vec2(0.0F)) << "nothing is known";
  for (int picture = 0; picture <= 1200; ++picture) {
    const double time_s = picture / 60.0;
    history.add(time_s, {static_cast<float>(time_s), 0.0F}, kEastward_m_s);
  }
  EXPECT_FLOAT_EQ(history.downwind_m({20.0F, 7.0F}), 20.0F);
  EXPECT_NEAR(history.delay_s(20.0F), 4.0, 1e-5);
  EXPECT_NEAR(history.sway_m(0.0).x, 20.0F, 1e-3F);
  EXPECT_NEAR(history.sway_m(history.delay_s(20.0F)).x, 16.0F, 1e-3F);
  EXPECT_NEAR(history.sway_m(2.51).x, 17.49F, 1e-3F) << "between two pictures";
}

TEST(SwayHistory, NoDelayIsBelowZeroOrLongerThanItKnows) {
  SwayHistory history;
  for (int picture = 0; picture <= 3000; ++picture) history.add(picture / 100.0, {1.0F, 0.0F}, kEastward_m_s);
  EXPECT_EQ(history.delay_s(-10.0F), 0.0);
  EXPECT_EQ(history.delay_s(1e6F), SwayHistory::kLongest_s);
  EXPECT_EQ(history.sway_m(SwayHistory::kLongest_s).x, 1.0F);
  EXPECT_EQ(SwayHistory().delay_s(3.0F), 3.0) << "in calm air as in a light one";
}

TEST(SwayHistory, BeginsAnewWhereTimeJumps) {
  for (const double then_s : {3.0, 100.0}) {
    SwayHistory history;
    for (int picture = 0; picture <= 600; ++picture) history.add(picture / 60.0, {1.0F, 0.0F}, kEastward_m_s);
    history.add(then_s, {0.0F, 2.0F}, {0.0F, 3.0F});
    EXPECT_EQ(history.sway_m(5.0), glm::vec2(0.0F, 2.0F));
    EXPECT_FLOAT_EQ(history.downwind_m({9.0F, 4.0F}), 4.0F);
  }
}

}  // namespace
}  // namespace yuragi::viewer::meshes
