// Searches of the local networks, of which the tests have only the loopback: each against one who answers there.
#include <atomic>
#include <optional>
#include <thread>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include "simulators/network/ecowitt_simulator.hpp"
#include "tests/support/descriptor.hpp"
#include "tests/support/dns_answer.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/simulator_thread.hpp"
#include "tests/support/still_wind.hpp"

namespace yuragi::drivers::network {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::ThrowsMessage;
using Bytes = std::vector<std::uint8_t>;

/// Says these datagrams back to whoever asks it.
class Responder {
 public:
  explicit Responder(std::vector<Bytes> answers) : answers_(std::move(answers)), thread_([this] { serve(); }) {}
  ~Responder() {
    eventfd_write(wake_.get(), 1);
    thread_.join();
  }
  Responder(const Responder&) = delete;
  Responder& operator=(const Responder&) = delete;

  std::uint16_t port() const { return socket_.port(); }

 private:
  void serve() {
    std::array<pollfd, 2> waits = {pollfd{wake_.get(), POLLIN, 0}, pollfd{socket_.descriptor(), POLLIN, 0}};
    while (poll(waits.data(), waits.size(), -1) > 0 && waits[0].revents == 0) {
      Bytes question(512);
      sockaddr_in asker{};
      socklen_t size = sizeof asker;
      auto* const to = reinterpret_cast<sockaddr*>(&asker);
      if (recvfrom(socket_.descriptor(), question.data(), question.size(), 0, to, &size) < 0) continue;
      for (const Bytes& answer : answers_) sendto(socket_.descriptor(), answer.data(), answer.size(), 0, to, size);
    }
  }

  std::vector<Bytes> answers_;
  LoopbackPort socket_{SOCK_DGRAM};
  Descriptor wake_{eventfd(0, EFD_CLOEXEC)};
  std::thread thread_;
};

sensor::NetworkSearch loopback() {
  return {.duration = 1500ms, .to = "127.0.0.1"};
}

std::vector<std::string> found_by(std::string_view driver, const sensor::NetworkSearch& search) {
  std::vector<std::string> found;
  for (const sensor::FoundDevice& device : driver_named(driver).find_in_network(search))
    found.push_back(device.what + "|" + device.settings + device.trouble);
  return found;
}

TEST(EcowittFinder, FindsTheGatewaysThatAnswer) {
  simulators::network::EcowittOptions options;
  options.port = 0;
  options.search_host = "127.0.0.1";
  auto simulator = std::make_unique<simulators::network::EcowittSimulator>(
      options, simulators::core::MeasuredWind(std::make_unique<StillWind>(simulators::core::PlayedMoment{})));
  sensor::NetworkSearch search = loopback();
  search.ecowitt_port = simulator->search_port();
  const std::string port = std::to_string(simulator->port());
  const SimulatorThread running(std::move(simulator));
  EXPECT_THAT(found_by("ecowitt", search),
              ElementsAre("Ecowitt gateway GW1000-WIFI5B1C V1.7.6 at 127.0.0.1 (02:00:5e:10:5b:1c)|host = "
                          "\"127.0.0.1\"\nport = " +
                          port + "\n"));
}

TEST(EcowittFinder, TakesNothingElse) {
  const Responder responder({{}, {0xFF, 0xFF, 0x12, 0x00}, Bytes(65, 0xFF), {0xFF, 0xFF, 0x27, 0x03, 0x2A}});
  sensor::NetworkSearch search = loopback();
  search.ecowitt_port = responder.port();
  EXPECT_THAT(found_by("ecowitt", search), IsEmpty());
}

TEST(EcowittFinder, SaysThatItCannotAsk) {
  sensor::NetworkSearch search = loopback();
  search.to = "gateway";
  EXPECT_THAT([&] { found_by("ecowitt", search); },
              ThrowsMessage<std::runtime_error>(testing::HasSubstr("is not an IPv4 address")));
}

TEST(WeatherLinkLiveFinder, FindsWhatIsAnnounced) {
  const Responder responder({DnsAnswer()
                                 .add_service("_weatherlinklive._tcp.local", "weatherlinklive-700008",
                                              "weatherlinklive-700008.local", 80, "\x0A\xBD\x24\x0B")
                                 .bytes(),
                             Bytes(300, 0xC0)});
  sensor::NetworkSearch search = loopback();
  search.dns_port = responder.port();
  EXPECT_THAT(found_by("weatherlink", search),
              ElementsAre("WeatherLink Live weatherlinklive-700008 at 10.189.36.11|host = \"10.189.36.11\"\n"));
}

TEST(SignalKFinder, FindsBothStreamsOfAServer) {
  const std::string type = "_signalk-ws._tcp.local";
  const std::string tcp = "_signalk-tcp._tcp.local";
  const Responder responder({DnsAnswer().add_service(type, "boat", "boat.local", 3100, "\x0A\x01\x02\x03").bytes(),
                             DnsAnswer().add(tcp, DnsAnswer::kPtr, DnsAnswer::name_of("boat." + tcp)).bytes()});
  sensor::NetworkSearch search = loopback();
  search.dns_port = responder.port();
  EXPECT_THAT(
      found_by("signalk", search),
      ElementsAre("Signal K server boat at 10.1.2.3|transport = \"websocket\"\nhost = \"10.1.2.3\"\nport = 3100\n",
                  "Signal K server boat at 127.0.0.1|transport = \"tcp\"\nhost = \"127.0.0.1\"\n"));
}

TEST(TempestFinder, FindsTheStationsThatAreHeard) {
  sensor::NetworkSearch search = loopback();
  search.tempest_port = free_port(SOCK_DGRAM);
  std::atomic<bool> is_over = false;
  std::thread hubs([&] {
    const LoopbackPort socket(SOCK_DGRAM);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(search.tempest_port);
    while (!is_over) {
      for (const std::string_view text :
           {R"({"serial_number":"ST-00000512","type":"rapid_wind","hub_sn":"HB-00013030","ob":[1493322445,2.3,128]})",
            R"({"serial_number":"HB-00000001","type":"hub_status","firmware_revision":"35","uptime":1,"rssi":-62,)"
            R"("timestamp":1495724691,"reset_flags":"BOR,PIN,POR","seq":48})",
            R"({"serial_number":"a\"\nb","type":"rapid_wind","hub_sn":"HB-2","ob":[1493322445,2.3,128]})", "\xFF{"}) {
        sendto(socket.descriptor(), text.data(), text.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
      }
      std::this_thread::yield();
    }
  });
  const auto found = found_by("tempest", search);
  is_over = true;
  hubs.join();
  EXPECT_THAT(found, ElementsAre("WeatherFlow hub HB-00000001|it has forwarded no wind of a station",
                                 "WeatherFlow station ST-00000512 of hub HB-00013030|serial_number = "
                                 "\"ST-00000512\"\n"));
}

}  // namespace
}  // namespace yuragi::drivers::network
