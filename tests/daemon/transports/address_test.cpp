#include "daemon/transports/address.hpp"

#include <gtest/gtest.h>

namespace yuragi {
namespace {

TEST(Address, HostAndPortAreReadAndWritten) {
  for (const char* text :
       {"127.0.0.1:7410", "localhost:0", "[::1]:7410", "[fe80::1%eth0]:65535", "a-wall.example:80"}) {
    const auto address = parse_address(text);
    ASSERT_TRUE(address.has_value()) << text;
    EXPECT_EQ(to_string(*address), text);
  }
  EXPECT_EQ(parse_address("[::1]:7410")->host, "::1");
  EXPECT_EQ(parse_address("[::1]:7410")->port, 7410);
}

TEST(Address, EverythingElseIsRefusedAndTheTextSaysWhatIsAllowed) {
  for (const char* text :
       {"", ":", "7410", "localhost", "localhost:", ":7410", "localhost:65536", "localhost:-1", "localhost:+1",
        "localhost:7410x", "::1:7410", "[::1]", "[127.0.0.1]:7410", "[]:7410", "a b:7410", "[::1:7410"}) {
    const auto address = parse_address(text);
    ASSERT_FALSE(address.has_value()) << text;
    EXPECT_NE(address.error().message.find("HOST:PORT"), std::string::npos);
  }
}

}  // namespace
}  // namespace yuragi
