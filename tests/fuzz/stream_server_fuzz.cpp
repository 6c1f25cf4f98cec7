// Any bytes of a client, sent by TCP to the server of the stream. The server answers or closes the connection, no
// handler throws, and the next client is greeted.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

#include "daemon/stream/tcp_stream.hpp"
#include "engine/base/address.hpp"
#include "engine/base/contain.hpp"
#include "engine/wire/message_reader.hpp"
#include "tests/engine/wire/samples.hpp"

namespace {

using namespace yuragi;
using boost::asio::ip::tcp;

void require(bool holds) {
  if (!holds) std::abort();
}

daemon::stream::TcpStreamSettings settings() {
  daemon::stream::TcpStreamSettings settings;
  settings.hello = {.software = "fuzz", .tick_rate_hz = 60.0};
  settings.scenes = samples::scenes();
  settings.is_token = [](const std::string& token) { return token == "correct horse battery staple"; };
  settings.on_control = [](const wire::Control& control, bool) {
    return wire::ControlReply{.done = true, .message = control.scene, .scenes = {}};
  };
  settings.on_reload = [](const wire::ReloadCommand& command, bool, const auto& reply) {
    reply({.done = true, .message = command.file, .scenes = {}});
  };
  settings.on_parameters = [](const wire::ParameterCommand&, bool, const auto& reply) {
    reply({.done = true, .message = "", .scenes = {}});
  };
  return settings;
}

class Daemon {
 public:
  Daemon() { stream_.publish_sensors(std::make_shared<const wire::Bytes>(wire::encode(samples::sensors())), nullptr); }

  /// Sends these bytes and no more, and reads until the server closes the connection. Returns the number of messages.
  std::size_t messages_for(std::span<const std::uint8_t> bytes) {
    tcp::socket client(io_);
    boost::system::error_code gone;
    client.connect(tcp::endpoint(boost::asio::ip::make_address(address_.host), address_.port), gone);
    if (gone) return 1;  // so many clients in a second can use up the machine's ports
    boost::asio::write(client, boost::asio::buffer(bytes.data(), bytes.size()), gone);
    client.shutdown(tcp::socket::shutdown_send, gone);
    client.non_blocking(true);
    wire::MessageReader reader(1 << 20);
    std::array<std::uint8_t, 65536> block{};
    std::size_t messages = 0;
    for (boost::system::error_code error;;) {
      const std::size_t size = client.read_some(boost::asio::buffer(block), error);
      reader.feed(std::span(block).first(size));
      for (; const auto message = reader.next(); ++messages) require(message->has_value());
      if (error && error != boost::asio::error::would_block) return messages;
      if (error) io_.run_one();  // its timer looks at the clients now and then
    }
  }

 private:
  boost::asio::io_context io_{1};
  daemon::stream::TcpStream stream_{io_, "127.0.0.1:0", settings()};
  const Address address_ = parse_address(stream_.local_endpoint()).value();
};

/// The first byte chooses what stands before the others: nothing, a subscription, or also the length of a message.
wire::Bytes request_of(std::span<const std::uint8_t> data) {
  if (data.empty()) return {};
  wire::Bytes bytes;
  const auto rest = data.subspan(1);
  const unsigned choice = data[0];
  if (choice % 2 == 1) bytes = wire::encode(wire::Subscribe{.sensors = true, .client = "fuzz", .raw = choice % 4 == 3});
  if (choice % 3 != 0) {
    for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(rest.size() >> shift));
  }
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  report_faults_to([](std::string_view, const char*) noexcept { std::abort(); });
  static Daemon daemon;
  static_cast<void>(daemon.messages_for(request_of({data, size})));
  static unsigned count = 0;
  if (++count % 64 == 0) require(daemon.messages_for({}) >= 1);
  return 0;
}
