#include "drivers/modbus/modbus_probe.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "drivers/modbus/modbus_plan.hpp"

namespace yuragi::drivers::modbus {
namespace {

using Registers = Result<decode::modbus::ModbusRegisters, decode::modbus::ModbusRefusal>;

/// How long a line must be quiet between two requests: shorter than in service, since most get no reply.
constexpr Nanoseconds kProbeQuiet = std::chrono::milliseconds(20);

/// Requests that nearly every device replies to: the first register of either kind.
constexpr std::array kKnocks = {decode::modbus::ModbusRequest{.function = 3, .address = 0, .count = 1},
                                decode::modbus::ModbusRequest{.function = 4, .address = 0, .count = 1}};

bool has_side_effects(const ModbusProfile& profile) {
  return profile.speed.read_has_side_effect || (profile.direction && profile.direction->read_has_side_effect) ||
         (profile.gust && profile.gust->read_has_side_effect);
}

bool has_one_slave(const ModbusProfile& profile) {
  return !profile.direction || profile.direction->slave == profile.speed.slave;
}

bool is_home_of(const bus::ModbusLine& line, const ModbusProfile& profile) {
  return line.framing == decode::modbus::ModbusFraming::kTcp ||
         (line.baud == profile.baud && line.parity == profile.parity && line.stop_bits == profile.stop_bits);
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

  /// The registers, or what was wrong with the reply; kTimeout where there was none.
  Registers cached_exchange(const decode::modbus::ModbusRequest& request) {
    const auto key = std::tuple(request.unit, request.function, request.address, request.count);
    if (const auto known = replies_.find(key); known != replies_.end()) return known->second;
    const Registers reply = exchange(request);
    replies_.emplace(key, reply);
    return reply;
  }

 private:
  Registers exchange(decode::modbus::ModbusRequest request) {
    constexpr decode::modbus::ModbusRefusal kSilence{decode::Refusal::kTimeout};
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
      const bus::BusMessage message = connection_->receive(buffer, interruption_);
      if (message.status == bus::BusStatus::kLost) connection_->close();
      if (message.status != bus::BusStatus::kMessage) return kSilence;
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

/// Does this reply come from a slave? A gateway's exception that none is there does not count.
bool is_sign_of_life(const Registers& reply) {
  return reply || (reply.error().why == decode::Refusal::kException &&
                   !decode::modbus::is_gateway_silence(reply.error().exception));
}

/// Enters the value of one reply into `fit`. False: it is not plausible. A mark for "no value" does, but not in place
/// of the speed.
bool take(const ModbusProfile& profile, const ModbusRead& read, const decode::modbus::ModbusRegisters& registers,
          ModbusFit& fit) {
  for (const ModbusMeasure measure : read.measures) {
    const decode::modbus::ModbusQuantity& quantity = quantity_of(profile, measure);
    const auto part = registers_of(quantity, read.request, registers);
    const auto value = measure == ModbusMeasure::kDirection ? decode::modbus::decode_direction_deg(quantity, part)
                                                            : decode::modbus::decode_speed_m_s(quantity, part);
    if (!value && (measure == ModbusMeasure::kSpeed || value.error() != decode::Refusal::kInvalid)) return false;
    if (!value) continue;
    if (measure == ModbusMeasure::kSpeed) fit.speed_m_s = *value;
    if (measure == ModbusMeasure::kDirection) fit.direction_deg = *value;
    if (measure == ModbusMeasure::kGust) fit.gust_m_s = *value;
  }
  return true;
}

/// The profile's values on that line, if all of its reads get replies with plausible values.
std::optional<ModbusFit> fit_of(const std::string& name, const ModbusProfile& profile,
                                const std::vector<ModbusRead>& reads, ProbedLine& line) {
  ModbusFit fit{.profile = name,
                .device = profile.name,
                .speed_m_s = {},
                .direction_deg = {},
                .gust_m_s = {},
                .speed_slave = profile.speed.slave,
                .direction_slave = {}};
  if (profile.direction) fit.direction_slave = profile.direction->slave;
  for (const ModbusRead& read : reads) {
    const Registers registers = line.cached_exchange(read.request);
    if (!registers || !take(profile, read, *registers, fit)) return std::nullopt;
  }
  return fit;
}

/// The reading of a pair's vane, if it had this id.
std::optional<ModbusFit> vane_fit_of(const NamedModbusProfile& named, std::uint8_t id, ProbedLine& line) {
  ModbusProfile profile = named.profile;
  profile.direction->slave = id;
  auto reads = plan_modbus_reads(profile, true);
  const auto is_direction = [](const ModbusRead& read) { return read.contains(ModbusMeasure::kDirection); };
  std::erase_if(reads, [&](const ModbusRead& read) { return !is_direction(read); });
  return fit_of(named.name, profile, reads, line);
}

/// Does a slave of this id reply? For devices that ignore requests for registers that they do not have, those of their
/// own profile are read, with its line settings.
bool replies_at_all(std::uint8_t id, const bus::ModbusLine& settings, const ModbusProbePlan& plan, ProbedLine& line) {
  for (decode::modbus::ModbusRequest knock : kKnocks) {
    knock.unit = id;
    if (is_sign_of_life(line.cached_exchange(knock))) return true;
  }
  return std::ranges::any_of(plan.profiles, [&](const NamedModbusProfile& named) {
    if (has_side_effects(named.profile) || !is_home_of(settings, named.profile)) return false;
    const auto reads = plan_modbus_reads(named.profile);
    return std::ranges::any_of(reads, [&](const ModbusRead& read) {
      return read.request.unit == id && is_sign_of_life(line.cached_exchange(read.request));
    });
  });
}

std::vector<ModbusFit> fits_of(std::uint8_t id, const bus::ModbusLine& settings, const ModbusProbePlan& plan,
                               ProbedLine& line, const bus::Interruption& interruption) {
  std::vector<ModbusFit> fits;
  for (const NamedModbusProfile& named : plan.profiles) {
    if (interruption.is_set() || has_side_effects(named.profile)) continue;
    // One of several slaves is searched for under the profile's ids.
    const bool is_pair = !has_one_slave(named.profile);
    if (is_pair && named.profile.speed.slave != id) continue;
    ModbusProfile profile = named.profile;
    if (!is_pair) set_slave(profile, id);
    auto fit = fit_of(named.name, profile, plan_modbus_reads(profile), line);
    if (!fit) continue;
    fit->is_at_home = named.profile.speed.slave == id && is_home_of(settings, named.profile);
    fits.push_back(*std::move(fit));
  }

  // No fit: it may be the vane of a pair whose cup is elsewhere.
  const bool may_be_vane = fits.empty();
  for (const NamedModbusProfile& named : plan.profiles) {
    if (!may_be_vane || has_side_effects(named.profile) || has_one_slave(named.profile)) continue;
    if (auto fit = vane_fit_of(named, id, line)) fits.push_back(*std::move(fit));
  }

  // The fits with the most quantities come first, and among them those with factory settings.
  std::ranges::stable_sort(fits, std::greater<>(), [](const ModbusFit& fit) {
    return std::tuple(fit.direction_deg.has_value(), fit.gust_m_s.has_value(), fit.is_at_home);
  });
  return fits;
}

}  // namespace

Result<int, Failure> probe_modbus(const ModbusProbePlan& plan, const ModbusProbeProgress& progress,
                                  const ModbusProbeFound& found, const bus::Interruption& interruption) {
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
      found({.line = settings, .id = id, .fits = fits_of(id, settings, plan, line, interruption)});
    }
    if (hits > 0 && !plan.tries_all_lines) break;
  }
  return hits;
}

std::vector<bus::ModbusLine> likely_modbus_lines(const std::string& device,
                                                 const std::vector<NamedModbusProfile>& profiles,
                                                 const std::vector<int>& bauds, const std::vector<char>& parities) {
  // How many profiles have these settings from the factory?
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
    line.framing = decode::modbus::ModbusFraming::kRtu;
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

std::string sensor_table_for(const bus::ModbusLine& line, const ModbusFit& fit, const ModbusProfile& profile,
                             const std::string& device) {
  std::string table = fmt::format("[[sensor]]\nname = \"wind\"\ndriver = \"modbus\"\nprofile = \"{}\"\n", fit.profile);
  if (line.framing == decode::modbus::ModbusFraming::kTcp) {
    table += fmt::format("transport = \"tcp\"\nhost = \"{}\"\nport = {}\n", line.host, line.port);
  } else {
    table += fmt::format("transport = \"rtu\"\ndevice = \"{}\"\n", device);
    if (line.baud != profile.baud) table += fmt::format("baud = {}\n", line.baud);
    if (line.parity != profile.parity) {
      table += fmt::format("parity = \"{}\"\n", line.parity == 'N' ? "none" : line.parity == 'E' ? "even" : "odd");
    }
  }
  // Whatever else is on the slave of the speed follows it.
  if (fit.speed_slave != profile.speed.slave) table += fmt::format("speed_slave = {}\n", fit.speed_slave);
  return table;
}

}  // namespace yuragi::drivers::modbus
