#include "daemon/stream/stream_client.hpp"

#include <array>
#include <utility>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

#include "engine/base/address.hpp"
#include "engine/base/close_on_exec.hpp"
#include "engine/wire/message_reader.hpp"

namespace yuragi::daemon::stream {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

}  // namespace

std::string_view name_of(End end) {
  switch (end) {
    case End::kTimeout:
      return "nothing was received in time";
    case End::kClosed:
      return "it closed the connection";
    case End::kInvalid:
      return "it sent something that is not a message";
  }
  return "?";
}

std::optional<Failure> refusal_in(const wire::Message& message, std::string_view address) {
  const auto* hello = std::get_if<wire::Hello>(&message);
  if (hello == nullptr) return std::nullopt;
  const std::string daemon = "the daemon at " + std::string(address) + " ";
  if (hello->refused) return Failure{daemon + "refuses the connection: " + *hello->refused, FailureKind::kUnavailable};
  if (const auto mismatch = wire::protocol_mismatch(*hello)) {
    return Failure{daemon + *mismatch, FailureKind::kUnavailable};
  }
  return std::nullopt;
}

Failure connection_lost(std::string_view address, End end) {
  return {"the connection to the daemon at " + std::string(address) + " was lost: " + std::string(name_of(end)),
          FailureKind::kUnavailable};
}

class Client::Connection {
 public:
  error_code connect(const Address& address, Nanoseconds timeout) {
    error_code error;
    tcp::resolver resolver(io_);
    const auto endpoints = resolver.resolve(address.host, std::to_string(address.port), error);
    if (error) return error;
    asio::async_connect(socket_, endpoints,
                        [&error](const error_code& result, const tcp::endpoint&) { error = result; });
    if (run_for(timeout)) {
      if (!error) close_on_exec(socket_.native_handle());
      return error;
    }
    close();  // cancelling alone would make it try the next address
    io_.run();
    return asio::error::timed_out;
  }

  bool write(const wire::Bytes& bytes) {
    error_code error;
    asio::write(socket_, asio::buffer(bytes), error);
    return !error;
  }

  Result<wire::Message, End> receive(Nanoseconds timeout) {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (true) {
      // Messages received already come first; those of unknown kinds are skipped.
      while (auto message = reader_.next()) {
        if (*message) return std::move(**message);
        if (message->error() == wire::Error::kUnknown) continue;
        close();
        return End::kInvalid;
      }
      if (!socket_.is_open()) return End::kClosed;

      // Read more, within the rest of the time.
      error_code error;
      std::size_t count = 0;
      socket_.async_read_some(asio::buffer(chunk_), [&](const error_code& result, std::size_t read) {
        error = result;
        count = read;
      });
      const bool in_time = run_for(deadline - std::chrono::steady_clock::now());
      if (!in_time) {
        error_code ignored;
        socket_.cancel(ignored);
        io_.run();  // the handler may still deliver bytes
      }
      reader_.feed(std::span(chunk_).first(count));
      if (!in_time && count == 0) return End::kTimeout;
      if (error) close();
    }
  }

 private:
  /// Runs the operation that was started. False if it does not complete in time: the caller has to end it.
  bool run_for(Nanoseconds timeout) {
    io_.restart();
    io_.run_for(timeout);
    return io_.stopped();
  }

  void close() {
    error_code ignored;
    socket_.close(ignored);
  }

  asio::io_context io_{1};
  tcp::socket socket_{io_};
  wire::MessageReader reader_;
  std::array<std::uint8_t, 65536> chunk_{};
};

Result<Client, Failure> Client::connect(std::string_view address, Nanoseconds timeout) {
  const auto parsed = parse_address(address);
  if (!parsed) return parsed.error();
  auto connection = std::make_unique<Connection>();
  if (const auto error = connection->connect(*parsed, timeout)) {
    return Failure{"cannot reach " + std::string(address) + ": " + error.message()};
  }
  return Client(std::move(connection));
}

Client::Client(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}
Client::Client(Client&&) noexcept = default;
Client& Client::operator=(Client&&) noexcept = default;
Client::~Client() = default;

bool Client::subscribe(const wire::Subscribe& request) {
  return connection_->write(wire::encode(request));
}

bool Client::send(const wire::Control& request) {
  return connection_->write(wire::encode(request));
}

Result<wire::Message, End> Client::receive(Nanoseconds timeout) {
  return connection_->receive(timeout);
}

}  // namespace yuragi::daemon::stream
