#include "viewer/watchdog.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::viewer {
namespace {

/// The service manager's end.
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& path) : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  }
  ~NotifySocket() { close(socket_); }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// What has come, or an empty text.
  std::string take() const {
    std::array<char, 64> text{};
    const ssize_t size = recv(socket_, text.data(), text.size(), MSG_DONTWAIT);
    return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : std::string();
  }

 private:
  int socket_;
};

TEST(Watchdog, IsFedAtOnceAndThenEachHalfOfItsTimeout) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "notify").string();
  const NotifySocket manager(path);
  Watchdog watchdog(path, 10.0);
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
  Watchdog watchdog(path, 10.0);
  watchdog.went_round(100.0);
  const NotifySocket manager(path);
  watchdog.went_round(100.1);
  EXPECT_EQ(manager.take(), "WATCHDOG=1");
}

TEST(Watchdog, IsSilentWhereNobodyAskedForIt) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "notify").string();
  const NotifySocket manager(path);
  Watchdog(path, std::nullopt).went_round(100.0);
  EXPECT_EQ(manager.take(), "");
  Watchdog("", 10.0).went_round(100.0);
}

}  // namespace
}  // namespace yuragi::viewer
