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
#include "daemon/commands/npy.hpp"
#include "daemon/exit.hpp"
#include "engine/noise/spectral_noise.hpp"

namespace yuragi {

extern const Command kNoiseCommand;

namespace {

constexpr const char* kSummary = "Write a tile of 1/f^beta noise as a float32 NumPy file";

constexpr const char* kNoiseFooter =
    "The tile is the raw material of every scene. It is periodic (its edges meet without a seam), has mean 0 and\n"
    "variance 1, and is the same, bit for bit, for the same seed.\n"
    "\n"
    "beta says how rough the noise is: its power falls as 1/frequency^beta. 0 is white noise, 5/3 (the default) is\n"
    "turbulent wind, 2 and more are rolling hills.\n"
    "\n"
    "In two dimensions beta can mean two things:\n"
    "  transect  a straight line cut through the tile has the spectrum 1/f^beta. This is what an anemometer sees when\n"
    "            the wind carries the tile past it, so it is the default. Each Fourier mode then has the power\n"
    "            1/|k|^(beta + 1).\n"
    "  radial    each Fourier mode has the power 1/|k|^beta, as Chiba's paper is written. A line cut is rougher: "
    "about\n"
    "            1/f^0.7 for beta 5/3.\n"
    "In one dimension the two are the same.\n"
    "\n"
    "Example: yuragi noise --dims 2 --size 512 --seed 7 --out tile.npy\n"
    "         python3 -c 'import numpy; print(numpy.load(\"tile.npy\").std())'";

struct NoiseOptions {
  int dims = 2;
  NoiseSpec spec{.size = 512};
  std::string meaning = "transect";
  std::string out;
};

/// Refuses what the library would silently bend into range: a sign, or more than 64 bits.
std::string check_whole_number(const std::string& text) {
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc() && rest == end) return {};
  return text + " is not a whole number from 0 to 18446744073709551615";
}

/// The tile's values, or ExitError that names the option to blame and what it takes.
std::vector<float> make_values(const NoiseOptions& options) {
  const auto refuse = [&](NoiseError error) {
    const std::string blamed = error == NoiseError::kSizeNotAllowed ? fmt::format("--size {}", options.spec.size)
                                                                    : fmt::format("--beta {}", options.spec.beta);
    return ExitError(kExitUsage, fmt::format("{}: {}", blamed, explain(error)));
  };
  if (options.dims == 1) {
    auto tile = make_noise_1d(options.spec);
    if (!tile) throw refuse(tile.error());
    return std::move(tile->values);
  }
  auto tile = make_noise_2d(options.spec);
  if (!tile) throw refuse(tile.error());
  return std::move(tile->values);
}

void run_noise(NoiseOptions options) {
  options.spec.meaning = options.meaning == "radial" ? BetaMeaning::kRadial : BetaMeaning::kTransect;
  const std::vector<float> values = make_values(options);

  const std::array<std::size_t, 2> shape{options.spec.size, options.spec.size};
  write_npy(options.out, std::span(shape).first(static_cast<std::size_t>(options.dims)), values);

  double sum = 0.0;
  double squares = 0.0;
  for (const float value : values) {
    sum += static_cast<double>(value);
    squares += static_cast<double>(value) * static_cast<double>(value);
  }
  const double mean = sum / static_cast<double>(values.size());
  const double variance = squares / static_cast<double>(values.size()) - mean * mean;
  const std::size_t size = options.spec.size;
  const std::string extent = options.dims == 1 ? fmt::format("{}", size) : fmt::format("{0} x {0}", size);
  fmt::print("{}: {} float32, mean {:.1e}, variance {:.6f}; mode power ~ |k|^-{:.4g}, seed {}\n", options.out, extent,
             mean, variance, mode_exponent(options.dims, options.spec.beta, options.spec.meaning), options.spec.seed);
}

void add_noise(CLI::App& app) {
  CLI::App* command = app.add_subcommand("noise", kSummary);
  command->footer(kNoiseFooter);
  auto options = std::make_shared<NoiseOptions>();
  command->add_option("--dims", options->dims, "Dimensions: 1 (a line) or 2 (a square)")
      ->check(CLI::IsMember({1, 2}))
      ->capture_default_str();
  command
      ->add_option("--size", options->spec.size,
                   "Samples an edge: a power of two, 8 to 4194304 for a line, 8 to 4096 for a square")
      ->check(check_whole_number)
      ->capture_default_str();
  command->add_option("--beta", options->spec.beta, "Exponent of the power spectrum, 0 to 8")->capture_default_str();
  command->add_option("--meaning", options->meaning, "What beta is the exponent of (see below)")
      ->check(CLI::IsMember({"radial", "transect"}))
      ->capture_default_str();
  command->add_option("--seed", options->spec.seed, "Any whole number from 0")
      ->check(check_whole_number)
      ->capture_default_str();
  command->add_option("--out", options->out, "The .npy file to write; one of that name is replaced")->required();
  command->callback([options] { run_noise(*options); });
}

}  // namespace

const Command kNoiseCommand{add_noise};

}  // namespace yuragi
