#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "simulators/commands.hpp"
#include "simulators/modbus_simulator.hpp"

namespace yuragi::sim {
namespace {

struct Options {
  std::string tcp = "127.0.0.1:1502";
  std::string profile = "renke-rs-fsjt-rs-fxjt-n01";
  std::string wind = "synthetic";
  SyntheticWindSettings synthetic;
  std::vector<std::string> faults;
  RunOptions run;
};

struct Address {
  std::string host;
  std::uint16_t port = 0;
};

/// "HOST:PORT", where an IPv6 address may stand in brackets.
Address parse_address(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos && colon > 0) {
    std::string host = text.substr(0, colon);
    if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
    const std::string digits = text.substr(colon + 1);
    const bool is_number =
        !digits.empty() && digits.size() <= 5 && digits.find_first_not_of("0123456789") == std::string::npos;
    if (const unsigned long port = is_number ? std::stoul(digits) : 65536; port <= 65535) {
      return {host, static_cast<std::uint16_t>(port)};
    }
  }
  throw CLI::ValidationError(
      "--tcp", "\"" + text + "\" is no address; allowed: HOST:PORT, with a port from 0 (a free one) to 65535");
}

void simulate(const Options& options) {
  Faults faults;
  for (const std::string& text : options.faults) {
    const auto fault = parse_fault(text);
    if (!fault) throw CLI::ValidationError("--fault", fault.error().message);
    faults.add(*fault);
  }

  const Address address = parse_address(options.tcp);
  auto wind = options.wind == "synthetic" ? play_synthetic_wind(options.synthetic) : play_recorded_wind(options.wind);
  ModbusSimulator simulator(options.profile, address.host, address.port, options.synthetic.seed, std::move(wind));

  // Scripts wait for this line.
  std::printf("listening on %s:%u\n", address.host.c_str(), static_cast<unsigned>(simulator.port()));
  std::fflush(stdout);
  run(simulator, std::move(faults), options.run);
}

}  // namespace

void add_modbus_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("modbus", "Modbus TCP server with the registers of real wind sensors");
  command->add_option("--tcp", options->tcp, "HOST:PORT to listen on; port 0 takes a free one")->capture_default_str();
  command->add_option("--profile", options->profile, "device: one of the simulator's own")
      ->check(CLI::IsMember(modbus_device_names()))
      ->capture_default_str();
  command->add_option("--wind", options->wind, "synthetic, or a recording FILE.windlog, played again and again")
      ->capture_default_str();
  command->add_option("--speed", options->synthetic.mean_speed_m_s, "mean of the synthetic wind, m/s")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  command->add_option("--direction", options->synthetic.mean_direction_deg, "where it comes from, degrees")
      ->check(CLI::Range(0.0, 360.0))
      ->capture_default_str();
  command->add_option("--turbulence", options->synthetic.turbulence_intensity, "its standard deviation over its mean")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--seed", options->synthetic.seed, "the same seed gives the same wind")->capture_default_str();
  command->add_option("--fault", options->faults,
                      "KIND@START+DURATION in seconds, such as silence@10+5; can be given again. The same by standard "
                      "input, live: KIND [SECONDS], clear, help");
  command->add_option("--duration", options->run.duration_s, "end after so many seconds")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--verbose", options->run.verbose, "a status line a second even where nobody watches");
  command->callback([options] { simulate(*options); });
}

}  // namespace yuragi::sim
