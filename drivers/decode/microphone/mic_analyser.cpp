#include "drivers/decode/microphone/mic_analyser.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace yuragi::drivers::decode::microphone {
namespace {

constexpr double kMinSegment_s = 0.125;
constexpr double kBlock_s = 0.25;
/// Samples of at least this magnitude are full scale for every converter of 8 bits and more.
constexpr float kClipLevel = 0.99F;
constexpr float kNoMicrophoneSays = 10.0F;
/// The band above the wind's, by which automatic gain shows.
constexpr double kHighFrom_hz = 1500.0;
constexpr double kHighTo_hz = 6000.0;
constexpr double kUsablePart = 0.45;  // of the rate: the converter's filter removes the frequencies above

std::size_t segment_size(double rate_hz) {
  std::size_t size = 8;
  while (static_cast<double>(size) < kMinSegment_s * rate_hz) size *= 2;
  return size;
}

const MicAnalyserOptions& checked_options(const MicAnalyserOptions& options) {
  const bool in_range = options.rate_hz >= 100.0 && options.rate_hz <= 1e6 && options.channels >= 1 &&
                        options.channels <= kMicMaxChannels && options.low_hz >= 1.0 &&
                        options.high_hz > options.low_hz;
  if (!in_range) throw std::invalid_argument("a microphone's options are out of range");
  if (options.low_hz * 1.5 > kUsablePart * options.rate_hz) {
    throw std::invalid_argument("the sample rate is too low for the band of the wind");
  }
  return options;
}

}  // namespace

MicAnalyser::MicAnalyser(const MicAnalyserOptions& options)
    : channels_(checked_options(options).channels), segment_(segment_size(options.rate_hz)), fft_(1, segment_) {
  const auto size = static_cast<double>(segment_);
  const double bin_hz = options.rate_hz / size;

  // Hann's window, and the factor that makes one-sided mean squares of |F|^2.
  double squares = 0.0;
  for (std::size_t i = 0; i < segment_; ++i) {
    window_.push_back(0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / size));
    squares += window_.back() * window_.back();
  }
  scale_ = 2.0 / (squares * size);

  // Bands of a third of an octave, with at least one bin; the first bin is left out because it contains the rest of the
  // mean.
  const double top_hz = std::min(options.high_hz, kUsablePart * options.rate_hz);
  const auto bin_at = [&](double hz) { return static_cast<std::size_t>(std::max(1L, std::lround(hz / bin_hz))); };
  band_edges_.push_back(bin_at(options.low_hz));
  const double thirds = std::clamp(std::round(3.0 * std::log2(top_hz / options.low_hz)), 1.0, double{kMicMaxBands});
  for (int band = 1; band <= static_cast<int>(thirds); ++band) {
    const std::size_t edge = bin_at(options.low_hz * std::pow(top_hz / options.low_hz, band / thirds));
    if (edge > band_edges_.back()) band_edges_.push_back(edge);
  }
  if (band_edges_.size() == 1) band_edges_.push_back(band_edges_.back() + 1);

  const double high_top_hz = std::min(kHighTo_hz, kUsablePart * options.rate_hz);
  if (high_top_hz > 1.5 * kHighFrom_hz && top_hz < kHighFrom_hz) {
    high_begin_ = bin_at(kHighFrom_hz);
    high_end_ = bin_at(high_top_hz);
  }

  segments_per_block_ = static_cast<std::size_t>(std::max(1L, std::lround(2.0 * kBlock_s * options.rate_hz / size)));
  history_.resize(segment_ * channels_);
  spectra_.assign(channels_, std::vector<std::complex<double>>(fft_.row_modes()));

  hello_.rate_hz = options.rate_hz;
  hello_.channels = static_cast<std::uint8_t>(channels_);
  hello_.bands = static_cast<std::uint8_t>(band_edges_.size() - 1);
  for (std::size_t band = 0; band + 1 < band_edges_.size(); ++band) {
    hello_.bins[band] = static_cast<std::uint16_t>(band_edges_[band + 1] - band_edges_[band]);
  }
  hello_.high_bins = static_cast<std::uint16_t>(high_end_ - high_begin_);
}

void MicAnalyser::restart() noexcept {
  filled_ = 0;
}

std::optional<MicBlock> MicAnalyser::add(std::span<const float> frame) noexcept {
  for (std::size_t channel = 0; channel < channels_; ++channel) {
    float sample = frame[channel];
    if (!(std::abs(sample) < kNoMicrophoneSays)) {
      sample = 0.0F;
      ++invalid_;
    }
    if (std::abs(sample) >= kClipLevel) ++sums_[channel].clipped;
    history_[filled_ * channels_ + channel] = sample;
  }
  ++filled_;
  ++samples_;
  ++block_frames_;
  if (filled_ < segment_) return std::nullopt;

  // The second half of this segment is the first of the next.
  add_segment();
  const auto half = static_cast<std::ptrdiff_t>(segment_ / 2 * channels_);
  std::copy(history_.begin() + half, history_.end(), history_.begin());
  filled_ = segment_ / 2;
  if (segments_ < segments_per_block_) return std::nullopt;
  return finish_block();
}

void MicAnalyser::add_segment() noexcept {
  const auto size = static_cast<double>(segment_);
  for (std::size_t channel = 0; channel < channels_; ++channel) {
    double mean = 0.0;
    for (std::size_t i = 0; i < segment_; ++i) mean += static_cast<double>(history_[i * channels_ + channel]);
    mean /= size;

    Sums& sums = sums_[channel];
    double squares = 0.0;
    const std::span<double> samples = fft_.samples();
    for (std::size_t i = 0; i < segment_; ++i) {
      const double sample = static_cast<double>(history_[i * channels_ + channel]) - mean;
      squares += sample * sample;
      sums.peak = std::max(sums.peak, std::abs(sample));
      samples[i] = sample * window_[i];
    }
    sums.total_power += squares / size;
    fft_.forward();
    std::ranges::copy(fft_.spectrum(), spectra_[channel].begin());
  }
  add_band_powers();
  ++segments_;
}

void MicAnalyser::add_band_powers() noexcept {
  for (std::size_t a = 0; a < channels_; ++a) {
    const auto power = [&](std::size_t begin, std::size_t end) {
      double sum = 0.0;
      for (std::size_t bin = begin; bin < end; ++bin) sum += std::norm(spectra_[a][bin]);
      return sum;
    };
    for (std::size_t band = 0; band + 1 < band_edges_.size(); ++band) {
      sums_[a].power[band] += power(band_edges_[band], band_edges_[band + 1]);
    }
    sums_[a].high_power += power(high_begin_, high_end_);

    for (std::size_t b = a + 1; b < channels_; ++b) {
      for (std::size_t band = 0; band + 1 < band_edges_.size(); ++band) {
        std::complex<double> sum;
        for (std::size_t bin = band_edges_[band]; bin < band_edges_[band + 1]; ++bin) {
          sum += spectra_[a][bin] * std::conj(spectra_[b][bin]);
        }
        cross_sums_[mic_pair(a, b)][band] += sum;
      }
    }
  }
}

MicBlock MicAnalyser::finish_block() noexcept {
  MicBlock block;
  block.end_sample = samples_;
  block.segments = segments_;
  block.invalid_samples = invalid_;
  const double per_segment = 1.0 / segments_;
  const double factor = scale_ * per_segment;
  for (std::size_t channel = 0; channel < channels_; ++channel) {
    const Sums& sums = sums_[channel];
    MicChannel& out = block.channels[channel];
    for (std::size_t band = 0; band < hello_.bands; ++band) {
      out.power[band] = static_cast<float>(factor * sums.power[band]);
    }
    out.high_power = static_cast<float>(factor * sums.high_power);
    out.total_power = static_cast<float>(per_segment * sums.total_power);
    out.clipped = static_cast<float>(sums.clipped) / static_cast<float>(block_frames_);
    out.peak = static_cast<float>(sums.peak);
  }
  for (std::size_t pair = 0; pair < mic_pair_count(channels_); ++pair) {
    for (std::size_t band = 0; band < hello_.bands; ++band) {
      block.cross[pair][band] = std::complex<float>(factor * cross_sums_[pair][band]);
    }
  }

  sums_ = {};
  cross_sums_ = {};
  segments_ = 0;
  block_frames_ = 0;
  invalid_ = 0;
  return block;
}

}  // namespace yuragi::drivers::decode::microphone
