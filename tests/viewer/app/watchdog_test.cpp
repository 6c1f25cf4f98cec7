#include "viewer/app/watchdog.hpp"

#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/service_manager_end.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::viewer::app {
namespace {

TEST(Watchdog, IsFedAtOnceAndThenEachHalfOfItsTimeout) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "notify").string();
  const test::ServiceManagerEnd manager(path);
  Watchdog watchdog({.socket_name = path, .watchdog = from_seconds(10.0)});
  watchdog.went_round(100.0);
  EXPECT_EQ(manager.take(), "WATCHDOG=1");
  watchdog.went_round(104.9);
  EXPECT_EQ(manager.take(), "");
  watchdog.went_round(105.0);
  EXPECT_EQ(manager.take(), "WATCHDOG=1");
  EXPECT_EQ(manager.take(), "");
}

TEST(Watchdog, SaysAgainWhatWasNotTaken) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "notify").string();
  Watchdog watchdog({.socket_name = path, .watchdog = from_seconds(10.0)});
  watchdog.went_round(100.0);
  const test::ServiceManagerEnd manager(path);
  watchdog.went_round(100.1);
  EXPECT_EQ(manager.take(), "WATCHDOG=1");
}

TEST(Watchdog, IsSilentWhereNobodyAskedForIt) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "notify").string();
  const test::ServiceManagerEnd manager(path);
  Watchdog({.socket_name = path, .watchdog = std::nullopt}).went_round(100.0);
  EXPECT_EQ(manager.take(), "");
  Watchdog({.socket_name = "", .watchdog = from_seconds(10.0)}).went_round(100.0);
}

}  // namespace
}  // namespace yuragi::viewer::app
