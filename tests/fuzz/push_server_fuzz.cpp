// Any bytes of a client, sent by TCP to the driver `ecowitt-push` as the daemon opens it. The driver answers the client
// or closes the connection, publishes only physical values, and goes on taking pushes.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

#include "engine/base/contain.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"

namespace {

using namespace yuragi;
using boost::asio::ip::tcp;

void require(bool holds) {
  if (!holds) std::abort();
}

class Station {
 public:
  Station() : sensor_(driver_named("ecowitt-push").open(values_for("ecowitt-push", {{"port", std::int64_t{port_}}}))) {
    sensor_->poll(clock_, sink_);  // listens
  }

  /// Sends these bytes and no more, and returns the answer until the driver closes the connection.
  std::string answer_to(std::string_view bytes) {
    clock_.advance(std::chrono::seconds(16));
    sink_.clear();
    boost::asio::io_context io;
    tcp::socket client(io);
    boost::system::error_code gone;
    client.connect(tcp::endpoint(boost::asio::ip::address_v4::loopback(), port_), gone);
    if (gone) return {};  // so many clients in a second can use up the machine's ports
    client.non_blocking(true);
    boost::asio::write(client, boost::asio::buffer(bytes), gone);
    client.shutdown(tcp::socket::shutdown_send, gone);
    std::string answer;
    std::array<char, 1024> block{};
    for (boost::system::error_code error;;) {
      const std::size_t size = client.read_some(boost::asio::buffer(block), error);
      answer.append(block.data(), size);
      if (error && error != boost::asio::error::would_block) break;
      if (error) sensor_->poll(clock_, sink_);
    }
    for (const wind::Reading& reading : sink_.readings) require(wind::is_plausible(reading));
    return answer;
  }

  std::size_t readings() const { return sink_.readings.size(); }

 private:
  std::uint16_t port_ = free_port(SOCK_STREAM);
  ManualClock clock_;
  RecordingSink sink_;
  std::unique_ptr<drivers::sensor::Sensor> sensor_;
};

/// The first byte chooses the part of a request that the others are, so that each is reached.
std::string request_of(std::string_view data) {
  if (data.empty()) return {};
  const std::string rest(data.substr(1));
  switch (static_cast<unsigned char>(data[0]) % 4) {
    case 0:
      return rest;
    case 1:
      return "GET /data/report/?" + rest + " HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n";
    case 2:
      return "GET /data/report/?PASSKEY=a&windspeedmph=1 HTTP/1.1\r\n" + rest + "\r\n\r\n";
    default:
      return "POST /data/report/ HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: " + std::to_string(rest.size()) +
             "\r\n\r\n" + rest;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  report_faults_to([](std::string_view, const char*) noexcept { std::abort(); });
  static Station station;
  const std::string answer = station.answer_to(request_of({reinterpret_cast<const char*>(data), size}));
  require(answer.empty() || answer.starts_with("HTTP/1."));
  static unsigned count = 0;
  if (++count % 64 != 0) return 0;
  const std::string push = "GET /a?PASSKEY=own&windspeedmph=10 HTTP/1.0\r\n\r\n";
  // It is refused until the station before it has been silent for five of its usual pauses: 64 requests hold two
  // pauses of 31 requests at most.
  for (int tries = 0; tries < 5 * 32 && station.readings() == 0; ++tries) {
    const std::string taken = station.answer_to(push);
    if (taken.empty()) return 0;
  }
  require(station.readings() == 1);
  return 0;
}
