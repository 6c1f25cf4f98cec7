#include "drivers/decode/microphone/mic_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace yuragi::drivers::decode::microphone {
namespace {

constexpr double kBlockLength_s = 0.25;
constexpr double kMaxStep_s = 2.0;
constexpr double kNothing_db = -200.0;
constexpr double kClipsFrom = 1e-3;      // part of the samples
constexpr double kMaxClipping = 0.5;     // beyond it the standard deviation is anybody's guess
constexpr double kFullScaleNoise = 0.1;  // mean square from which on white noise is no microphone's own
constexpr double kWhiteFrom = 0.25;      // density of the upper band over that of the wind's band
// The part of a band's power in which two channels differ. Copies differ by rounding, some 1e-7; two microphones by
// their own noise, and by what they are apart: by 5 cm 1e-4 from 160 to 200 Hz, however loud the sound is.
constexpr double kMaxTwinDifference = 1e-6;
constexpr double kGustWindow_s = 3.0;
constexpr double kGustMemory_s = 600.0;

double db_of(double power) {
  return power > 0.0 ? std::max(kNothing_db, 10.0 * std::log10(power)) : kNothing_db;
}

/// The standard deviation of a Gaussian signal that is beyond +-1 for this part of the time.
double clipped_deviation(double part) {
  // erfc(x / sqrt(2)) = part, by bisection: it falls in x.
  double low = 0.3;
  double high = 6.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (std::erfc(middle / std::numbers::sqrt2) > part ? low : high) = middle;
  }
  return 1.0 / low;
}

/// How many independent estimates an average holds of `segments` Hann segments that overlap by half and `bins`
/// neighbouring frequencies of each: the correlations of neighbours in power are 1/36; 4/9 and 1/36 (Harris 1978, "On
/// the use of windows for harmonic analysis with the discrete Fourier transform").
double independent_averages(double segments, double bins) {
  const double in_time = segments / (1.0 + 2.0 / 36.0 * (1.0 - 1.0 / segments));
  const double second = bins > 1.0 ? std::max(0.0, 1.0 - 2.0 / bins) / 36.0 : 0.0;
  return in_time * bins / (1.0 + 2.0 * (4.0 / 9.0 * (1.0 - 1.0 / bins) + second));
}

}  // namespace

MicEstimator::MicEstimator(const MicEstimatorOptions& options, const MicHello& hello)
    : options_(options), hello_(hello), floor_(options.noise_memory_s) {
  const auto blocks = std::lround(options_.window_s / kBlockLength_s);
  window_.resize(static_cast<std::size_t>(std::clamp(blocks, 1L, 240L)));
  if (options_.faces_deg.empty()) return;
  if (options_.faces_deg.size() != hello_.channels) {
    throw std::invalid_argument("a direction needs one face for each channel");
  }
  direction_.emplace(options_.faces_deg, options_.direction_smoothing_s);
}

void MicEstimator::restart() noexcept {
  filled_ = 0;
  last_sample_ = 0;
  recent_.clear();
  if (direction_) direction_->restart();
}

std::optional<Refusal> MicEstimator::refuse(const MicBlock& block) const {
  if (block.invalid_samples > 0) return Refusal::kInvalid;
  const auto channels = std::span(block.channels).first(hello_.channels);
  if (std::ranges::all_of(channels, [](const MicChannel& channel) { return channel.peak == 0.0F; })) {
    return Refusal::kInvalid;
  }
  // Wind falls as f^-7/3: at full scale, the band above has a thousandth of its density.
  const auto is_white = [this](const MicChannel& channel) {
    if (hello_.high_bins == 0 || static_cast<double>(channel.total_power) < kFullScaleNoise) return false;
    double band_power = 0.0;
    double bins = 0.0;
    for (std::size_t band = 0; band < hello_.bands; ++band) {
      band_power += static_cast<double>(channel.power[band]);
      bins += hello_.bins[band];
    }
    return static_cast<double>(channel.high_power) / hello_.high_bins > kWhiteFrom * band_power / bins;
  };
  if (std::ranges::all_of(channels, is_white)) return Refusal::kImplausible;
  return std::nullopt;
}

double MicEstimator::coherence(std::size_t a, std::size_t b, std::size_t band) const {
  std::complex<double> cross;
  double power_a = 0.0;
  double power_b = 0.0;
  double segments = 0.0;
  for (const MicBlock& block : window_) {
    const double weight = block.segments;
    segments += weight;
    cross += weight * std::complex<double>(block.cross[mic_pair(a, b)][band]);
    power_a += weight * static_cast<double>(block.channels[a].power[band]);
    power_b += weight * static_cast<double>(block.channels[b].power[band]);
  }
  if (!(power_a > 0.0) || !(power_b > 0.0)) return 0.0;
  const double square = std::min(1.0, std::norm(cross) / (power_a * power_b));
  const double averages = independent_averages(segments, hello_.bins[band]);
  if (averages <= 1.0) return 0.0;
  return std::sqrt(std::max(0.0, (square * averages - 1.0) / (averages - 1.0)));
}

/// Returns true if two channels carry the same signal, with any gains, in every band with power. With a single average
/// any two look so.
bool MicEstimator::are_twins(std::size_t a, std::size_t b) const {
  bool have_power = false;
  for (std::size_t band = 0; band < hello_.bands; ++band) {
    std::complex<double> cross;
    double power_a = 0.0;
    double power_b = 0.0;
    double segments = 0.0;
    for (const MicBlock& block : window_) {
      segments += block.segments;
      cross += std::complex<double>(block.cross[mic_pair(a, b)][band]);
      power_a += static_cast<double>(block.channels[a].power[band]);
      power_b += static_cast<double>(block.channels[b].power[band]);
    }
    if ((power_a > 0.0) != (power_b > 0.0)) return false;
    if (!(power_a > 0.0) || independent_averages(segments, hello_.bins[band]) <= 1.0) continue;
    have_power = true;
    if (std::norm(cross) < (1.0 - kMaxTwinDifference) * power_a * power_b) return false;
  }
  return have_power;
}

std::optional<std::array<std::size_t, 2>> MicEstimator::find_twins() const {
  for (std::size_t b = 1; b < hello_.channels; ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if (are_twins(a, b)) return std::array{a, b};
    }
  }
  return std::nullopt;
}

MicEstimator::Levels MicEstimator::levels_of_window() const {
  Levels levels;
  const std::size_t channels = hello_.channels;
  std::vector<std::size_t> living;
  for (std::size_t channel = 0; channel < channels; ++channel) {
    const bool is_silent =
        std::ranges::all_of(window_, [channel](const MicBlock& block) { return block.channels[channel].peak == 0.0F; });
    if (is_silent) {
      levels.silent_channels |= 1U << channel;
    } else {
      living.push_back(channel);
    }
  }

  // The coherence of each band: the mean over the pairs, so that it is the same for every channel, and faces
  // in the lee are not taken for quiet ones.
  std::array<double, kMicMaxBands> wind_part{};
  wind_part.fill(1.0);
  if (options_.ignores_sound && living.size() > 1) {
    const auto pairs = static_cast<double>(mic_pair_count(living.size()));
    for (std::size_t band = 0; band < hello_.bands; ++band) {
      double sum = 0.0;
      for (std::size_t i = 0; i < living.size(); ++i) {
        for (std::size_t j = i + 1; j < living.size(); ++j) sum += coherence(living[i], living[j], band);
      }
      wind_part[band] = 1.0 - sum / pairs;
    }
  }

  const auto blocks = static_cast<double>(window_.size());
  for (const std::size_t channel : living) {
    double clipped = 0.0;
    double total = 0.0;
    double all = 0.0;
    for (const MicBlock& block : window_) {
      const MicChannel& input = block.channels[channel];
      clipped += static_cast<double>(input.clipped) / blocks;
      total += static_cast<double>(input.total_power) / blocks;
      levels.high_power += static_cast<double>(input.high_power) / blocks;
      for (std::size_t band = 0; band < hello_.bands; ++band) {
        const double power = static_cast<double>(input.power[band]) / blocks;
        all += power;
        levels.power[channel] += wind_part[band] * power;
      }
    }
    if (clipped >= kClipsFrom && total > 0.0) {
      levels.is_clipping = true;
      const double deviation = clipped_deviation(std::min(clipped, kMaxClipping));
      levels.power[channel] *= std::max(1.0, deviation * deviation / total);
    }
    levels.power_with_sound += all / static_cast<double>(living.size());
    levels.wind_power += levels.power[channel] / static_cast<double>(living.size());
  }
  return levels;
}

Result<std::optional<MicEstimate>, Refusal> MicEstimator::add(const MicBlock& block) {
  const double samples = block.end_sample > last_sample_ ? static_cast<double>(block.end_sample - last_sample_) : 0.0;
  const double duration_s = std::clamp(samples / hello_.rate_hz, 0.0, kMaxStep_s);
  last_sample_ = block.end_sample;
  time_s_ += duration_s;
  if (const auto refusal = refuse(block)) {
    twins_.reset();
    filled_ = 0;
    return *refusal;
  }
  window_[next_] = block;
  next_ = (next_ + 1) % window_.size();
  filled_ = std::min(filled_ + 1, window_.size());
  if (filled_ < window_.size()) return std::optional<MicEstimate>();
  twins_ = options_.ignores_sound ? find_twins() : std::nullopt;
  if (twins_) {
    filled_ = 0;
    return Refusal::kInvalid;
  }

  const Levels levels = levels_of_window();
  MicEstimate estimate;
  estimate.level_db = db_of(levels.wind_power);
  estimate.is_clipping = levels.is_clipping;
  estimate.silent_channels = levels.silent_channels;
  if (levels.power_with_sound > 0.0) {
    estimate.sound_part = std::clamp(1.0 - levels.wind_power / levels.power_with_sound, 0.0, 1.0);
  }

  floor_.add(estimate.level_db, duration_s);
  estimate.floor_db = options_.noise_floor_db.value_or(floor_.floor_db().value_or(kNothing_db));
  const double noise_power = estimate.floor_db > kNothing_db ? std::pow(10.0, 0.1 * estimate.floor_db) : 0.0;
  estimate.speed_m_s = mic_speed_m_s(options_.calibration, levels.wind_power, noise_power);
  estimate.gust_m_s = add_gust(estimate.speed_m_s, duration_s);

  gain_watch_.add(db_of(levels.power_with_sound),
                  hello_.high_bins > 0 ? std::optional(db_of(levels.high_power)) : std::nullopt, duration_s);
  estimate.suspects_automatic_gain = gain_watch_.suspects();

  if (direction_ && levels.silent_channels == 0) {
    std::array<double, kMicMaxChannels> speeds_m_s{};
    for (std::size_t channel = 0; channel < hello_.channels; ++channel) {
      speeds_m_s[channel] = mic_speed_m_s(options_.calibration, levels.power[channel], noise_power);
    }
    if (const auto found = direction_->add(std::span(speeds_m_s).first(hello_.channels), duration_s)) {
      estimate.direction_confidence = found->confidence;
      if (found->confidence >= options_.least_confidence) estimate.direction_deg = found->direction_deg;
    }
  }
  return std::optional(estimate);
}

std::optional<double> MicEstimator::add_gust(double speed_m_s, double duration_s) {
  recent_.push_back({time_s_, speed_m_s});
  while (recent_.front().time_s <= time_s_ - kGustWindow_s) recent_.pop_front();
  const double measured_s = time_s_ - recent_.front().time_s + duration_s;
  if (measured_s >= kGustWindow_s - duration_s) {
    double mean_m_s = 0.0;
    for (const Gust& one : recent_) mean_m_s += one.speed_m_s / static_cast<double>(recent_.size());
    while (!gusts_.empty() && gusts_.back().speed_m_s <= mean_m_s) gusts_.pop_back();
    gusts_.push_back({time_s_, mean_m_s});
  }
  while (!gusts_.empty() && gusts_.front().time_s < time_s_ - kGustMemory_s) gusts_.pop_front();
  if (gusts_.empty()) return std::nullopt;
  return gusts_.front().speed_m_s;
}

}  // namespace yuragi::drivers::decode::microphone
