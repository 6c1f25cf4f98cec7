#include "simulators/davis/weatherlink_live.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace yuragi::simulators::davis {
namespace {

constexpr double kLiveMphOfOneMetrePerSecond = 3600.0 / 1609.344;
constexpr int kUsualDuration_s = 1200;
constexpr int kMaxDuration_s = 86400;
constexpr std::size_t kMaxRequest = 4096;
constexpr std::size_t kLiveGarbage = 300;
/// The delay of a late reply: longer than a client should wait.
constexpr double kLiveLate_s = 8.0;

}  // namespace

WeatherLinkLive::WeatherLinkLive(std::unique_ptr<text::Wire> http, std::unique_ptr<text::Wire> broadcasts,
                                 const WeatherLinkLiveOptions& options, core::MeasuredWind wind)
    : http_(std::move(http)),
      broadcasts_(std::move(broadcasts)),
      options_(options),
      wind_(std::move(wind)),
      random_(options.garbage_seed),
      known_faults_{core::FaultKind::kSilence, core::FaultKind::kFreeze,   core::FaultKind::kSpike,
                    core::FaultKind::kGarbage, core::FaultKind::kPartial,  core::FaultKind::kWrongId,
                    core::FaultKind::kLate,    core::FaultKind::kException} {
  const auto more = http_->known_faults();
  known_faults_.insert(known_faults_.end(), more.begin(), more.end());
}

void WeatherLinkLive::serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) {
  fault_ = fault;
  if (fault == core::FaultKind::kDisconnect || fault == core::FaultKind::kUnplug) {
    http_->take_away();
    broadcasts_->take_away();
    waiting_.clear();
    received_.clear();
    broadcasts_until_s_ = 0.0;
    return;
  }
  http_->bring_back();
  broadcasts_->bring_back();

  moment_ = wind_.at(time_s, fault);
  received_ += http_->read(ready);
  for (std::size_t end = 0; (end = received_.find("\r\n\r\n")) != std::string::npos; received_.erase(0, end + 4)) {
    obey(std::string_view(received_).substr(0, end), time_s, fault);
  }
  if (received_.size() > kMaxRequest) received_.clear();
  while (!waiting_.empty() && waiting_.front().time_s <= time_s) {
    http_->write(waiting_.front().bytes);
    waiting_.pop_front();
  }
  if (time_s >= broadcasts_until_s_) return;
  for (; next_broadcast_s_ <= time_s; next_broadcast_s_ += options_.interval_s) broadcast(time_s, fault);
}

void WeatherLinkLive::obey(std::string_view request, double time_s, std::optional<core::FaultKind> fault) {
  const std::string line(request.substr(0, request.find('\r')));
  if (fault == core::FaultKind::kException) {
    return reply(500, R"({"data":null,"error":{"code":500,"message":"Internal Server Error"}})", time_s, fault);
  }
  if (line == "GET /v1/current_conditions HTTP/1.1") {
    return reply(200, fmt::format(R"({{"data":{},"error":null}})", conditions(false)) + "\n", time_s, fault);
  }
  int duration_s = kUsualDuration_s;
  const bool has_duration = std::sscanf(line.c_str(), "GET /v1/real_time?duration=%d ", &duration_s) == 1;
  if (!has_duration && line != "GET /v1/real_time HTTP/1.1") {
    return reply(404, R"({"data":null,"error":{"code":404,"message":"HTTP Page Not Found"}})", time_s, fault);
  }
  if (duration_s < 1 || duration_s > kMaxDuration_s) {
    return reply(400, R"({"data":null,"error":{"code":400,"message":"Bad Request"}})", time_s, fault);
  }
  ++broadcast_requests_;
  if (time_s >= broadcasts_until_s_) next_broadcast_s_ = time_s;
  broadcasts_until_s_ = std::max(broadcasts_until_s_, time_s + duration_s);
  reply(200,
        fmt::format(R"({{"data":{{"broadcast_port":{},"duration":{:.0f}}},"error":null}})", options_.broadcast_port,
                    broadcasts_until_s_ - time_s),
        time_s, fault);
}

void WeatherLinkLive::broadcast(double /*time_s*/, std::optional<core::FaultKind> fault) {
  if (fault == core::FaultKind::kSilence) return;
  std::string message = conditions(true);
  if (fault == core::FaultKind::kPartial) message.resize(message.size() * 2 / 3);
  broadcasts_->write(fault == core::FaultKind::kGarbage ? garbage() : message);
  ++sent_;
}

/// A broadcast, or the current conditions, which have more fields and the barometer.
std::string WeatherLinkLive::conditions(bool is_broadcast) const {
  const double speed_mph = moment_.speed_m_s * kLiveMphOfOneMetrePerSecond;
  const long direction_deg = speed_mph < 0.005 ? 0 : std::lround(moment_.direction_deg) % 360;
  const std::string wind =
      fmt::format(R"("wind_speed_last":{:.2f},"wind_dir_last":{},"wind_speed_hi_last_10_min":{:.2f})"
                  R"(,"wind_dir_at_hi_speed_last_10_min":{},"rain_size":2,"rain_rate_last":15,"rainfall_daily":37)",
                  speed_mph, direction_deg, std::ceil(speed_mph), direction_deg);
  const std::string station =
      is_broadcast ? "" : R"("temp": 58.1,"hum":65.0,"dew_point": 46.4,"wet_bulb":null,"rx_state":0,)";
  const std::string others =
      is_broadcast ? ""
                   : R"(,{"lsid":288312,"data_structure_type":4,"temp_in": 68.2,"hum_in":35.9})"
                     R"(,{"lsid":288311,"data_structure_type":3,"bar_sea_level":29.921,"bar_absolute":29.315})";
  return fmt::format(
      R"({{"did":"{}","ts":1532031640,"conditions":[{{"lsid":48308,"data_structure_type":1,"txid":1,{}{}}}{}]}})",
      is_broadcast && fault_ == core::FaultKind::kWrongId ? "001D0A7000FF" : "001D0A700002", station, wind, others);
}

void WeatherLinkLive::reply(int status, const std::string& body, double time_s, std::optional<core::FaultKind> fault) {
  if (fault == core::FaultKind::kSilence) return;
  std::string bytes = fmt::format(
      "HTTP/1.1 {} {}\r\nContent-Type: application/json\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{}", status,
      status == 200 ? "OK" : "Error", body.size(), body);
  if (fault == core::FaultKind::kPartial) bytes.resize(bytes.size() * 2 / 3);
  if (fault == core::FaultKind::kGarbage) bytes = garbage();
  waiting_.push_back({fault == core::FaultKind::kLate ? time_s + kLiveLate_s : time_s, bytes});
}

std::string WeatherLinkLive::garbage() {
  std::string bytes(kLiveGarbage, '\0');
  std::ranges::generate(bytes, [this] { return static_cast<char>(random_()); });
  return bytes;
}

std::string WeatherLinkLive::status() const {
  return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {}, {} broadcasts{}{}", moment_.speed_m_s,
                     moment_.direction_deg, http_->place(), sent_, fault_ ? ", fault: " : "",
                     fault_ ? name_of(*fault_) : "");
}

}  // namespace yuragi::simulators::davis
