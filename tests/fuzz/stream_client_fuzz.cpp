// Any bytes of a daemon, sent by TCP to the client of the stream that the commands use: it ends with messages or a
// reason, and never hangs.
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

#include "daemon/stream/stream_client.hpp"
#include "tests/engine/wire/samples.hpp"

namespace {

using namespace yuragi;
using boost::asio::ip::tcp;

/// Good messages, some of them with a byte changed, and any bytes: each step takes four bytes of the input.
wire::Bytes stream_of(std::span<const std::uint8_t> steps) {
  static const std::vector<wire::Bytes> good = samples::one_of_each();
  wire::Bytes bytes;
  for (; steps.size() >= 4; steps = steps.subspan(4)) {
    const std::size_t choice = steps[0] % (good.size() + 1);
    wire::Bytes message = choice < good.size() ? good[choice] : wire::Bytes(steps.begin(), steps.end());
    if (choice < good.size() && steps[1] != 0) message[(steps[1] + 256U * steps[3]) % message.size()] = steps[2];
    bytes.insert(bytes.end(), message.begin(), message.end());
    if (choice == good.size()) break;
  }
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static boost::asio::io_context io;
  static tcp::acceptor acceptor(io, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
  static const std::string address = "127.0.0.1:" + std::to_string(acceptor.local_endpoint().port());
  auto client = daemon::stream::Client::connect(address, std::chrono::seconds(60));
  if (!client) return 0;  // so many clients in a second can use up the machine's ports
  tcp::socket server = acceptor.accept();
  static_cast<void>(client->subscribe({.sensors = true}));
  server.non_blocking(true);
  boost::system::error_code ignored;
  boost::asio::write(server, boost::asio::buffer(stream_of({data, size})), ignored);
  server.close(ignored);
  for (bool is_open = true; is_open;) {
    const auto message = client->receive(std::chrono::seconds(60));
    if (message) static_cast<void>(daemon::stream::refusal_in(*message, address));
    if (!message && message.error() == daemon::stream::End::kTimeout) std::abort();
    is_open = message.has_value();
  }
  return 0;
}
