#include "simulators/text/text_wire.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>

#include "simulators/core/pty.hpp"
#include "simulators/core/socket_address.hpp"
#include "simulators/core/tcp_listener.hpp"

namespace yuragi::simulators::text {
namespace {

using boost::asio::ip::tcp;
using boost::asio::ip::udp;

template <class Endpoint>
std::string text_of(const Endpoint& endpoint) {
  std::ostringstream text;
  text << endpoint;
  return text.str();
}

bool has(std::span<const int> ready, int descriptor) {
  return std::ranges::find(ready, descriptor) != ready.end();
}

class PtyWire final : public Wire {
 public:
  explicit PtyWire(const std::string& link) : pty_(link) {}

  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {core::FaultKind::kUnplug};
    return kKnown;
  }
  std::vector<int> descriptors() const override {
    return pty_.is_plugged_in() ? std::vector{pty_.descriptor()} : std::vector<int>{};
  }
  std::string read(std::span<const int> /*ready*/) override {
    if (!pty_.is_plugged_in()) return {};
    const auto bytes = pty_.read();
    return {bytes.begin(), bytes.end()};
  }
  void write(std::string_view bytes) override {
    if (!pty_.is_plugged_in()) return;
    pty_.write({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  }
  void take_away() override { pty_.unplug(); }
  void bring_back() override { pty_.plug_in(); }
  std::string place() const override { return "listening on " + pty_.path(); }

 private:
  core::Pty pty_;
};

class TcpWire final : public Wire {
 public:
  TcpWire(const std::string& host, std::uint16_t port) : listener_(host, port) {}

  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {core::FaultKind::kDisconnect, core::FaultKind::kUnplug};
    return kKnown;
  }
  std::vector<int> descriptors() const override {
    std::vector<int> all;
    if (listener_.is_open()) all.push_back(const_cast<core::TcpListener&>(listener_).descriptor());
    for (const Client& client : clients_) all.push_back(const_cast<tcp::socket&>(client.socket).native_handle());
    return all;
  }

  std::string read(std::span<const int> ready) override {
    std::string received;
    for (Client& client : clients_) {
      if (!has(ready, client.socket.native_handle())) continue;
      std::array<char, 512> block{};
      boost::system::error_code error;
      const std::size_t size = client.socket.read_some(boost::asio::buffer(block), error);
      received.append(block.data(), size);
      client.has_spoken |= size > 0;
      if (error && error != boost::asio::error::would_block) client.socket.close(error);
    }
    accept_all();
    forget_closed();
    return received;
  }

  void write(std::string_view bytes) override {
    for (Client& client : clients_) {
      if (waits_for_clients_ && !client.has_spoken) continue;
      boost::system::error_code error;
      boost::asio::write(client.socket, boost::asio::buffer(bytes), error);
      if (error && error != boost::asio::error::would_block) client.socket.close(error);
    }
    forget_closed();
  }

  void greet_with(const std::string& bytes) override { greeting_ = bytes; }
  void wait_for_clients() override { waits_for_clients_ = true; }

  void take_away() override {
    clients_.clear();
    listener_.close();
  }
  void bring_back() override { listener_.open_again(); }
  std::string place() const override { return "listening on " + text_of(listener_.endpoint()); }

 private:
  struct Client {
    tcp::socket socket;
    bool has_spoken = false;
  };

  void accept_all() {
    while (auto client = listener_.accept()) {
      boost::system::error_code error;
      boost::asio::write(*client, boost::asio::buffer(greeting_), error);
      if (!error) clients_.push_back({.socket = std::move(*client)});
    }
  }
  void forget_closed() {
    std::erase_if(clients_, [](const Client& client) { return !client.socket.is_open(); });
  }

  core::TcpListener listener_;
  std::vector<Client> clients_;
  std::string greeting_;
  bool waits_for_clients_ = false;
};

class UdpWire final : public Wire {
 public:
  UdpWire(const std::string& host, std::uint16_t port) : endpoint_(core::socket_address(host), port) {
    if (port == 0) throw std::runtime_error("cannot send to port 0; give the receiver's port");
    bring_back();
  }

  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {core::FaultKind::kUnplug};
    return kKnown;
  }
  std::vector<int> descriptors() const override { return {}; }
  std::string read(std::span<const int> /*ready*/) override { return {}; }
  void write(std::string_view bytes) override {
    // Without a listener the next write fails; that is ignored.
    boost::system::error_code ignored;
    if (socket_.is_open()) socket_.send_to(boost::asio::buffer(bytes), endpoint_, 0, ignored);
  }
  void take_away() override {
    boost::system::error_code ignored;
    socket_.close(ignored);
  }
  void bring_back() override {
    boost::system::error_code ignored;
    if (!socket_.is_open()) socket_.open(endpoint_.protocol(), ignored);
  }
  std::string place() const override { return "sending to " + text_of(endpoint_); }

 private:
  boost::asio::io_context context_;
  udp::endpoint endpoint_;
  udp::socket socket_{context_};
};

}  // namespace

std::unique_ptr<Wire> make_pty_wire(const std::string& link) {
  return std::make_unique<PtyWire>(link);
}

std::unique_ptr<Wire> make_tcp_wire(const std::string& host, std::uint16_t port) {
  return std::make_unique<TcpWire>(host, port);
}

std::unique_ptr<Wire> make_udp_wire(const std::string& host, std::uint16_t port) {
  return std::make_unique<UdpWire>(host, port);
}

}  // namespace yuragi::simulators::text
