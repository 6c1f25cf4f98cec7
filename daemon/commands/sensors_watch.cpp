// `yuragi sensors watch`: shows the sensors of the running daemon, or the devices themselves if none runs.
#include <algorithm>
#include <functional>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/commands/sensors.hpp"
#include "daemon/sensing/sensor_hub.hpp"
#include "daemon/sensing/system_clock.hpp"
#include "daemon/service/daemon_log.hpp"
#include "daemon/settings/own_token.hpp"
#include "daemon/settings/standard_output.hpp"
#include "daemon/shaping/wind_shaper.hpp"
#include "daemon/state/sensor_json.hpp"
#include "daemon/stream/stream_client.hpp"
#include "daemon/tools/decode/raw_text.hpp"
#include "daemon/tools/sensors/sensor_table.hpp"

namespace yuragi::daemon::commands {
namespace {

constexpr auto kConnectTimeout = std::chrono::seconds(2);
constexpr auto kSilenceTimeout = std::chrono::seconds(5);
constexpr auto kTableInterval = std::chrono::milliseconds(500);
constexpr double kWindStep_s = 0.02;

struct WatchOptions {
  RunOptions run;
  bool once = false;
  bool raw = false;
  bool hex = false;
  bool as_json = false;
  std::string sensor;  ///< of raw messages; empty: all
};

/// The end of watching, if it is limited.
class Deadline {
 public:
  explicit Deadline(const std::optional<double>& duration_s) : duration_s_(duration_s), begun_(clock_.now().mono) {}

  bool is_over() const { return duration_s_ && seconds(clock_.now().mono - begun_) >= *duration_s_; }

 private:
  sensing::SystemClock clock_;
  std::optional<double> duration_s_;
  MonoTime begun_;
};

/// A view of the messages of either source. Each function returns false when enough has been shown.
class Screen {
 public:
  virtual ~Screen() = default;
  virtual wire::Subscribe subscription() const = 0;
  /// Called with the sensors at once, and then about twice a second; `source` names their origin.
  virtual bool show_sensors(const wire::Sensors& sensors, const std::string& source) = 0;
  virtual bool show_message(const wire::RawTrace& /*trace*/) { return true; }
};

/// Shows tables: in place on a terminal, one below the other elsewhere.
class TableScreen final : public Screen {
 public:
  TableScreen(bool once, bool as_json) : once_(once), as_json_(as_json) {}

  wire::Subscribe subscription() const override { return {.poses = false, .sensors = true, .client = "sensors watch"}; }

  bool show_sensors(const wire::Sensors& sensors, const std::string& source) override {
    if (as_json_) {
      print_json_line(state::sensors_json(sensors));
      return !once_;
    }
    constexpr const char* kHomeAndClear = "\x1b[H\x1b[J";
    const bool in_place = isatty(STDOUT_FILENO) != 0 && !once_;
    settings::write_at_once(fmt::format("{}{}\n{}{}", in_place ? kHomeAndClear : "", source,
                                        tools::sensors::sensor_table(sensors),
                                        in_place ? "\n"
                                                   "Ctrl-C ends this display; the daemon keeps running.\n"
                                                 : "\n"));
    return !once_;
  }

 private:
  bool once_;
  bool as_json_;
};

/// Shows the messages to and from the devices, one below the other.
class RawScreen final : public Screen {
 public:
  explicit RawScreen(const WatchOptions& options) : options_(options) {}

  wire::Subscribe subscription() const override {
    return {
        .poses = false, .sensors = true, .client = "sensors watch --raw", .raw = true, .raw_sensor = options_.sensor};
  }

  /// Prints their origin once, and whether there is such a sensor.
  bool show_sensors(const wire::Sensors& sensors, const std::string& source) override {
    if (std::exchange(is_begun_, true)) return true;
    std::string known;
    bool is_known = options_.sensor.empty();
    for (const wire::SensorStatus& sensor : sensors.sensors) {
      known += fmt::format("{}{}", known.empty() ? "" : ", ", sensor.name);
      is_known = is_known || sensor.name == options_.sensor;
    }
    if (!is_known) {
      throw ExitError(kExitUsage, fmt::format("there is no sensor \"{}\"; there are: {}", options_.sensor, known));
    }
    fmt::print(stderr, "{}; times are UTC; <- from the device, -> to it\n", source);
    return true;
  }

  bool show_message(const wire::RawTrace& trace) override {
    if (options_.as_json) {
      print_json_line(state::raw_trace_json(trace));
      return !options_.once;
    }
    const std::string text = options_.hex ? hex_lines_.line_of(trace) : tools::decode::raw_text(trace);
    settings::write_at_once(text);
    return !options_.once || text.empty();
  }

 private:
  const WatchOptions& options_;
  tools::decode::RawHexLines hex_lines_;
  bool is_begun_ = false;
};

void watch_daemon(stream::Client client, const std::string& address, const Deadline& deadline, Screen& screen) {
  const std::string source = "daemon at " + address;
  wire::Subscribe subscription = screen.subscription();
  subscription.token = settings::own_token(address).token;
  client.subscribe(subscription);
  while (!deadline.is_over()) {
    const auto message = client.receive(kSilenceTimeout);
    if (!message) throw FailureError(stream::connection_lost(address, message.error()));
    if (const auto refusal = stream::refusal_in(*message, address)) throw FailureError(*refusal);
    const auto* sensors = std::get_if<wire::Sensors>(&*message);
    if (sensors != nullptr && !screen.show_sensors(*sensors, source)) return;
    const auto* trace = std::get_if<wire::RawTrace>(&*message);
    if (trace != nullptr && !screen.show_message(*trace)) return;
  }
}

void watch_devices(const settings::Config& config, const std::string& why, const Deadline& deadline, Screen& screen) {
  const sensing::SystemClock clock;
  const std::shared_ptr<const wind::turbulence::GustNoise> gusts = sensing::make_gust_noise(config);
  sensing::SensorHub hub(config, clock, gusts);
  shaping::WindShaper shaper(config, gusts);
  const wire::Subscribe subscription = screen.subscription();
  hub.trace([&](std::string_view sensor) {
    return subscription.raw && (subscription.raw_sensor.empty() || subscription.raw_sensor == sensor);
  });
  const std::string source = "no daemon is running (" + why + "): reading the devices directly";

  // The first table is delayed so that it shows readings; raw messages are not.
  MonoTime next_status = clock.now().mono + (subscription.raw ? Nanoseconds::zero() : kTableInterval);
  while (!deadline.is_over()) {
    wire::Sensors sensors;
    sensors.wind = hub.advance();
    wind::ground::DrivingWind wind{sensors.wind, hub.ground(), hub.stroke()};
    shaper.shape(wind, clock.now().utc, hub.is_any_live());
    if (clock.now().mono >= next_status) {
      next_status += kTableInterval;
      sensors.sensors = hub.status();
      sensors.shaping = shaper.status();
      if (!screen.show_sensors(sensors, source)) return;
    }
    bool is_enough = false;
    hub.drain_traces([&](const wire::RawTrace& trace) { is_enough = is_enough || !screen.show_message(trace); });
    if (is_enough) return;
    std::this_thread::sleep_for(from_seconds(kWindStep_s));
  }
}

void watch(const WatchOptions& options) {
  if (options.hex && options.as_json) throw ExitError(kExitUsage, "--hex and --json exclude each other");
  if (!options.raw && (options.hex || !options.sensor.empty())) {
    throw ExitError(kExitUsage, "a SENSOR and --hex are for raw messages: add --raw");
  }
  const service::DaemonLog log(options.run.verbose);
  if (!options.run.verbose) spdlog::set_level(spdlog::level::warn);  // the table shows the rest
  const settings::Config config = options.run.config();
  const std::string& address = config.stream.listen;
  std::unique_ptr<Screen> screen;
  if (options.raw) {
    screen = std::make_unique<RawScreen>(options);
  } else {
    screen = std::make_unique<TableScreen>(options.once, options.as_json);
  }
  const Deadline deadline(options.run.duration_s);
  auto client = stream::Client::connect(address, kConnectTimeout);
  if (client) {
    watch_daemon(std::move(*client), address, deadline, *screen);
  } else {
    watch_devices(config, client.error().message, deadline, *screen);
  }
}

}  // namespace

void add_sensors_watch(CLI::App& sensors) {
  CLI::App* command = sensors.add_subcommand("watch", "show a live table of the sensors, or their raw messages");
  command->footer(
      "Asks the running daemon over its stream, so that no device is opened twice; without a daemon it opens the\n"
      "configured sensors itself. If the output is not a terminal, tables are printed one after another.\n"
      "Columns: m/s, gust and from (degrees) as measured; age of the last reading; interval between readings; frames\n"
      "(messages from the device), readings among them, and how often the device was reconnected.\n"
      "States: live, simulated and REPLAY sensors contribute to the wind. Those that are connecting, STALE (silent),\n"
      "DISCONNECTED, FROZEN (constant readings), SEIZED (no wind measured while wind blows) or IMPLAUSIBLE do not;\n"
      "the reason and what to do are shown below the table.\n"
      "The wind is that at the sensors: at the windward edge of the scenes, unless [sensor.blend] gives a place. Its\n"
      "distance from the middle of the scenes, the time that a gust takes to it, and the effects of [shaping] are\n"
      "shown, too. With sensors at several places the reach of gusts follows after some hours, as a multiple of "
      "usual.\n"
      "Since the daemon's start: clients refused (no place), stuck (they stopped reading) and idle (they requested\n"
      "nothing), and the lateness of its I/O thread and of the animation's ticks: median, 99th percentile, maximum.\n"
      "Raw messages need [stream] control. Clients of other machines get the names of files without folders.\n"
      "--json: an object a line: wind (speed_m_s, direction_deg, source, ...), sensors (a list: name, driver, state,\n"
      "state_reason, value (what its speed is), reads_times_group (1: not levelled), speed_m_s, direction_deg,\n"
      "gust_m_s, age_s, interval_s, frames, readings, reconnects, refused, ...), shaping, by_hand (wind, blackout and\n"
      "camera, null: not set), cameras, camera, recorder (null: nothing is recorded), clients, gust_reach (across,\n"
      "along), late_ticks, recent_ticks, recent_skipped_ticks, io_lateness and tick_lateness (p50_s, p99_s, max_s),\n"
      "animation (running_s, period_s, tick_s, carried_times, scenes; null:\n"
      "none). With --raw: sensor, utc_ns, mono_ns, is_received, hex, length_bytes, lost. Unknown values are null.\n"
      "  yuragi sensors watch --raw roof                            every message to and from its device\n"
      "  yuragi sensors watch --raw roof --hex | tee roof.hex       for `yuragi decode FORMAT --hex`");
  auto options = std::make_shared<WatchOptions>();
  options->run.add_to_client(*command);
  command->add_flag("--once", options->once, "print one table, or one message, and end");
  command->add_flag("--raw", options->raw, "show the messages to and from the devices");
  add_json(*command, options->as_json);
  command->add_option("sensor", options->sensor, "with --raw: of this sensor only")->option_text("[SENSOR]");
  command->add_flag("--hex", options->hex,
                    "with --raw: hexadecimal digits only, one message per line, for `yuragi decode --hex`");
  command->callback([options] { watch(*options); });
}

}  // namespace yuragi::daemon::commands
