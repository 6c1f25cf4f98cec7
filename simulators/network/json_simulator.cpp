#include "simulators/network/json_simulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <list>
#include <map>
#include <random>
#include <stdexcept>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>

#include "engine/base/count_text.hpp"
#include "simulators/core/tcp_listener.hpp"

namespace yuragi::simulators::network {
namespace {

using boost::asio::ip::tcp;

constexpr double kReplyPieceGap_s = 0.03;
constexpr std::size_t kJsonGarbageBytes = 120;
constexpr std::size_t kMaxJsonRequest = 8192;
constexpr std::size_t kMaxIndex = 100;  ///< of a place in an array
constexpr std::string_view kOtherPage =
    "<!DOCTYPE html>\n<html><head><title>Sign in</title></head><body></body></html>\n";

double units_of_one_metre_per_second(const std::string& unit) {
  static const std::map<std::string, double, std::less<>> kUnits = {
      {"m/s", 1.0}, {"km/h", 3.6}, {"kn", 3600.0 / 1852.0}, {"mph", 3600.0 / 1609.344}, {"ft/s", 1.0 / 0.3048}};
  return kUnits.at(unit);
}

/// A JSON text that is written from values at their places.
class JsonTree {
 public:
  /// `value`: JSON. Throws std::runtime_error if another value is in the way.
  void put(std::string_view pointer, const std::string& value) {
    if (!value_.empty()) throw std::runtime_error("a place is within the value at another place");
    if (pointer.empty()) {
      if (!parts_.empty()) throw std::runtime_error("a value would be in the place of others");
      value_ = value;
      return;
    }
    if (pointer.front() != '/') throw std::runtime_error("a JSON pointer begins with a slash, as in /wind/speed");
    const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
    parts_[unescaped(pointer.substr(1, end - 1))].put(pointer.substr(end), value);
  }

  std::string text() const {
    if (!value_.empty()) return value_;
    return is_array() ? array_text() : object_text();
  }

 private:
  static std::string unescaped(std::string_view token) {
    std::string name;
    for (std::size_t i = 0; i < token.size(); ++i) {
      const bool is_escape = token[i] == '~' && i + 1 < token.size();
      name += !is_escape ? token[i] : token[++i] == '1' ? '/' : '~';
    }
    return name;
  }

  static bool is_index(const std::string& name) {
    const bool is_number =
        !name.empty() && name.size() <= 3 && std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
    return is_number && (name == "0" || name.front() != '0') && std::stoul(name) <= kMaxIndex;
  }

  bool is_array() const {
    return !parts_.empty() && std::ranges::all_of(parts_, [](const auto& part) { return is_index(part.first); });
  }

  std::string array_text() const {
    std::size_t size = 0;
    for (const auto& [name, part] : parts_) size = std::max<std::size_t>(size, std::stoul(name) + 1);
    std::string text;
    for (std::size_t i = 0; i < size; ++i) {
      const auto part = parts_.find(std::to_string(i));
      text += (i == 0 ? "" : ", ") + (part == parts_.end() ? "null" : part->second.text());
    }
    return "[" + text + "]";
  }

  std::string object_text() const {
    std::string text;
    for (const auto& [name, part] : parts_) {
      std::string quoted;
      for (const char c : name) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
      text += fmt::format("{}\"{}\": {}", text.empty() ? "" : ", ", quoted, part.text());
    }
    return "{" + text + "}";
  }

  std::string value_;
  std::map<std::string, JsonTree> parts_;
};

}  // namespace

class JsonSimulator::State {
 public:
  State(const JsonOptions& options, core::MeasuredWind wind)
      : options_(options), wind_(std::move(wind)), random_(options.seed), listener_(options.host, options.port) {
    static_cast<void>(body(false));
  }

  std::uint16_t port() const { return listener_.endpoint().port(); }

  std::vector<int> descriptors() {
    std::vector<int> all;
    if (listener_.is_open()) all.push_back(listener_.descriptor());
    for (Client& client : clients_) all.push_back(client.socket.native_handle());
    return all;
  }

  void serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) {
    fault_ = fault;
    observe(time_s);
    if (fault == core::FaultKind::kDisconnect) {
      clients_.clear();
      listener_.close();
      return;
    }
    if (!listener_.open_again()) return;
    for (Client& client : clients_) {
      if (std::ranges::find(ready, client.socket.native_handle()) != ready.end()) read(client, time_s);
      send_what_is_due(client, time_s);
    }
    std::erase_if(clients_, [](const Client& client) { return !client.socket.is_open(); });
    while (auto client = listener_.accept()) clients_.push_back({.socket = std::move(*client)});
  }

  std::string status() const {
    return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {}{}{}", moment_.speed_m_s, moment_.direction_deg,
                       count_text(requests_, "request"), fault_ ? ", fault: " : "", fault_ ? name_of(*fault_) : "");
  }

 private:
  struct Due {
    double time_s;
    std::string bytes;
  };
  struct Client {
    tcp::socket socket;
    std::string received = {};
    std::deque<Due> waiting = {};
    bool ends_early = false;
  };

  void observe(double time_s) {
    moment_ = wind_.at(time_s, fault_);
    gust_m_s_ = std::max(gust_m_s_, moment_.speed_m_s);
    if (time_s < next_observation_s_ || fault_ == core::FaultKind::kFreeze) return;
    while (next_observation_s_ <= time_s) next_observation_s_ += options_.interval_s;
    ++observations_;
    observed_ = moment_;
    observed_gust_m_s_ = gust_m_s_;
    gust_m_s_ = 0.0;
  }

  /// `has_wind`: the anemometer is connected.
  std::string body(bool has_wind) const {
    const double units = units_of_one_metre_per_second(options_.unit);
    const auto value = [has_wind](double number, int digits) {
      return has_wind ? fmt::format("{:.{}f}", number, digits) : std::string("null");
    };
    JsonTree tree;
    tree.put(options_.speed_at, value(observed_.speed_m_s * units, 3));
    if (!options_.direction_at.empty())
      tree.put(options_.direction_at, value(std::fmod(std::round(observed_.direction_deg), 360.0), 0));
    if (!options_.gust_at.empty()) tree.put(options_.gust_at, value(observed_gust_m_s_ * units, 3));
    // Without a zone: it names no moment of this machine's clock.
    if (!options_.time_at.empty()) tree.put(options_.time_at, fmt::format("\"observation {}\"", observations_));
    return tree.text();
  }

  void read(Client& client, double time_s) {
    std::array<char, 2048> block{};
    boost::system::error_code error;
    const std::size_t size = client.socket.read_some(boost::asio::buffer(block), error);
    client.received.append(block.data(), size);
    if (error && error != boost::asio::error::would_block) client.socket.close(error);
    for (std::size_t end = 0; (end = client.received.find("\r\n\r\n")) != std::string::npos;) {
      reply(client, client.received.substr(0, end + 2), time_s);
      client.received.erase(0, end + 4);
    }
    if (client.received.size() > kMaxJsonRequest) client.socket.close(error);
  }

  void reply(Client& client, const std::string& request, double time_s) {
    ++requests_;
    if (fault_ == core::FaultKind::kSilence) return;
    std::string bytes = reply_to(request);
    if (fault_ == core::FaultKind::kGarbage) {
      bytes.resize(kJsonGarbageBytes);
      std::ranges::generate(bytes, [this] { return static_cast<char>(random_()); });
      bytes.front() = 'G';
    }
    if (fault_ == core::FaultKind::kPartial) bytes.pop_back();
    client.ends_early = fault_ == core::FaultKind::kPartial || fault_ == core::FaultKind::kGarbage;
    const double start_s = time_s + (fault_ == core::FaultKind::kLate ? options_.late_s : 0.0);
    const std::size_t piece = fault_ == core::FaultKind::kSplit ? bytes.size() / 4 + 1 : bytes.size();
    for (std::size_t from = 0, i = 0; from < bytes.size(); from += piece, ++i)
      client.waiting.push_back({start_s + kReplyPieceGap_s * static_cast<double>(i), bytes.substr(from, piece)});
  }

  std::string reply_to(const std::string& request) const {
    if (!request.starts_with("GET ")) return with_header("405 Method Not Allowed", "text/plain", "only GET\n");
    if (fault_ == core::FaultKind::kException)
      return with_header("503 Service Unavailable", "application/json", R"({"error": "overloaded"})");
    if (fault_ == core::FaultKind::kWrongId) return with_header("200 OK", "text/html", std::string(kOtherPage));
    const std::string etag = fmt::format("\"{}\"", observations_);
    if (fault_ != core::FaultKind::kUnplug && fault_ != core::FaultKind::kPartial &&
        request.find("\r\nIf-None-Match: " + etag + "\r\n") != std::string::npos)
      return fmt::format("HTTP/1.1 304 Not Modified\r\nETag: {}\r\n\r\n", etag);
    const bool has_wind = fault_ != core::FaultKind::kUnplug;
    return with_header("200 OK", "application/json", body(has_wind), has_wind ? "ETag: " + etag + "\r\n" : "");
  }

  static std::string with_header(std::string_view status, std::string_view type, const std::string& body,
                                 const std::string& more = "") {
    return fmt::format("HTTP/1.1 {}\r\nContent-Type: {}\r\nContent-Length: {}\r\n{}\r\n{}", status, type, body.size(),
                       more, body);
  }

  static void send_what_is_due(Client& client, double time_s) {
    boost::system::error_code error;
    while (client.socket.is_open() && !client.waiting.empty() && client.waiting.front().time_s <= time_s) {
      boost::asio::write(client.socket, boost::asio::buffer(client.waiting.front().bytes), error);
      client.waiting.pop_front();
      const bool is_over = client.ends_early && client.waiting.empty();
      if (is_over || (error && error != boost::asio::error::would_block)) client.socket.close(error);
    }
  }

  JsonOptions options_;
  core::MeasuredWind wind_;
  std::mt19937_64 random_;
  core::TcpListener listener_;
  std::list<Client> clients_;

  double next_observation_s_ = 0.0;
  std::uint64_t observations_ = 0;
  core::PlayedMoment observed_;
  double observed_gust_m_s_ = 0.0;
  double gust_m_s_ = 0.0;
  core::PlayedMoment moment_;
  std::optional<core::FaultKind> fault_;
  std::uint64_t requests_ = 0;
};

JsonSimulator::JsonSimulator(const JsonOptions& options, core::MeasuredWind wind)
    : state_(std::make_unique<State>(options, std::move(wind))) {}

JsonSimulator::~JsonSimulator() = default;

std::uint16_t JsonSimulator::port() const {
  return state_->port();
}

std::span<const core::FaultKind> JsonSimulator::known_faults() const {
  using enum core::FaultKind;
  static constexpr std::array kKnown = {kSilence, kFreeze, kSpike,     kGarbage,    kSplit, kPartial,
                                        kWrongId, kLate,   kException, kDisconnect, kUnplug};
  return kKnown;
}

std::vector<int> JsonSimulator::descriptors() const {
  return state_->descriptors();
}

void JsonSimulator::serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) {
  state_->serve(ready, time_s, fault);
}

std::string JsonSimulator::status() const {
  return state_->status();
}

}  // namespace yuragi::simulators::network
