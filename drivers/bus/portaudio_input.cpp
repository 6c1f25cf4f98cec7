// PortAudio 19.6.0 over ALSA can spin without end in its own thread when a USB device is unplugged (PortAudio issue
// 1037), and its list of devices is frozen until the library is begun anew (issues 447, 750). This wrapper cannot mend
// that: it runs in a process that may be killed (drivers/microphone/microphone_worker.hpp).
#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <portaudio.h>

#include "drivers/bus/audio_input.hpp"
#include "engine/base/spsc_ring.hpp"

namespace yuragi::drivers::bus {
namespace {

/// More than a second at 48 kHz: the possible delay of the worker.
constexpr std::size_t kWaitingBlocks = 512;
constexpr double kBelievableLatency_s = 0.5;
constexpr double kLatencyWanted_s = 0.1;

bool contains(std::string_view text, std::string_view part) {
  const auto equal = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return part.empty() || std::search(text.begin(), text.end(), part.begin(), part.end(), equal) != text.end();
}

class PortaudioInput final : public AudioInput {
 public:
  PortaudioInput() = default;
  ~PortaudioInput() override {
    if (stream_ != nullptr) Pa_AbortStream(stream_);
    if (stream_ != nullptr) Pa_CloseStream(stream_);
    if (is_begun_) Pa_Terminate();
  }
  PortaudioInput(const PortaudioInput&) = delete;
  PortaudioInput& operator=(const PortaudioInput&) = delete;

  Result<std::vector<AudioDevice>, Failure> list() override {
    if (auto begun = begin(); !begun) return begun.error();
    std::vector<AudioDevice> devices;
    for (PaDeviceIndex index = 0; index < Pa_GetDeviceCount(); ++index) {
      if (AudioDevice device = describe(index); device.channels > 0) devices.push_back(std::move(device));
    }
    return devices;
  }

  Result<AudioDevice, Failure> open(const AudioChoice& choice, std::function<MonoTime()> now) override {
    if (auto begun = begin(); !begun) return begun.error();
    const auto index = find(choice);
    if (!index) return index.error();
    AudioDevice device = describe(*index);
    if (device.channels < choice.channels) {
      return Failure{fmt::format("{} has {} channels, not {}: set channels to that number", device.name,
                                 device.channels, choice.channels)};
    }
    device.channels = choice.channels;
    if (choice.rate_hz > 0.0) device.rate_hz = choice.rate_hz;

    now_ = std::move(now);
    channels_ = choice.channels;
    rate_hz_ = device.rate_hz;
    const PaDeviceInfo* info = Pa_GetDeviceInfo(*index);
    const PaStreamParameters input = {*index, static_cast<int>(channels_), paFloat32,
                                      std::max(kLatencyWanted_s, info->defaultHighInputLatency), nullptr};
    // Neither clipped nor dithered: clipping must be visible, and no noise must be added.
    PaError error = Pa_OpenStream(&stream_, &input, nullptr, rate_hz_, paFramesPerBufferUnspecified,
                                  paClipOff | paDitherOff, &PortaudioInput::call_back, this);
    if (error == paNoError) error = Pa_StartStream(stream_);
    if (error != paNoError) {
      return Failure{fmt::format(
          "cannot open {} with {} channels at {:g} Hz ({}): check whether another program or the sound system uses it",
          device.name, channels_, rate_hz_, reason(error))};
    }
    return device;
  }

  bool take(AudioBlock& block) override { return ring_.pop(block); }

  bool is_running() override { return stream_ != nullptr && Pa_IsStreamActive(stream_) == 1; }

 private:
  Result<void, Failure> begin() {
    if (is_begun_) return {};
    const PaError error = Pa_Initialize();
    if (error != paNoError) return Failure{fmt::format("the sound system cannot start ({})", reason(error))};
    is_begun_ = true;
    return {};
  }

  static std::string reason(PaError error) {
    if (error == paUnanticipatedHostError) {
      const PaHostErrorInfo* info = Pa_GetLastHostErrorInfo();
      if (info != nullptr && info->errorText != nullptr && *info->errorText != '\0') return info->errorText;
    }
    return Pa_GetErrorText(error);
  }

  static AudioDevice describe(PaDeviceIndex index) {
    const PaDeviceInfo* info = Pa_GetDeviceInfo(index);
    if (info == nullptr) return {};
    const PaHostApiInfo* host = Pa_GetHostApiInfo(info->hostApi);
    return {.name = info->name != nullptr ? info->name : "",
            .host_api = host != nullptr && host->name != nullptr ? host->name : "",
            .channels = static_cast<std::size_t>(std::max(0, info->maxInputChannels)),
            .rate_hz = info->defaultSampleRate,
            .is_default = index == Pa_GetDefaultInputDevice()};
  }

  /// The configured device; if there are several, the first.
  static Result<PaDeviceIndex, Failure> find(const AudioChoice& choice) {
    std::string there;
    for (PaDeviceIndex index = 0; index < Pa_GetDeviceCount(); ++index) {
      const AudioDevice device = describe(index);
      if (device.channels == 0) continue;
      const bool is_meant = choice.device.empty() && choice.host_api.empty()
                                ? device.is_default
                                : contains(device.name, choice.device) && contains(device.host_api, choice.host_api);
      if (is_meant) return index;
      there += fmt::format("{}\"{}\"", there.empty() ? "" : ", ", device.name);
    }
    const std::string wanted =
        choice.device.empty() ? "default input" : fmt::format("input called \"{}\"", choice.device);
    return Failure{fmt::format("there is no {}{}: plug it in, or set device to a part of an existing name ({})", wanted,
                               choice.host_api.empty() ? "" : " of " + choice.host_api,
                               there.empty() ? "there is no input at all" : there)};
  }

  /// On the sound system's own thread: copies, and no more. An exception, of which there is none, would end the worker.
  static int call_back(const void* input, void* /*output*/, unsigned long frames, const PaStreamCallbackTimeInfo* time,
                       PaStreamCallbackFlags flags, void* self) noexcept {
    static_cast<PortaudioInput*>(self)->hand_over(static_cast<const float*>(input), frames, *time,
                                                  (flags & paInputOverflow) != 0);
    return paContinue;
  }

  void hand_over(const float* input, std::size_t frames, const PaStreamCallbackTimeInfo& time, bool overflowed) {
    if (input == nullptr) return;
    // PortAudio's own clock is not ours: it is only used for the age of the first frame at the converter. Some sound
    // systems report nothing, or nonsense; then the buffer is taken to have just become full.
    const double duration_s = static_cast<double>(frames) / rate_hz_;
    double age_s = time.currentTime - time.inputBufferAdcTime;
    if (!(time.inputBufferAdcTime > 0.0) || !(age_s >= duration_s) || age_s > duration_s + kBelievableLatency_s) {
      age_s = duration_s;
    }
    const auto now_ns = now_().time_since_epoch().count();
    const double begin_ns = -1e9 * age_s;

    // How many frames an overflow lost is not reported: the worker's clock finds it; here one is counted, so that it
    // shows.
    std::uint32_t lost = overflowed ? 1U : 0U;
    for (std::size_t done = 0; done < frames;) {
      const std::size_t count = std::min(frames - done, kAudioBlockFrames);
      done += count;
      frame_ += count;
      block_.frames = static_cast<std::uint32_t>(count);
      block_.end_frame = frame_;
      block_.end_mono_ns = now_ns + static_cast<std::int64_t>(begin_ns + 1e9 * static_cast<double>(done) / rate_hz_);
      block_.lost_frames = lost + dropped_;
      std::copy_n(input + (done - count) * channels_, count * channels_, block_.samples.begin());
      if (ring_.push(block_)) {
        dropped_ = 0;
        lost = 0;
      } else {
        dropped_ += static_cast<std::uint32_t>(count);
      }
    }
  }

  bool is_begun_ = false;
  PaStream* stream_ = nullptr;
  std::function<MonoTime()> now_;
  std::size_t channels_ = 1;
  double rate_hz_ = 0.0;
  SpscRing<AudioBlock> ring_{kWaitingBlocks};

  // The sound system's thread alone.
  AudioBlock block_;
  std::uint64_t frame_ = 0;
  std::uint32_t dropped_ = 0;
};

}  // namespace

std::unique_ptr<AudioInput> make_portaudio_input() {
  return std::make_unique<PortaudioInput>();
}

}  // namespace yuragi::drivers::bus
