#include "tests/proof/sonic_record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "engine/fft/real_fft.hpp"
#include "engine/math/philox.hpp"
#include "engine/wind/blend/blended_estimator.hpp"
#include "engine/wind/turbulence/wind_spectrum.hpp"
#include "tests/support/places.hpp"

namespace yuragi::proof {
namespace {

constexpr std::array<const char*, 2> kNames = {"20180720T133000", "20180720T140000"};

wind::Reading reading_of(wind::Vector wind, double time_s) {
  wind::Reading reading;
  reading.time.mono = MonoTime(from_seconds(time_s));
  reading.speed_m_s = speed_of(wind);
  reading.direction_deg = wind::direction_from_deg(wind);
  return reading;
}

/// A component of a made-up wind: random waves of a spectrum.
std::vector<double> noise_of(const wind::turbulence::WindSpectrum& spectrum, double rate_hz, std::size_t size,
                             std::uint64_t seed, std::uint64_t stream) {
  fft::RealFft fft(1, size);
  const math::RandomStream random(seed, stream);
  const double step_hz = rate_hz / static_cast<double>(size);
  for (std::size_t k = 1; k < size / 2; ++k) {
    const auto [re, im] = random.normal_pair(k);
    const double variance = spectrum.density_m2_s2_hz(static_cast<double>(k) * step_hz) * step_hz;
    fft.spectrum()[k] = 0.5 * std::sqrt(variance) * std::complex<double>(re, im);
  }
  fft.inverse();
  return {fft.samples().begin(), fft.samples().end()};
}

}  // namespace

std::optional<SonicRecord> load_sonic(int number) {
  const std::string name = kNames.at(static_cast<std::size_t>(number));
  const std::string file = test::source_path("../shared/data/sonic/finse_csat3_10hz_" + name + ".csv");
  std::ifstream in(file);
  if (!in) return std::nullopt;

  // time,u,v,w,temperature at equal steps of 0.1 s, below a comment and the names of the columns.
  SonicRecord record{.name = name, .samples = {}};
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#') || line.starts_with("timestamp")) continue;
    const std::size_t comma = line.find(',');
    wind::Vector wind;
    if (comma == std::string::npos || std::sscanf(line.c_str() + comma, ",%lf,%lf", &wind.u_m_s, &wind.v_m_s) != 2) {
      throw std::runtime_error(std::string(file).append(": a line is not time,u,v: ").append(line));
    }
    record.samples.push_back(wind);
  }
  if (record.samples.size() < 10000) throw std::runtime_error(file + ": ends too soon");
  return record;
}

SonicRecord sonic_or_synthetic(int number) {
  if (auto record = load_sonic(number)) return *record;
  constexpr int kTicksASample = 6;
  constexpr int kSamples = 18'000;
  // Gusts of another seed than those of the runs that hear them.
  const auto seed = static_cast<std::uint64_t>(number) + 1;
  const auto gusts =
      std::make_shared<const wind::turbulence::GustNoise>(wind::turbulence::GustNoiseSettings{.seed = 999 + seed});
  wind::blend::BlendedEstimator climate(
      0,
      {.climate = {.mean_speed_m_s = 7.0, .mean_direction_deg = 270.0, .turbulence_intensity = 0.3, .seed = seed},
       .gustiness = 0.5},
      gusts);
  SonicRecord record{.name = "synthetic", .samples = {}};
  for (int i = 0; i < kTicksASample * kSamples; ++i) {
    const wind::Vector wind = climate.advance(MonoTime(from_seconds(i / (kTicksASample * record.rate_hz)))).wind;
    if (i % kTicksASample == 0) record.samples.push_back(wind);
  }
  return record;
}

std::vector<wind::Reading> instant_samples(const SonicRecord& record, double interval_s) {
  const auto per_block = static_cast<std::size_t>(std::lround(interval_s * record.rate_hz));
  std::vector<wind::Reading> readings;
  for (std::size_t end = per_block; end <= record.samples.size(); end += per_block) {
    readings.push_back(reading_of(record.samples[end - 1], static_cast<double>(end) / record.rate_hz));
  }
  return readings;
}

SonicRecord von_karman_record(double speed_m_s, double intensity, double length_m, std::uint64_t seed) {
  constexpr std::size_t kSize = std::size_t{1} << 15;
  SonicRecord record{.name = "von Karman", .samples = std::vector<wind::Vector>(kSize)};
  const auto component = [&](wind::turbulence::WindComponent which, double sigma_m_s) {
    const auto spectrum =
        wind::turbulence::WindSpectrum::make(
            {.component = which, .speed_m_s = speed_m_s, .sigma_m_s = sigma_m_s, .length_m = length_m})
            .value();
    return noise_of(spectrum, record.rate_hz, kSize, seed, static_cast<std::uint64_t>(which));
  };
  const std::vector<double> along = component(wind::turbulence::WindComponent::kAlong, intensity * speed_m_s);
  const std::vector<double> across = component(wind::turbulence::WindComponent::kAcross, 0.8 * intensity * speed_m_s);
  for (std::size_t i = 0; i < kSize; ++i) record.samples[i] = {speed_m_s + along[i], across[i]};
  return record;
}

std::vector<wind::Reading> block_means(const SonicRecord& record, double interval_s) {
  const auto per_block = static_cast<std::size_t>(std::lround(interval_s * record.rate_hz));
  std::vector<wind::Reading> readings;
  for (std::size_t end = per_block; end <= record.samples.size(); end += per_block) {
    wind::Vector sum{};
    for (std::size_t i = end - per_block; i < end; ++i) sum = sum + record.samples[i];
    const wind::Vector mean = (1.0 / static_cast<double>(per_block)) * sum;
    readings.push_back(reading_of(mean, static_cast<double>(end) / record.rate_hz));
  }
  return readings;
}

}  // namespace yuragi::proof
