#include "simulators/network/tempest_simulator.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <random>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <fmt/format.h>

#include "engine/base/count_text.hpp"
#include "simulators/core/socket_address.hpp"

namespace yuragi::simulators::network {
namespace {

using boost::asio::ip::udp;

constexpr double kHubClock_s = 1.7e9;
constexpr double kHubStatusInterval_s = 10.0;
constexpr std::size_t kHubGarbageBytes = 80;

/// The winds of one report.
struct Report {
  double lull_m_s = std::numeric_limits<double>::max();
  double sum_m_s = 0.0;
  double gust_m_s = 0.0;
  int count = 0;

  void add(double speed_m_s) {
    lull_m_s = std::min(lull_m_s, speed_m_s);
    gust_m_s = std::max(gust_m_s, speed_m_s);
    sum_m_s += speed_m_s;
    ++count;
  }
};

}  // namespace

class TempestSimulator::State {
 public:
  State(const TempestOptions& options, core::MeasuredWind wind)
      : options_(options),
        wind_(std::move(wind)),
        random_(options.seed),
        to_(core::socket_address(options.host), options.port),
        socket_(context_, to_.protocol()) {
    socket_.set_option(boost::asio::socket_base::broadcast(true));
    next_report_s_ = options.report_interval_s;
  }

  void serve(double time_s, std::optional<core::FaultKind> fault) {
    fault_ = fault;
    moment_ = wind_.at(time_s, fault);
    report_.add(moment_.speed_m_s);
    const bool has_stations = fault != core::FaultKind::kUnplug;
    if (options_.rapid_wind_interval_s > 0.0 && is_due(next_rapid_wind_s_, options_.rapid_wind_interval_s, time_s)) {
      for (const std::string& station : options_.stations) {
        if (has_stations) send(rapid_wind(station, time_s));
      }
    }
    if (is_due(next_report_s_, options_.report_interval_s, time_s)) {
      for (const std::string& station : options_.stations) {
        if (has_stations) send(observation(station, time_s));
      }
      report_ = {};
    }
    if (is_due(next_hub_status_s_, kHubStatusInterval_s, time_s)) send(hub_status(time_s));
  }

  std::uint64_t sent() const noexcept { return sent_; }
  std::string status() const {
    return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {}{}{}", moment_.speed_m_s, moment_.direction_deg,
                       count_text(sent_, "message"), fault_ ? ", fault: " : "", fault_ ? name_of(*fault_) : "");
  }

 private:
  /// Messages that were due while serve() was not called are skipped.
  static bool is_due(double& next_s, double interval_s, double time_s) {
    if (time_s < next_s) return false;
    while (next_s <= time_s) next_s += interval_s;
    return true;
  }

  static std::int64_t hub_time_s(double time_s) { return static_cast<std::int64_t>(kHubClock_s + time_s); }

  /// Returns the serial number that a station sends: a wrong one under that fault.
  std::string name_of_station(const std::string& station) const {
    return fault_ == core::FaultKind::kWrongId ? station.substr(0, 3) + "99999999" : station;
  }

  std::string rapid_wind(const std::string& station, double time_s) const {
    return fmt::format(R"({{"serial_number":"{}","type":"rapid_wind","hub_sn":"{}","ob":[{},{:.2f},{:.0f}]}})",
                       name_of_station(station), options_.hub, hub_time_s(time_s), moment_.speed_m_s, direction_deg());
  }

  std::string observation(const std::string& station, double time_s) const {
    return fmt::format(
        R"({{"serial_number":"{}","type":"obs_st","hub_sn":"{}","obs":[[{},{:.2f},{:.2f},{:.2f},{:.0f},3,)"
        R"(1017.57,22.37,50.26,328,0.03,3,0.010000,0,0,0,2.410,{:.0f}]],"firmware_revision":129}})",
        name_of_station(station), options_.hub, hub_time_s(time_s), report_.lull_m_s, report_.sum_m_s / report_.count,
        report_.gust_m_s, direction_deg(), std::max(1.0, options_.report_interval_s / 60.0));
  }

  std::string hub_status(double time_s) const {
    return fmt::format(
        R"({{"serial_number":"{}","type":"hub_status","firmware_revision":"171","uptime":{:.0f},"rssi":-62,)"
        R"("timestamp":{},"reset_flags":"BOR,PIN,POR","seq":48,"radio_stats":[25,1,0,3,2839],"mqtt_stats":[1,0]}})",
        options_.hub, time_s, hub_time_s(time_s));
  }

  double direction_deg() const { return moment_.speed_m_s < 0.005 ? 0.0 : moment_.direction_deg; }

  void send(std::string message) {
    if (fault_ == core::FaultKind::kSilence) return;
    if (fault_ == core::FaultKind::kPartial) message.resize(message.size() * 2 / 3);
    if (fault_ == core::FaultKind::kGarbage) {
      message.resize(kHubGarbageBytes);
      std::ranges::generate(message, [this] { return static_cast<char>(random_()); });
    }
    // Without a listener the next send fails; that is ignored.
    boost::system::error_code ignored;
    socket_.send_to(boost::asio::buffer(message), to_, 0, ignored);
    ++sent_;
  }

  TempestOptions options_;
  core::MeasuredWind wind_;
  std::mt19937_64 random_;
  boost::asio::io_context context_;
  udp::endpoint to_;
  udp::socket socket_;

  double next_rapid_wind_s_ = 0.0;
  double next_report_s_ = 0.0;
  double next_hub_status_s_ = 0.0;
  core::PlayedMoment moment_;
  Report report_;
  std::optional<core::FaultKind> fault_;
  std::uint64_t sent_ = 0;
};

TempestSimulator::TempestSimulator(const TempestOptions& options, core::MeasuredWind wind)
    : state_(std::make_unique<State>(options, std::move(wind))) {}

TempestSimulator::~TempestSimulator() = default;

std::span<const core::FaultKind> TempestSimulator::known_faults() const {
  using enum core::FaultKind;
  static constexpr std::array kKnown = {kSilence, kFreeze, kSpike, kGarbage, kPartial, kWrongId, kUnplug};
  return kKnown;
}

void TempestSimulator::serve(std::span<const int> /*ready*/, double time_s, std::optional<core::FaultKind> fault) {
  state_->serve(time_s, fault);
}

std::uint64_t TempestSimulator::sent() const noexcept {
  return state_->sent();
}

std::string TempestSimulator::status() const {
  return state_->status();
}

}  // namespace yuragi::simulators::network
