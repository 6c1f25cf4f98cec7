// Any datagram, sent by UDP to the drivers that listen for them, each as the daemon opens it. What they publish is
// physical, and whatever comes, they ask to be polled again.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>

#include "engine/base/contain.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/manual_clock.hpp"
#include "tests/support/recording_sink.hpp"

namespace {

using namespace yuragi;
using boost::asio::ip::udp;

/// A driver that listens, and who sends to it.
class Listener {
 public:
  explicit Listener(std::string_view driver) {
    ParameterValues::Map given = {{"host", std::string("127.0.0.1")}, {"port", std::int64_t{port_}}};
    if (driver == "nmea" || driver == "line") given["transport"] = std::string("udp");
    sensor_ = driver_named(driver).open(values_for(driver, given));
    sensor_->poll(clock_, sink_);  // listens
  }

  void take(udp::socket& sender, boost::asio::const_buffer datagram) {
    sink_.clear();
    clock_.advance(std::chrono::seconds(1));
    boost::system::error_code too_long;
    sender.send_to(datagram, udp::endpoint(boost::asio::ip::address_v4::loopback(), port_), 0, too_long);
    if (too_long) return;
    sensor_->poll(clock_, sink_);
    for (const wind::Reading& reading : sink_.readings) {
      if (!wind::is_plausible(reading)) std::abort();
    }
  }

 private:
  std::uint16_t port_ = free_port(SOCK_DGRAM);
  ManualClock clock_;
  RecordingSink sink_;
  std::unique_ptr<drivers::sensor::Sensor> sensor_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  report_faults_to([](std::string_view, const char*) noexcept { std::abort(); });
  static std::array<Listener, 4> listeners = {Listener("nmea"), Listener("line"), Listener("osc"), Listener("tempest")};
  static boost::asio::io_context io;
  static udp::socket sender(io, udp::v4());
  listeners[data[0] % listeners.size()].take(sender, boost::asio::buffer(data + 1, size - 1));
  return 0;
}
