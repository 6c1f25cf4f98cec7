#include "drivers/bus/sender_filter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::drivers::bus {
namespace {

using testing::HasSubstr;

bool takes(const std::string& senders, const char* sender) {
  return SenderFilter::parse(senders).value().takes(boost::asio::ip::make_address(sender));
}

TEST(SenderFilter, TakesAnyWhereNoneIsNamed) {
  EXPECT_TRUE(takes("", "203.0.113.9"));
  EXPECT_TRUE(takes("", "2001:db8::1"));
}

TEST(SenderFilter, TakesAddressesAndNetsOfBothKinds) {
  const std::string senders = "192.168.1.20, 10.0.0.0/8 ,fd00::/8,2001:db8::7";
  for (const char* sender : {"192.168.1.20", "10.255.0.1", "fd12::1", "2001:db8::7", "::ffff:192.168.1.20"}) {
    EXPECT_TRUE(takes(senders, sender)) << sender;
  }
  for (const char* sender : {"192.168.1.21", "11.0.0.1", "127.0.0.1", "fc00::1", "2001:db8::8", "::ffff:11.0.0.1"}) {
    EXPECT_FALSE(takes(senders, sender)) << sender;
  }
}

TEST(SenderFilter, TakesANetByAnyAddressInItAndAllByTheNetOfAll) {
  EXPECT_TRUE(takes("10.1.2.3/16", "10.1.9.9"));
  EXPECT_FALSE(takes("10.1.2.3/16", "10.2.0.1"));
  EXPECT_TRUE(takes("0.0.0.0/0", "203.0.113.9"));
  EXPECT_FALSE(takes("0.0.0.0/0", "2001:db8::1"));
  EXPECT_TRUE(takes("::/0", "2001:db8::1"));
}

TEST(SenderFilter, TakesALinkLocalSenderOnWhateverInterface) {
  EXPECT_TRUE(takes("fe80::1", "fe80::1%1"));
  EXPECT_TRUE(takes("fe80::/10", "fe80::1%1"));
}

TEST(SenderFilter, SaysWhatIsNeitherAnAddressNorANet) {
  for (const char* wrong : {"nobody", "10.0.0.0/33", "10.0.0.0/", "fd00::/129", "10.0.0", ",", "1.2.3.4,,5.6.7.8"}) {
    const auto filter = SenderFilter::parse(wrong);
    ASSERT_FALSE(filter.has_value()) << wrong;
    EXPECT_THAT(filter.error().message,
                HasSubstr("is neither an address (192.168.1.20) nor a network (192.168.1.0/24)"));
  }
}

TEST(Loopback, IsWhatOnlyThisMachineReaches) {
  for (const char* address : {"127.0.0.1", "127.9.9.9", "::1", "::ffff:127.0.0.1"}) {
    EXPECT_TRUE(is_loopback(address).value()) << address;
  }
  for (const char* address : {"0.0.0.0", "::", "192.168.1.20", "224.0.0.1"}) EXPECT_FALSE(is_loopback(address).value());
  EXPECT_FALSE(is_loopback("").has_value());
  EXPECT_FALSE(is_loopback("localhost").has_value());
}

}  // namespace
}  // namespace yuragi::drivers::bus
