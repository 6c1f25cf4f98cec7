#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace yuragi::test {

/// The service manager's end of its socket.
class ServiceManagerEnd {
 public:
  explicit ServiceManagerEnd(const std::string& path) : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  }
  ~ServiceManagerEnd() { close(socket_); }
  ServiceManagerEnd(const ServiceManagerEnd&) = delete;
  ServiceManagerEnd& operator=(const ServiceManagerEnd&) = delete;

  /// What has come, or an empty text.
  std::string take() const {
    std::array<char, 64> text{};
    const ssize_t size = recv(socket_, text.data(), text.size(), MSG_DONTWAIT);
    return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : std::string();
  }

 private:
  int socket_;
};

}  // namespace yuragi::test
