#include "viewer/app/paused_moment.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/viewer/test_meadow.hpp"

namespace yuragi::viewer::app {
namespace {

stream::PoseMoment leaning(double speed_m_s, std::size_t side = 2) {
  const pose::Skeleton meadow = test_meadow(side, 1.0);
  stream::PoseMoment moment;
  moment.wind.wind = {.u_m_s = speed_m_s, .v_m_s = 0.0};
  moment.poses = {test_pose(meadow, 0.0, 0.1 * speed_m_s, 0.0, 90.0)};
  moment.opacities = {1.0F};
  return moment;
}

TEST(PausedMoment, IsWhatIsLiveWithoutAPause) {
  PausedMoment paused;
  const stream::PoseMoment live = leaning(3.0);
  EXPECT_EQ(&paused.advance(live, 0.02), &live);
}

TEST(PausedMoment, StandsStillAndGoesOnWithoutAJump) {
  PausedMoment paused;
  paused.toggle();
  EXPECT_DOUBLE_EQ(paused.advance(leaning(2.0), 0.02).wind.wind.u_m_s, 2.0);
  EXPECT_DOUBLE_EQ(paused.advance(leaning(9.0), 5.0).wind.wind.u_m_s, 2.0);
  paused.toggle();
  double before_m_s = 2.0;
  for (int picture = 0; picture < 50; ++picture) {
    const double shown_m_s = paused.advance(leaning(10.0), 0.02).wind.wind.u_m_s;
    EXPECT_LT(std::abs(shown_m_s - before_m_s), 0.3);
    EXPECT_GE(shown_m_s, before_m_s);
    before_m_s = shown_m_s;
  }
  const stream::PoseMoment live = leaning(4.0);
  paused.advance(live, 0.1);
  EXPECT_EQ(&paused.advance(live, 0.02), &live);
}

TEST(PausedMoment, APauseWithinTheCrossFadeKeepsWhatIsSeen) {
  PausedMoment paused;
  paused.toggle();
  paused.advance(leaning(2.0), 0.02);
  paused.toggle();
  const double seen_m_s = paused.advance(leaning(10.0), 0.5).wind.wind.u_m_s;
  EXPECT_NEAR(seen_m_s, 6.0, 0.01);
  paused.toggle();
  EXPECT_DOUBLE_EQ(paused.advance(leaning(0.0), 1.0).wind.wind.u_m_s, seen_m_s);
}

TEST(PausedMoment, OtherScenesAreShownAtOnce) {
  PausedMoment paused;
  paused.toggle();
  paused.advance(leaning(2.0), 0.02);
  paused.toggle();
  const stream::PoseMoment other = leaning(5.0, 8);
  EXPECT_EQ(&paused.advance(other, 0.02), &other);
}

}  // namespace
}  // namespace yuragi::viewer::app
