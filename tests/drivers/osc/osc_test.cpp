// The driver as the daemon opens it and runs it, with messages from liblo's own oscsend, and datagrams that are none.
#include <bit>
#include <chrono>
#include <functional>
#include <optional>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/bus/osc_message.hpp"
#include "drivers/sensor/driver.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/descriptor.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/running_sensor.hpp"

namespace yuragi::drivers::osc {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::unique_ptr<sensor::Sensor> open_osc_sensor(const ParameterValues::Map& given) {
  return driver_named("osc").open(values_for("osc", given));
}

/// A message of two floats, as any sender makes it.
const std::string kWindOf5From90 = "/wind\0\0\0,ff\0\x40\xa0\0\0\x42\xb4\0\0"s;

// Time tags. Those with a first byte from 0x80 count from 1900, others from 2036.
const std::string kAtOnce = "\0\0\0\0\0\0\0\1"s;
const std::string kIn1968 = "\x80\0\0\0\0\0\0\0"s;
const std::string kIn2104 = "\x7f\xff\xff\xff\0\0\0\0"s;

std::chrono::system_clock::time_point now() {
  return std::chrono::system_clock::now();
}

/// A time before 2036, in whole seconds.
std::string tag_of(std::chrono::system_clock::time_point time) {
  constexpr std::int64_t kFrom1900To1970_s = 2'208'988'800;
  const auto since_1900_s =
      std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch()).count() + kFrom1900To1970_s;
  std::string tag;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) tag += static_cast<char>(since_1900_s >> shift);
  return tag + "\0\0\0\0"s;
}

/// A bundle of one element.
std::string bundle_of(const std::string& element, const std::string& time = kAtOnce) {
  const auto size = static_cast<std::uint32_t>(element.size());
  std::string bundle = "#bundle\0"s;
  bundle += time;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bundle += static_cast<char>(size >> shift);
  return bundle += element;
}

/// The driver on a thread of its own, and what is sent to it.
class OscRun {
 public:
  explicit OscRun(ParameterValues::Map given = {}) : OscRun(free_port(SOCK_DGRAM), std::move(given)) {}
  OscRun(std::uint16_t port, ParameterValues::Map given) : port_(port), sensor_(make(port, std::move(given))) {}

  std::uint16_t port() const { return port_; }

  /// By an independent program.
  void send(std::vector<std::string> message) const {
    std::vector<std::string> command = {"oscsend", "127.0.0.1", std::to_string(port_)};
    command.insert(command.end(), message.begin(), message.end());
    ChildProcess program(command);
    program.rest();
    ASSERT_EQ(program.wait(), 0);
  }
  /// Any bytes as one datagram, from an address of the loopback.
  void send_bytes(const std::string& bytes) const { send_bytes_from(from_.descriptor(), bytes); }
  void send_bytes_from(int socket, const std::string& bytes) const {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port_);
    const auto sent =
        sendto(socket, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&address), sizeof address);
    ASSERT_EQ(sent, std::ssize(bytes));
  }
  /// Sends when the driver listens, and waits for the reading.
  bool reads_after(const std::function<void()>& send) {
    const bool listens = sensor_.wait_until([](const RecordingSink& sink) {
      const std::string detail = sink.last_detail();
      return sink.last_state() == wind::LinkState::kConnected || detail.find("waits for") != std::string::npos ||
             detail.find("no wind has been received") != std::string::npos;
    });
    const std::size_t before = count();
    send();
    return listens && has_read(before + 1);
  }
  void send_when_it_listens(const std::string& bytes) {
    ASSERT_TRUE(reports("waits for"));
    send_bytes(bytes);
  }
  bool reads_wind() {
    return reads_after([this] { send_bytes(kWindOf5From90); });
  }
  /// Sends again for as long as it is told to be too frequent.
  bool reads_wind_when_the_limit_lets_it() {
    for (const std::size_t before = count(); count() == before;) {
      const auto times = count(decode::Refusal::kTooFrequent);
      send_bytes(kWindOf5From90);
      const bool is_answered = sensor_.wait_until([&](const RecordingSink& sink) {
        return sink.readings.size() > before || sink.count(decode::Refusal::kTooFrequent) > times;
      });
      if (!is_answered) return false;
    }
    return true;
  }
  /// Messages that were read or refused.
  std::ptrdiff_t handled() {
    return sensor_.look(
        [](const RecordingSink& sink) { return std::ssize(sink.readings) + std::ssize(sink.refusals); });
  }
  bool has_handled(std::ptrdiff_t messages) {
    return sensor_.wait_until([messages](const RecordingSink& sink) {
      return std::ssize(sink.readings) + std::ssize(sink.refusals) >= messages;
    });
  }
  std::ptrdiff_t count(decode::Refusal why) {
    return sensor_.look([why](const RecordingSink& sink) { return sink.count(why); });
  }
  bool has_refused(decode::Refusal why, std::ptrdiff_t times = 1) {
    return sensor_.wait_until([&](const RecordingSink& sink) { return sink.count(why) >= times; });
  }
  bool has_read(std::size_t readings) {
    return sensor_.wait_until([&](const RecordingSink& sink) { return sink.readings.size() >= readings; });
  }
  bool is_in(wind::LinkState state) {
    return sensor_.wait_until([&](const RecordingSink& sink) { return sink.last_state() == state; });
  }
  bool reports(const std::string& text) {
    return sensor_.wait_until(
        [&](const RecordingSink& sink) { return sink.last_detail().find(text) != std::string::npos; });
  }
  std::size_t count() {
    return sensor_.look([](const RecordingSink& sink) { return sink.readings.size(); });
  }
  wind::Reading last() {
    return sensor_.look([](const RecordingSink& sink) { return sink.readings.back(); });
  }
  /// Ends it; what it says at last.
  std::string end() {
    sensor_.end();
    return all().last_detail();
  }
  RecordingSink all() {
    return sensor_.look([](const RecordingSink& sink) { return sink; });
  }

  /// A datagram is refused for this reason, and is no reading; then the wind is read again.
  void expect_refused(const std::string& bytes, decode::Refusal why) {
    const std::size_t before = count();
    const auto times = count(why);
    send_bytes(bytes);
    EXPECT_TRUE(has_refused(why, times + 1));
    EXPECT_EQ(count(), before);
    EXPECT_TRUE(reads_wind());
    EXPECT_EQ(last().speed_m_s, 5.0);
  }

 private:
  static std::unique_ptr<sensor::Sensor> make(std::uint16_t port, ParameterValues::Map given) {
    given.try_emplace("port", std::int64_t{port});
    return open_osc_sensor(given);
  }

  LoopbackPort from_{SOCK_DGRAM};
  std::uint16_t port_;
  RunningSensor sensor_;
};

TEST(OscDriver, ReadsWhatOscsendSends) {
  OscRun run;
  ASSERT_TRUE(run.reads_after([&] { run.send({"/wind", "ff", "4.5", "270"}); }));
  EXPECT_EQ(run.last().speed_m_s, 4.5);
  EXPECT_EQ(run.last().direction_deg, 270.0);
  EXPECT_FALSE(run.last().gust_m_s.has_value());
  EXPECT_EQ(run.all().last_state(), wind::LinkState::kConnected);
}

TEST(OscDriver, TakesNumbersOfAnyTypeInAnyOrder) {
  OscRun run({{"address", std::string("/station/*/wind")},
              {"speed_argument", std::int64_t{3}},
              {"direction_argument", std::int64_t{1}},
              {"gust_argument", std::int64_t{2}},
              {"speed_unit", std::string("km/h")}});
  ASSERT_TRUE(run.reads_after([&] { run.send({"/station/roof/wind", "sihd", "north mast", "350", "36", "18"}); }));
  EXPECT_DOUBLE_EQ(run.last().speed_m_s, 5.0);
  EXPECT_DOUBLE_EQ(run.last().gust_m_s.value(), 10.0);
  EXPECT_EQ(run.last().direction_deg, 350.0);
}

TEST(OscDriver, KnowsWhatADaemonSendsBesideItsWind) {
  OscRun run;
  for (const char* address : {"/wind/speed", "/sensor/roof/age", "/place/door", "/scene/meadow/opacity"})
    run.send({address, "f", "1"});
  ASSERT_TRUE(run.reads_after([&] { run.send({"/wind", "ff", "4.5", "270"}); }));
  EXPECT_EQ(run.all().count(decode::Refusal::kNotMine), 0);
  run.send({"/window/speed", "f", "1"});
  EXPECT_TRUE(run.has_refused(decode::Refusal::kNotMine));
}

/// A message of one float.
std::string float_message(std::string address, float number) {
  address += std::string(4 - address.size() % 4, '\0');
  std::string message = address + ",f\0\0"s;
  const auto bits = std::bit_cast<std::uint32_t>(number);
  for (const unsigned shift : {24U, 16U, 8U, 0U}) message += static_cast<char>(bits >> shift);
  return message;
}

const ParameterValues::Map kOneValueAnAddress = {{"address", std::string("/wind/speed")},
                                                 {"direction_address", std::string("/wind/direction")},
                                                 {"gust_address", std::string("/wind/gust")}};

TEST(OscDriver, JoinsOneValueAnAddress) {
  OscRun run(kOneValueAnAddress);
  ASSERT_TRUE(run.reads_after([&] { run.send({"/wind/speed", "f", "4.5"}); }));
  EXPECT_FALSE(run.last().direction_deg.has_value()) << "none was sent";
  run.send({"/wind/direction", "i", "277"});
  run.send({"/wind/gust", "f", "6"});
  ASSERT_TRUE(run.reads_after([&] { run.send({"/wind/speed", "f", "5"}); }));
  EXPECT_EQ(run.last().speed_m_s, 5.0);
  EXPECT_EQ(run.last().direction_deg, 277.0);
  EXPECT_EQ(run.last().gust_m_s, 6.0);
  EXPECT_TRUE(run.all().refusals.empty());
}

TEST(OscDriver, JoinsTheValuesOfABundleInAnyOrder) {
  OscRun run(kOneValueAnAddress);
  const std::string speed = bundle_of(float_message("/wind/speed", 8.0F));
  const std::string direction = bundle_of(float_message("/wind/direction", 277.0F));
  const std::string gust = bundle_of(float_message("/wind/gust", 9.0F));
  for (const std::string& bundle :
       {speed + direction.substr(16) + gust.substr(16), gust + direction.substr(16) + speed.substr(16)}) {
    ASSERT_TRUE(run.reads_after([&] { run.send_bytes(bundle); }));
    EXPECT_EQ(run.last().speed_m_s, 8.0);
    EXPECT_EQ(run.last().direction_deg, 277.0);
    EXPECT_EQ(run.last().gust_m_s, 9.0);
  }
  EXPECT_EQ(run.count(), 2U);
}

TEST(OscDriver, UsesADirectionOfItsOwnAddressForAsLongAsHold) {
  ParameterValues::Map given = kOneValueAnAddress;
  given["hold"] = 0.1;
  OscRun run(given);
  ASSERT_TRUE(run.reads_after([&] { run.send_bytes(float_message("/wind/speed", 4.0F)); }));
  run.send_bytes(float_message("/wind/direction", 90.0F));
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  do {  // some are too frequent
    const auto before = run.handled();
    run.send_bytes(float_message("/wind/speed", 4.0F));
    ASSERT_TRUE(run.has_handled(before + 1));
  } while (run.last().direction_deg && std::chrono::steady_clock::now() < deadline);
  EXPECT_FALSE(run.last().direction_deg.has_value());
}

TEST(OscDriver, KeepsTheSpeedBesideAnImpossibleDirection) {
  OscRun run;
  ASSERT_TRUE(run.reads_after([&] { run.send({"/wind", "ff", "4.5", "-90"}); }));
  EXPECT_EQ(run.last().speed_m_s, 4.5);
  EXPECT_FALSE(run.last().direction_deg.has_value());
  EXPECT_EQ(run.last().quality, wind::ReadingQuality::kUncertain);
  EXPECT_EQ(run.count(decode::Refusal::kImplausible), 1);
  ASSERT_TRUE(run.reads_after([&] { run.send({"/wind", "ff", "4.5", "90"}); }));
  ASSERT_TRUE(run.reads_after([&] { run.send({"/wind", "f", "4.5"}); }));
  EXPECT_FALSE(run.last().direction_deg.has_value()) << "only an address of its own holds one";
}

TEST(OscDriver, NamesTheSettingsWhereSpeedsComeByThemselves) {
  OscRun run;
  run.send_when_it_listens(float_message("/wind/speed", 4.0F));
  EXPECT_TRUE(run.reports("set address to \"/wind/speed\", and direction_address and gust_address"));
  EXPECT_TRUE(run.reads_wind());
  EXPECT_THAT(run.all().last_detail(), testing::Not(HasSubstr("direction_address")));
}

TEST(OscDriver, HasNoDirectionWhereNoneIsSent) {
  OscRun run;
  ASSERT_TRUE(run.reads_after([&] { run.send({"/wind", "f", "4.5"}); }));
  EXPECT_FALSE(run.last().direction_deg.has_value());
  ASSERT_TRUE(run.reads_after([&] { run.send({"/wind", "fs", "4.5", "NNE"}); }));
  EXPECT_FALSE(run.last().direction_deg.has_value());
}

TEST(OscDriver, TakesBundlesOfNowAndOfThePast) {
  OscRun run;
  for (const std::string& time : {kAtOnce, std::string(8, '\0'), tag_of(now()), tag_of(now() - 1h), kIn1968}) {
    ASSERT_TRUE(run.reads_after([&] { run.send_bytes(bundle_of(kWindOf5From90, time)); }));
    EXPECT_EQ(run.last().speed_m_s, 5.0);
    EXPECT_EQ(run.last().direction_deg, 90.0);
  }
}

TEST(OscDriver, RefusesWindOfTheFutureAndSaysSo) {
  OscRun run;
  run.send_when_it_listens(bundle_of(kWindOf5From90, tag_of(now() + 1h)));
  EXPECT_TRUE(run.has_refused(decode::Refusal::kInvalid));
  EXPECT_TRUE(run.reports("s in the future: set the clocks of both machines"));
  run.expect_refused(bundle_of(kWindOf5From90, kIn2104), decode::Refusal::kInvalid);
  run.expect_refused(bundle_of(bundle_of(kWindOf5From90), tag_of(now() + 1h)), decode::Refusal::kInvalid);
  run.expect_refused(bundle_of(bundle_of(kWindOf5From90, tag_of(now() + 1h))), decode::Refusal::kInvalid);
}

TEST(OscDriver, ShowsEveryDatagramAsItCame) {
  OscRun run;
  ASSERT_TRUE(run.reads_wind());
  run.send_bytes("abc");
  ASSERT_TRUE(run.has_refused(decode::Refusal::kMalformed));
  const RecordingSink sink = run.all();
  EXPECT_EQ(std::string(sink.raws.front().message.begin(), sink.raws.front().message.end()), kWindOf5From90);
  EXPECT_EQ(std::string(sink.raws.back().message.begin(), sink.raws.back().message.end()), "abc");
}

TEST(OscDriver, StandsAnyDatagram) {
  OscRun run;
  ASSERT_TRUE(run.reads_wind());
  std::mt19937_64 random(20260609);
  for (int round = 0; round < 2000; ++round) {
    std::string bytes = kWindOf5From90;
    bytes.resize(random() % 2 == 0 ? bytes.size() : random() % 64);
    for (int change = 0; change < 4 && !bytes.empty(); ++change)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    run.send_bytes(bytes);
  }
  // Bundles within bundles, as deep as a datagram can hold.
  std::string nested = kWindOf5From90;
  while (nested.size() < 60'000) nested = bundle_of(nested);
  run.send_bytes(nested);
  EXPECT_TRUE(run.reads_wind_when_the_limit_lets_it());
  for (const wind::Reading& reading : run.all().readings) EXPECT_TRUE(wind::is_plausible(reading));
}

/// A socket bound to an address of the loopback; nothing where somebody else has that port there.
std::optional<Descriptor> socket_at(const char* address, std::uint16_t port = 0) {
  Descriptor bound(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(port);
  inet_pton(AF_INET, address, &at.sin_addr);
  if (bind(bound.get(), reinterpret_cast<sockaddr*>(&at), sizeof at) != 0) return std::nullopt;
  return bound;
}

TEST(OscDriver, HearsThisMachineAloneUnlessItIsToldOtherwise) {
  OscRun run;
  ASSERT_TRUE(run.reports("waits for"));
  EXPECT_TRUE(socket_at("127.0.0.2", run.port())) << "it has not taken the port on every address";
  OscRun open({{"host", std::string("0.0.0.0")}, {"from", std::string("127.0.0.0/8")}});
  ASSERT_TRUE(open.reports("waits for"));
  EXPECT_FALSE(socket_at("127.0.0.2", open.port()));
}

TEST(OscDriver, TakesTheSendersThatItIsToldAndNamesTheFirstOfTheOthersOnce) {
  OscRun run({{"host", std::string("0.0.0.0")}, {"from", std::string("127.0.0.8, 127.2.0.0/16")}});
  const auto stranger = socket_at("127.0.0.9");
  const auto other_stranger = socket_at("127.0.0.10");
  const auto roof = socket_at("127.2.3.4");
  ASSERT_TRUE(stranger && other_stranger && roof);
  ASSERT_TRUE(run.reports("waits for"));
  for (int i = 0; i < 50; ++i) {
    run.send_bytes_from(stranger->get(), kWindOf5From90);
    run.send_bytes_from(other_stranger->get(), kWindOf5From90);
  }
  EXPECT_TRUE(run.has_refused(decode::Refusal::kNotMine, 100));
  EXPECT_EQ(run.count(), 0U);
  EXPECT_TRUE(run.reports("; refuses 127.0.0.9, which is not in `from`"));
  EXPECT_EQ(run.all().links.size(), 2U) << "without it, and with it";
  EXPECT_TRUE(run.reads_after([&] { run.send_bytes_from(roof->get(), kWindOf5From90); }));
}

TEST(OscDriver, TakesOfAFloodNoMoreReadingsThanTheLimitAndCountsTheOthers) {
  OscRun run;
  ASSERT_TRUE(run.reads_wind());
  std::ptrdiff_t sent = 1;
  for (; sent < 5000; ++sent) run.send_bytes(kWindOf5From90);
  // What the kernel dropped is told with the next datagram that it keeps.
  while (run.handled() != sent) {
    const auto before = run.handled();
    run.send_bytes(kWindOf5From90);
    ++sent;
    ASSERT_TRUE(run.has_handled(before + 1)) << "each is accounted for";
  }
  const RecordingSink sink = run.all();
  const auto taken = std::ssize(sink.readings);
  const double duration_s = seconds(sink.readings.back().time.mono - sink.readings.front().time.mono);
  EXPECT_LE(static_cast<double>(taken), 100.0 * duration_s + 101.0);
  EXPECT_GT(sink.count(decode::Refusal::kTooFrequent), 0);
}

TEST(OscDriver, CountsEachMessageOfABundleAgainstTheLimit) {
  OscRun run;
  ASSERT_TRUE(run.reads_wind());
  const std::string one = bundle_of(kWindOf5From90);
  std::string thousand = one;
  for (int i = 1; i < 1000; ++i) thousand += one.substr(16);  // the element alone
  run.send_bytes(thousand);
  EXPECT_TRUE(run.has_refused(decode::Refusal::kTooFrequent, 850));
}

TEST(OscDriver, IsInterruptedWhileItWaits) {
  OscRun run;
  ASSERT_TRUE(run.reads_wind());
  EXPECT_EQ(run.end(), "interrupted");
}

TEST(OscDriver, WantsToKnowWhoMaySendWhereOthersCan) {
  const auto refusal_of = [](const std::string& host, const std::string& from) -> std::string {
    try {
      open_osc_sensor({{"host", host}, {"from", from}});
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(refusal_of("127.0.0.1", ""), "none");
  EXPECT_EQ(refusal_of("::1", ""), "none");
  EXPECT_EQ(refusal_of("0.0.0.0", "192.168.1.20"), "none");
  EXPECT_EQ(refusal_of("0.0.0.0", "0.0.0.0/0"), "none");
  for (const char* host : {"0.0.0.0", "::", "192.168.1.2", "239.1.2.3"}) {
    EXPECT_THAT(refusal_of(host, ""), HasSubstr("from: is missing"));
  }
  EXPECT_THAT(refusal_of("", ""), HasSubstr("host: \"\" is not an address"));
  EXPECT_THAT(refusal_of("localhost", ""), HasSubstr("host: \"localhost\" is not an address"));
  EXPECT_THAT(refusal_of("127.0.0.1", "roof"), HasSubstr("from: \"roof\" is neither an address"));
}

TEST(OscDriver, RefusesAnAddressThatIsNone) {
  EXPECT_THAT(
      [] {
        open_osc_sensor({{"address", std::string("wind")}});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("address: must begin with a slash")));
  EXPECT_THAT(
      [] {
        open_osc_sensor({{"direction_address", std::string("wind/direction")}});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("direction_address: must begin with a slash")));
  EXPECT_THAT(
      [] {
        open_osc_sensor({{"gust_address", std::string("/wind")}});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("gust_address: is the same as address")));
}

TEST(OscDatagram, HoldsOneMessageOrThoseOfABundle) {
  const auto bytes_of = [](const std::string& text) { return std::vector<std::uint8_t>(text.begin(), text.end()); };
  const auto one = bus::decode_osc(bytes_of(kWindOf5From90));
  ASSERT_TRUE(one.has_value());
  ASSERT_EQ(one->size(), 1U);
  EXPECT_EQ((*one)[0].address, "/wind");
  EXPECT_THAT((*one)[0].numbers, testing::ElementsAre(5.0, 90.0));

  const std::string head = "#bundle\0\0\0\0\0\0\0\0\1"s;
  const std::string element = "\0\0\0\x14"s + kWindOf5From90;
  EXPECT_EQ(bus::decode_osc(bytes_of(head))->size(), 0U) << "an empty bundle is one";
  EXPECT_EQ(bus::decode_osc(bytes_of(head + element + element))->size(), 2U);
  EXPECT_EQ(bus::decode_osc(bytes_of(head + "\0\0\0\x28"s + head + element + element))->size(), 2U);
  EXPECT_FALSE(bus::decode_osc(bytes_of(head + element + "\0\0"s)).has_value());
  EXPECT_FALSE(bus::decode_osc(bytes_of(head + "\0\0\0\x18"s + kWindOf5From90)).has_value())
      << "longer than the datagram";
  EXPECT_EQ(bus::decode_osc({}).error(), decode::Refusal::kTooShort);
}

TEST(OscAddress, MatchesOscPatterns) {
  EXPECT_TRUE(bus::osc_address_matches("/wind", "/wind"));
  EXPECT_FALSE(bus::osc_address_matches("/wind2", "/wind"));
  EXPECT_TRUE(bus::osc_address_matches("/a/b/wind", "/a/?/wind"));
  EXPECT_TRUE(bus::osc_address_matches("/gust", "/{wind,gust}"));
}

TEST(OscFault, Silence) {
  OscRun run({{"silence", 1.0}});
  ASSERT_TRUE(run.reads_wind());
  EXPECT_TRUE(run.is_in(wind::LinkState::kConnecting));
  EXPECT_THAT(run.all().last_detail(), HasSubstr("no wind has been received on UDP"));
  EXPECT_TRUE(run.reads_wind());
  EXPECT_TRUE(run.is_in(wind::LinkState::kConnected));
}

TEST(OscFault, Freeze) {
  // The same again and again: the driver says so, and the hub has to judge it.
  OscRun run;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(run.reads_wind());
  EXPECT_EQ(run.last().speed_m_s, 5.0);
  EXPECT_EQ(run.all().last_state(), wind::LinkState::kConnected);
}

TEST(OscFault, Spike) {
  // 55 m/s is a wind, for the hub to judge; 1000 m/s is none.
  OscRun run;
  ASSERT_TRUE(run.reads_after([&] { run.send({"/wind", "ff", "55", "90"}); }));
  EXPECT_EQ(run.last().speed_m_s, 55.0);
  run.expect_refused("/wind\0\0\0,ff\0\x44\x7a\0\0\x42\xb4\0\0"s, decode::Refusal::kImplausible);
}

TEST(OscFault, Garbage) {
  OscRun run;
  ASSERT_TRUE(run.reads_wind());
  for (const std::string& bytes : {"xyz"s, "\xff\xfe\xfd\xfc"s, "no osc here!"s, "/wind\0\0\0,zz\0aaaa"s}) {
    run.expect_refused(bytes, decode::Refusal::kMalformed);
  }
  run.expect_refused("/wind\0\0\0,ff\0\x7f\xc0\0\0\x42\xb4\0\0"s, decode::Refusal::kInvalid);  // not a number
  run.expect_refused("/wind\0\0\0,sf\0fast\0\0\0\0\x42\xb4\0\0"s, decode::Refusal::kInvalid);  // a text for the speed
}

TEST(OscFault, Partial) {
  OscRun run;
  ASSERT_TRUE(run.reads_wind());
  for (std::size_t size = 1; size < kWindOf5From90.size(); ++size) {
    run.expect_refused(kWindOf5From90.substr(0, size), decode::Refusal::kMalformed);
  }
  run.expect_refused("/wind\0\0\0,\0\0\0"s, decode::Refusal::kTooShort);  // whole, but without arguments
}

TEST(OscFault, WrongId) {
  OscRun run;
  ASSERT_TRUE(run.reads_wind());
  run.expect_refused("/rain\0\0\0,ff\0\x40\xa0\0\0\x42\xb4\0\0"s, decode::Refusal::kNotMine);
}

TEST(OscFault, Disconnect) {
  // Another program has the port; then it ends.
  auto other = std::make_unique<LoopbackPort>(SOCK_DGRAM);
  OscRun run(other->port(), {});
  EXPECT_TRUE(run.reports("cannot listen at UDP"));
  EXPECT_EQ(run.all().last_state(), wind::LinkState::kConnecting);
  other.reset();
  EXPECT_TRUE(run.reads_wind());
  EXPECT_TRUE(run.is_in(wind::LinkState::kConnected));
}

}  // namespace
}  // namespace yuragi::drivers::osc
