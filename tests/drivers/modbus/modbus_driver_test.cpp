// The driver as the daemon opens it, against servers on the loopback and on pseudo terminals.
#include <array>
#include <stdexcept>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>

#include "drivers/sensor/driver.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/modbus_servers.hpp"
#include "tests/support/places.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/scripted_server.hpp"

namespace yuragi::drivers::modbus {
namespace {

using namespace std::chrono_literals;
using Bytes = ScriptedServer::Bytes;
using testing::Each;
using testing::HasSubstr;

/// So long that even a machine under load answers; and, for what waits until the end of it, as short as can be.
constexpr double kPatient_s = 5.0;
constexpr double kImpatient_s = 0.2;

std::unique_ptr<sensor::Sensor> open_sensor(ParameterValues::Map given) {
  given.try_emplace("response_timeout", kPatient_s);
  given.try_emplace("profile_dir", test::source_path("drivers/modbus/profiles"));
  return driver_named("modbus").open(values_for("modbus", given));
}

std::unique_ptr<sensor::Sensor> open_tcp(std::uint16_t port, const std::string& profile = "renke-rs-fsjt-rs-fxjt-n01",
                                         double timeout_s = kPatient_s) {
  return open_sensor({{"port", std::int64_t{port}}, {"profile", profile}, {"response_timeout", timeout_s}});
}

/// What a device with 8.6 m/s and 270 degrees answers.
Bytes right_reply(const Bytes& request) {
  const std::uint16_t value = request[6] == 1 ? 86 : 270;
  return {request[0],
          request[1],
          0,
          0,
          0,
          5,
          request[6],
          request[7],
          2,
          static_cast<std::uint8_t>(value >> 8U),
          static_cast<std::uint8_t>(value & 0xFFU)};
}

struct Bench {
  ManualClock clock;
  RecordingSink sink;
  MonoTime due{};

  void poll(sensor::Sensor& sensor) {
    clock.advance_to(due);
    due = sensor.poll(clock, sink);
  }
  /// Polls until a new reading is there; false if it never comes.
  bool poll_for_reading(sensor::Sensor& sensor) {
    const auto before = sink.readings.size();
    for (int i = 0; i < 40 && sink.readings.size() == before; ++i) poll(sensor);
    return sink.readings.size() > before;
  }
  /// Polls until something was refused twice for this reason, and publishes nothing meanwhile.
  void expect_refusals(sensor::Sensor& sensor, decode::Refusal why, bool and_no_others) {
    sink.refusals.clear();
    const auto before = sink.readings.size();
    for (int i = 0; i < 40 && sink.count(why) < 2; ++i) poll(sensor);
    EXPECT_GE(sink.count(why), 2);
    EXPECT_EQ(sink.readings.size(), before);
    if (and_no_others) {
      EXPECT_THAT(sink.refusals, Each(why));
    }
  }
};

TEST(ModbusDriver, ReadsBothSlavesOverTcp) {
  const ScriptedServer server([](const Bytes& request) { return right_reply(request); });
  const auto sensor = open_tcp(server.port());
  Bench bench;
  ASSERT_TRUE(bench.poll_for_reading(*sensor));
  EXPECT_NEAR(bench.sink.readings[0].speed_m_s, 8.6, 1e-9);
  EXPECT_EQ(bench.sink.readings[0].direction_deg, 270.0);
  EXPECT_TRUE(bench.sink.refusals.empty());
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("127.0.0.1:" + std::to_string(server.port())));
}

TEST(ModbusDriver, ReachesAServerByItsName) {
  const ScriptedServer server([](const Bytes& request) { return right_reply(request); });
  const auto sensor = open_sensor({{"host", std::string("localhost")}, {"port", std::int64_t{server.port()}}});
  Bench bench;
  EXPECT_TRUE(bench.poll_for_reading(*sensor));
}

/// One way for a device to fail, and what it must be counted as.
struct Fault {
  const char* name;
  decode::Refusal why;
  std::function<std::optional<Bytes>(const Bytes& request)> reply;
  double timeout_s = kPatient_s;
  wind::LinkState state = wind::LinkState::kConnecting;

  friend void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }
};

class ModbusFaultTest : public testing::TestWithParam<Fault> {};

TEST_P(ModbusFaultTest, IsCountedNeverPublishedAndTheReadingReturnsByItself) {
  std::atomic<bool> is_broken = false;
  const ScriptedServer server(
      [&](const Bytes& request) { return is_broken ? GetParam().reply(request) : right_reply(request); });
  const auto sensor = open_tcp(server.port(), "renke-rs-fsjt-n01", GetParam().timeout_s);
  Bench bench;
  ASSERT_TRUE(bench.poll_for_reading(*sensor));

  is_broken = true;
  bench.expect_refusals(*sensor, GetParam().why, GetParam().timeout_s == kPatient_s);
  EXPECT_EQ(bench.sink.last_state(), GetParam().state);

  is_broken = false;
  ASSERT_TRUE(bench.poll_for_reading(*sensor));
  EXPECT_NEAR(bench.sink.readings.back().speed_m_s, 8.6, 1e-9);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
}

INSTANTIATE_TEST_SUITE_P(Every, ModbusFaultTest,
                         testing::Values(Fault{"Silence", decode::Refusal::kTimeout,
                                               [](const Bytes&) { return Bytes{}; }, kImpatient_s},
                                         Fault{"Exception", decode::Refusal::kException,
                                               [](const Bytes& request) {
                                                 return Bytes{request[0], request[1], 0, 0, 0, 3, request[6], 0x83, 4};
                                               }},
                                         Fault{"WrongId", decode::Refusal::kNotMine,
                                               [](const Bytes& request) {
                                                 Bytes reply = right_reply(request);
                                                 ++reply[6];
                                                 return reply;
                                               },
                                               kImpatient_s},
                                         Fault{"WrongTransaction", decode::Refusal::kNotMine,
                                               [](const Bytes& request) {
                                                 Bytes reply = right_reply(request);
                                                 --reply[1];
                                                 return reply;
                                               },
                                               kImpatient_s},
                                         Fault{"CutOff", decode::Refusal::kTooShort,
                                               [](const Bytes& request) {
                                                 Bytes reply = right_reply(request);
                                                 reply.pop_back();
                                                 return reply;
                                               },
                                               kImpatient_s},
                                         Fault{"OtherFunction", decode::Refusal::kMalformed,
                                               [](const Bytes& request) {
                                                 Bytes reply = right_reply(request);
                                                 reply[7] = 4;
                                                 return reply;
                                               }},
                                         Fault{"NotModbus", decode::Refusal::kMalformed,
                                               [](const Bytes&) {
                                                 const std::string text = "login: user unknown";
                                                 return Bytes(text.begin(), text.end());
                                               }},
                                         Fault{"TooFast", decode::Refusal::kImplausible,
                                               [](const Bytes& request) {
                                                 Bytes reply = right_reply(request);
                                                 reply[9] = 0x7F;
                                                 return reply;
                                               },
                                               kPatient_s, wind::LinkState::kConnected}),
                         [](const auto& test) { return test.param.name; });

/// How often a device that answers like this is asked in a minute.
int requests_in_a_minute(const std::function<Bytes(const Bytes&)>& reply) {
  std::atomic<int> requests = 0;
  const ScriptedServer server([&](const Bytes& request) {
    ++requests;
    return reply(request);
  });
  const auto sensor = open_tcp(server.port(), "renke-rs-fsjt-n01");
  Bench bench;
  const MonoTime end = bench.clock.now().mono + 60s;
  while (bench.due < end) bench.poll(*sensor);
  EXPECT_TRUE(bench.sink.readings.empty());
  return requests;
}

TEST(ModbusDriver, AsksADeviceLessAndLessOftenThatAnswersWithWhatIsNoReply) {
  const auto implausible = [](const Bytes& request) {
    Bytes reply = right_reply(request);
    reply[9] = 0x7F;
    return reply;
  };
  EXPECT_EQ(requests_in_a_minute(implausible), 5 * 60) << "a valid reply: the profile's pace is kept";

  const auto text = [](const Bytes&) {
    const std::string greeting = "login: user unknown";
    return Bytes(greeting.begin(), greeting.end());
  };
  const auto other_function = [](const Bytes& request) {
    Bytes reply = right_reply(request);
    reply[7] = 4;
    return reply;
  };
  const auto exception = [](const Bytes& request) {
    return Bytes{request[0], request[1], 0, 0, 0, 3, request[6], 0x83, 4};
  };
  for (const std::function<Bytes(const Bytes&)>& reply :
       {std::function<Bytes(const Bytes&)>(text), std::function<Bytes(const Bytes&)>(other_function),
        std::function<Bytes(const Bytes&)>(exception)}) {
    const int requests = requests_in_a_minute(reply);
    EXPECT_GE(requests, 6);
    EXPECT_LE(requests, 15) << "waits double up to 10 s";
  }
}

TEST(ModbusDriver, NeverTakesTheAnswerToAnEarlierRequestForTheNextOne) {
  // The device answers each request only when the next one comes: every answer is one too late.
  Bytes held;
  int number = 0;
  const ScriptedServer server([&](const Bytes& request) {
    Bytes late = std::exchange(held, right_reply(request));
    held.back() = static_cast<std::uint8_t>(++number);
    return late;
  });
  const auto sensor = open_tcp(server.port(), "renke-rs-fsjt-n01", kImpatient_s);
  Bench bench;
  bench.expect_refusals(*sensor, decode::Refusal::kNotMine, false);
}

TEST(ModbusDriver, TakesTheRightAnswerBehindALateOne) {
  const ScriptedServer server([](const Bytes& request) {
    Bytes late = right_reply(request);
    --late[1];
    late.back() = 0;
    const Bytes right = right_reply(request);
    late.insert(late.end(), right.begin(), right.end());
    return late;
  });
  const auto sensor = open_tcp(server.port(), "renke-rs-fsjt-n01");
  Bench bench;
  ASSERT_TRUE(bench.poll_for_reading(*sensor));
  EXPECT_NEAR(bench.sink.readings[0].speed_m_s, 8.6, 1e-9);
  EXPECT_THAT(bench.sink.refusals, testing::ElementsAre(decode::Refusal::kNotMine));
}

TEST(ModbusDriver, ComesBackAfterTheServerDroppedItsConnections) {
  std::atomic<bool> drops = false;
  const ScriptedServer server(
      [&](const Bytes& request) { return drops ? std::nullopt : std::optional(right_reply(request)); });
  const auto sensor = open_tcp(server.port());
  Bench bench;
  ASSERT_TRUE(bench.poll_for_reading(*sensor));
  drops = true;
  const auto before = bench.sink.readings.size();
  for (int i = 0; i < 6; ++i) bench.poll(*sensor);
  EXPECT_EQ(bench.sink.readings.size(), before);
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("was lost"));
  drops = false;
  EXPECT_TRUE(bench.poll_for_reading(*sensor));
}

TEST(ModbusDriver, FindsARestartedServerAgainAndSaysSoMeanwhile) {
  const auto script = [](const Bytes& request) { return right_reply(request); };
  auto server = std::make_unique<ScriptedServer>(script);
  const std::uint16_t port = server->port();
  const auto sensor = open_tcp(port);
  Bench bench;
  ASSERT_TRUE(bench.poll_for_reading(*sensor));

  server.reset();
  for (int i = 0; i < 10; ++i) bench.poll(*sensor);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("cannot connect to 127.0.0.1:" + std::to_string(port)));
  EXPECT_LE(bench.due - bench.clock.now().mono, 10s);

  server = std::make_unique<ScriptedServer>(script, port);
  EXPECT_TRUE(bench.poll_for_reading(*sensor));
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
}

TEST(ModbusDriver, EndsAPollThatWaitsWhenItIsInterrupted) {
  // The server interrupts while the driver waits for its answer, for which it would give it ten seconds.
  std::unique_ptr<sensor::Sensor> sensor;
  const ScriptedServer server([&](const Bytes&) {
    sensor->interrupt();
    return Bytes{};
  });
  sensor = open_sensor({{"port", std::int64_t{server.port()}}, {"response_timeout", 10.0}});
  Bench bench;
  bench.poll(*sensor);
  bench.poll(*sensor);
  EXPECT_TRUE(bench.sink.refusals.empty());
  EXPECT_TRUE(bench.sink.readings.empty());
}

TEST(ModbusDriver, ReadsBothSlavesOverASerialLine) {
  const SerialBus bus({{.slave = 1, .registers = {123}}, {.slave = 2, .registers = {0, 360}}});
  const auto sensor = open_sensor({{"transport", std::string("rtu")}, {"device", bus.device()}});
  Bench bench;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(bench.poll_for_reading(*sensor));
  EXPECT_NEAR(bench.sink.readings[4].speed_m_s, 12.3, 1e-9);
  EXPECT_EQ(bench.sink.readings[4].direction_deg, 0.0);
  EXPECT_TRUE(bench.sink.refusals.empty());
}

/// A serial device that answers 8 bytes of request with whatever the test says, over and over.
class ScriptedSerial {
 public:
  ScriptedSerial(int line, std::function<Bytes(const Bytes&)> script) : line_(line), script_(std::move(script)) {
    thread_ = std::thread([this] {
      for (Bytes request;;) {
        std::array<pollfd, 2> waits = {{{wake_.get(), POLLIN, 0}, {line_, POLLIN, 0}}};
        poll(waits.data(), waits.size(), -1);
        if (waits[0].revents != 0) return;
        std::uint8_t byte = 0;
        if (read(line_, &byte, 1) != 1) return;
        request.push_back(byte);
        if (request.size() < 8) continue;
        const Bytes reply = script_(request);
        EXPECT_EQ(write(line_, reply.data(), reply.size()), std::ssize(reply));
        request.clear();
      }
    });
  }
  ~ScriptedSerial() {
    eventfd_write(wake_.get(), 1);
    thread_.join();
  }
  ScriptedSerial(const ScriptedSerial&) = delete;
  ScriptedSerial& operator=(const ScriptedSerial&) = delete;

 private:
  int line_;
  std::function<Bytes(const Bytes&)> script_;
  Descriptor wake_{eventfd(0, 0)};
  std::thread thread_;
};

struct SerialFault {
  const char* name;
  decode::Refusal why;
  Bytes reply;
  double timeout_s = kPatient_s;

  friend void PrintTo(const SerialFault& fault, std::ostream* out) { *out << fault.name; }
};

class ModbusSerialFaultTest : public testing::TestWithParam<SerialFault> {};

TEST_P(ModbusSerialFaultTest, IsCountedNeverPublishedAndTheReadingReturnsByItself) {
  const SerialPort port;
  std::atomic<bool> is_broken = true;
  const ScriptedSerial device(port.far_end(), [&](const Bytes&) {
    return is_broken ? GetParam().reply : Bytes{0x01, 0x03, 0x02, 0x00, 0x56, 0x38, 0x7A};
  });
  const auto sensor = open_sensor({{"transport", std::string("rtu")},
                                   {"device", port.device()},
                                   {"profile", std::string("renke-rs-fsjt-n01")},
                                   {"response_timeout", GetParam().timeout_s}});
  Bench bench;
  bench.expect_refusals(*sensor, GetParam().why, GetParam().timeout_s == kPatient_s);

  is_broken = false;
  ASSERT_TRUE(bench.poll_for_reading(*sensor));
  EXPECT_NEAR(bench.sink.readings.back().speed_m_s, 8.6, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(
    Every, ModbusSerialFaultTest,
    testing::Values(
        SerialFault{"Silence", decode::Refusal::kTimeout, {}, kImpatient_s},
        SerialFault{"Exception", decode::Refusal::kException, {0x01, 0x83, 0x02, 0xC0, 0xF1}},
        SerialFault{
            "AnotherSlave", decode::Refusal::kNotMine, {0x02, 0x03, 0x02, 0x00, 0x25, 0x3D, 0x9F}, kImpatient_s},
        SerialFault{"CutOff", decode::Refusal::kTooShort, {0x01, 0x03, 0x02, 0x00, 0x56, 0x38}, kImpatient_s},
        SerialFault{"WrongSum", decode::Refusal::kBadChecksum, {0x01, 0x03, 0x02, 0x00, 0x57, 0x38, 0x7A}},
        SerialFault{"Noise", decode::Refusal::kBadChecksum, {0x5A, 0x13, 0xFF, 0x00, 0x77, 0xFE, 0x00}},
        SerialFault{"NoiseThatClaimsToBeLong", decode::Refusal::kMalformed, {0x5A, 0x00, 0xFF, 0x13, 0x77, 0xFE}}),
    [](const auto& test) { return test.param.name; });

TEST(ModbusDriver, ReadsThroughTheStrayByteOfAnRs485Transceiver) {
  for (const std::uint8_t stray : {std::uint8_t{0x00}, std::uint8_t{0xFF}}) {
    const SerialPort port;
    const ScriptedSerial device(
        port.far_end(), [stray](const Bytes&) { return Bytes{stray, 0x01, 0x03, 0x02, 0x00, 0x56, 0x38, 0x7A}; });
    const auto sensor = open_sensor(
        {{"transport", std::string("rtu")}, {"device", port.device()}, {"profile", std::string("renke-rs-fsjt-n01")}});
    Bench bench;
    ASSERT_TRUE(bench.poll_for_reading(*sensor)) << int{stray};
    EXPECT_NEAR(bench.sink.readings[0].speed_m_s, 8.6, 1e-9);
    EXPECT_TRUE(bench.sink.refusals.empty());
  }
}

TEST(ModbusDriver, TakesTheRightAnswerBehindAnotherSlavesLateOneOnASerialLine) {
  const SerialPort port;
  const ScriptedSerial device(port.far_end(), [](const Bytes&) {
    return Bytes{0x02, 0x03, 0x02, 0x00, 0x25, 0x3D, 0x9F, 0x01, 0x03, 0x02, 0x00, 0x56, 0x38, 0x7A};
  });
  const auto sensor = open_sensor(
      {{"transport", std::string("rtu")}, {"device", port.device()}, {"profile", std::string("renke-rs-fsjt-n01")}});
  Bench bench;
  ASSERT_TRUE(bench.poll_for_reading(*sensor));
  EXPECT_NEAR(bench.sink.readings[0].speed_m_s, 8.6, 1e-9);
  EXPECT_THAT(bench.sink.refusals, testing::ElementsAre(decode::Refusal::kNotMine));
}

TEST(ModbusDriver, SaysWhatToDoWhenTheSerialPortIsGone) {
  auto bus = std::make_unique<SerialBus>(
      std::vector<SerialBus::Device>{{.slave = 1, .registers = {50}}, {.slave = 2, .registers = {0, 90}}});
  const std::string device = bus->device();
  const auto sensor = open_sensor({{"transport", std::string("rtu")}, {"device", device}});
  Bench bench;
  ASSERT_TRUE(bench.poll_for_reading(*sensor));
  bus.reset();
  for (int i = 0; i < 6; ++i) bench.poll(*sensor);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("cannot open " + device));
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("group dialout"));
}

TEST(ModbusDriver, RefusesOptionsThatCannotWork) {
  const auto error_of = [](const ParameterValues::Map& given) -> std::string {
    try {
      open_sensor(given);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(error_of({{"transport", std::string("rtu")}}), HasSubstr("device: is missing"));
  EXPECT_THAT(error_of({{"host", std::string()}}), HasSubstr("host: is empty"));
  EXPECT_THAT(
      error_of({{"transport", std::string("rtu")}, {"device", std::string("/dev/x")}, {"baud", std::int64_t{1234}}}),
      HasSubstr("baud: is 1234; allowed: 0, 1200, "));
  EXPECT_THAT(error_of({{"profile", std::string("nothing")}}),
              HasSubstr("no Modbus profile named \"nothing\"; known: "));
  EXPECT_THAT(error_of({{"profile", std::string("renke-rs-fsjt-n01")}, {"direction_slave", std::int64_t{3}}}),
              HasSubstr("direction_slave: "));
  EXPECT_THAT(error_of({{"direction_device", std::string("/dev/x")}}),
              HasSubstr("direction_device: is only for transport"));
  EXPECT_THAT(error_of({{"transport", std::string("rtu")},
                        {"device", std::string("/dev/x")},
                        {"direction_device", std::string("/dev/y")},
                        {"profile", std::string("renke-rs-fsjt-n01")}}),
              HasSubstr("direction_device: profile"));
}

TEST(ModbusDriver, AsksTheSlavesThatTheOptionsName) {
  std::atomic<int> strangers = 0;
  const ScriptedServer server([&](const Bytes& request) {
    if (request[6] != 7 && request[6] != 9) ++strangers;
    Bytes reply = right_reply(request);
    if (request[6] == 7) reply[9] = 0, reply[10] = 42;
    return reply;
  });
  const auto sensor = open_sensor(
      {{"port", std::int64_t{server.port()}}, {"speed_slave", std::int64_t{7}}, {"direction_slave", std::int64_t{9}}});
  Bench bench;
  ASSERT_TRUE(bench.poll_for_reading(*sensor));
  EXPECT_NEAR(bench.sink.readings[0].speed_m_s, 4.2, 1e-9);
  EXPECT_EQ(bench.sink.readings[0].direction_deg, 270.0);
  EXPECT_EQ(strangers, 0);
}

TEST(ModbusDriver, RefusesTwoSensorsThatWantDifferentSettingsOnOneSerialPort) {
  const SerialPort port;
  const ParameterValues::Map cup = {
      {"transport", std::string("rtu")}, {"device", port.device()}, {"profile", std::string("renke-rs-fsjt-n01")}};
  const auto first = open_sensor(cup);
  ParameterValues::Map other = cup;
  other["baud"] = std::int64_t{9600};
  EXPECT_THROW(open_sensor(other), std::runtime_error);
  other["baud"] = std::int64_t{4800};
  EXPECT_NO_THROW(open_sensor(other));
}

TEST(ModbusDriver, KeepsTheGapThatTheInstallationAsksFor) {
  const ScriptedServer server([](const Bytes& request) { return right_reply(request); });
  const auto sensor = open_sensor({{"port", std::int64_t{server.port()}}, {"min_gap", 0.3}});
  Bench bench;
  for (int i = 0; i < 6; ++i) {
    bench.poll(*sensor);
    if (i > 0) {
      EXPECT_GE(bench.due - bench.clock.now().mono, 300ms);
    }
  }
  EXPECT_GE(bench.sink.readings.size(), 2U);
}

TEST(ModbusDriver, SaysWhoElseHasThePort) {
  // Another program is another open file to the system.
  const SerialPort port;
  const Descriptor other(open(port.device().c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  ASSERT_EQ(flock(other.get(), LOCK_EX | LOCK_NB), 0);
  const auto sensor = open_sensor({{"transport", std::string("rtu")}, {"device", port.device()}});
  Bench bench;
  bench.poll(*sensor);
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("another program uses it"));
}

}  // namespace
}  // namespace yuragi::drivers::modbus
