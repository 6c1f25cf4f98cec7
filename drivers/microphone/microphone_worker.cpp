#include "drivers/microphone/microphone_worker.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "drivers/decode/microphone/mic_analyser.hpp"
#include "drivers/decode/microphone/mic_frame.hpp"
#include "drivers/decode/microphone/sample_clock.hpp"

namespace yuragi::drivers::microphone {
namespace {

/// A running sound system delivers samples many times a second.
constexpr Nanoseconds kSoundTimeout = std::chrono::milliseconds(1500);
constexpr Nanoseconds kTurn = std::chrono::milliseconds(20);

/// Writes all of it. Returns false if the reader has closed the pipe.
bool write_all(int descriptor, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t size = write(descriptor, bytes.data(), bytes.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
  return true;
}

/// Makes blocks of the pieces of a stream, with the time at which they were recorded.
class Listener {
 public:
  Listener(const decode::microphone::MicAnalyserOptions& options, std::string device)
      : analyser_(options), hello_(analyser_.hello()), clock_(options.rate_hz), sample_s_(1.0 / options.rate_hz) {
    hello_.device = std::move(device);
  }

  const decode::microphone::MicHello& hello() const { return hello_; }

  /// Calls `use` with each block that the piece completes.
  template <class Use>
  void take(const bus::AudioBlock& piece, Use&& use) {
    if (piece.lost_frames > 0) {
      lost_ += piece.lost_frames;
      analyser_.restart();
    }
    const std::int64_t end_ns = clock_.add(piece.end_frame, piece.end_mono_ns);
    const std::size_t channels = hello_.channels;
    for (std::uint32_t i = 0; i < piece.frames; ++i) {
      auto block = analyser_.add(std::span(piece.samples).subspan(i * channels, channels));
      if (!block) continue;
      block->end_mono_ns = end_ns - std::llround(1e9 * sample_s_ * (piece.frames - 1 - i));
      block->lost_samples = std::exchange(lost_, 0);
      use(*block);
    }
  }

 private:
  decode::microphone::MicAnalyser analyser_;
  decode::microphone::MicHello hello_;
  decode::microphone::SampleClock clock_;
  double sample_s_;
  std::uint32_t lost_ = 0;
};

}  // namespace

bool run_microphone_worker(const MicWorkerOptions& options, bus::AudioInput& input, const sensor::Clock& clock,
                           int output, const std::atomic<bool>& is_over) {
  const auto fail = [&](const std::string& message) {
    write_all(output, decode::microphone::encode_mic_frame(decode::microphone::MicTrouble{message}));
    return false;
  };

  const auto device = input.open(options.choice, [&clock] { return clock.now().mono; });
  if (!device) return fail(device.error().message);
  const std::string name =
      fmt::format("{} ({}), {} channels at {:g} Hz", device->name, device->host_api, device->channels, device->rate_hz);
  std::optional<Listener> listener;
  try {
    listener.emplace(decode::microphone::MicAnalyserOptions{.rate_hz = device->rate_hz,
                                                            .channels = device->channels,
                                                            .low_hz = options.low_hz,
                                                            .high_hz = options.high_hz},
                     name);
  } catch (const std::invalid_argument& error) {
    return fail(fmt::format("{}: {}", name, error.what()));
  }
  if (!write_all(output, decode::microphone::encode_mic_frame(listener->hello()))) return true;

  bus::AudioBlock piece;
  MonoTime last_sound = clock.now().mono;
  while (!is_over) {
    bool is_read = true;
    while (is_read && input.take(piece)) {
      last_sound = clock.now().mono;
      listener->take(piece, [&](const decode::microphone::MicBlock& block) {
        is_read = is_read && write_all(output, decode::microphone::encode_mic_frame(block, listener->hello()));
      });
    }
    if (!is_read) return true;
    if (!input.is_running()) return fail(name + " stopped: check whether it was unplugged");
    if (clock.now().mono - last_sound > kSoundTimeout) {
      return fail(fmt::format("{} has been silent for {:g} s: check whether it was unplugged; if not, plug it in again",
                              name, seconds(kSoundTimeout)));
    }
    std::this_thread::sleep_for(kTurn);
  }
  return true;
}

std::string list_of_microphones(const std::vector<bus::AudioDevice>& devices) {
  std::string lines;
  for (const bus::AudioDevice& device : devices) {
    std::string name = device.name;
    std::ranges::replace_if(
        name, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    lines += fmt::format("{}\t{}\t{:g}\t{}\t{}\n", device.host_api, device.channels, device.rate_hz,
                         device.is_default ? "default" : "-", name);
  }
  return lines;
}

}  // namespace yuragi::drivers::microphone
