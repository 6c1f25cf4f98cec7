#include "engine/base/address.hpp"

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

TEST(Address, APortThatIsLeftOutIsTheDefault) {
  EXPECT_EQ(parse_address("wind.local", 7410)->port, 7410);
  EXPECT_EQ(parse_address("wind.local:80", 7410)->port, 80);
  EXPECT_EQ(parse_address("[::1]", 7410)->host, "::1");
  EXPECT_EQ(parse_address("[::1]", 7410)->port, 7410);
  for (const char* text : {"", ":7410", "host:", "host:65536", "host:74x0", "::1", "[::1", "[::1]x", "[]:1"}) {
    EXPECT_FALSE(parse_address(text, 7410).has_value()) << text;
  }
}

}  // namespace
}  // namespace yuragi
