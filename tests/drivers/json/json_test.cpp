// The driver as the daemon opens and runs it: with the simulated web server under each fault, and with servers that a
// test makes, over TCP on the loopback.
#include <algorithm>
#include <fstream>
#include <future>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/json/headers_file.hpp"
#include "drivers/json/json_sensor.hpp"
#include "drivers/json/observation_watch.hpp"
#include "drivers/sensor/speed_unit.hpp"
#include "simulators/network/json_simulator.hpp"
#include "tests/drivers/network/gateway_fault.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/scripted_server.hpp"
#include "tests/support/still_wind.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::json {
namespace {

using namespace std::chrono_literals;
using simulators::core::FaultKind;
using simulators::network::JsonOptions;
using simulators::network::JsonSimulator;
using testing::Each;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::ThrowsMessage;

/// The query has a key that nobody may see.
constexpr std::string_view kKey = "hunter2";

std::string url_at(std::uint16_t port) {
  return fmt::format("http://127.0.0.1:{}/wind.json?key={}", port, kKey);
}

/// A driver that polls this port of this machine.
std::unique_ptr<sensor::Sensor> open_json(std::uint16_t port, ParameterValues::Map given = {}) {
  given.try_emplace("url", Secret(url_at(port)));
  given.try_emplace("speed", std::string("/wind/speed"));
  given.try_emplace("direction", std::string("/wind/direction"));
  given.try_emplace("response_timeout", 60.0);
  return driver_named("json").open(values_for("json", given));
}

/// More often than the driver's keys allow, so that a test is short.
std::unique_ptr<sensor::Sensor> fast_sensor(std::uint16_t port) {
  Settings settings;
  settings.resource = {.url = Secret(url_at(port)), .timeout = 500ms, .max_body = 1000};
  settings.places = {.speed = "/wind/speed",
                     .direction = "/wind/direction",
                     .time = "/seen/0/at",
                     .metres_per_second = sensor::metres_per_second_in("km/h")};
  settings.every = 50ms;
  return std::make_unique<Sensor>(settings, fmt::format("127.0.0.1:{}", port),
                                  bus::make_http_client(settings.resource));
}

class JsonFault : public network::GatewayFault {
 protected:
  JsonFault() : JsonFault(free_port(SOCK_STREAM)) {}

  void wait_for_polls(std::size_t count) {
    live_.sink.raws.clear();
    ASSERT_TRUE(live_.wait_until([&] {
      return static_cast<std::size_t>(std::ranges::count(live_.sink.raws, sensor::RawDirection::kSent,
                                                         &RecordingSink::Raw::direction)) >= count;
    }));
  }

  ~JsonFault() override {
    for (const auto& link : live_.sink.links) EXPECT_THAT(link.detail, Not(HasSubstr(kKey)));
  }

 private:
  explicit JsonFault(std::uint16_t port) : GatewayFault(server(port), fast_sensor(port), 1e-3) {}

  static std::unique_ptr<JsonSimulator> server(std::uint16_t port) {
    JsonOptions options;
    options.port = port;
    options.direction_at = "/wind/direction";
    options.time_at = "/seen/0/at";
    options.unit = "km/h";
    options.interval_s = 0.05;
    options.late_s = 1.0;
    return std::make_unique<JsonSimulator>(options, simulators::core::MeasuredWind(std::make_unique<StillWind>(kWind)));
  }
};

TEST_F(JsonFault, Silence) {
  expect_refusals(FaultKind::kSilence, decode::Refusal::kTimeout, "does not reply within 0.5 s");
  expect_return();
}

TEST_F(JsonFault, Freeze) {
  simulator_.set_fault(FaultKind::kFreeze);
  wait_for_polls(3);
  forget();
  wait_for_polls(5);
  EXPECT_THAT(live_.sink.readings, IsEmpty()) << "the same observation is no new reading";
  EXPECT_THAT(live_.sink.refusals, IsEmpty());
  EXPECT_EQ(live_.sink.last_state(), wind::LinkState::kConnected);
  expect_return();
}

TEST_F(JsonFault, Spike) {
  expect_spike_is_not_believed();
}

TEST_F(JsonFault, Garbage) {
  expect_refusals(FaultKind::kGarbage, decode::Refusal::kMalformed, "is damaged (");
  expect_return();
}

TEST_F(JsonFault, Split) {
  expect_pieces_are_joined();
}

TEST_F(JsonFault, Partial) {
  expect_refusals(FaultKind::kPartial, decode::Refusal::kTooShort, "is damaged (");
  expect_return();
}

TEST_F(JsonFault, WrongId) {
  expect_refusals(FaultKind::kWrongId, decode::Refusal::kMalformed, "is a web page, not JSON: check url");
  expect_return();
}

TEST_F(JsonFault, Late) {
  expect_refusals(FaultKind::kLate, decode::Refusal::kTimeout, "does not reply within 0.5 s");
  expect_return();
}

TEST_F(JsonFault, Exception) {
  expect_refusals(FaultKind::kException, decode::Refusal::kException, "replies with HTTP 503");
  expect_return();
}

TEST_F(JsonFault, Disconnect) {
  simulator_.set_fault(FaultKind::kDisconnect);
  ASSERT_TRUE(live_.wait_until([&] {
    return live_.sink.last_detail().find("cannot connect to 127.0.0.1:") != std::string::npos;
  })) << live_.sink.last_detail();
  EXPECT_EQ(live_.sink.last_state(), wind::LinkState::kConnecting);
  expect_return();
}

TEST_F(JsonFault, Unplug) {
  expect_refusals(FaultKind::kUnplug, decode::Refusal::kInvalid, "has no speed at /wind/speed");
  expect_return();
}

/// A server that gives the answer of the moment to each request, and keeps the last request.
class Server {
 public:
  Server()
      : server_([this](const ScriptedServer::Bytes& bytes) -> std::optional<ScriptedServer::Bytes> {
          const std::lock_guard lock(mutex_);
          request_.assign(bytes.begin(), bytes.end());
          ++requests_;
          return ScriptedServer::Bytes(answer_.begin(), answer_.end());
        }) {}

  std::uint16_t port() const { return server_.port(); }
  void answer(std::string_view status, const std::string& body, std::string_view headers = "") {
    answer_with(fmt::format("HTTP/1.1 {}\r\nContent-Length: {}\r\n{}\r\n{}", status, body.size(), headers, body));
  }
  void answer_with(std::string bytes) {
    const std::lock_guard lock(mutex_);
    answer_ = std::move(bytes);
  }
  std::string request() {
    const std::lock_guard lock(mutex_);
    return request_;
  }
  int requests() {
    const std::lock_guard lock(mutex_);
    return requests_;
  }

 private:
  std::mutex mutex_;
  std::string answer_;
  std::string request_;
  int requests_ = 0;
  ScriptedServer server_;
};

/// The driver in a time that the test makes.
class JsonBench : public testing::Test {
 protected:
  ~JsonBench() override {
    for (const auto& link : sink_.links) EXPECT_THAT(link.detail, Not(HasSubstr(kKey)));
    for (const auto& raw : sink_.raws)
      EXPECT_THAT(std::string(raw.message.begin(), raw.message.end()), Not(HasSubstr(kKey)));
  }

  void open(ParameterValues::Map given = {}) {
    sensor_ = open_json(server_.port(), std::move(given));
    poll();
  }
  /// Polls when the sensor wants to be. Returns the wait until the next time, s.
  double poll() {
    clock_.advance_to(due_);
    due_ = sensor_->poll(clock_, sink_);
    return seconds(due_ - clock_.now().mono);
  }
  /// One answer that is refused so.
  void expect_refusal(decode::Refusal why, const std::string& detail) {
    sink_.refusals.clear();
    poll();
    EXPECT_THAT(sink_.refusals, testing::ElementsAre(why)) << sink_.last_detail();
    EXPECT_THAT(sink_.last_detail(), HasSubstr(detail));
    EXPECT_EQ(sink_.last_state(), wind::LinkState::kConnecting);
  }
  Server server_;
  ManualClock clock_;
  RecordingSink sink_;
  MonoTime due_ = clock_.now().mono;
  std::unique_ptr<sensor::Sensor> sensor_;
};

std::string wind_json(double speed, const std::string& more = "") {
  return fmt::format(R"({{"wind": {{"speed": {}, "direction": "NW"}}{}}})", speed, more);
}

TEST_F(JsonBench, AnotherTimeIsANewObservation) {
  open({{"time", std::string("/at")}});
  server_.answer("200 OK", wind_json(4.5, R"(, "at": "2024-06-01T00:00:00Z", "noise": 1)"));
  EXPECT_EQ(poll(), 60.0);
  ASSERT_EQ(sink_.readings.size(), 1U) << sink_.last_detail();
  EXPECT_EQ(sink_.readings[0].speed_m_s, 4.5);
  EXPECT_EQ(sink_.readings[0].direction_deg, 315.0);
  server_.answer("200 OK", wind_json(4.5, R"(, "at": "2024-06-01T00:00:00Z", "noise": 2)"));
  poll();
  poll();
  server_.answer("200 OK", wind_json(4.5, R"(, "at": "2024-06-01T00:01:00Z")"));
  poll();
  EXPECT_EQ(sink_.readings.size(), 2U);
  EXPECT_TRUE(sink_.refusals.empty());
  EXPECT_EQ(sink_.last_detail(), fmt::format("server 127.0.0.1:{}", server_.port()));
}

TEST_F(JsonBench, AnObservationThatStaysTheSameIsNoLongerTheWind) {
  open({{"time", std::string("/at")}, {"silence", 150.0}});
  server_.answer("200 OK", wind_json(4.5, R"(, "at": 17)"));
  for (int i = 0; i < 3; ++i) poll();  // 0, 60, 120 s
  EXPECT_EQ(sink_.readings.size(), 0U) << "its time is 1970";
  EXPECT_EQ(sink_.count(decode::Refusal::kInvalid), 3);
  EXPECT_THAT(sink_.last_detail(), HasSubstr("is older than 150 s: check the station behind it"));

  server_.answer("200 OK", wind_json(4.5, R"(, "at": "noon")"));
  for (int i = 0; i < 3; ++i) poll();
  EXPECT_EQ(sink_.readings.size(), 1U);
  expect_refusal(decode::Refusal::kInvalid, "is older than 150 s");
  server_.answer("200 OK", wind_json(4.5, R"(, "at": "one")"));
  poll();
  EXPECT_EQ(sink_.readings.size(), 2U);
}

TEST_F(JsonBench, WithoutATimeTheSameValuesAreNewAfterTheInterval) {
  open({{"every", 2.0}});
  for (int i = 0; i < 12; ++i) {  // to 22 s
    server_.answer("200 OK", wind_json(0.0, fmt::format(R"(, "uptime": {})", i)));
    poll();
  }
  ASSERT_EQ(sink_.readings.size(), 2U);
  EXPECT_EQ(sink_.readings[1].time.mono - sink_.readings[0].time.mono, 20s);
  server_.answer("200 OK", wind_json(0.1));
  poll();
  EXPECT_EQ(sink_.readings.size(), 3U);
  EXPECT_EQ(driver_named("json").unchanged_for_s(values_for("json", {{"every", 2.0}})), 40.0);
  EXPECT_EQ(driver_named("json").unchanged_for_s(values_for("json", {{"interval", 3600.0}})), 7200.0);
}

TEST_F(JsonBench, AnEtagSparesTheServerTheSameAnswer) {
  open();
  server_.answer("200 OK", wind_json(4.5), "ETag: W/\"a1\"\r\n");
  poll();
  EXPECT_THAT(server_.request(), Not(HasSubstr("If-None-Match")));
  server_.answer_with("HTTP/1.1 304 Not Modified\r\n\r\n");
  for (int i = 0; i < 10; ++i) {
    poll();
    EXPECT_THAT(server_.request(), HasSubstr("\r\nIf-None-Match: W/\"a1\"\r\n"));
  }
  EXPECT_EQ(sink_.readings.size(), 2U) << "after the interval, ten polls, it is new";
  EXPECT_TRUE(sink_.refusals.empty());
}

TEST_F(JsonBench, StrangeEtagsAreNotSentBack) {
  open();
  for (const std::string etag : {"a", "\"a b\"", "\"\x01\"", "\"", "\"\xff\""}) {
    server_.answer("200 OK", wind_json(4.5), "etag: " + etag + "\r\n");
    poll();
    poll();
    EXPECT_THAT(server_.request(), Not(HasSubstr("If-None-Match"))) << etag;
  }
  server_.answer_with("HTTP/1.1 304 Not Modified\r\n\r\n");
  expect_refusal(decode::Refusal::kException, "replies with HTTP 304");
}

TEST_F(JsonBench, WaitsLongerAfterEachError) {
  open();
  server_.answer("500 Internal Server Error", "oops");
  double longest_s = 0.0;
  for (int i = 0; i < 8; ++i) {
    const double wait_s = poll();
    EXPECT_GE(wait_s, 45.0) << "a quarter less at most than a poll";
    EXPECT_LE(wait_s, 600.0);
    longest_s = std::max(longest_s, wait_s);
  }
  EXPECT_GE(longest_s, 450.0);
  EXPECT_EQ(sink_.count(decode::Refusal::kException), 8);
  server_.answer("200 OK", wind_json(4.5));
  EXPECT_EQ(poll(), 60.0);
  server_.answer("500 Internal Server Error", "oops");
  EXPECT_LE(poll(), 60.0) << "it begins small again";
}

TEST_F(JsonBench, WaitsAsLongAsTheServerAsksForWithinBounds) {
  open();
  server_.answer("429 Too Many Requests", "", "Retry-After: 1234\r\n");
  EXPECT_EQ(poll(), 1234.0);
  EXPECT_THAT(sink_.last_detail(), HasSubstr("too many requests: increase `every`"));
  server_.answer("503 Service Unavailable", "", "Retry-After: 99999999999\r\n");
  EXPECT_EQ(poll(), 3600.0);
  server_.answer("503 Service Unavailable", "", "Retry-After: -7\r\n");
  EXPECT_GE(poll(), 45.0);
}

TEST_F(JsonBench, ARedirectIsNotFollowed) {
  open();
  server_.answer("302 Found", "", fmt::format("Location: http://127.0.0.1:{}/again?key={}\r\n", server_.port(), kKey));
  expect_refusal(decode::Refusal::kException, "redirects to 127.0.0.1 (HTTP 302), which is not followed");
  EXPECT_EQ(server_.requests(), 1) << "not a loop";
  server_.answer("301 Moved Permanently", "", "Location: file:///etc/passwd\r\n");
  expect_refusal(decode::Refusal::kException, "(HTTP 301)");
}

TEST_F(JsonBench, StatusesHaveARemedy) {
  open();
  for (const auto& [status, remedy] :
       {std::pair("401 Unauthorized", "check the key in headers_file or url"),
        std::pair("404 Not Found", "HTTP 404: check url"), std::pair("418 Teapot", "check url and headers_file"),
        std::pair("204 No Content", "HTTP 204"), std::pair("999 Odd", "HTTP 999")}) {
    server_.answer(status, "");
    expect_refusal(decode::Refusal::kException, remedy);
  }
}

TEST_F(JsonBench, AnswersThatCannotBeReadAreCounted) {
  open();
  server_.answer("200 OK", "<!doctype html><p>Sign in");
  expect_refusal(decode::Refusal::kMalformed, "is a web page, not JSON: check url");
  server_.answer("200 OK", "wind 4 m/s");
  expect_refusal(decode::Refusal::kMalformed, "is not JSON: check url");
  server_.answer("200 OK", "");
  expect_refusal(decode::Refusal::kMalformed, "is not JSON: check url");
  server_.answer("200 OK", R"({"wind": {"speed": {"value": 4}}})");
  expect_refusal(decode::Refusal::kMalformed, "has no number at /wind/speed");
  server_.answer("200 OK", R"({"observations": []})");
  expect_refusal(decode::Refusal::kInvalid, "has no speed at /wind/speed");
  server_.answer("200 OK", wind_json(400.0));
  expect_refusal(decode::Refusal::kImplausible, "check `speed` and speed_unit");
  EXPECT_TRUE(sink_.readings.empty());
}

TEST_F(JsonBench, ALongAnswerIsNotTaken) {
  open();
  const std::string mebibyte(1024UL * 1024, ' ');
  server_.answer("200 OK", mebibyte + "1");
  expect_refusal(decode::Refusal::kMalformed, "is too long (maximum 1048576 bytes)");
  server_.answer_with("HTTP/1.1 200 OK\r\nConnection: close\r\n\r\n" + mebibyte + mebibyte);
  expect_refusal(decode::Refusal::kMalformed, "is too long");
  server_.answer_with("HTTP/1.1 200 OK\r\nX: " + mebibyte + "\r\n\r\n");
  expect_refusal(decode::Refusal::kMalformed, "is too long");
  std::string header = "HTTP/1.1 200 OK\r\n";
  for (int i = 0; i < 1000; ++i) header += fmt::format("X-{}: {}\r\n", i, std::string(100, 'x'));
  server_.answer_with(header + "\r\n{}");
  expect_refusal(decode::Refusal::kMalformed, "is too long");
}

TEST_F(JsonBench, AnAnswerThatNeverEndsIsLate) {
  open({{"response_timeout", 0.1}});
  server_.answer_with("HTTP/1.1 200 OK\r\nContent-Length: 100\r\n\r\n{");
  expect_refusal(decode::Refusal::kTimeout, "does not reply within 0.1 s");
}

TEST_F(JsonBench, SendsTheHeadersOfAFile) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "headers") << "# of the weather service\nX-Api-Key: " << kKey
                                    << "\r\n\nAuthorization: Bearer a.b\n";
  open({{"headers_file", (folder / "headers").string()}});
  server_.answer("200 OK", wind_json(4.5));
  poll();
  EXPECT_THAT(server_.request(), testing::StartsWith(fmt::format("GET /wind.json?key={} HTTP/1.1\r\n", kKey)));
  EXPECT_THAT(server_.request(), HasSubstr(fmt::format("\r\nX-Api-Key: {}\r\n", kKey)));
  EXPECT_THAT(server_.request(), HasSubstr("\r\nAuthorization: Bearer a.b\r\n"));
  EXPECT_THAT(server_.request(), HasSubstr("\r\nAccept: application/json\r\n"));
  EXPECT_EQ(sink_.readings.size(), 1U);
}

TEST(JsonDriver, EndsAtOnce) {
  std::promise<void> is_asked;
  const ScriptedServer server([&](const ScriptedServer::Bytes&) {
    is_asked.set_value();
    return ScriptedServer::Bytes{};
  });
  test::LiveSensor live(open_json(server.port()));
  ASSERT_EQ(is_asked.get_future().wait_for(RunningSensor::kHang), std::future_status::ready);
  live.end();
  EXPECT_THAT(live.sink.last_detail(), HasSubstr("interrupted"));
}

TEST(JsonSettings, AreChecked) {
  const auto refuses = [](ParameterValues::Map given, const std::string& why) {
    given.try_emplace("url", Secret("http://127.0.0.1/"));
    given.try_emplace("speed", std::string("/a"));
    EXPECT_THAT([&] { driver_named("json").open(values_for("json", given)); },
                ThrowsMessage<std::runtime_error>(HasSubstr(why)));
  };
  refuses({{"url", Secret()}}, "url: is missing");
  refuses({{"url", Secret("ftp://hunter2/")}}, "url: must be a URL that begins with http:// or https://");
  refuses({{"url", Secret("no url")}}, "url: must be a URL");
  refuses({{"speed", std::string()}}, "speed: is missing");
  refuses({{"direction", std::string("wind")}}, "direction: \"wind\" is not a JSON pointer");
  refuses({{"headers_file", std::string("/does/not/exist")}}, "headers_file: \"/does/not/exist\" does not exist");
}

TEST(JsonSettings, NeverShowTheUrl) {
  const ParameterValues values = values_for(
      "json", {{"url", Secret("https://user:hunter2@[::1]:8443/hunter2?key=hunter2")}, {"speed", std::string("/a")}});
  const auto& driver = driver_named("json");
  EXPECT_EQ(driver.endpoints(values).front().name, "[::1]:8443");
  const sensor::ValueSelection one = driver.selection(values);
  EXPECT_EQ(one.device, "server [::1]:8443");
  EXPECT_THAT(one.parts.front().value, Not(HasSubstr("hunter2")));
  const sensor::ValueSelection other = driver.selection(
      values_for("json", {{"url", Secret("https://[::1]:8443/hunter2?key=hunter3")}, {"speed", std::string("/a")}}));
  EXPECT_FALSE(covers(one, other));
}

TEST(JsonHeaders, AreLinesWithANameAndAValue) {
  EXPECT_EQ(headers_of("a: b\r\n\n# c\nd:e")->size(), 2U);
  EXPECT_EQ(headers_of("")->size(), 0U);
  for (const std::string bad : {"a", "a b: c", ": c", "a:", "a: \t", "a: b\x01", "a: b\rX: y", "a: \xc3\xa4"}) {
    const auto headers = headers_of("# first\n" + bad + "\n");
    ASSERT_FALSE(headers) << bad;
    EXPECT_EQ(headers.error().message, "line 2 is not a header; write \"Name: value\"");
  }
  std::string many;
  for (int i = 0; i < 17; ++i) many += "a: b\n";
  EXPECT_FALSE(headers_of(many));
}

TEST(JsonTime, NamesAMoment) {
  EXPECT_EQ(moment_of("1717200000"), UtcTime(1'717'200'000s));
  EXPECT_EQ(moment_of("1717200000500"), UtcTime(1'717'200'000s + 500ms));
  EXPECT_EQ(moment_of("2024-06-01T02:00:00+02:00"), UtcTime(1'717'200'000s));
  EXPECT_EQ(moment_of("2024-06-01T00:00:00Z"), UtcTime(1'717'200'000s));
  for (const char* none : {"", "2024-06-01T00:00:00", "2024-06-01", "noon", "-5", "1e300", "nan", "12:00-"})
    EXPECT_EQ(moment_of(none), std::nullopt) << none;
}

}  // namespace
}  // namespace yuragi::drivers::json
