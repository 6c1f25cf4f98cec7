#include "engine/platform/notify_socket.hpp"

#include <string>

#include <gtest/gtest.h>

#include "tests/support/service_manager_end.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::platform {
namespace {

TEST(NotifySocket, SaysWhatIsSentOnceSomebodyListens) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "notify").string();
  const NotifySocket socket(path);
  EXPECT_TRUE(socket.is_open());
  EXPECT_FALSE(socket.send("READY=1"));
  const test::ServiceManagerEnd manager(path);
  EXPECT_TRUE(socket.send("READY=1"));
  EXPECT_EQ(manager.take(), "READY=1");
}

TEST(NotifySocket, WithoutANameOrWithOneThatIsTooLongIsSilent) {
  EXPECT_TRUE(NotifySocket("").send("READY=1"));
  EXPECT_FALSE(NotifySocket("").is_open());
  EXPECT_FALSE(NotifySocket(std::string(200, 'a')).is_open());
}

}  // namespace
}  // namespace yuragi::platform
