// Logs through the whole driver, from a file and over TCP, against what the decoder alone makes of each line: one that
// is made up here, and real ones where they stand beside the project.
#include <filesystem>
#include <fstream>
#include <thread>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include "drivers/decode/text/nmea.hpp"
#include "engine/wind/turbulence/synthetic_wind.hpp"
#include "tests/support/decoded_text.hpp"
#include "tests/support/descriptor.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/places.hpp"
#include "tests/support/recording_sink.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::text {
namespace {

struct Log {
  std::string file;
  ParameterValues::Map settings;
  std::vector<decode::DecodedWind> expected;
};

/// What the log says of one sentence of one talker, line by line; empty where the log is missing.
std::vector<decode::DecodedWind> winds_in(const std::string& path, std::string_view beginning) {
  std::ifstream in(path);
  std::vector<decode::DecodedWind> winds;
  for (std::string line; std::getline(in, line);) {
    const auto wind = decode::text::decode_nmea(
        {.checksum = decode::WhenMissing::kRefuse, .status = decode::WhenMissing::kAccept, .xdr_first_id = 0}, line);
    const bool is_wanted = line.starts_with(beginning) && (!wind || wind->reference != decode::WindReference::kTrue);
    if (wind && is_wanted) winds.push_back(*wind);
  }
  return winds;
}

/// A minute of an anemometer at sea, with other instruments on the same line and a few damaged sentences.
void write_log(const std::string& path) {
  std::ofstream out(path, std::ios::binary);
  wind::turbulence::SyntheticWind wind({.mean_speed_m_s = 7.0, .mean_direction_deg = 50.0});
  for (int number = 0; number < 120; ++number) {
    const wind::Vector now = wind.at(0.5 * number);
    std::string line = sentence(fmt::format("WIMWV,{:.1f},R,{:.1f},M,A", wind::direction_from_deg(now), speed_of(now)));
    if (number % 17 == 5) line[8] = '#';
    if (number % 23 == 7) line.resize(11);
    out << line << "\r\n";
    if (number % 4 == 0) out << sentence("SDDBT,36.1,f,11.0,M,6.0,F") << "\r\n";
  }
}

/// The logs that are there; the one that is made up is written to `folder`.
std::vector<Log> logs_here(const test::TemporaryFolder& folder) {
  const std::string made_up = (folder / "made_up.log").string();
  write_log(made_up);
  const auto path = [](const std::string& name) { return test::source_path("../shared/data/nmea/" + name); };
  std::vector<Log> logs = {
      {made_up, {}, {}},
      // A plotter that says one wind in three sentences.
      {path("gpsd_bundg_zeus_9.log"), {}, {}},
      {path("gpsd_bundg_zeus_9.log"), {{"reference", std::string("relative")}}, {}},
      // Two anemometers that leave out the status.
      {path("signalk_n2kd-183-merrimac.log"), {{"talker", std::string("02")}}, {}},
      {path("signalk_n2kd-183-merrimac.log"), {{"talker", std::string("24")}}, {}},
  };
  const std::array<std::string_view, 5> wanted = {"$WIMWV", "$WIMWD", "$WIMWV", "$02MWV", "$24MWV"};
  for (std::size_t i = 0; i < logs.size(); ++i) logs[i].expected = winds_in(logs[i].file, wanted[i]);
  std::erase_if(logs, [](const Log& log) { return !std::filesystem::exists(log.file); });
  return logs;
}

/// Everything of the log but the first reading, which a better one of its burst may overtake.
void expect_the_log(const std::vector<wind::Reading>& readings, const std::vector<decode::DecodedWind>& expected) {
  ASSERT_GE(readings.size(), expected.size() - 1);
  ASSERT_LE(readings.size(), expected.size());
  const std::size_t ahead = expected.size() - readings.size();
  for (std::size_t i = 0; i < readings.size(); ++i) {
    ASSERT_DOUBLE_EQ(readings[i].speed_m_s, *expected[i + ahead].speed_m_s) << i;
    ASSERT_EQ(readings[i].direction_deg.has_value(), expected[i + ahead].direction_deg.has_value()) << i;
    if (readings[i].direction_deg) {
      ASSERT_NEAR(*readings[i].direction_deg, *expected[i + ahead].direction_deg, 1e-9);
    }
  }
}

TEST(TextLog, IsReadFromAFileToItsLastReading) {
  const test::TemporaryFolder folder;
  for (Log& log : logs_here(folder)) {
    SCOPED_TRACE(log.file);
    log.settings["transport"] = std::string("file");
    log.settings["file"] = log.file;
    log.settings["play_rate"] = 10.0;
    const auto sensor = driver_named("nmea").open(values_for("nmea", log.settings));
    ManualClock clock;
    RecordingSink sink;
    for (int i = 0; i < 100'000 && sink.last_state() != wind::LinkState::kFinished; ++i) {
      clock.advance_to(sensor->poll(clock, sink));
    }
    EXPECT_EQ(sink.last_state(), wind::LinkState::kFinished);
    EXPECT_GT(log.expected.size(), 20U);
    expect_the_log(sink.readings, log.expected);
  }
}

/// Serves a file to one client after the other, as fast as they take it.
class LogServer {
 public:
  explicit LogServer(const std::string& file) : listener_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    if (bind(listener_.get(), generic, size) != 0 || listen(listener_.get(), 1) != 0 ||
        getsockname(listener_.get(), generic, &size) != 0) {
      throw std::runtime_error("no port on the loopback");
    }
    port_ = ntohs(address.sin_port);
    std::ifstream in(file);
    text_.assign(std::istreambuf_iterator<char>(in), {});
    thread_ = std::thread([this] { serve(); });
  }
  ~LogServer() { thread_.join(); }
  LogServer(const LogServer&) = delete;
  LogServer& operator=(const LogServer&) = delete;

  std::uint16_t port() const { return port_; }

 private:
  void serve() const {
    const Descriptor client(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    for (std::string_view rest = text_; !rest.empty();) {
      const ssize_t size = send(client.get(), rest.data(), std::min<std::size_t>(rest.size(), 1000), MSG_NOSIGNAL);
      if (size <= 0) return;
      rest.remove_prefix(static_cast<std::size_t>(size));
    }
  }

  Descriptor listener_;
  std::uint16_t port_ = 0;
  std::string text_;
  std::thread thread_;
};

TEST(TextLog, IsReadOverTcpToItsLastReading) {
  const test::TemporaryFolder folder;
  for (Log& log : logs_here(folder)) {
    SCOPED_TRACE(log.file);
    const LogServer server(log.file);
    log.settings["transport"] = std::string("tcp");
    log.settings["host"] = std::string("127.0.0.1");
    log.settings["port"] = std::int64_t{server.port()};
    const auto sensor = driver_named("nmea").open(values_for("nmea", log.settings));
    ManualClock clock;
    RecordingSink sink;
    const auto is_over = [&] { return sink.last_detail().find("is gone") != std::string::npos; };
    for (int i = 0; i < 100'000 && !is_over(); ++i) clock.advance_to(sensor->poll(clock, sink));
    EXPECT_TRUE(is_over());
    expect_the_log(sink.readings, log.expected);
  }
}

}  // namespace
}  // namespace yuragi::drivers::text
