// `yuragi sensors probe modbus`: finds the Modbus devices on a line, and prints their configuration.
#include <algorithm>
#include <atomic>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <memory>
#include <set>

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/commands/sensors.hpp"
#include "daemon/state/json_value.hpp"
#include "drivers/bus/serial_ports.hpp"
#include "drivers/modbus/modbus_probe.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr int kMaxModbusId = 247;

struct ProbeOptions {
  std::string where;
  std::vector<int> bauds;
  std::vector<std::string> parities;
  std::string ids;
  double timeout_s = 0.2;
  bool tries_all = false;
  std::string profile_dir;
  bool as_json = false;
};

/// While it lives, Ctrl-C sets an interruption instead of ending the program.
class WakeOnInterrupt {
 public:
  WakeOnInterrupt() {
    target_ = &interruption_;
    before_ = std::signal(SIGINT, [](int) {
      if (drivers::bus::Interruption* const interruption = target_.load())
        interruption->set();  // a write(), which a signal handler may do
    });
  }
  ~WakeOnInterrupt() {
    std::signal(SIGINT, before_);
    target_ = nullptr;
  }
  WakeOnInterrupt(const WakeOnInterrupt&) = delete;
  WakeOnInterrupt& operator=(const WakeOnInterrupt&) = delete;

  const drivers::bus::Interruption& interruption() const { return interruption_; }

 private:
  static inline std::atomic<drivers::bus::Interruption*> target_ = nullptr;
  drivers::bus::Interruption interruption_;
  void (*before_)(int) = nullptr;
};

[[noreturn]] void refuse_ids(const std::string& text) {
  throw ExitError(kExitUsage,
                  "--id: \"" + text + "\" is not an id; allowed: ids from 1 to 247, such as 3, 1-10 or 1,2,17");
}

/// "1-10,17" as numbers.
std::vector<std::uint8_t> ids_of(const std::string& text) {
  const auto number = [&text](std::string_view digits) {
    int value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool is_id = error == std::errc{} && end == digits.data() + digits.size() && value >= 1;
    if (!is_id || value > kMaxModbusId) refuse_ids(text);
    return value;
  };
  std::vector<std::uint8_t> ids;
  for (const std::string& part : CLI::detail::split(text, ',')) {
    const std::size_t dash = part.find('-');
    const int first = number(std::string_view(part).substr(0, dash));
    const int last = dash == std::string::npos ? first : number(std::string_view(part).substr(dash + 1));
    for (int id = first; id <= last; ++id) ids.push_back(static_cast<std::uint8_t>(id));
  }
  if (ids.empty()) refuse_ids(text);
  return ids;
}

/// The default, if none are given: those that people choose, and those that devices have from the factory.
std::vector<std::uint8_t> usual_ids(const std::vector<drivers::modbus::NamedModbusProfile>& profiles) {
  std::vector<std::uint8_t> ids = ids_of("1-16");
  for (const drivers::modbus::NamedModbusProfile& named : profiles) {
    if (std::ranges::count(ids, named.profile.speed.slave) == 0) ids.push_back(named.profile.speed.slave);
  }
  return ids;
}

/// "9600 8N1", or nothing over TCP.
std::string settings_of(const drivers::bus::ModbusLine& line) {
  if (line.framing == drivers::decode::modbus::Framing::kTcp) return "";
  return fmt::format(", {} 8{}{}", line.baud, line.parity, line.stop_bits);
}

/// HOST:PORT, or nullopt if it is not an address.
std::optional<drivers::bus::ModbusLine> tcp_line_of(const std::string& where) {
  const std::size_t colon = where.rfind(':');
  if (where.starts_with('/') || colon == std::string::npos || colon == 0) return std::nullopt;
  drivers::bus::ModbusLine line;
  line.host = where.substr(0, colon);
  if (line.host.starts_with('[') && line.host.ends_with(']')) line.host = line.host.substr(1, line.host.size() - 2);
  const std::string_view digits = std::string_view(where).substr(colon + 1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), line.port);
  if (error != std::errc{} || end != digits.data() + digits.size() || line.port == 0) return std::nullopt;
  return line;
}

/// The persistent name of a serial port, if the system has one.
std::string stable_name(const std::string& device) {
  std::error_code ignored;
  for (const drivers::bus::SerialPortInfo& port : drivers::bus::find_serial_ports()) {
    if (std::filesystem::equivalent(port.node, device, ignored)) return port.name;
  }
  return device;
}

drivers::modbus::ProbePlan plan_of(const ProbeOptions& options) {
  drivers::modbus::ProbePlan plan;
  plan.profiles = drivers::modbus::shipped_modbus_profiles(options.profile_dir);
  plan.ids = options.ids.empty() ? usual_ids(plan.profiles) : ids_of(options.ids);
  plan.response_timeout = from_seconds(options.timeout_s);
  plan.tries_all_lines = options.tries_all;
  if (const auto line = tcp_line_of(options.where)) {
    plan.lines = {*line};
    return plan;
  }
  std::vector<char> parities;
  for (const std::string& parity : options.parities) {
    parities.push_back(parity == "none" ? 'N' : parity == "even" ? 'E' : 'O');
  }
  plan.lines = drivers::modbus::likely_modbus_lines(options.where, plan.profiles, options.bauds, parities);
  return plan;
}

void show_progress(const drivers::bus::ModbusLine& line, std::uint8_t id, double done) {
  // Overwritten in place on a terminal; elsewhere a line for each setting of the port.
  static std::string last;
  const std::string trying = fmt::format("trying {}{}", describe(line), settings_of(line));
  if (isatty(STDERR_FILENO) != 0) {
    fmt::print(stderr, "\r\x1b[K{:3.0f} %  {}, id {}", 100.0 * done, trying, id);
  } else if (trying != last) {
    fmt::print(stderr, "{:3.0f} %  {}\n", 100.0 * done, trying);
  }
  last = trying;
  std::fflush(stderr);
}

void end_progress() {
  if (isatty(STDERR_FILENO) != 0) fmt::print(stderr, "\r\x1b[K");
}

/// Prints a fit as a comment of a TOML file.
void show_fit(const drivers::modbus::Hit& hit, const drivers::modbus::Fit& fit) {
  if (!fit.speed_m_s) {
    fmt::print("#   may be the vane of {} ({:.0f} degrees): in its table, set direction_slave = {}\n", fit.profile,
               fit.direction_deg.value_or(0.0), hit.id);
    return;
  }
  fmt::print("#   fits {} ({}): {:.1f} m/s", fit.profile, fit.device, *fit.speed_m_s);
  if (fit.direction_deg) fmt::print(" from {:.0f} degrees", *fit.direction_deg);
  if (fit.gust_m_s) fmt::print(", gust {:.1f} m/s", *fit.gust_m_s);
  if (fit.verdict != drivers::modbus::ForceVerdict::kNone) {
    fmt::print("; its own wind force, {:.0f} Beaufort, {}", *fit.beaufort,
               fit.verdict == drivers::modbus::ForceVerdict::kAgrees ? "agrees" : "CONTRADICTS that: not this one");
  }
  if (!is_live(fit)) fmt::print("; all of it is 0");
  if (fit.direction_slave && !fit.direction_deg) {
    fmt::print("; no direction from slave {}: set direction_slave, if its vane has another id", *fit.direction_slave);
  }
  fmt::print("{}\n", fit.is_at_home ? "" : " (its settings are not the factory settings)");
}

/// A name that no other sensor of this probe has: by the slave's id, which several lines can have.
std::string unused_name(int id, std::set<std::string>& used) {
  std::string name = fmt::format("wind-{}", id);
  for (int again = 2; !used.insert(name).second; ++again) name = fmt::format("wind-{}-{}", id, again);
  return name;
}

/// Prints a device as a part of a configuration: its [[sensor]] table by the best fit, and everything else as comments.
void show_hit(const drivers::modbus::Hit& hit, const drivers::modbus::ProbePlan& plan,
              std::set<std::string>& used_names) {
  end_progress();
  fmt::print("# slave {} at {}{}\n", hit.id, describe(hit.line), settings_of(hit.line));
  if (hit.fits.empty()) {
    fmt::print("#   no profile fits; drivers/modbus/profiles/README.md describes how to write one\n");
  }
  for (const drivers::modbus::Fit& fit : hit.fits) show_fit(hit, fit);
  if (hit.fits.size() > 1) {
    fmt::print("#   Several devices have these registers: choose the one with the name of your device.\n");
  }
  if (!hit.scale_doubts.empty()) {
    fmt::print(
        "#   The scale is not certain: {} read the same register with different scales.\n"
        "#   Choose the one whose speed is the wind that you feel, or probe again when it blows.\n",
        fmt::join(hit.scale_doubts, " and "));
  }
  const auto best =
      std::ranges::find_if(hit.fits, [](const drivers::modbus::Fit& fit) { return fit.speed_m_s.has_value(); });
  if (best != hit.fits.end()) {
    const auto named = std::ranges::find(plan.profiles, best->profile, &drivers::modbus::NamedModbusProfile::name);
    fmt::print("{}", drivers::modbus::sensor_table_for(unused_name(hit.id, used_names), hit.line, *best, named->profile,
                                                       stable_name(hit.line.device)));
    for (auto other = best + 1; other != hit.fits.end(); ++other) {
      if (other->speed_m_s) fmt::print("# profile = \"{}\"\n", other->profile);
    }
  }
  fmt::print("\n");
  std::fflush(stdout);
}

/// On a line of its own as soon as it is found.
void show_hit_as_json(const drivers::modbus::Hit& hit) {
  const bool is_tcp = hit.line.framing == drivers::decode::modbus::Framing::kTcp;
  nlohmann::ordered_json fits = nlohmann::ordered_json::array();
  for (const drivers::modbus::Fit& fit : hit.fits) {
    nlohmann::ordered_json agrees = nullptr;
    if (fit.verdict != drivers::modbus::ForceVerdict::kNone)
      agrees = fit.verdict == drivers::modbus::ForceVerdict::kAgrees;
    fits.push_back({{"profile", fit.profile},
                    {"device", fit.device},
                    {"speed_m_s", state::json_or_null(fit.speed_m_s)},
                    {"direction_deg", state::json_or_null(fit.direction_deg)},
                    {"gust_m_s", state::json_or_null(fit.gust_m_s)},
                    {"beaufort", state::json_or_null(fit.beaufort)},
                    {"agrees_with_beaufort", agrees},
                    {"is_live", is_live(fit)},
                    {"has_factory_settings", fit.is_at_home}});
  }
  nlohmann::ordered_json json = {{"line", describe(hit.line)},
                                 {"baud", nullptr},
                                 {"parity", nullptr},
                                 {"stop_bits", nullptr},
                                 {"slave", hit.id},
                                 {"fits", fits},
                                 {"scale_doubts", hit.scale_doubts}};
  if (!is_tcp) {
    json["baud"] = hit.line.baud;
    json["parity"] = std::string(1, hit.line.parity);
    json["stop_bits"] = hit.line.stop_bits;
  }
  end_progress();
  print_json_line(json);
}

void probe(const ProbeOptions& options) {
  const drivers::modbus::ProbePlan plan = plan_of(options);
  if (plan.lines.empty()) throw ExitError(kExitUsage, "--baud and --parity leave nothing to try");
  const WakeOnInterrupt interrupt;
  std::set<std::string> used_names;
  const auto hits = drivers::modbus::probe_modbus(
      plan, show_progress,
      [&](const drivers::modbus::Hit& hit) {
        options.as_json ? show_hit_as_json(hit) : show_hit(hit, plan, used_names);
      },
      interrupt.interruption());
  end_progress();
  if (interrupt.interruption().is_set()) fmt::print(stderr, "interrupted\n");
  if (!hits) throw ExitError(kExitUnavailable, hits.error().message);
  if (*hits > 0) return;
  throw ExitError(kExitUnavailable,
                  fmt::format("no device replies at {}: check power, wiring (swap A and B) and termination, or try "
                              "more: --id 1-247, --timeout 1, --parity even, --baud 1200",
                              options.where));
}

}  // namespace

void add_sensors_probe(CLI::App& sensors) {
  CLI::App* probe_command = sensors.add_subcommand("probe", "find the devices on a line");
  probe_command->require_subcommand(1);
  CLI::App* command = probe_command->add_subcommand("modbus", "which Modbus devices reply, and which profile fits");
  command->footer(
      "Tries line settings and slave ids, likely ones first, and prints each device that replies as a [[sensor]] "
      "table\n"
      "with the profile that fits best; everything else is a comment, so that all of it can be pasted into one\n"
      "configuration. It only reads, and only registers that reading does not change. A running daemon "
      "uses\n"
      "the serial port exclusively: stop it first.\n"
      "  yuragi sensors probe modbus /dev/ttyUSB0\n"
      "  yuragi sensors probe modbus 192.168.1.20:502 --id 1-10\n"
      "Where profiles read the same register with different scales, all of them are shown, and the device's own wind "
      "force, where\n"
      "it has one, shows which is right. Those that read only zeros come last.\n"
      "--json: an object a line for each device: line, baud, parity, stop_bits (null over TCP), slave, fits, "
      "scale_doubts (the\n"
      "profiles between which it cannot decide); of each fit profile, device, speed_m_s, direction_deg, gust_m_s, "
      "beaufort, "
      "agrees_with_beaufort\n"
      "(null if it has none), is_live (not all of it is 0), has_factory_settings.");
  auto options = std::make_shared<ProbeOptions>();
  command->add_option("where", options->where, "serial port, or HOST:PORT of a device or gateway")
      ->required()
      ->type_name("PORT|HOST:PORT");
  command->add_option("--baud", options->bauds, "serial: only these")
      ->check(CLI::IsMember({1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200}))
      ->delimiter(',');
  command->add_option("--parity", options->parities, "serial: only these")
      ->check(CLI::IsMember({"none", "even", "odd"}))
      ->delimiter(',');
  command->add_option("--id", options->ids, "slaves to ask: 3, 1-10, 1,2,17; default: 1-16, and the profiles' own ids");
  command->add_option("--timeout", options->timeout_s, "maximum wait for a reply, s")
      ->check(CLI::Range(0.02, 10.0))
      ->capture_default_str();
  command->add_flag("--all", options->tries_all, "serial: try further settings even after a device has replied");
  command->add_option("--profile-dir", options->profile_dir, "a directory to look for profiles in first")
      ->type_name("FOLDER");
  add_json(*command, options->as_json);
  command->callback([options] { probe(*options); });
}

}  // namespace yuragi::daemon::commands
