#include "simulators/microphone/microphone_file.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

namespace yuragi::simulators::microphone {
namespace {

constexpr double kStep_s = 0.05;
constexpr double kMaxInWav_bytes = 4.0e9;  // its sizes are 32-bit numbers

struct CloseFile {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

class SampleWriter {
 public:
  SampleWriter(std::FILE* file, SampleFormat format) : file_(file), format_(format) {}

  void put(std::uint32_t value, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) bytes_.push_back(static_cast<char>(value >> (8U * i)));
  }
  void put(const char* mark) { bytes_.insert(bytes_.end(), mark, mark + std::strlen(mark)); }
  void put(float sample) {
    if (format_ == SampleFormat::kFloat32) return put(std::bit_cast<std::uint32_t>(sample), 4);
    put(static_cast<std::uint32_t>(std::lround(std::clamp(sample, -1.0F, 1.0F) * 32767.0F)) & 0xFFFFU, 2);
  }

  /// Returns false if the reader has closed it.
  bool flush() {
    const bool is_written = std::fwrite(bytes_.data(), 1, bytes_.size(), file_) == bytes_.size();
    bytes_.clear();
    return is_written;
  }

 private:
  std::FILE* file_;
  SampleFormat format_;
  std::vector<char> bytes_;
};

/// The canonical header of 44 bytes (Microsoft and IBM 1991, "Multimedia Programming Interface and Data
/// Specifications").
void put_wav_header(SampleWriter& out, SampleFormat format, const Options& options, std::uint32_t data_bytes) {
  const std::uint32_t sample_bytes = format == SampleFormat::kFloat32 ? 4 : 2;
  const auto channels = static_cast<std::uint32_t>(options.channels);
  const auto rate = static_cast<std::uint32_t>(std::lround(options.rate_hz));
  out.put("RIFF");
  out.put(36 + data_bytes, 4);
  out.put("WAVEfmt ");
  out.put(16, 4);
  out.put(format == SampleFormat::kFloat32 ? 3 : 1, 2);
  out.put(channels, 2);
  out.put(rate, 4);
  out.put(rate * channels * sample_bytes, 4);
  out.put(channels * sample_bytes, 2);
  out.put(8 * sample_bytes, 2);
  out.put("data");
  out.put(data_bytes, 4);
}

}  // namespace

void write_microphone_file(const std::string& path, SampleFormat format, const Options& options,
                           core::MeasuredWind wind, const core::Faults& faults, double duration_s) {
  const bool is_stdout = path == "-";
  std::signal(SIGPIPE, SIG_IGN);
  const File opened(is_stdout ? nullptr : std::fopen(path.c_str(), "wb"));
  if (!is_stdout && !opened)
    throw std::runtime_error(fmt::format("cannot write {} ({})", path, std::generic_category().message(errno)));
  SampleWriter out(is_stdout ? stdout : opened.get(), format);

  const auto frames = static_cast<std::uint64_t>(std::llround(duration_s * options.rate_hz));
  const double bytes = static_cast<double>(frames) * static_cast<double>(options.channels) *
                       (format == SampleFormat::kFloat32 ? 4.0 : 2.0);
  if (path.ends_with(".wav")) {
    if (bytes > kMaxInWav_bytes) throw std::runtime_error("too long for a WAV file: shorten --duration, or write .raw");
    put_wav_header(out, format, options, static_cast<std::uint32_t>(bytes));
  }

  Sound sound(options);
  std::vector<float> samples;
  const auto step = static_cast<std::uint64_t>(std::max(1.0, kStep_s * options.rate_hz));
  for (std::uint64_t done = 0; done < frames;) {
    const std::uint64_t count = std::min(step, frames - done);
    const double time_s = static_cast<double>(done) / options.rate_hz;
    const auto fault = faults.at(time_s);
    done += count;
    samples.clear();
    if (fault == core::FaultKind::kSilence) {
      samples.resize(count * options.channels);  // a file cannot pause: it is digitally silent
    } else {
      sound.render(wind.at(time_s, fault), count, fault, samples);
    }
    for (const float sample : samples) out.put(sample);
    if (out.flush()) continue;
    if (is_stdout && errno == EPIPE) return;
    throw std::runtime_error(fmt::format("cannot write {} ({})", path, std::generic_category().message(errno)));
  }
  if (std::fflush(is_stdout ? stdout : opened.get()) != 0 && !is_stdout) {
    throw std::runtime_error(fmt::format("cannot write {} ({})", path, std::generic_category().message(errno)));
  }
}

}  // namespace yuragi::simulators::microphone
