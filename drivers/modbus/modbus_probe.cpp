#include "drivers/modbus/modbus_probe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "drivers/modbus/modbus_plan.hpp"

namespace yuragi::drivers::modbus {
namespace {

using Registers = Result<decode::modbus::Registers, decode::modbus::RefusedReply>;

/// How long a line must be quiet between two requests: shorter than in normal use, because most get no reply.
constexpr Nanoseconds kProbeQuiet = std::chrono::milliseconds(20);

/// Requests that nearly every device replies to: the first register of either kind.
constexpr std::array kKnocks = {decode::modbus::Request{.function = 3, .address = 0, .count = 1},
                                decode::modbus::Request{.function = 4, .address = 0, .count = 1}};

/// Below this a value counts as 0: a float that is read in a wrong order of words can be 1e-40.
constexpr double kMinLive = 0.005;

/// The speeds, m/s, from which the wind has 1, 2, ... 12 Beaufort (WMO No. 306, code table 1100).
constexpr std::array kBeaufortFrom_m_s = {0.3, 1.6, 3.4, 5.5, 8.0, 10.8, 13.9, 17.2, 20.8, 24.5, 28.5, 32.7};

bool has_side_effects(const Profile& profile) {
  return profile.speed.read_has_side_effect || (profile.direction && profile.direction->read_has_side_effect) ||
         (profile.gust && profile.gust->read_has_side_effect) ||
         std::ranges::any_of(profile.quantities,
                             [](const StationQuantity& station) { return station.quantity.read_has_side_effect; });
}

/// Compares the device's own wind force with the speed. Devices round and average in different ways.
void judge_by_force(const Profile& profile, const Registers& reply, Fit& fit) {
  if (!reply || !fit.speed_m_s) return;
  const auto force = decode::modbus::decode_number(*profile.beaufort, reply->span());
  if (!force || *force < 0.0 || *force > static_cast<double>(kBeaufortFrom_m_s.size())) return;
  fit.beaufort = *force;
  if (*force == 0.0) return;  // a calm, or a register that is never written
  const auto reached =
      std::ranges::count_if(kBeaufortFrom_m_s, [&fit](double from_m_s) { return *fit.speed_m_s >= from_m_s; });
  const bool agrees = std::abs(static_cast<double>(reached) - *force) <= 1.0;
  fit.verdict = agrees ? ForceVerdict::kAgrees : ForceVerdict::kContradicts;
}

/// Returns true if both read the speed from the same register, but with a different meaning.
bool differ_in_scale(const Profile& one, const Profile& other) {
  const auto place = [](const decode::modbus::Quantity& speed) {
    return std::tuple(speed.function, speed.address, speed.type, speed.order);
  };
  const auto meaning = [](const decode::modbus::Quantity& speed) {
    return std::tuple(speed.scale, speed.offset, speed.unit);
  };
  return place(one.speed) == place(other.speed) && meaning(one.speed) != meaning(other.speed);
}

bool has_one_slave(const Profile& profile) {
  return !profile.direction || profile.direction->slave == profile.speed.slave;
}

/// Stop bits make no difference here: a device that sends two is understood by one that expects one, and vice versa.
bool is_home_of(const bus::ModbusLine& line, const Profile& profile) {
  return line.framing == decode::modbus::Framing::kTcp || (line.baud == profile.baud && line.parity == profile.parity);
}

/// One open line. Replies are cached, so that nothing is requested twice.
class ProbedLine {
 public:
  ProbedLine(const bus::ModbusLine& line, Nanoseconds response_timeout, const bus::Interruption& interruption)
      : line_(line),
        patience_{.response_timeout = response_timeout, .byte_timeout = kProbeQuiet},
        interruption_(interruption),
        connection_(bus::make_modbus_connection(line)) {}

  Result<void, Failure> open() { return connection_->open(interruption_); }

  /// The registers, or what was wrong with the reply; kTimeout if there was none.
  Registers cached_exchange(const decode::modbus::Request& request) {
    const auto key = std::tuple(request.unit, request.function, request.address, request.count);
    if (const auto known = replies_.find(key); known != replies_.end()) return known->second;
    const Registers reply = exchange(request);
    replies_.emplace(key, reply);
    return reply;
  }

 private:
  Registers exchange(decode::modbus::Request request) {
    constexpr decode::modbus::RefusedReply kSilence{decode::Refusal::kTimeout};
    std::array<std::uint8_t, decode::modbus::kModbusMaxMessage> buffer{};
    request.transaction = ++transaction_;
    // A TCP peer that is not a Modbus server may close the connection.
    if (!connection_->is_open() && !connection_->open(interruption_)) return kSilence;
    connection_->settle(buffer, patience_, interruption_);
    if (!connection_->send(request, patience_)) {
      connection_->close();
      return kSilence;
    }
    for (;;) {
      const bus::Message message = connection_->receive(buffer, interruption_);
      if (message.status == bus::Status::kLost) connection_->close();
      if (message.status != bus::Status::kMessage) return kSilence;
      const auto registers =
          decode::modbus::decode_modbus(line_.framing, request, std::span(buffer).first(message.size));
      if (registers || registers.error().why != decode::Refusal::kNotMine) return registers;
    }
  }

  const bus::ModbusLine line_;
  const bus::ModbusPatience patience_;
  const bus::Interruption& interruption_;
  std::unique_ptr<bus::ModbusConnection> connection_;
  std::map<std::tuple<std::uint8_t, std::uint8_t, std::uint16_t, std::uint16_t>, Registers> replies_;
  std::uint16_t transaction_ = 0;
};

/// Returns true if this reply comes from a slave. A gateway's exception that none exists does not count.
bool is_sign_of_life(const Registers& reply) {
  return reply || (reply.error().why == decode::Refusal::kException &&
                   !decode::modbus::is_gateway_silence(reply.error().exception));
}

/// Enters the value of one reply into `fit`. Returns false if it is implausible. A mark for "no value" is accepted, but
/// not for the speed.
bool take(const Profile& profile, const RegisterRead& read, const decode::modbus::Registers& registers, Fit& fit) {
  for (const Measure measure : read.measures) {
    const decode::modbus::Quantity& quantity = quantity_of(profile, measure);
    const auto part = registers_of(quantity, read.request, registers);
    const auto value = measure == Measure::kDirection ? decode::modbus::decode_direction_deg(quantity, part)
                                                      : decode::modbus::decode_speed_m_s(quantity, part);
    if (!value && (measure == Measure::kSpeed || value.error() != decode::Refusal::kInvalid)) return false;
    if (!value) continue;
    if (measure == Measure::kSpeed) fit.speed_m_s = *value;
    if (measure == Measure::kDirection) fit.direction_deg = *value;
    if (measure == Measure::kGust) fit.gust_m_s = *value;
  }
  return true;
}

/// The profile's values on that line, if all of its reads get replies with plausible values.
std::optional<Fit> fit_of(const std::string& name, const Profile& profile, const std::vector<RegisterRead>& reads,
                          ProbedLine& line) {
  Fit fit{.profile = name,
          .device = profile.name,
          .speed_m_s = {},
          .direction_deg = {},
          .gust_m_s = {},
          .beaufort = {},
          .speed_slave = profile.speed.slave,
          .direction_slave = {}};
  if (profile.direction) fit.direction_slave = profile.direction->slave;
  for (const RegisterRead& read : reads) {
    if (!read.has_wind()) continue;
    const Registers registers = line.cached_exchange(read.request);
    if (!registers || !take(profile, read, *registers, fit)) return std::nullopt;
  }
  if (profile.beaufort) judge_by_force(profile, line.cached_exchange(request_for(*profile.beaufort)), fit);
  return fit;
}

/// The reading of a pair's cup, if it had this id and its vane were elsewhere.
std::optional<Fit> cup_fit_of(const NamedModbusProfile& named, std::uint8_t id, ProbedLine& line) {
  Profile profile = named.profile;
  profile.direction.reset();
  set_slave(profile, id);
  auto fit = fit_of(named.name, profile, plan_modbus_reads(profile), line);
  if (fit) fit->direction_slave = named.profile.direction->slave;
  return fit;
}

/// The reading of a pair's vane, if it had this id.
std::optional<Fit> vane_fit_of(const NamedModbusProfile& named, std::uint8_t id, ProbedLine& line) {
  Profile profile = named.profile;
  profile.direction->slave = id;
  auto reads = plan_modbus_reads(profile, true);
  const auto is_direction = [](const RegisterRead& read) { return read.contains(Measure::kDirection); };
  std::erase_if(reads, [&](const RegisterRead& read) { return !is_direction(read); });
  return fit_of(named.name, profile, reads, line);
}

/// Returns true if a slave of this id replies. Some devices ignore requests for registers that they do not have: so the
/// registers of each profile are read, with its line settings.
bool replies_at_all(std::uint8_t id, const bus::ModbusLine& settings, const ProbePlan& plan, ProbedLine& line) {
  for (decode::modbus::Request knock : kKnocks) {
    knock.unit = id;
    if (is_sign_of_life(line.cached_exchange(knock))) return true;
  }
  return std::ranges::any_of(plan.profiles, [&](const NamedModbusProfile& named) {
    if (has_side_effects(named.profile) || !is_home_of(settings, named.profile)) return false;
    const auto reads = plan_modbus_reads(named.profile);
    return std::ranges::any_of(reads, [&](const RegisterRead& read) {
      return read.request.unit == id && is_sign_of_life(line.cached_exchange(read.request));
    });
  });
}

std::vector<Fit> fits_of(std::uint8_t id, const bus::ModbusLine& settings, const ProbePlan& plan, ProbedLine& line,
                         const bus::Interruption& interruption) {
  std::vector<Fit> fits;
  for (const NamedModbusProfile& named : plan.profiles) {
    if (interruption.is_set() || has_side_effects(named.profile)) continue;
    // One of several slaves is searched for under the profile's ids.
    const bool is_pair = !has_one_slave(named.profile);
    if (is_pair && named.profile.speed.slave != id) continue;
    Profile profile = named.profile;
    if (!is_pair) set_slave(profile, id);
    auto fit = fit_of(named.name, profile, plan_modbus_reads(profile), line);
    if (!fit) continue;
    fit->is_at_home = named.profile.speed.slave == id && is_home_of(settings, named.profile);
    fits.push_back(*std::move(fit));
  }

  // No fit: it may be one half of a pair whose other half is elsewhere.
  const bool may_be_half = fits.empty();
  for (const NamedModbusProfile& named : plan.profiles) {
    if (!may_be_half || has_side_effects(named.profile) || has_one_slave(named.profile)) continue;
    if (auto fit = cup_fit_of(named, id, line)) fits.push_back(*std::move(fit));
    if (auto fit = vane_fit_of(named, id, line)) fits.push_back(*std::move(fit));
  }

  std::ranges::stable_sort(fits, std::greater<>(), [](const Fit& fit) {
    return std::tuple(is_live(fit), fit.verdict != ForceVerdict::kContradicts, fit.direction_deg.has_value(),
                      fit.gust_m_s.has_value(), fit.is_at_home);
  });
  return fits;
}

/// Hit::scale_doubts.
std::vector<std::string> scale_doubts_of(const std::vector<Fit>& fits, const ProbePlan& plan) {
  if (fits.empty() || !fits.front().speed_m_s || fits.front().verdict == ForceVerdict::kAgrees) return {};
  const auto profile_of = [&plan](const Fit& fit) -> const Profile& {
    return std::ranges::find(plan.profiles, fit.profile, &NamedModbusProfile::name)->profile;
  };
  std::vector<std::string> doubts = {fits.front().profile};
  for (const Fit& fit : std::span(fits).subspan(1)) {
    const bool is_possible = fit.speed_m_s && fit.verdict != ForceVerdict::kContradicts;
    if (is_possible && differ_in_scale(profile_of(fits.front()), profile_of(fit))) doubts.push_back(fit.profile);
  }
  if (doubts.size() == 1) doubts.clear();
  return doubts;
}

}  // namespace

bool is_live(const Fit& fit) {
  return std::max({fit.speed_m_s.value_or(0.0), fit.direction_deg.value_or(0.0), fit.gust_m_s.value_or(0.0)}) >=
         kMinLive;
}

Result<int, Failure> probe_modbus(const ProbePlan& plan, const ProbeProgress& progress, const ProbeFound& found,
                                  const bus::Interruption& interruption) {
  int hits = 0;
  const double all = static_cast<double>(plan.lines.size() * plan.ids.size());
  double done = 0.0;
  for (const bus::ModbusLine& settings : plan.lines) {
    ProbedLine line(settings, plan.response_timeout, interruption);
    if (const auto opened = line.open(); !opened) return opened.error();
    for (const std::uint8_t id : plan.ids) {
      if (interruption.is_set()) return hits;
      progress(settings, id, done++ / all);
      if (!replies_at_all(id, settings, plan, line)) continue;
      ++hits;
      auto fits = fits_of(id, settings, plan, line, interruption);
      auto doubts = scale_doubts_of(fits, plan);
      found({.line = settings, .id = id, .fits = std::move(fits), .scale_doubts = std::move(doubts)});
    }
    if (hits > 0 && !plan.tries_all_lines) break;
  }
  return hits;
}

std::vector<bus::ModbusLine> likely_modbus_lines(const std::string& device,
                                                 const std::vector<NamedModbusProfile>& profiles,
                                                 const std::vector<int>& bauds, const std::vector<char>& parities) {
  // The number of profiles with these settings from the factory.
  using Settings = std::pair<int, char>;
  std::map<Settings, int> counts;
  for (const int baud : {2400, 4800, 9600, 19200, 38400, 57600, 115200}) counts[{baud, 'N'}] = 0;
  for (const auto& named : profiles) ++counts[{named.profile.baud, named.profile.parity}];
  for (const int baud : bauds) {
    for (const char parity : parities.empty() ? std::vector<char>{'N'} : parities)
      counts.try_emplace({baud, parity}, 0);
  }
  for (const char parity : parities) {
    for (const auto baud : kModbusBauds) counts.try_emplace({static_cast<int>(baud), parity}, 0);
  }

  std::vector<std::pair<int, Settings>> order;
  for (const auto& [settings, count] : counts) {
    const bool is_wanted = (bauds.empty() || std::ranges::count(bauds, settings.first) != 0) &&
                           (parities.empty() || std::ranges::count(parities, settings.second) != 0);
    if (is_wanted) order.emplace_back(-count, settings);
  }
  std::ranges::sort(order);

  std::vector<bus::ModbusLine> lines;
  for (const auto& [count, settings] : order) {
    bus::ModbusLine line;
    line.framing = decode::modbus::Framing::kRtu;
    line.device = device;
    line.baud = settings.first;
    line.parity = settings.second;
    lines.push_back(line);
  }
  return lines;
}

std::vector<NamedModbusProfile> shipped_modbus_profiles(const std::string& directory) {
  std::vector<NamedModbusProfile> profiles;
  for (const std::string& name : modbus_profile_names(directory)) {
    profiles.push_back({name, load_modbus_profile(name, directory)});
  }
  return profiles;
}

std::string sensor_table_for(const std::string& name, const bus::ModbusLine& line, const Fit& fit,
                             const Profile& profile, const std::string& device) {
  std::string table =
      fmt::format("[[sensor]]\nname = \"{}\"\ndriver = \"modbus\"\nprofile = \"{}\"\n", name, fit.profile);
  if (line.framing == decode::modbus::Framing::kTcp) {
    table += fmt::format("transport = \"tcp\"\nhost = \"{}\"\nport = {}\n", line.host, line.port);
  } else {
    table += fmt::format("transport = \"rtu\"\ndevice = \"{}\"\n", device);
    if (line.baud != profile.baud) table += fmt::format("baud = {}\n", line.baud);
    if (line.parity != profile.parity) {
      table += fmt::format("parity = \"{}\"\n", line.parity == 'N' ? "none" : line.parity == 'E' ? "even" : "odd");
    }
  }
  // All other quantities of that slave follow it.
  if (fit.speed_slave != profile.speed.slave) table += fmt::format("speed_slave = {}\n", fit.speed_slave);
  return table;
}

}  // namespace yuragi::drivers::modbus
