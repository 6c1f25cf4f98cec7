#include "drivers/bus/dns_message.hpp"

#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/dns_answer.hpp"

namespace yuragi::drivers::bus {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::string kType = "_signalk-ws._tcp.local";
const std::string kAddress = "\xC0\xA8\x01\x14";  // 192.168.1.20

TEST(DnsMessage, AsksForAServiceWithoutAnIdOrFlags) {
  const std::string name = DnsAnswer::name_of(kType);
  const std::string wanted = std::string("\0\0\0\0\0\x01\0\0\0\0\0\0", 12) + name + std::string("\0\x0C\0\x01", 4);
  const auto question = service_question(kType);
  EXPECT_EQ(std::string(question.begin(), question.end()), wanted);
  EXPECT_THAT(service_question(std::string(64, 'a') + ".local"), IsEmpty()) << "a label has 63 characters at most";
}

TEST(DnsMessage, ReadsTheServicesOfAType) {
  DnsAnswer answer;
  answer.add_service("_http._tcp.local", "printer", "printer.local", 631, kAddress)
      .add_service("_SignalK-WS._tcp.LOCAL", "My boat. No 1", "Boat.local", 3000, kAddress)
      .add_service(kType, "other", "other.local", 3443, "\x0A\x01\x02\x03");
  EXPECT_THAT(services_in(answer.bytes(), kType),
              ElementsAre(AnnouncedService{.name = "My boat. No 1", .address = "192.168.1.20", .port = 3000},
                          AnnouncedService{.name = "other", .address = "10.1.2.3", .port = 3443}));
}

TEST(DnsMessage, TellsWhatItIsNotTold) {
  const auto pointer = DnsAnswer().add(kType, DnsAnswer::kPtr, DnsAnswer::name_of("boat." + kType)).bytes();
  EXPECT_THAT(services_in(pointer, kType), ElementsAre(AnnouncedService{.name = "boat"}));
  const auto server = DnsAnswer()
                          .add(kType, DnsAnswer::kPtr, DnsAnswer::name_of("boat." + kType))
                          .add("boat." + kType, DnsAnswer::kSrv, std::string("\0\0\0\0\x0B\xB8", 6))
                          .bytes();
  EXPECT_THAT(services_in(server, kType), ElementsAre(AnnouncedService{.name = "boat"})) << "a port of no host";
}

TEST(DnsMessage, ShowsNothingThatATerminalObeys) {
  const auto answer = DnsAnswer().add_service(kType, "\x1B[2J\n\xFF", "a.local", 3000, kAddress).bytes();
  const auto services = services_in(answer, kType);
  ASSERT_EQ(services.size(), 1U);
  EXPECT_EQ(services.front().name, "?[2J??");
}

TEST(DnsMessage, TakesNoQuestionForAnAnswer) {
  auto bytes = DnsAnswer().add_service(kType, "boat", "boat.local", 3000, kAddress).bytes();
  bytes[2] = 0;
  EXPECT_THAT(services_in(bytes, kType), IsEmpty());
  EXPECT_THAT(services_in({}, kType), IsEmpty());
}

TEST(DnsMessage, TakesNoMoreThanItPromises) {
  DnsAnswer answer;
  for (int i = 0; i < 40; ++i) answer.add(kType, DnsAnswer::kPtr, DnsAnswer::name_of(std::to_string(i) + "." + kType));
  EXPECT_EQ(services_in(answer.bytes(), kType).size(), 16U);
  for (int i = 0; i < 200; ++i) answer.add(kType, DnsAnswer::kPtr, DnsAnswer::name_of(std::to_string(i) + "." + kType));
  EXPECT_THAT(services_in(answer.bytes(), kType), IsEmpty()) << "longer than any message of multicast DNS";
}

TEST(DnsMessage, KeepsItsPromisesWhateverIsHurt) {
  const auto whole = DnsAnswer().add_service(kType, "boat", "boat.local", 3000, kAddress).bytes();
  std::mt19937 random(1);
  const auto expect_bounds = [](const std::vector<std::uint8_t>& bytes) {
    for (const AnnouncedService& service : services_in(bytes, kType)) {
      ASSERT_LE(service.name.size(), 4 * 63U);
      ASSERT_EQ(service.address.find_first_not_of("0123456789."), std::string::npos);
    }
  };
  for (std::size_t size = 0; size < whole.size(); ++size) {
    expect_bounds({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
  }
  for (int i = 0; i < 20'000; ++i) {
    auto hurt = whole;
    for (unsigned changes = 1 + random() % 4; changes > 0; --changes)
      hurt[random() % hurt.size()] = static_cast<std::uint8_t>(random());
    expect_bounds(hurt);
  }
  // Names that refer to themselves, and to each other.
  const std::string loop = DnsAnswer::number(0) + DnsAnswer::number(0x8400) + DnsAnswer::number(0) +
                           DnsAnswer::number(0xFFFF) + DnsAnswer::number(0) + DnsAnswer::number(0) +
                           std::string("\xC0\x0E\xC0\x0C", 4);
  EXPECT_THAT(services_in(std::vector<std::uint8_t>(loop.begin(), loop.end()), kType), IsEmpty());
}

}  // namespace
}  // namespace yuragi::drivers::bus
