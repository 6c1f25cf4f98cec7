#include <array>
#include <charconv>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/tools/offline/npy.hpp"
#include "engine/noise/spectral_noise.hpp"

namespace yuragi::daemon::commands {

extern const Command kNoiseCommand;

namespace {

constexpr const char* kSummary = "Write a tile of 1/f^beta noise as a float32 NumPy file";

constexpr const char* kNoiseFooter =
    "The tile is the noise from which every scene is made. It repeats without a seam, has mean 0 and variance 1,\n"
    "and is the same, bit for bit, for the same seed.\n"
    "\n"
    "--beta is the roughness: the power falls as 1/frequency^beta. 0 is white noise, 5/3 (the default) turbulent\n"
    "wind, 2 and more rolling hills. In two and three dimensions it can mean two things:\n"
    "  transect  a straight line through the tile has the spectrum 1/f^beta, as an anemometer sees it when the wind\n"
    "            carries the tile past it (the default). Each Fourier mode has the power 1/|k|^(beta + 1) in two\n"
    "            dimensions, 1/|k|^(beta + 2) in three. The minimum of beta is 0.6 in two, 1 in three.\n"
    "  radial    each Fourier mode has the power 1/|k|^beta, as in Chiba's paper. A line is rougher: about\n"
    "            1/f^0.7 for beta 5/3 in two dimensions.\n"
    "\n"
    "--integral-scale is the length of the gusts, as a part of the edge: 0.1 on a tile of 256 m is 25.6 m. Longer\n"
    "waves have no more power than those (von Karman's spectrum). With 0 the longest waves are the strongest.\n"
    "\n"
    "Example: yuragi noise --dims 2 --size 512 --seed 7 --out tile.npy\n"
    "         python3 -c 'import numpy; print(numpy.load(\"tile.npy\").std())'";

struct NoiseOptions {
  int dims = 2;
  noise::Spec spec{.size = 512};
  std::string meaning = "transect";
  std::string out;
};

/// Refuses what the library would silently convert: a sign, or more than 64 bits.
std::string check_whole_number(const std::string& text) {
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc() && rest == end) return {};
  return text + " is not a whole number from 0 to 18446744073709551615";
}

/// The options that an error is about, as given.
std::string blamed_option(int dims, const noise::Spec& spec, noise::Error error) {
  switch (error) {
    case noise::Error::kSizeNotAllowed:
      return fmt::format("--size {}", spec.size);
    case noise::Error::kBetaOutOfRange:
      return fmt::format("--beta {}", spec.beta);
    case noise::Error::kTransectTooFlat:
      return fmt::format("--dims {} --meaning transect --beta {}", dims, spec.beta);
    case noise::Error::kIntegralScaleOutOfRange:
      return fmt::format("--integral-scale {}", spec.integral_scale);
    case noise::Error::kBandOutOfRange:
      break;  // no option sets it
  }
  return "?";
}

/// The values of the tile. Throws ExitError, which names the wrong options and what is allowed.
std::vector<float> make_values(const NoiseOptions& options) {
  const auto refuse = [&](noise::Error error) {
    return ExitError(kExitUsage,
                     fmt::format("{}: {}", blamed_option(options.dims, options.spec, error), explain(error)));
  };
  const auto values_of = [&](auto tile) {
    if (!tile) throw refuse(tile.error());
    return std::move(tile->values);
  };
  if (options.dims == 1) return values_of(noise::make_noise_1d(options.spec));
  if (options.dims == 2) return values_of(noise::make_noise_2d(options.spec));
  return values_of(noise::make_noise_3d(options.spec));
}

void run_noise(NoiseOptions options) {
  options.spec.meaning =
      options.meaning == noise::kBetaMeaningNames[1] ? noise::BetaMeaning::kRadial : noise::BetaMeaning::kTransect;
  const std::vector<float> values = make_values(options);

  std::array<std::size_t, 3> shape{};
  shape.fill(options.spec.size);
  tools::offline::write_npy(options.out, std::span(shape).first(static_cast<std::size_t>(options.dims)), values);

  double sum = 0.0;
  double squares = 0.0;
  for (const float value : values) {
    sum += static_cast<double>(value);
    squares += static_cast<double>(value) * static_cast<double>(value);
  }
  const double mean = sum / static_cast<double>(values.size());
  const double variance = squares / static_cast<double>(values.size()) - mean * mean;
  const std::size_t size = options.spec.size;
  std::string extent = fmt::format("{}", size);
  for (int axis = 1; axis < options.dims; ++axis) extent += fmt::format(" x {}", size);
  fmt::print("{}: {} float32, mean {:.1e}, variance {:.6f}; mode power ~ |k|^-{:.4g}, seed {}\n", options.out, extent,
             mean, variance, noise::mode_exponent(options.dims, options.spec.beta, options.spec.meaning),
             options.spec.seed);
}

void add_noise(CLI::App& app) {
  CLI::App* command = app.add_subcommand("noise", kSummary);
  command->footer(kNoiseFooter);
  auto options = std::make_shared<NoiseOptions>();
  command->add_option("--dims", options->dims, "Dimensions: 1 (a line), 2 (a square) or 3 (a cube)")
      ->check(CLI::IsMember({1, 2, 3}))
      ->capture_default_str();
  command
      ->add_option(
          "--size", options->spec.size,
          "Samples per edge: a power of two, 8 to 4194304 for a line, 8 to 4096 for a square, 8 to 256 for a cube")
      ->check(check_whole_number)
      ->capture_default_str();
  command
      ->add_option("--beta", options->spec.beta,
                   "Exponent of the power spectrum, 0 to 8; of a transect of a square from 0.6, of a cube from 1")
      ->capture_default_str();
  command->add_option("--meaning", options->meaning, "What beta is the exponent of (see below)")
      ->check(CLI::IsMember({"radial", "transect"}))
      ->capture_default_str();
  command
      ->add_option("--integral-scale", options->spec.integral_scale,
                   "Length scale of the gusts, as a part of the edge; 0 is no limit (see below)")
      ->capture_default_str();
  command->add_option("--seed", options->spec.seed, "Any whole number from 0")
      ->check(check_whole_number)
      ->capture_default_str();
  command->add_option("--out", options->out, "The .npy file to write; an existing one is replaced")->required();
  command->callback([options] { run_noise(*options); });
}

}  // namespace

const Command kNoiseCommand{add_noise};

}  // namespace yuragi::daemon::commands
