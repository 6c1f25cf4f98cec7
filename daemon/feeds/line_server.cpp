#include "daemon/feeds/line_server.hpp"

#include <array>
#include <list>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "drivers/bus/host_lookup.hpp"
#include "engine/base/address.hpp"

namespace yuragi::daemon::feeds {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

/// An address that is in use is tried again at this interval.
constexpr auto kOpenAgainAfter = std::chrono::seconds(5);
constexpr auto kGivenUpAfter = std::chrono::seconds(30);
constexpr std::size_t kMaxDiscarded = 4096;

}  // namespace

struct LineServer::Sockets {
  explicit Sockets(const Address& address) : lookup(address.host, address.port) {}

  struct Client {
    tcp::socket socket;
    std::string rest;               ///< of a message that was begun
    std::optional<MonoTime> stuck;  ///< since when it takes nothing
  };

  drivers::bus::HostLookup lookup;
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  std::list<Client> clients;
};

namespace {

/// Writes what a client takes of a text now, and returns the rest; nullopt: it has gone.
template <class Client>
std::optional<std::string_view> rest_of(Client& client, std::string_view text, MonoTime now) {
  while (!text.empty()) {
    boost::system::error_code error;
    const std::size_t taken = client.socket.write_some(asio::buffer(text), error);
    if (error == asio::error::would_block) {
      client.stuck = client.stuck.value_or(now);
      break;
    }
    if (error) return std::nullopt;
    client.stuck.reset();
    text.remove_prefix(taken);
  }
  return text;
}

/// Reads and forgets what it has sent. Returns false if it has gone.
bool is_there(tcp::socket& socket) {
  std::array<char, kMaxDiscarded> discarded{};
  boost::system::error_code error;
  socket.read_some(asio::buffer(discarded), error);
  return !error || error == asio::error::would_block;
}

}  // namespace

LineServer::LineServer(std::string feed, const std::string& address)
    : feed_(std::move(feed)), address_(address), sockets_(std::make_unique<Sockets>(parse_address(address).value())) {}
LineServer::~LineServer() {
  sockets_->lookup.interrupt();
}

void LineServer::open(MonoTime now) {
  if (tried_ && now - *tried_ < kOpenAgainAfter && !sockets_->lookup.is_under_way()) return;
  tried_ = now;
  const auto found = sockets_->lookup.find(Nanoseconds(0));
  if (!found && sockets_->lookup.is_under_way()) return;
  tcp::acceptor& acceptor = sockets_->acceptor;
  boost::system::error_code error;
  if (found) {
    acceptor.open(found->front().protocol(), error);
    if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor.bind(found->front(), error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (!error) acceptor.non_blocking(true, error);
  }
  if (found && !error) {
    if (!trouble_.empty()) spdlog::info("feed {}: listens at {} again", feed_, address_);
    trouble_.clear();
    return;
  }
  const std::string trouble =
      found ? fmt::format("cannot listen at {} ({}): choose another port, or end the program that has it", address_,
                          error.message())
            : found.error().message;
  boost::system::error_code ignored;
  acceptor.close(ignored);
  if (trouble_.empty()) spdlog::warn("feed {}: {}; it is tried again", feed_, trouble);
  trouble_ = trouble;
}

void LineServer::accept() {
  for (std::size_t i = 0; i < kMaxClients; ++i) {
    boost::system::error_code error;
    tcp::socket socket = sockets_->acceptor.accept(error);
    if (error) return;
    if (sockets_->clients.size() >= kMaxClients) continue;  // closed
    socket.non_blocking(true, error);
    if (!error) socket.set_option(tcp::no_delay(true), error);
    if (!error) sockets_->clients.push_back({std::move(socket), {}, {}});
  }
}

void LineServer::send(std::string_view message, MonoTime now) {
  if (!sockets_->acceptor.is_open()) open(now);
  if (!sockets_->acceptor.is_open()) return;
  accept();
  sockets_->clients.remove_if([&](Sockets::Client& client) {
    if (!is_there(client.socket) || (client.stuck && now - *client.stuck > kGivenUpAfter)) return true;
    const auto before = rest_of(client, client.rest, now);
    if (!before) return true;
    client.rest = std::string(*before);
    if (!client.rest.empty()) return false;
    const auto rest = rest_of(client, message, now);
    if (!rest) return true;
    if (rest->size() == message.size()) return false;  // lost
    client.rest = std::string(*rest);
    ++messages_;
    bytes_ += message.size();
    last_sent_ = now;
    return false;
  });
}

std::string LineServer::address() const {
  boost::system::error_code error;
  const tcp::endpoint at = sockets_->acceptor.local_endpoint(error);
  return error ? address_ : to_string(Address{at.address().to_string(), at.port()});
}

std::size_t LineServer::clients() const noexcept {
  return sockets_->clients.size();
}

}  // namespace yuragi::daemon::feeds
