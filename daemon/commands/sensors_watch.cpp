// `yuragi sensors watch`: what the sensors say, from the running daemon, or from the devices where none runs.
#include <functional>
#include <memory>
#include <thread>

#include <fmt/core.h>
#include <unistd.h>

#include "daemon/commands/run_options.hpp"
#include "daemon/commands/sensors.hpp"
#include "daemon/exit.hpp"
#include "daemon/sensor_hub.hpp"
#include "daemon/sensor_table.hpp"
#include "daemon/system_clock.hpp"
#include "daemon/transports/stream_client.hpp"

namespace yuragi {
namespace {

constexpr auto kConnectTimeout = std::chrono::seconds(2);
constexpr auto kSilenceTimeout = std::chrono::seconds(5);
constexpr auto kTableInterval = std::chrono::milliseconds(500);
constexpr double kWindStep_s = 0.02;

struct WatchOptions {
  RunOptions run;
  bool once = false;
};

/// Shows table after table: in place on a terminal, one below the other elsewhere. False when enough was shown.
class Screen {
 public:
  explicit Screen(const WatchOptions& options) : options_(options), begun_(clock_.now().mono) {}

  bool show(const wire::Sensors& sensors, std::string_view source) {
    constexpr const char* kHomeAndClear = "\x1b[H\x1b[J";
    const bool in_place = isatty(STDOUT_FILENO) != 0 && !options_.once;
    fmt::print("{}{}\n{}{}", in_place ? kHomeAndClear : "", source, sensor_table(sensors),
               in_place ? "\nCtrl-C ends this; the daemon goes on.\n" : "\n");
    std::fflush(stdout);
    return !options_.once && !is_over();
  }

  bool is_over() const {
    return options_.run.duration_s && seconds(clock_.now().mono - begun_) >= *options_.run.duration_s;
  }

 private:
  const WatchOptions& options_;
  SystemClock clock_;
  MonoTime begun_;
};

void watch_daemon(StreamClient client, const std::string& address, Screen& screen) {
  const std::string source = "daemon at " + address;
  client.subscribe({.poses = false, .sensors = true, .client = "sensors watch"});
  while (true) {
    const auto message = client.receive(kSilenceTimeout);
    if (!message) {
      throw ExitError(kExitUnavailable,
                      fmt::format("the daemon at {} has gone ({})", address, name_of(message.error())));
    }
    if (const auto* hello = std::get_if<wire::Hello>(&*message); hello != nullptr && hello->refused) {
      throw ExitError(kExitUnavailable, fmt::format("the daemon at {} lets nobody in: {}", address, *hello->refused));
    }
    const auto* sensors = std::get_if<wire::Sensors>(&*message);
    if (sensors != nullptr && !screen.show(*sensors, source)) return;
  }
}

void watch_devices(const Config& config, const std::string& why, Screen& screen) {
  const SystemClock clock;
  SensorHub hub(config, clock);
  const std::string source = "no daemon (" + why + "): the devices themselves";
  MonoTime next_table = clock.now().mono + kTableInterval;
  while (!screen.is_over()) {
    const WindState& wind = hub.advance();
    if (clock.now().mono >= next_table) {
      next_table += kTableInterval;
      wire::Sensors sensors;
      sensors.sensors = hub.status();
      sensors.wind = wind;
      if (!screen.show(sensors, source)) return;
    }
    std::this_thread::sleep_for(from_seconds(kWindStep_s));
  }
}

void watch(const WatchOptions& options) {
  const Config config = options.run.config();
  const std::string& address = config.stream.text("listen");
  Screen screen(options);
  auto client = StreamClient::connect(address, kConnectTimeout);
  if (client) {
    watch_daemon(std::move(*client), address, screen);
  } else {
    watch_devices(config, client.error().message, screen);
  }
}

}  // namespace

void add_sensors_watch(CLI::App& sensors) {
  CLI::App* command = sensors.add_subcommand("watch", "a live table of what the sensors say");
  command->footer(
      "Asks the running daemon over its stream, so that nothing is opened twice; where no daemon runs, it opens the\n"
      "configured sensors itself. Away from a terminal it prints table after table.");
  auto options = std::make_shared<WatchOptions>();
  options->run.add_to(*command);
  command->add_flag("--once", options->once, "print one table and end");
  command->callback([options] { watch(*options); });
}

}  // namespace yuragi
