#include "engine/base/known_host.hpp"

#include <array>

#include <gtest/gtest.h>

namespace yuragi {
namespace {

const std::array<std::string, 2> kNames = {"roof", "wall.example.org"};

TEST(KnownHost, AddressesLocalhostAndNames) {
  for (const char* host : {"127.0.0.1", "127.0.0.1:7480", "192.168.1.30:7480", "[::1]:7480", "[fe80::1]", "localhost",
                           "LOCALHOST:7480", "roof", "roof:7480", "Roof.local", "wall.example.org:80"}) {
    EXPECT_TRUE(is_known_host(host, kNames)) << host;
  }
}
TEST(KnownHost, NothingElse) {
  for (const char* host : {"", "evil.example", "roof.evil.example", "evilroof", "127.0.0.1.evil.example", "[::1",
                           "[::1]evil", "[::1]evil:7480", "[evil.example]", "roof:evil", "127.0.0.1evil", "1",
                           "wall.example.org.evil", "local", ".local", ":7480", "localhost.evil:7480"}) {
    EXPECT_FALSE(is_known_host(host, kNames)) << host;
  }
}

TEST(SameOrigin, OfTheHostOrNone) {
  EXPECT_TRUE(is_same_origin("", "roof:7480", true)) << "curl names none";
  EXPECT_TRUE(is_same_origin("http://roof:7480", "roof:7480", false));
  EXPECT_TRUE(is_same_origin("https://Roof:7480", "roof:7480", true));
  EXPECT_TRUE(is_same_origin("https://roof:7480", "roof:7480", false)) << "a proxy speaks HTTPS";
}
TEST(SameOrigin, APageInTheClearIsNotThatOfHttps) {
  EXPECT_FALSE(is_same_origin("http://roof:7480", "roof:7480", true));
}
TEST(SameOrigin, AnotherPort_AnotherName_OrNull) {
  for (const char* origin : {"http://roof", "http://roof:80", "http://evil.example", "null", "roof:7480",
                             "http://roof:7480.evil.example", "http://evil.example/roof:7480"}) {
    EXPECT_FALSE(is_same_origin(origin, "roof:7480", false)) << origin;
  }
}

}  // namespace
}  // namespace yuragi
