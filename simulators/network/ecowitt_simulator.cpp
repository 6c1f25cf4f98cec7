#include "simulators/network/ecowitt_simulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <list>
#include <numeric>
#include <random>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ip/udp.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>

#include "engine/base/count_text.hpp"
#include "simulators/core/socket_address.hpp"
#include "simulators/core/tcp_listener.hpp"

namespace yuragi::simulators::network {
namespace {

using boost::asio::ip::tcp;
using GatewayBytes = std::vector<std::uint8_t>;

constexpr double kPieceGap_s = 0.03;
const GatewayBytes kSearchQuestion = {0xFF, 0xFF, 0x12, 0x03, 0x15};
const GatewayBytes kMacAddress = {0x02, 0x00, 0x5E, 0x10, 0x5B, 0x1C};
constexpr std::string_view kGatewayName = "GW1000-WIFI5B1C V1.7.6";
constexpr std::size_t kGatewayGarbageBytes = 40;
const GatewayBytes kLiveDataRequest = {0xFF, 0xFF, 0x27, 0x03, 0x2A};

/// The last values of the anemometer.
struct RadioWind {
  double speed_m_s = 0.0;
  double gust_m_s = 0.0;
  double direction_deg = 0.0;
};

void append(GatewayBytes& bytes, std::uint8_t id, double value, int size) {
  const auto number = static_cast<std::uint32_t>(std::lround(value));
  bytes.push_back(id);
  for (int shift = 8 * (size - 1); shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(number >> shift));
}

/// A reply with its size and checksum.
GatewayBytes framed(std::uint8_t command, const GatewayBytes& items) {
  const std::size_t size = 1 + 2 + items.size() + 1;
  GatewayBytes reply(2, 0xFF);
  append(reply, command, static_cast<double>(size), 2);
  for (const std::uint8_t byte : items) reply.push_back(byte);
  reply.push_back(static_cast<std::uint8_t>(std::accumulate(reply.begin() + 2, reply.end(), 0U)));
  return reply;
}

/// The values of a gateway whose anemometer is heard, or not, in the order of a GW1000.
GatewayBytes live_items(const RadioWind* wind) {
  GatewayBytes items;
  append(items, 0x01, 225, 2);    // inside: 22.5 degrees Celsius
  append(items, 0x06, 37, 1);     // 37 %
  append(items, 0x08, 10163, 2);  // 1016.3 hPa
  append(items, 0x09, 10178, 2);
  if (wind != nullptr) {
    append(items, 0x02, 65531, 2);  // outside: -0.5 degrees Celsius
    append(items, 0x07, 93, 1);
    append(items, 0x0A, wind->direction_deg, 2);
    append(items, 0x0B, wind->speed_m_s * 10.0, 2);
    append(items, 0x0C, wind->gust_m_s * 10.0, 2);
    append(items, 0x15, 37820, 4);  // light
    append(items, 0x16, 32, 2);
    append(items, 0x17, 0, 1);
    append(items, 0x19, 71, 2);  // greatest wind of the day
  }
  append(items, 0x0E, 12, 2);  // 1.2 mm/h
  append(items, 0x10, 8, 2);
  append(items, 0x13, 3979, 4);  // 397.9 mm
  return items;
}

}  // namespace

class EcowittSimulator::State {
 public:
  State(const EcowittOptions& options, core::MeasuredWind wind)
      : options_(options), wind_(std::move(wind)), random_(options.seed), listener_(options.host, options.port) {
    if (options.search_host.empty()) return;
    using boost::asio::ip::udp;
    search_.open(udp::v4());
    search_.bind(udp::endpoint(core::socket_address(options.search_host), options.search_port));
    search_.non_blocking(true);
  }

  std::uint16_t port() const { return listener_.endpoint().port(); }

  std::uint16_t search_port() const { return search_.local_endpoint().port(); }

  std::vector<int> descriptors() {
    std::vector<int> all;
    if (listener_.is_open()) all.push_back(listener_.descriptor());
    for (Client& client : clients_) all.push_back(client.socket.native_handle());
    if (search_.is_open()) all.push_back(search_.native_handle());
    return all;
  }

  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) {
    fault_ = fault;
    measure(time_s);
    if (fault == core::FaultKind::kDisconnect) {
      clients_.clear();
      listener_.close();
      return;
    }
    if (!listener_.open_again()) return;
    answer_searches();
    for (Client& client : clients_) {
      if (std::ranges::find(ready, client.socket.native_handle()) != ready.end()) read(client, time_s);
      send_what_is_due(client, time_s);
    }
    std::erase_if(clients_, [](const Client& client) { return !client.socket.is_open(); });
    while (auto client = listener_.accept()) clients_.push_back({.socket = std::move(*client)});
  }

  std::string status() const {
    return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {}{}{}", moment_.speed_m_s, moment_.direction_deg,
                       count_text(replied_, "request"), fault_ ? ", fault: " : "", fault_ ? name_of(*fault_) : "");
  }

 private:
  struct Due {
    double time_s;
    GatewayBytes bytes;
  };
  struct Client {
    tcp::socket socket;
    GatewayBytes received = {};
    std::deque<Due> waiting = {};
  };

  /// The anemometer measures all the time, and reports at its own interval.
  void measure(double time_s) {
    moment_ = wind_.at(time_s, fault_);
    gust_m_s_ = std::max(gust_m_s_, moment_.speed_m_s);
    if (time_s < next_radio_s_) return;
    while (next_radio_s_ <= time_s) next_radio_s_ += options_.interval_s;
    radio_ = {.speed_m_s = moment_.speed_m_s, .gust_m_s = gust_m_s_, .direction_deg = moment_.direction_deg};
    gust_m_s_ = 0.0;
  }

  void read(Client& client, double time_s) {
    std::array<std::uint8_t, 256> block{};
    boost::system::error_code error;
    const std::size_t size = client.socket.read_some(boost::asio::buffer(block), error);
    client.received.insert(client.received.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(size));
    if (error && error != boost::asio::error::would_block) client.socket.close(error);
    if (client.received == kLiveDataRequest) reply(client, time_s);
    if (client.received.size() >= kLiveDataRequest.size()) client.received.clear();
  }

  void answer_searches() {
    while (search_.is_open()) {
      std::array<std::uint8_t, 64> question{};
      boost::asio::ip::udp::endpoint from;
      boost::system::error_code error;
      const std::size_t size = search_.receive_from(boost::asio::buffer(question), from, 0, error);
      if (error) return;
      if (GatewayBytes(question.begin(), question.begin() + static_cast<std::ptrdiff_t>(size)) != kSearchQuestion)
        continue;
      search_.send_to(boost::asio::buffer(who_it_is()), from, 0, error);
    }
  }

  /// As in a recorded reply: the size counts up to the name's end, without the checksum.
  GatewayBytes who_it_is() const {
    GatewayBytes all = {0xFF, 0xFF, 0x12, 0x00, static_cast<std::uint8_t>(16 + kGatewayName.size())};
    for (const std::uint8_t byte : kMacAddress) all.push_back(byte);
    const auto address = listener_.endpoint().address();
    if (address.is_v4()) {
      for (const std::uint8_t byte : address.to_v4().to_bytes()) all.push_back(byte);
    } else {
      for (int i = 0; i < 4; ++i) all.push_back(0);
    }
    all.push_back(static_cast<std::uint8_t>(port() >> 8U));
    all.push_back(static_cast<std::uint8_t>(port() & 0xFFU));
    all.push_back(static_cast<std::uint8_t>(kGatewayName.size()));
    for (const char c : kGatewayName) all.push_back(static_cast<std::uint8_t>(c));
    all.push_back(static_cast<std::uint8_t>(std::accumulate(all.begin() + 2, all.end(), 0U)));
    return all;
  }

  void reply(Client& client, double time_s) {
    ++replied_;
    GatewayBytes bytes = framed(0x27, live_items(fault_ == core::FaultKind::kUnplug ? nullptr : &radio_));
    if (fault_ == core::FaultKind::kSilence) return;
    if (fault_ == core::FaultKind::kGarbage) {
      bytes.resize(kGatewayGarbageBytes);
      std::ranges::generate(bytes, [this] { return static_cast<std::uint8_t>(random_()); });
    }
    if (fault_ == core::FaultKind::kPartial) bytes.resize(bytes.size() / 2);
    if (fault_ == core::FaultKind::kBadChecksum) bytes.back() ^= 0xFFU;
    if (fault_ == core::FaultKind::kWrongTransaction) bytes = framed(0x34, {0x0E, 0x00, 0x0C});
    if (fault_ != core::FaultKind::kSplit) {
      client.waiting.push_back({time_s + (fault_ == core::FaultKind::kLate ? options_.late_s : 0.0), std::move(bytes)});
      return;
    }
    // The head in two, and then the rest.
    for (std::size_t from = 0, piece = 0; from < bytes.size(); ++piece) {
      const std::size_t to = piece < 2 ? from + 2 : bytes.size();
      client.waiting.push_back(
          {time_s + static_cast<double>(piece) * kPieceGap_s,
           {bytes.begin() + static_cast<std::ptrdiff_t>(from), bytes.begin() + static_cast<std::ptrdiff_t>(to)}});
      from = to;
    }
  }

  static void send_what_is_due(Client& client, double time_s) {
    while (client.socket.is_open() && !client.waiting.empty() && client.waiting.front().time_s <= time_s) {
      boost::system::error_code error;
      boost::asio::write(client.socket, boost::asio::buffer(client.waiting.front().bytes), error);
      if (error && error != boost::asio::error::would_block) client.socket.close(error);
      client.waiting.pop_front();
    }
  }

  EcowittOptions options_;
  core::MeasuredWind wind_;
  std::mt19937_64 random_;
  core::TcpListener listener_;
  std::list<Client> clients_;
  boost::asio::io_context context_;
  boost::asio::ip::udp::socket search_{context_};

  double next_radio_s_ = 0.0;
  double gust_m_s_ = 0.0;
  RadioWind radio_;
  core::PlayedMoment moment_;
  std::optional<core::FaultKind> fault_;
  std::uint64_t replied_ = 0;
};

EcowittSimulator::EcowittSimulator(const EcowittOptions& options, core::MeasuredWind wind)
    : state_(std::make_unique<State>(options, std::move(wind))) {}

EcowittSimulator::~EcowittSimulator() = default;

std::uint16_t EcowittSimulator::port() const {
  return state_->port();
}

std::uint16_t EcowittSimulator::search_port() const {
  return state_->search_port();
}

std::span<const core::FaultKind> EcowittSimulator::known_faults() const {
  using enum core::FaultKind;
  static constexpr std::array kKnown = {kSilence,     kFreeze,           kSpike, kGarbage,    kSplit, kPartial,
                                        kBadChecksum, kWrongTransaction, kLate,  kDisconnect, kUnplug};
  return kKnown;
}

std::vector<int> EcowittSimulator::descriptors() const {
  return state_->descriptors();
}

void EcowittSimulator::serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) {
  state_->serve(ready, time_s, fault);
}

std::string EcowittSimulator::status() const {
  return state_->status();
}

}  // namespace yuragi::simulators::network
