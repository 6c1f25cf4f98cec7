// The driver as the daemon opens and runs it, with the simulated gateway and with requests of the test's own, over TCP
// on the loopback.
#include <array>
#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>

#include "drivers/network/http_server.hpp"
#include "simulators/network/ecowitt_push_simulator.hpp"
#include "tests/drivers/network/gateway_fault.hpp"
#include "tests/support/descriptor.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/live_sensor.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/simulator_thread.hpp"
#include "tests/support/still_wind.hpp"

namespace yuragi::drivers::network {
namespace {

using namespace std::chrono_literals;
using simulators::core::FaultKind;
using simulators::network::EcowittPushOptions;
using simulators::network::EcowittPushSimulator;
using simulators::network::PushProtocol;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
using testing::ThrowsMessage;

constexpr simulators::core::PlayedMoment kPushedWind = {.speed_m_s = 7.3, .direction_deg = 123.0};
constexpr std::string_view kPasskey = "0123456789ABCDEF0123456789ABCDEF";

/// Hundredths of a mile per hour are what a push says.
constexpr double kPushStep_m_s = 0.0023;

std::unique_ptr<sensor::Sensor> open_push(std::uint16_t port, ParameterValues::Map given = {}) {
  given.try_emplace("port", std::int64_t{port});
  return driver_named("ecowitt-push").open(values_for("ecowitt-push", given));
}

std::unique_ptr<EcowittPushSimulator> pushing_gateway(std::uint16_t port, PushProtocol protocol) {
  EcowittPushOptions options;
  options.port = port;
  options.protocol = protocol;
  options.station = kPasskey;
  options.interval_s = 0.12;
  return std::make_unique<EcowittPushSimulator>(
      options, simulators::core::MeasuredWind(std::make_unique<StillWind>(kPushedWind)));
}

class EcowittPushFault : public GatewayFault {
 protected:
  EcowittPushFault() : EcowittPushFault(free_port(SOCK_STREAM)) {}

 private:
  explicit EcowittPushFault(std::uint16_t port)
      : GatewayFault(pushing_gateway(port, PushProtocol::kEcowitt),
                     open_push(port, {{"silence", 1.0}, {"station_key", Secret(std::string(kPasskey))}}),
                     kPushStep_m_s) {}
};

TEST_F(EcowittPushFault, Silence) {
  simulator_.set_fault(FaultKind::kSilence);
  ASSERT_TRUE(live_.wait_until([&] {
    return live_.sink.last_detail().find("for a gateway, set host") != std::string::npos;
  })) << live_.sink.last_detail();
  EXPECT_EQ(live_.sink.last_state(), wind::LinkState::kConnecting);
  expect_return();
}

TEST_F(EcowittPushFault, Freeze) {
  expect_freeze_is_published();
}

TEST_F(EcowittPushFault, Spike) {
  expect_spike_is_not_believed();
}

TEST_F(EcowittPushFault, Garbage) {
  expect_refusals(FaultKind::kGarbage, decode::Refusal::kMalformed, "does not use HTTP");
  expect_return();
}

TEST_F(EcowittPushFault, Split) {
  expect_pieces_are_joined();
}

TEST_F(EcowittPushFault, Partial) {
  expect_refusals(FaultKind::kPartial, decode::Refusal::kTooShort, "ends the connection before its push is complete");
  expect_return();
}

TEST_F(EcowittPushFault, WrongId) {
  expect_refusals(FaultKind::kWrongId, decode::Refusal::kNotMine, "`station_key` selects another station");
  expect_return();
}

TEST_F(EcowittPushFault, Disconnect) {
  expect_refusals(FaultKind::kDisconnect, decode::Refusal::kTooShort,
                  "ends the connection before its push is complete");
  expect_return();
}

TEST_F(EcowittPushFault, Unplug) {
  expect_refusals(FaultKind::kUnplug, decode::Refusal::kInvalid,
                  "GW1100A_V2.4.5 at 127.0.0.1 pushes no wind: check the anemometer's battery");
  expect_return();
}

class EcowittPushProtocols : public testing::TestWithParam<PushProtocol> {};

TEST_P(EcowittPushProtocols, AreAllTaken) {
  const std::uint16_t port = free_port(SOCK_STREAM);
  const SimulatorThread simulator(pushing_gateway(port, GetParam()));
  test::LiveSensor live(open_push(port));
  ASSERT_TRUE(live.wait_for_readings(3)) << live.sink.last_detail();
  EXPECT_NEAR(live.sink.readings.back().speed_m_s, 7.3, kPushStep_m_s);
  EXPECT_EQ(live.sink.readings.back().direction_deg, 123.0);
  EXPECT_THAT(live.sink.refusals, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(All, EcowittPushProtocols,
                         testing::Values(PushProtocol::kEcowitt, PushProtocol::kWunderground, PushProtocol::kAmbient,
                                         PushProtocol::kWsLink));

/// A connection to a port of this machine.
Descriptor connect_to(std::uint16_t port) {
  Descriptor client(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const timeval hang = {.tv_sec = RunningSensor::kHang.count(), .tv_usec = 0};
  setsockopt(client.get(), SOL_SOCKET, SO_RCVTIMEO, &hang, sizeof hang);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  if (connect(client.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("nobody listens");
  return client;
}

void send_all(const Descriptor& client, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = send(client.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;  // it has heard enough
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

/// All that comes until the other side closes.
std::string receive_all(const Descriptor& client) {
  std::string all;
  std::array<char, 1024> block{};
  for (ssize_t size = 0; (size = recv(client.get(), block.data(), block.size(), 0)) > 0;)
    all.append(block.data(), static_cast<std::size_t>(size));
  return all;
}

std::string answer_to(std::uint16_t port, std::string_view request) {
  const Descriptor client = connect_to(port);
  send_all(client, request);
  return receive_all(client);
}

std::string post_of(std::string_view form, std::string_view path = "/data/report/") {
  return fmt::format("POST {} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: {}\r\n\r\n{}", path, form.size(), form);
}

std::string wind_form(std::string_view station, double speed_mph) {
  return fmt::format(
      "PASSKEY={}&stationtype=GW2000A_V2.1.5&dateutc=2022-07-15+15:26:14&tempf=50&winddir=289"
      "&windspeedmph={}&windgustmph=30",
      station, speed_mph);
}

/// The driver in a time that the test makes, and what it says.
struct PushBench {
  explicit PushBench(ParameterValues::Map given = {}) : sensor(open_push(port, std::move(given))) {
    sensor->poll(clock, sink);  // listens
  }

  /// The answer to a request at this moment.
  std::string ask(const std::string& request) {
    auto answer = std::async(std::launch::async, [&] { return answer_to(port, request); });
    while (answer.wait_for(0s) != std::future_status::ready) sensor->poll(clock, sink);
    return answer.get();
  }

  std::uint16_t port = free_port(SOCK_STREAM);
  ManualClock clock;
  RecordingSink sink;
  std::unique_ptr<sensor::Sensor> sensor;
};

TEST(EcowittPushDriver, AnswersWhatItTakes) {
  PushBench bench;
  const std::string answer = bench.ask(post_of(wind_form(kPasskey, 10)));
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(answer, HasSubstr("Connection: close\r\n"));
  EXPECT_TRUE(answer.ends_with("\r\n\r\nsuccess\n")) << answer;
  ASSERT_EQ(bench.sink.readings.size(), 1U);
  EXPECT_NEAR(bench.sink.readings[0].speed_m_s, 4.4704, 1e-9);
  EXPECT_NEAR(*bench.sink.readings[0].gust_m_s, 13.4112, 1e-9);
  EXPECT_EQ(bench.sink.readings[0].direction_deg, 289.0);
  EXPECT_EQ(bench.sink.readings[0].time.utc, bench.clock.now().utc) << "when it arrived";
  ASSERT_EQ(bench.sink.station_quantities.size(), 1U);
  EXPECT_NEAR(*bench.sink.station_quantities[0].air_temperature_c, 10.0, 1e-9);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
  EXPECT_EQ(bench.sink.last_detail(),
            fmt::format("GW2000A_V2.1.5 at 127.0.0.1 pushes to http://127.0.0.1:{}", bench.port));

  // Without an anemometer the values are taken, and the station has done nothing wrong.
  EXPECT_THAT(bench.ask(post_of("PASSKEY=" + std::string(kPasskey) + "&tempf=50")), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(bench.sink.refusals, ElementsAre(decode::Refusal::kInvalid));
  EXPECT_EQ(bench.sink.station_quantities.size(), 2U);
}

TEST(EcowittPushDriver, TakesTargetsThatWereTypedWithoutAQuestionMark) {
  PushBench bench;
  EXPECT_THAT(bench.ask("GET /data/report/" + wind_form(kPasskey, 10) + " HTTP/1.1\r\nHost: 10.0.0.1\r\n\r\n"),
              StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(bench.ask("GET " + wind_form(kPasskey, 10) + " HTTP/1.0\r\n\r\n"), StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(bench.sink.readings.size(), 2U);
}

TEST(EcowittPushDriver, SaysWhatIsWrongWithARequest) {
  PushBench bench({{"path", std::string("/roof/")}});
  EXPECT_THAT(bench.ask(post_of(wind_form(kPasskey, 10))), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("set Path in the gateway to /roof/"));
  EXPECT_THAT(bench.ask("PUT /roof/ HTTP/1.1\r\nContent-Length: 0\r\n\r\n"), StartsWith("HTTP/1.1 405"));
  EXPECT_THAT(bench.ask(post_of("{\"speed\": 3}", "/roof/")), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(bench.ask(post_of("", "/roof")), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(bench.ask("hello\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(bench.ask("POST /roof/ HTTP/1.1\r\nContent-Length: 1000000000000\r\n\r\nPASSKEY=a"),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(bench.ask("GET /roof/?a=" + std::string(20'000, 'a') + " HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(bench.sink.readings, IsEmpty());
  EXPECT_EQ(bench.sink.refusals.size(), 7U);
  EXPECT_THAT(bench.ask(post_of(wind_form(kPasskey, 10), "/roof")), StartsWith("HTTP/1.1 200"));
}

TEST(EcowittPushDriver, RefusesBrowsersAndHostsOfOthers) {
  PushBench bench({{"host_name", std::string("wall.example.org")}});
  const auto push_with = [&](const std::string& fields) {
    return bench.ask("GET /data/report/?" + wind_form(kPasskey, 10) + " HTTP/1.1\r\n" + fields + "\r\n\r\n");
  };
  for (const char* const field : {"Origin: http://evil.example", "Referer: http://evil.example/",
                                  "Sec-Fetch-Site: cross-site", "Sec-Fetch-Mode: no-cors"}) {
    EXPECT_THAT(push_with(std::string("Host: 127.0.0.1\r\n") + field), StartsWith("HTTP/1.1 403")) << field;
    EXPECT_THAT(bench.sink.last_detail(), HasSubstr("refuses pushes of a web browser at 127.0.0.1"));
  }
  for (const char* const host : {"evil.example", "127.0.0.1.evil.example", "[::1]evil", "wall.example.org.evil"}) {
    EXPECT_THAT(push_with(std::string("Host: ") + host), StartsWith("HTTP/1.1 421")) << host;
    EXPECT_THAT(bench.sink.last_detail(), HasSubstr("set this machine's address in the gateway"));
  }
  EXPECT_THAT(bench.sink.readings, IsEmpty());
  for (const char* const host :
       {"127.0.0.1", "192.168.1.5:8090", "[::1]:8090", "localhost", "wall.example.org:8090", ""}) {
    EXPECT_THAT(push_with(std::string("Host: ") + host), StartsWith("HTTP/1.1 200")) << host;
  }
}

TEST(EcowittPushDriver, WarnsOfASecondStationUntilTheFirstFallsSilent) {
  PushBench bench({{"silence", 60.0}});
  EXPECT_THAT(bench.ask(post_of(wind_form("AAA", 10))), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(bench.ask(post_of(wind_form("BBB", 20))), StartsWith("HTTP/1.1 403"));
  EXPECT_EQ(bench.sink.readings.size(), 1U);
  bench.clock.advance(16s);
  EXPECT_THAT(bench.ask(post_of(wind_form("AAA", 10))), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(bench.sink.last_detail(),
              HasSubstr("GW2000A_V2.1.5 at 127.0.0.1 pushes, too, but is not used: select one"));

  bench.clock.advance(60s);
  bench.sensor->poll(bench.clock, bench.sink);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(bench.ask(post_of(wind_form("BBB", 20))), StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
}

TEST(EcowittPushDriver, KnowsTheIntervalThatIsSetInTheGateway) {
  PushBench bench({{"silence", 60.0}});
  for (int i = 0; i < 3; ++i) {
    bench.ask(post_of(wind_form(kPasskey, 10)));
    bench.clock.advance(50s);
  }
  bench.clock.advance(150s);  // 200 s, four of its pauses
  bench.sensor->poll(bench.clock, bench.sink);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
  bench.clock.advance(50s);
  bench.sensor->poll(bench.clock, bench.sink);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);
}

TEST(EcowittPushDriver, LearnsTheIntervalOfTheNextStationAnew) {
  PushBench bench({{"silence", 60.0}});
  for (int i = 0; i < 3; ++i) {
    bench.ask(post_of(wind_form("AAA", 10)));
    bench.clock.advance(600s);
    bench.sensor->poll(bench.clock, bench.sink);
  }
  bench.clock.advance(2400s);  // 3000 s, five of AAA's pauses
  bench.sensor->poll(bench.clock, bench.sink);
  EXPECT_THAT(bench.ask(post_of(wind_form("BBB", 20))), StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnected);
  bench.clock.advance(60s);
  bench.sensor->poll(bench.clock, bench.sink);
  EXPECT_EQ(bench.sink.last_state(), wind::LinkState::kConnecting);
}

/// Neither a message that is traced nor a status, whatever is wrong with the push.
TEST(EcowittPushDriver, ShowsNoKey) {
  PushBench bench({{"path", std::string("/a")}});
  const std::string form = "PASSKEY=topsecret&PASSWORD=topsecret&windspeedmph=10&tempf=1";
  for (const std::string& request :
       {post_of(form, "/a"), post_of(form, "/b"), post_of("x" + form, "/a"), post_of("windspeedmph=y&" + form, "/a"),
        "GET /a?" + form + " HTTP/1.1\r\n\r\n", "GET /a/" + form + " HTTP/1.1\r\n\r\n",
        "GET /atopsecret" + form + " HTTP/1.1\r\n\r\n", post_of("{\"PASSKEY\": \"topsecret\"}", "/a")}) {
    EXPECT_THAT(bench.ask(request), Not(HasSubstr("topsecret")));
  }
  EXPECT_THAT(bench.ask("GET /a?wsid=b&wspw=topsecret&t1ws=1 HTTP/1.1\r\n\r\n"), Not(HasSubstr("topsecret")));
  EXPECT_EQ(bench.sink.raws.size(), 9U);
  for (const RecordingSink::Raw& raw : bench.sink.raws)
    EXPECT_THAT(std::string(raw.message.begin(), raw.message.end()), Not(HasSubstr("topsecret")));
  for (const RecordingSink::Link& link : bench.sink.links) EXPECT_THAT(link.detail, Not(HasSubstr("topsecret")));
  EXPECT_EQ(std::string(bench.sink.raws[0].message.begin(), bench.sink.raws[0].message.end()),
            "PASSKEY=(secret)&PASSWORD=(secret)&windspeedmph=10&tempf=1");
}

TEST(EcowittPushDriver, TakesNoMoreThanAWindCanSay) {
  PushBench bench;
  int taken = 0;
  for (int i = 0; i < 110; ++i)
    taken += bench.ask(post_of(wind_form(kPasskey, 10))).starts_with("HTTP/1.1 200") ? 1 : 0;
  EXPECT_EQ(taken, 100) << "those of a second at most";
  EXPECT_EQ(bench.sink.count(decode::Refusal::kTooFrequent), 10);
}

TEST(EcowittPushDriver, HearsOnlyWhoMaySend) {
  PushBench bench({{"host", std::string("0.0.0.0")}, {"from", std::string("192.0.2.1")}});
  EXPECT_EQ(bench.ask(post_of(wind_form(kPasskey, 10))), "");
  bench.sensor->poll(bench.clock, bench.sink);
  EXPECT_THAT(bench.sink.refusals, Each(decode::Refusal::kNotMine));
  EXPECT_THAT(bench.sink.last_detail(), HasSubstr("refuses 127.0.0.1, which is not in `from`"));
  EXPECT_THAT(bench.sink.readings, IsEmpty());
}

TEST(EcowittPushDriver, SaysThatItsPortIsTaken) {
  const LoopbackPort taken(SOCK_STREAM);
  ASSERT_EQ(listen(taken.descriptor(), 1), 0);
  const auto sensor = open_push(taken.port());
  ManualClock clock;
  RecordingSink sink;
  sensor->poll(clock, sink);
  EXPECT_THAT(sink.last_detail(), HasSubstr("another program or sensor uses this port"));
}

TEST(EcowittPushDriver, EndsAtOnce) {
  test::LiveSensor live(open_push(free_port(SOCK_STREAM)));
  ASSERT_TRUE(live.wait_until([&] { return !live.sink.links.empty(); }));
  live.end();
}

TEST(EcowittPushSettings, AreChecked) {
  const auto throws = [](const ParameterValues::Map& given, const std::string& why) {
    EXPECT_THAT([&] { driver_named("ecowitt-push").open(values_for("ecowitt-push", given)); },
                ThrowsMessage<std::runtime_error>(HasSubstr(why)));
  };
  throws({{"host", std::string("0.0.0.0")}}, "from: is missing");
  throws({{"host", std::string("192.168.1.10")}}, "from: is missing");
  throws({{"host", std::string("gateway")}}, "host: ");
  throws({{"from", std::string("gateway")}}, "from: ");
  throws({{"path", std::string("data/report")}}, "path: must begin with a slash");

  const auto endpoints = driver_named("ecowitt-push").endpoints(values_for("ecowitt-push", {}));
  ASSERT_EQ(endpoints.size(), 1U);
  EXPECT_EQ(endpoints[0].claim, "TCP port 8090");
  EXPECT_FALSE(endpoints[0].is_shared);
}

/// Answers everything with 200, and keeps what failed.
struct KeptFailures final : HttpService {
  bool admits(const boost::asio::ip::address& /*sender*/) override { return true; }
  HttpAnswer answer(const HttpRequest& /*request*/) override {
    if (std::exchange(is_faulty, false)) throw std::runtime_error("a fault");
    ++answered;
    return {.status = 200, .text = "taken"};
  }
  void failed(HttpFailure why, const boost::asio::ip::address& /*sender*/) override { failures.push_back(why); }

  bool is_faulty = false;  ///< at the next request
  int answered = 0;
  std::vector<HttpFailure> failures;
};

/// Serves until a client has received all that it gets.
std::string serve_until_answered(HttpServer& server, HttpService& service, const Descriptor& client) {
  auto answer = std::async(std::launch::async, [&] { return receive_all(client); });
  while (answer.wait_for(0s) != std::future_status::ready) EXPECT_TRUE(server.serve(50ms, service).has_value());
  return answer.get();
}

TEST(HttpServer, GivesUpWhoIsTooSlow) {
  HttpServer server({.host = "127.0.0.1", .port = 0}, {.time = 100ms});
  ASSERT_TRUE(server.open().has_value());
  KeptFailures service;
  const Descriptor slow = connect_to(server.port());
  send_all(slow, "POST / HTTP/1.1\r\nContent-Le");
  EXPECT_EQ(serve_until_answered(server, service, slow), "");
  EXPECT_THAT(service.failures, ElementsAre(HttpFailure::kTooSlow));

  // Also who has been answered, and does not close.
  const Descriptor lingering = connect_to(server.port());
  send_all(lingering, "GET / HTTP/1.1\r\n\r\n");
  EXPECT_THAT(serve_until_answered(server, service, lingering), HasSubstr("taken"));
  EXPECT_EQ(service.failures.size(), 1U);
}

TEST(HttpServer, ClosesTheOldestOfTooManyConnections) {
  HttpServer server({.host = "127.0.0.1", .port = 0}, {.connections = 2, .time = 600s});
  ASSERT_TRUE(server.open().has_value());
  KeptFailures service;
  const Descriptor first = connect_to(server.port());
  const Descriptor second = connect_to(server.port());
  const Descriptor third = connect_to(server.port());
  EXPECT_EQ(serve_until_answered(server, service, first), "");
  EXPECT_THAT(service.failures, ElementsAre(HttpFailure::kTooMany));

  send_all(third, "GET / HTTP/1.1\r\n\r\n");
  EXPECT_THAT(serve_until_answered(server, service, third), StartsWith("HTTP/1.1 200"));
  send_all(second, "GET / HTTP/1.1\r\n\r\n");
  EXPECT_THAT(serve_until_answered(server, service, second), StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(service.answered, 2);
}

TEST(HttpServer, ListensAgainAfterItWasClosed) {
  const std::uint16_t port = free_port(SOCK_STREAM);
  HttpServer server({.host = "127.0.0.1", .port = port});
  KeptFailures service;
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(server.open().has_value());
    const Descriptor waiting = connect_to(port);
    const Descriptor client = connect_to(port);
    send_all(client, "GET / HTTP/1.1\r\n\r\n");
    EXPECT_THAT(serve_until_answered(server, service, client), StartsWith("HTTP/1.1 200"));
    server.close();
    EXPECT_EQ(receive_all(waiting), "");
  }
  EXPECT_THAT(service.failures, IsEmpty());
}

TEST(HttpServer, TellsOfAClientThatBreaksOffBeforeItWasAccepted) {
  HttpServer server({.host = "127.0.0.1", .port = 0});
  ASSERT_TRUE(server.open().has_value());
  KeptFailures service;
  {
    const Descriptor client = connect_to(server.port());
    send_all(client, "POST / HTTP/1.1\r\nContent-Length: 100\r\n\r\nwind");
    const linger reset = {.l_onoff = 1, .l_linger = 0};
    setsockopt(client.get(), SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
  }
  for (int turn = 0; turn < 100 && service.failures.empty(); ++turn)
    ASSERT_TRUE(server.serve(100ms, service).has_value());
  EXPECT_THAT(service.failures, ElementsAre(HttpFailure::kCutOff));
}

TEST(HttpServer, ARequestThatThrowsCostsItsAnswerOnly) {
  HttpServer server({.host = "127.0.0.1", .port = 0});
  ASSERT_TRUE(server.open().has_value());
  KeptFailures service;
  service.is_faulty = true;
  const std::string request = "GET / HTTP/1.1\r\n\r\n";
  for (const char* const answer : {"HTTP/1.1 500", "HTTP/1.1 200"}) {
    const Descriptor client = connect_to(server.port());
    send_all(client, request);
    EXPECT_THAT(serve_until_answered(server, service, client), StartsWith(answer));
  }
}

TEST(HttpServer, IsInterrupted) {
  HttpServer server({.host = "127.0.0.1", .port = 0});
  ASSERT_TRUE(server.open().has_value());
  KeptFailures service;
  auto served = std::async(std::launch::async, [&] { return server.serve(3600s, service).has_value(); });
  server.interrupt();
  ASSERT_EQ(served.wait_for(RunningSensor::kHang), std::future_status::ready);
  EXPECT_TRUE(served.get());
  EXPECT_TRUE(server.serve(3600s, service).has_value()) << "and from then on";
}

}  // namespace
}  // namespace yuragi::drivers::network
