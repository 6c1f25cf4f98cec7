#include <algorithm>
#include <array>
#include <cerrno>
#include <map>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <modbus/modbus.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "simulators/modbus/modbus_port.hpp"

namespace yuragi::simulators::modbus {
namespace {

constexpr int kModbusBacklog = 8;

std::uint16_t listening_port(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  // The port is at the same place in the addresses of both families.
  return ntohs(reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

class TcpPort final : public Port {
 public:
  TcpPort(const std::string& host, std::uint16_t port) : host_(host), port_(port) {
    if (listen()) return;
    throw std::runtime_error(fmt::format("cannot listen on {}:{} ({}): choose another port, or 0 for a free one", host,
                                         port, modbus_strerror(errno)));
  }
  ~TcpPort() override { TcpPort::leave(); }
  TcpPort(const TcpPort&) = delete;
  TcpPort& operator=(const TcpPort&) = delete;

  bool is_rtu() const override { return false; }
  std::string name() const override { return fmt::format("{}:{}", host_, port_); }

  std::vector<int> descriptors() const override {
    std::vector<int> all;
    if (listener_ >= 0) all.push_back(listener_);
    for (const auto& [client, bytes] : clients_) all.push_back(client);
    return all;
  }

  std::vector<ClientRequest> receive(std::span<const int> ready) override {
    std::vector<ClientRequest> received;
    for (const int descriptor : ready) {
      if (descriptor == listener_) {
        accept_client();
      } else if (const auto client = clients_.find(descriptor); client != clients_.end()) {
        if (!read_from(descriptor, client->second)) {
          close(descriptor);
          clients_.erase(client);
          continue;
        }
        while (const auto request = take_tcp_request(client->second)) received.push_back({descriptor, *request});
      }
    }
    return received;
  }

  void send(int client, std::span<const std::uint8_t> bytes) override {
    if (clients_.contains(client)) ::send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }

  void leave() override {
    for (const auto& [client, bytes] : clients_) close(client);
    clients_.clear();
    if (listener_ >= 0) close(listener_);
    listener_ = -1;
  }

  void come_back() override {
    if (listener_ < 0) listen();
  }

 private:
  bool listen() {
    const std::unique_ptr<modbus_t, void (*)(modbus_t*)> context(
        modbus_new_tcp_pi(host_.c_str(), std::to_string(port_).c_str()), modbus_free);
    if (!context) return false;
    listener_ = modbus_tcp_pi_listen(context.get(), kModbusBacklog);
    if (listener_ < 0) return false;
    fcntl(listener_, F_SETFL, O_NONBLOCK);
    port_ = listening_port(listener_);
    return true;
  }

  void accept_client() {
    const int client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (client >= 0) clients_[client] = {};
  }

  /// Returns false if the client has closed the connection.
  static bool read_from(int client, Bytes& incoming) {
    std::array<std::uint8_t, 512> block{};
    const ssize_t size = recv(client, block.data(), block.size(), 0);
    if (size <= 0) return size < 0 && (errno == EAGAIN || errno == EINTR);
    incoming.insert(incoming.end(), block.begin(), block.begin() + size);
    return true;
  }

  std::string host_;
  std::uint16_t port_;
  int listener_ = -1;
  std::map<int, Bytes> clients_;  // with the bytes of incomplete requests
};

}  // namespace

std::unique_ptr<Port> make_modbus_tcp_port(const std::string& host, std::uint16_t port) {
  return std::make_unique<TcpPort>(host, port);
}

}  // namespace yuragi::simulators::modbus
