#include "engine/noise/moving_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <string>

#include "engine/math/portable.hpp"
#include "engine/noise/noise_spectrum.hpp"

namespace yuragi::noise {
namespace {

/// exp(-2 pi i k X) of each wave number of an axis, in the spectrum's order.
std::vector<std::complex<double>> carried_waves(std::size_t size, double carried) {
  const double part = carried - std::nearbyint(carried);  // whole periods change nothing
  std::vector<std::complex<double>> waves(size);
  for (std::size_t i = 0; i < size; ++i) {
    waves[i] = std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(signed_wave(i, size)) * part);
  }
  return waves;
}

/// Waves with two samples on an axis cannot be carried by a part of a sample; the constant one is no noise.
bool is_left_out(std::int64_t x, std::int64_t z, std::int64_t y, std::int64_t half) noexcept {
  return x == half || std::abs(z) == half || std::abs(y) == half || (x == 0 && z == 0 && y == 0);
}

/// The two samples next to a place, given in periods, on an axis of `size` samples.
struct Between {
  std::size_t first, second;
  double fraction;
};
Between samples_at(double place, std::size_t size) noexcept {
  const double sample = (place - std::floor(place)) * static_cast<double>(size);
  const double whole = std::floor(sample);
  const std::size_t first = static_cast<std::size_t>(whole) % size;  // a place just below 0 can round to the end
  return {first, (first + 1) % size, sample - whole};
}

}  // namespace

SharedVariance shared_variance(int dims, std::size_t size, const WavePower& one, const WavePower& other) {
  const auto half = static_cast<std::int64_t>(size / 2);
  const std::int64_t deepest = dims == 3 ? half : 0;
  SharedVariance sum;
  for (std::int64_t y = -deepest; y <= deepest; ++y) {
    for (std::int64_t z = -half; z <= half; ++z) {
      for (std::int64_t x = 0; x <= half; ++x) {
        if (is_left_out(x, z, y, half)) continue;
        const double waves = x == 0 ? 1.0 : 2.0;  // mirror images: those of x = 0 are in this loop themselves
        const double power = one(static_cast<double>(x), static_cast<double>(z), static_cast<double>(y));
        const double other_power = other(static_cast<double>(x), static_cast<double>(z), static_cast<double>(y));
        sum.one += waves * power;
        sum.other += waves * other_power;
        sum.common += waves * std::sqrt(power * other_power);
      }
    }
  }
  return sum;
}

MovingNoise::MovingNoise(int dims, std::size_t size, std::span<const MovingField> fields) : fft_(dims, size) {
  if (dims != 2 && dims != 3) throw std::invalid_argument("a moving noise must have two or three dimensions");
  if (check_noise(dims, {.size = size})) throw std::invalid_argument(std::string(explain(Error::kSizeNotAllowed)));
  if (fields.empty()) throw std::invalid_argument("a moving noise must have at least one field");

  // All fields turn in the same way: their modes are still independent of each other.
  const std::vector<std::int8_t> signs = turning_signs(fft_, fields[0].seed);
  turns_.reserve(signs.size());
  for (std::size_t i = 0; i < signs.size(); ++i) {
    const auto x = static_cast<double>(i % fft_.row_modes());
    const SpectrumRow row = spectrum_row(i / fft_.row_modes(), size, dims);
    const double k = math::length(x, static_cast<double>(row.wave_z), static_cast<double>(row.wave_y));
    turns_.push_back(signs[i] * math::cube_root(k * k));
  }
  for (const MovingField& field : fields) fields_.push_back(make_field(field));
  move_to({0.0, 0.0, 0.0}, 0.0);
}

MovingNoise::Field MovingNoise::make_field(const MovingField& wanted) {
  Field field;
  const auto half = static_cast<std::int64_t>(size() / 2);
  const auto draw = [&](std::uint64_t seed, double share) {
    field.variance = 0.0;
    fill_modes(fft_, seed, [&](std::int64_t x, std::int64_t z, std::int64_t y) {
      if (is_left_out(x, z, y, half)) return 0.0;
      const double power = wanted.power(static_cast<double>(x), static_cast<double>(z), static_cast<double>(y));
      field.variance += 2.0 * power;          // each drawn mode also counts for its mirror image
      return share * std::sqrt(0.5 * power);  // standard deviation of the real and of the imaginary part
    });
  };
  draw(wanted.seed, std::sqrt(1.0 - wanted.likeness * wanted.likeness));
  field.modes.reserve(fft_.spectrum().size());
  for (const std::complex<double> mode : fft_.spectrum()) field.modes.emplace_back(mode);
  if (wanted.likeness != 0.0) {
    draw(wanted.like_seed, wanted.likeness);
    for (std::size_t i = 0; i < field.modes.size(); ++i) field.modes[i] += std::complex<float>(fft_.spectrum()[i]);
  }
  field.samples.resize(fft_.samples().size());
  return field;
}

void MovingNoise::move_to(std::array<double, 3> carried, double turn_rad) noexcept {
  const std::vector<std::complex<double>> along_x = carried_waves(size(), carried[0]);
  const std::vector<std::complex<double>> along_z = carried_waves(size(), carried[1]);
  const std::vector<std::complex<double>> along_y = carried_waves(size(), dims() == 3 ? carried[2] : 0.0);
  const std::size_t columns = fft_.row_modes();
  for (Field& field : fields_) {
    // Turn the phase of each mode, then transform.
    for (std::size_t i = 0; i < field.modes.size(); ++i) {
      const std::size_t x = i % columns;
      const std::size_t z = i / columns % size();
      const std::size_t y = i / columns / size();
      std::complex<double> mode = std::complex<double>(field.modes[i]) * along_x[x] * along_z[z] * along_y[y];
      if (turn_rad != 0.0) mode *= std::polar(1.0, -turn_rad * turns_[i]);
      fft_.spectrum()[i] = mode;
    }
    fft_.inverse();
    std::ranges::transform(fft_.samples(), field.samples.begin(), [](double v) { return static_cast<float>(v); });
  }
}

double MovingNoise::read(std::size_t index, std::array<double, 3> place) const noexcept {
  const std::vector<float>& samples = fields_[index].samples;
  const Between x = samples_at(place[0], size());
  const Between z = samples_at(place[1], size());
  const auto level = [&](std::size_t y) {
    const auto row = [&](std::size_t row_z) {
      const std::size_t first = (y * size() + row_z) * size();
      return std::lerp(static_cast<double>(samples[first + x.first]), static_cast<double>(samples[first + x.second]),
                       x.fraction);
    };
    return std::lerp(row(z.first), row(z.second), z.fraction);
  };
  if (dims() == 2) return level(0);
  const Between y = samples_at(place[2], size());
  return std::lerp(level(y.first), level(y.second), y.fraction);
}

}  // namespace yuragi::noise
