#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/json_output.hpp"
#include "daemon/tools/plot/plot.hpp"
#include "daemon/tools/plot/plot_script.hpp"
#include "engine/wind/turbulence/wind_spectrum.hpp"

namespace yuragi::daemon::commands {

extern const Command kSpectrumCommand;

namespace {

constexpr const char* kSpectrumFooter =
    "Prints one line \"f S\" for each frequency: S(f), one-sided, in m^2/s^2/Hz, so that its integral over f is the\n"
    "variance of that component. Lines that begin with # are comments.\n"
    "\n"
    "  simiu, kaimal  n = f z / U, scaled by u*^2: Simiu and Scanlan 1996, Kaimal et al. 1972\n"
    "  davenport      x = 1200 f / U, component u only; U is the speed at 10 m for every --height\n"
    "  von-karman     scaled by sigma^2; x = f L_u / U for u, half of it for v and w\n"
    "  iec-kaimal     scaled by sigma^2; L_u = 8.1 Lambda, those of v and w a third and a twelfth of it\n"
    "\n"
    "--sigma is the standard deviation of the requested component. Without --sigma and --ustar, u* follows "
    "from\n"
    "the logarithmic profile over open country (roughness 0.03 m), and sigma from IEC 61400-1's normal turbulence, "
    "class\n"
    "B. Without --length, L_u is 8.1 Lambda (Lambda is 0.7 z below 60 m, 42 m above).\n"
    "\n"
    "--json: model, component, speed_m_s, height_m, variance_m2_s2, and the lists frequency_hz and density_m2_s2_hz.\n"
    "\n"
    "Example: yuragi spectrum --model kaimal --speed 8 --height 10 --frequency 0.01,0.1,1 --plot kaimal.svg";

struct SpectrumOptions {
  std::string model = "von-karman";
  std::string component = "u";
  wind::turbulence::SpectrumSettings settings;
  std::vector<double> frequencies_hz;
  std::string plot;
  bool as_json = false;
};

template <class Enum, std::size_t N>
Enum named(const std::array<std::string_view, N>& names, const std::string& name) {
  return static_cast<Enum>(std::ranges::find(names, name) - names.begin());
}

template <std::size_t N>
std::vector<std::string> words(const std::array<std::string_view, N>& names) {
  return {names.begin(), names.end()};
}

void draw_spectrum(const SpectrumOptions& options, const wind::turbulence::WindSpectrum& spectrum) {
  tools::plot::Curve curve{
      .title = options.model + " " + options.component, .style = tools::plot::Style::kLine, .x = {}, .y = {}};
  tools::plot::Curve asked{.title = "asked for", .style = tools::plot::Style::kPoints, .x = {}, .y = {}};
  double from_hz = 1e-3;
  double to_hz = 10.0;
  for (const double f : options.frequencies_hz) {
    if (f <= 0.0) continue;
    from_hz = std::min(from_hz, f);
    to_hz = std::max(to_hz, f);
    asked.x.push_back(f);
    asked.y.push_back(f * spectrum.density_m2_s2_hz(f));
  }
  constexpr int kPoints = 400;
  for (int k = 0; k <= kPoints; ++k) {
    const double f = from_hz * std::pow(to_hz / from_hz, static_cast<double>(k) / kPoints);
    curve.x.push_back(f);
    curve.y.push_back(f * spectrum.density_m2_s2_hz(f));
  }
  const tools::plot::Panel panel{.title = fmt::format("{} spectrum of {}, {:g} m/s at {:g} m: variance {:.3g} m^2/s^2",
                                                      options.model, options.component, options.settings.speed_m_s,
                                                      options.settings.height_m, spectrum.variance_m2_s2()),
                                 .x_label = "frequency f, Hz",
                                 .y_label = "f S(f), m^2/s^2",
                                 .is_x_log = true,
                                 .is_y_log = true,
                                 .curves = asked.x.empty() ? std::vector{curve} : std::vector{curve, asked}};
  tools::plot::draw_plot(options.plot, std::span(&panel, 1)).value();
}

void print_spectrum(const SpectrumOptions& options, const wind::turbulence::WindSpectrum& spectrum) {
  fmt::print("# {} {}, mean speed {:g} m/s, height {:g} m, variance {:.6g} m^2/s^2\n# f_Hz S_m2_s2_Hz\n", options.model,
             options.component, options.settings.speed_m_s, options.settings.height_m, spectrum.variance_m2_s2());
  for (const double f : options.frequencies_hz) fmt::print("{} {}\n", f, spectrum.density_m2_s2_hz(f));
}

void print_spectrum_as_json(const SpectrumOptions& options, const wind::turbulence::WindSpectrum& spectrum) {
  std::vector<double> densities;
  for (const double f : options.frequencies_hz) densities.push_back(spectrum.density_m2_s2_hz(f));
  print_json({{"model", options.model},
              {"component", options.component},
              {"speed_m_s", options.settings.speed_m_s},
              {"height_m", options.settings.height_m},
              {"variance_m2_s2", spectrum.variance_m2_s2()},
              {"frequency_hz", options.frequencies_hz},
              {"density_m2_s2_hz", densities}});
}

void run_spectrum(SpectrumOptions options) {
  if (!options.plot.empty()) tools::plot::check_plot_name(options.plot).value();
  options.settings.model = named<wind::turbulence::SpectrumModel>(wind::turbulence::kSpectrumModelNames, options.model);
  options.settings.component =
      named<wind::turbulence::WindComponent>(wind::turbulence::kWindComponentNames, options.component);
  const auto spectrum = wind::turbulence::WindSpectrum::make(options.settings);
  if (!spectrum) {
    throw ExitError(kExitUsage, fmt::format("--model {}: {}", options.model, explain(spectrum.error())));
  }

  if (options.as_json) {
    print_spectrum_as_json(options, *spectrum);
  } else {
    print_spectrum(options, *spectrum);
  }
  if (!options.plot.empty()) draw_spectrum(options, *spectrum);
}

void add_spectrum(CLI::App& app) {
  CLI::App* command = app.add_subcommand("spectrum", "Print or draw a named spectrum of the wind");
  command->footer(kSpectrumFooter);
  auto options = std::make_shared<SpectrumOptions>();
  command->add_option("--model", options->model, "Which spectrum")
      ->check(CLI::IsMember(words(wind::turbulence::kSpectrumModelNames)))
      ->capture_default_str();
  command->add_option("--speed", options->settings.speed_m_s, "Mean speed U, m/s")->capture_default_str();
  command->add_option("--height", options->settings.height_m, "Height z above the ground, m")->capture_default_str();
  command->add_option("--component", options->component, "u along the wind, v across it, w upward")
      ->check(CLI::IsMember(words(wind::turbulence::kWindComponentNames)))
      ->capture_default_str();
  auto* const sigma = command->add_option("--sigma", options->settings.sigma_m_s, "Standard deviation, m/s");
  command->add_option("--ustar", options->settings.friction_velocity_m_s, "Friction velocity u*, m/s")->excludes(sigma);
  command->add_option("--length", options->settings.length_m, "Integral length scale L_u, m (von-karman, iec-kaimal)");
  auto* const frequency = command->add_option("--frequency", options->frequencies_hz, "Frequencies, Hz: F or F,F,...")
                              ->delimiter(',')
                              ->check(CLI::Range(0.0, 1e9));
  auto* const plot = command->add_option("--plot", options->plot, "Draw it into FILE.png or FILE.svg");
  add_json(*command, options->as_json);
  command->callback([options, frequency, plot] {
    if (frequency->empty() && plot->empty()) {
      throw CLI::ValidationError("--frequency", "give frequencies, or --plot FILE.svg to draw the whole spectrum");
    }
    run_spectrum(*options);
  });
}

}  // namespace

const Command kSpectrumCommand{add_spectrum};

}  // namespace yuragi::daemon::commands
