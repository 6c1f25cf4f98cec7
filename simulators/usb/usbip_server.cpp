#include "simulators/usb/usbip_server.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <fmt/format.h>

#include "simulators/usb/usbip_protocol.hpp"

namespace yuragi::simulators::usb {
namespace {

namespace asio = boost::asio;
using tcp = asio::ip::tcp;

/// A host that leaves this many bytes unread is disconnected: it has hung, or is hostile.
constexpr std::size_t kMaxUnread = std::size_t{1024} * 1024;
constexpr std::size_t kMaxClients = 64;

}  // namespace

struct UsbipServer::State {
  struct Client {
    explicit Client(tcp::socket connected) : socket(std::move(connected)) {}

    tcp::socket socket;
    UsbipPhase phase = UsbipPhase::kRequests;
    std::optional<std::size_t> device;  // the port that it has imported
    Bytes in;
    Bytes out;
    bool is_gone = false;
    bool ends_after_reply = false;
  };

  State(const std::string& host, std::uint16_t port, std::vector<std::unique_ptr<Port>> all)
      : ports(std::move(all)), known_faults(faults_of(ports)) {
    try {
      acceptor.open(tcp::v4());
      const tcp::endpoint endpoint(asio::ip::make_address(host), port);
      if (endpoint.protocol() != tcp::v4()) {
        acceptor.close();
        acceptor.open(endpoint.protocol());
      }
      acceptor.set_option(tcp::acceptor::reuse_address(true));
      acceptor.bind(endpoint);
      acceptor.listen();
      acceptor.non_blocking(true);
    } catch (const boost::system::system_error& error) {
      throw std::runtime_error(fmt::format("cannot listen on {}:{} ({}): choose another port, or 0 for a free one",
                                           host, port, error.code().message()));
    }
  }

  UsbipOffer offer(std::size_t index) const {
    return {bus_id(index), static_cast<std::uint32_t>(index + 1), ports[index]->summary()};
  }
  static std::string bus_id(std::size_t index) { return "1-" + std::to_string(index + 1); }

  void accept_clients() {
    for (boost::system::error_code error;;) {
      tcp::socket socket = acceptor.accept(error);
      if (error) return;
      if (clients.size() >= kMaxClients) continue;
      socket.non_blocking(true, error);
      socket.set_option(tcp::no_delay(true), error);
      clients.push_back(std::make_unique<Client>(std::move(socket)));
    }
  }

  static void read(Client& client) {
    std::array<std::uint8_t, 4096> block{};
    boost::system::error_code error;
    for (;;) {
      const std::size_t size = client.socket.read_some(asio::buffer(block), error);
      client.in.insert(client.in.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(size));
      if (error || client.in.size() > std::size_t{2} * kUsbipLongestTransfer) break;
    }
    if (error && error != asio::error::would_block) client.is_gone = true;
  }

  static void write(Client& client) {
    boost::system::error_code error;
    while (!client.out.empty() && !error) {
      const std::size_t size = client.socket.write_some(asio::buffer(client.out), error);
      client.out.erase(client.out.begin(), client.out.begin() + static_cast<std::ptrdiff_t>(size));
    }
    const bool is_broken = error && error != asio::error::would_block;
    if (is_broken || client.out.size() > kMaxUnread || (client.ends_after_reply && client.out.empty())) {
      client.is_gone = true;
    }
  }

  /// Handles each whole message that has arrived.
  void obey(Client& client) {
    std::size_t done = 0;
    while (!client.is_gone && !client.ends_after_reply) {
      const auto taken = take_usbip_message(client.phase, std::span(client.in).subspan(done));
      if (!taken) {
        client.is_gone = true;
        trouble = taken.error().message;
        return;
      }
      if (!taken->message) break;
      done += taken->size;
      std::visit([&](const auto& message) { obey(client, message); }, *taken->message);
    }
    client.in.erase(client.in.begin(), client.in.begin() + static_cast<std::ptrdiff_t>(done));
  }

  void obey(Client& client, const UsbipListRequest& /*request*/) {
    std::vector<UsbipOffer> offers;
    for (std::size_t i = 0; i < ports.size(); ++i) {
      if (ports[i]->is_plugged_in()) offers.push_back(offer(i));
    }
    queue(client, usbip_list_reply(offers));
    client.ends_after_reply = true;
  }

  void obey(Client& client, const UsbipImportRequest& request) {
    for (std::size_t i = 0; i < ports.size(); ++i) {
      if (request.bus_id != bus_id(i) || !ports[i]->is_plugged_in()) continue;
      const bool is_taken = std::ranges::any_of(clients, [i](const auto& other) { return other->device == i; });
      const UsbipOffer offered = offer(i);
      queue(client, usbip_import_reply(&offered, is_taken));
      if (is_taken) break;
      client.phase = UsbipPhase::kTransfers;
      client.device = i;
      return;
    }
    if (client.out.empty()) queue(client, usbip_import_reply(nullptr, false));
    client.ends_after_reply = true;
  }

  void obey(Client& client, const UsbipSubmit& submit) const {
    ports[*client.device]->submit({.id = submit.number,
                                   .endpoint = submit.endpoint,
                                   .is_to_host = submit.is_to_host,
                                   .setup = submit.setup,
                                   .data = submit.data,
                                   .max_size = submit.length});
    // Now, so that an unlink later in the same bytes finds the transfer answered or waiting.
    send_outcomes(client);
  }

  void obey(Client& client, const UsbipUnlink& unlink) const {
    const bool was_waiting = ports[*client.device]->cancel(unlink.unlinked);
    queue(client, usbip_unlink_reply(unlink.number, was_waiting ? kUsbipUnlinked : kUsbipDone));
  }

  void send_outcomes(Client& client) const {
    for (const Outcome& outcome : ports[*client.device]->take_outcomes()) {
      queue(client, usbip_submit_reply(static_cast<std::uint32_t>(outcome.id),
                                       outcome.is_refused ? kUsbipStalled : kUsbipDone, outcome.size, outcome.data));
    }
  }

  static void queue(Client& client, const Bytes& bytes) {
    client.out.insert(client.out.end(), bytes.begin(), bytes.end());
  }

  void drop_those_that_are_gone() {
    for (const auto& client : clients) {
      if (client->is_gone && client->device) ports[*client->device]->cancel_all();
    }
    std::erase_if(clients, [](const auto& client) { return client->is_gone; });
  }

  asio::io_context context;  // never run: every call here returns at once
  tcp::acceptor acceptor{context};
  std::vector<std::unique_ptr<Port>> ports;
  std::vector<core::FaultKind> known_faults;
  std::vector<std::unique_ptr<Client>> clients;
  std::optional<core::FaultKind> fault;
  std::string trouble;  // the error of the last connection that was closed
};

UsbipServer::UsbipServer(const std::string& host, std::uint16_t port, std::vector<std::unique_ptr<Port>> ports)
    : state_(std::make_unique<State>(host, port, std::move(ports))) {}

UsbipServer::~UsbipServer() = default;

std::uint16_t UsbipServer::port() const {
  return state_->acceptor.local_endpoint().port();
}

std::span<const core::FaultKind> UsbipServer::known_faults() const {
  return state_->known_faults;
}

std::vector<int> UsbipServer::descriptors() const {
  std::vector<int> all = {state_->acceptor.native_handle()};
  for (const auto& client : state_->clients) all.push_back(client->socket.native_handle());
  return all;
}

void UsbipServer::serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) {
  State& state = *state_;
  state.fault = fault;
  for (const auto& port : state.ports) port->advance(time_s, fault);
  if (std::ranges::count(ready, state.acceptor.native_handle()) != 0) state.accept_clients();

  for (const auto& client : state.clients) {
    if (client->device && !state.ports[*client->device]->is_plugged_in()) client->is_gone = true;
    if (client->is_gone) continue;
    if (std::ranges::count(ready, client->socket.native_handle()) != 0) {
      State::read(*client);
      state.obey(*client);
    }
    if (client->device && !client->is_gone) state.send_outcomes(*client);
    State::write(*client);
  }
  state.drop_those_that_are_gone();
}

std::string UsbipServer::status() const {
  const State& state = *state_;
  const core::PlayedMoment moment = state.ports.empty() ? core::PlayedMoment{} : state.ports.front()->moment();
  const auto attached =
      std::ranges::count_if(state.clients, [](const auto& client) { return client->device.has_value(); });
  return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {} of {} attached{}{}{}{}", moment.speed_m_s,
                     moment.direction_deg, attached, state.ports.size(), state.fault ? ", fault: " : "",
                     state.fault ? name_of(*state.fault) : "",
                     state.trouble.empty() ? "" : ", given up: ", state.trouble);
}

std::vector<core::FaultKind> faults_of(std::span<const std::unique_ptr<Port>> ports) {
  std::vector<core::FaultKind> all;
  for (const auto& port : ports) {
    for (const core::FaultKind kind : port->known_faults()) {
      if (std::ranges::count(all, kind) == 0) all.push_back(kind);
    }
  }
  return all;
}

}  // namespace yuragi::simulators::usb
