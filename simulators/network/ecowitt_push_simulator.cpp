#include "simulators/network/ecowitt_push_simulator.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <random>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <fmt/format.h>

#include "engine/base/count_text.hpp"
#include "simulators/core/socket_address.hpp"

namespace yuragi::simulators::network {
namespace {

using boost::asio::ip::tcp;

constexpr double kMphPerMetrePerSecond = 3600.0 / 1609.344;
constexpr double kPushPieceGap_s = 0.03;
constexpr std::size_t kPushGarbageBytes = 60;
/// Gateways give a server up that does not answer.
constexpr double kAnswerPatience_s = 5.0;
constexpr std::string_view kPushWrongStation = "00000000000000000000000000000000";

struct PushedWind {
  double speed_mph = 0.0;
  double gust_mph = 0.0;
  double direction_deg = 0.0;
};

std::string usual_path(PushProtocol protocol) {
  if (protocol == PushProtocol::kWunderground) return "/weatherstation/updateweatherstation.php?";
  if (protocol == PushProtocol::kWsLink) return "/data/upload.php?";
  return protocol == PushProtocol::kAmbient ? "/data/report/?" : "/data/report/";
}

/// `wind`: nullptr if the anemometer is not received.
std::string ecowitt_form(const std::string& station, const PushedWind* wind) {
  std::string form = fmt::format(
      "PASSKEY={}&stationtype=GW1100A_V2.4.5&runtime=3728&heap=24412&dateutc=2026-05-18+16:32:04&tempinf=80.42"
      "&humidityin=41&baromrelin=29.394&baromabsin=29.203",
      station);
  if (wind != nullptr)
    form += fmt::format(
        "&tempf=51.08&humidity=93&winddir={:.0f}&windspeedmph={:.2f}&windgustmph={:.2f}&maxdailygust=28.05"
        "&solarradiation=127.25&uv=1",
        wind->direction_deg, wind->speed_mph, wind->gust_mph);
  return form +
         "&rainratein=0.071&eventrainin=0.051&hourlyrainin=0.039&dailyrainin=0.079&weeklyrainin=0.169"
         "&monthlyrainin=1.480&yearlyrainin=15.571&totalrainin=15.571&wh65batt=0&freq=868M&model=GW1100A&interval=16";
}

std::string ambient_form(const std::string& station, const PushedWind* wind) {
  std::string form = fmt::format("stationtype=AMBWeatherV4.3.4&PASSKEY={}&dateutc=2026-05-18+16:32:04", station);
  if (wind != nullptr)
    form += fmt::format("&winddir={:.0f}&windspeedmph={:.2f}&windgustmph={:.2f}&tempf=51.1&humidity=93",
                        wind->direction_deg, wind->speed_mph, wind->gust_mph);
  return form +
         "&hourlyrainin=0.04&dailyrainin=0.08&totalrainin=15.57&tempinf=74.1&humidityin=55&baromrelin=29.394"
         "&baromabsin=29.203";
}

std::string wunderground_form(const std::string& station, const PushedWind* wind) {
  constexpr int kNone = -9999;
  const std::string said = wind == nullptr ? fmt::format(
                                                 "tempf={0}&humidity={0}&winddir={0}&windspeedmph={0}"
                                                 "&windgustmph={0}",
                                                 kNone)
                                           : fmt::format(
                                                 "tempf=51.1&humidity=93&winddir={:.0f}&windspeedmph={:.2f}"
                                                 "&windgustmph={:.2f}",
                                                 wind->direction_deg, wind->speed_mph, wind->gust_mph);
  return fmt::format(
      "ID={}&PASSWORD=correct-horse&{}&rainin=0.04&dailyrainin=0.08&yearlyrainin=15.57&indoortempf=74.1"
      "&indoorhumidity=55&absbaromin=29.203&baromin=29.394&lowbatt=0&dateutc=2026-5-18%2016:32:4"
      "&softwaretype=EasyWeatherV1.5.7&action=updateraw&realtime=1&rtfreq=5",
      station, said);
}

/// In m/s. A console that does not receive the sensors reports so and repeats no values.
std::string ws_link_form(const std::string& station, const PushedWind* wind) {
  const std::string said = wind == nullptr ? "t1cn=0"
                                           : fmt::format(
                                                 "t1cn=1&t1bat=1&t1tem=10.6&t1hum=93&t1wdir={:.0f}&t1ws={:.2f}&"
                                                 "t1ws10mav=2.9&t1wgust={:.2f}&t1rainra=1.8&t1rainyr=395.5",
                                                 wind->direction_deg, wind->speed_mph / kMphPerMetrePerSecond,
                                                 wind->gust_mph / kMphPerMetrePerSecond);
  return fmt::format(
      "wsid={}&wspw=correct-horse&datetime=2026-05-18%2016:32:04&rbar=1013.2&abar=988.9&intem=23.4&inhum=55&inbat=1&{}&"
      "apiver=1.00",
      station, said);
}

std::string get_form(PushProtocol protocol, const std::string& station, const PushedWind* wind) {
  if (protocol == PushProtocol::kAmbient) return ambient_form(station, wind);
  return protocol == PushProtocol::kWsLink ? ws_link_form(station, wind) : wunderground_form(station, wind);
}

}  // namespace

class EcowittPushSimulator::State {
 public:
  State(const EcowittPushOptions& options, core::MeasuredWind wind)
      : options_(options),
        wind_(std::move(wind)),
        random_(options.seed),
        to_(core::socket_address(options.host), options.port) {
    if (options_.path.empty()) options_.path = usual_path(options_.protocol);
  }

  std::vector<int> descriptors() {
    if (!socket_.is_open() || is_connecting_) return {};
    return {socket_.native_handle()};
  }

  void serve(double time_s, std::optional<core::FaultKind> fault) {
    fault_ = fault;
    moment_ = wind_.at(time_s, fault);
    gust_m_s_ = std::max(gust_m_s_, moment_.speed_m_s);
    // On a busy machine sending the pieces of a request can take longer than the push interval: it is finished first.
    if (time_s >= next_push_s_ && waiting_.empty()) {
      while (next_push_s_ <= time_s) next_push_s_ += options_.interval_s;
      if (fault != core::FaultKind::kSilence) begin_push(time_s);
      gust_m_s_ = 0.0;
    }
    // Connects, sends what is due, and reads the reply. Never waits.
    context_.restart();
    context_.poll();
    send_what_is_due(time_s);
    receive();
    if (socket_.is_open() && time_s >= give_up_s_) end_push();
  }

  std::uint64_t pushed() const noexcept { return pushed_; }
  const std::string& last_answer() const noexcept { return last_answer_; }

  std::string status() const {
    return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {}, {}{}{}", moment_.speed_m_s, moment_.direction_deg,
                       count_text(pushed_, "request"), last_answer_.empty() ? "no reply" : last_answer_,
                       fault_ ? ", fault: " : "", fault_ ? name_of(*fault_) : "");
  }

 private:
  struct Due {
    double time_s;
    std::string bytes;
  };

  void begin_push(double time_s) {
    end_push();
    ++pushed_;
    last_answer_.clear();
    give_up_s_ = time_s + kAnswerPatience_s;
    std::string request = this->request();
    if (fault_ == core::FaultKind::kGarbage) {
      request.resize(kPushGarbageBytes);
      std::ranges::generate(request, [this] { return static_cast<char>(random_()); });
      request.back() = '\n';
    }
    if (fault_ == core::FaultKind::kPartial || fault_ == core::FaultKind::kDisconnect)
      request.resize(request.size() * 3 / 4);
    is_reset_ = fault_ == core::FaultKind::kDisconnect;
    ends_early_ = fault_ == core::FaultKind::kPartial;
    const std::size_t piece = fault_ == core::FaultKind::kSplit ? request.size() / 4 + 1 : request.size();
    for (std::size_t from = 0; from < request.size(); from += piece) {
      const double delay_s = kPushPieceGap_s * static_cast<double>(waiting_.size());
      waiting_.push_back({time_s + delay_s, request.substr(from, piece)});
    }
    is_connecting_ = true;
    socket_.async_connect(to_, [this, push = pushed_](const boost::system::error_code& error) {
      if (push != pushed_ || error == boost::asio::error::operation_aborted) return;
      is_connecting_ = false;
      boost::system::error_code not_set;
      socket_.non_blocking(true, not_set);
      if (error || not_set) end_push();
    });
  }

  std::string request() const {
    const PushedWind wind = {.speed_mph = moment_.speed_m_s * kMphPerMetrePerSecond,
                             .gust_mph = std::max(gust_m_s_, moment_.speed_m_s) * kMphPerMetrePerSecond,
                             .direction_deg = moment_.direction_deg};
    const PushedWind* const heard = fault_ == core::FaultKind::kUnplug ? nullptr : &wind;
    const std::string station = fault_ == core::FaultKind::kWrongId ? std::string(kPushWrongStation) : options_.station;
    const std::string host = fmt::format("{}:{}", options_.host, options_.port);
    if (options_.protocol == PushProtocol::kEcowitt) {
      const std::string form = ecowitt_form(station, heard);
      // With the blank that some firmware sends after the length.
      return fmt::format(
          "POST {} HTTP/1.1\r\nHOST: {}\r\nConnection: Close\r\nContent-Type: application/x-www-form-urlencoded\r\n"
          "Content-Length:{} \r\n\r\n{}",
          options_.path, host, form.size(), form);
    }
    return fmt::format("GET {}{} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", options_.path,
                       get_form(options_.protocol, station, heard), host);
  }

  void send_what_is_due(double time_s) {
    while (socket_.is_open() && !is_connecting_ && !waiting_.empty() && waiting_.front().time_s <= time_s) {
      boost::system::error_code error;
      boost::asio::write(socket_, boost::asio::buffer(waiting_.front().bytes), error);
      waiting_.pop_front();
      if (error) return end_push();
      if (!waiting_.empty()) continue;
      if (ends_early_) socket_.shutdown(tcp::socket::shutdown_send, error);
      if (!is_reset_) continue;
      socket_.set_option(boost::asio::socket_base::linger(true, 0), error);
      end_push();
    }
  }

  void receive() {
    if (!socket_.is_open() || is_connecting_) return;
    std::array<char, 512> block{};
    boost::system::error_code error;
    const std::size_t size = socket_.read_some(boost::asio::buffer(block), error);
    answer_.append(block.data(), size);
    if (const std::size_t end = answer_.find("\r\n"); end != answer_.npos) last_answer_ = answer_.substr(0, end);
    if (error && error != boost::asio::error::would_block) end_push();
  }

  void end_push() {
    boost::system::error_code ignored;
    socket_.close(ignored);
    is_connecting_ = false;
    waiting_.clear();
    answer_.clear();
  }

  EcowittPushOptions options_;
  core::MeasuredWind wind_;
  std::mt19937_64 random_;
  tcp::endpoint to_;
  boost::asio::io_context context_;
  tcp::socket socket_{context_};
  bool is_connecting_ = false;
  bool is_reset_ = false;
  bool ends_early_ = false;
  std::deque<Due> waiting_;
  std::string answer_;
  std::string last_answer_;

  double next_push_s_ = 0.0;
  double give_up_s_ = 0.0;
  double gust_m_s_ = 0.0;
  core::PlayedMoment moment_;
  std::optional<core::FaultKind> fault_;
  std::uint64_t pushed_ = 0;
};

EcowittPushSimulator::EcowittPushSimulator(const EcowittPushOptions& options, core::MeasuredWind wind)
    : state_(std::make_unique<State>(options, std::move(wind))) {}

EcowittPushSimulator::~EcowittPushSimulator() = default;

std::span<const core::FaultKind> EcowittPushSimulator::known_faults() const {
  using enum core::FaultKind;
  static constexpr std::array kKnown = {kSilence, kFreeze,  kSpike,      kGarbage, kSplit,
                                        kPartial, kWrongId, kDisconnect, kUnplug};
  return kKnown;
}

std::vector<int> EcowittPushSimulator::descriptors() const {
  return state_->descriptors();
}

void EcowittPushSimulator::serve(std::span<const int> /*ready*/, double time_s, std::optional<core::FaultKind> fault) {
  state_->serve(time_s, fault);
}

std::string EcowittPushSimulator::status() const {
  return state_->status();
}

std::uint64_t EcowittPushSimulator::pushed() const noexcept {
  return state_->pushed();
}

const std::string& EcowittPushSimulator::last_answer() const noexcept {
  return state_->last_answer();
}

}  // namespace yuragi::simulators::network
