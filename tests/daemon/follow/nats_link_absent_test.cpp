// The link of a build without NATS, which this program compiles itself.
#include <array>
#include <cstdint>

#include <gtest/gtest.h>

#include "daemon/follow/nats_link.hpp"

namespace yuragi::daemon::follow {
namespace {

TEST(NatsLinkAbsentTest, ReportsHowToBuildItAndLosesWhatIsPublished) {
  const char* const reason = "this build has no NATS (cmake -D YURAGI_NATS=ON, libnats-dev)";
  EXPECT_EQ(NatsLink::refusal(), reason);
  NatsLink link(NatsSettings(), {"a"}, [] {});
  const std::array<std::uint8_t, 2> bytes{1, 2};
  link.publish("a", bytes);
  link.leave_server();
  const NatsLink::State state = link.state();
  EXPECT_FALSE(state.is_connected);
  EXPECT_EQ(state.trouble, reason);
  EXPECT_EQ(state.lost, 1U);
  EXPECT_TRUE(link.received().empty());
  EXPECT_FALSE(link.inbox().empty());
}

}  // namespace
}  // namespace yuragi::daemon::follow
