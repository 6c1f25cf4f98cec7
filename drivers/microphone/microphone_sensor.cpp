#include "drivers/microphone/microphone_sensor.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace yuragi::drivers::microphone {
namespace {

/// A time stamp farther than this from now is of another clock, or wrong.
constexpr Nanoseconds kBelievableAge = std::chrono::seconds(5);

/// A worker that does not start in time gets up to this many times longer: the machine may be slow.
constexpr int kMaxPatience = 8;

}  // namespace

Sensor::Sensor(Settings settings, std::uint32_t seed, std::unique_ptr<bus::BytePort> port)
    : sensor::ReopeningSensor(seed), settings_(std::move(settings)), port_(std::move(port)) {}

Result<MonoTime, Failure> Sensor::open(const sensor::Clock& clock) {
  reader_.clear();
  hello_.reset();
  trouble_.clear();
  if (auto opened = port_->open(); !opened) return opened.error();
  const MonoTime now = clock.now().mono;
  start_timeout_ = settings_.start_timeout * patience_;
  deadline_ = now + start_timeout_;
  return now;
}

void Sensor::close() noexcept {
  port_->close();
}

Result<MonoTime, Failure> Sensor::work(const sensor::Clock& clock, sensor::Sink& sink) {
  const bus::ByteArrival arrival = port_->read(buffer_, std::max(Nanoseconds::zero(), deadline_ - clock.now().mono));
  reader_.push(std::span(buffer_).first(arrival.size));
  while (const auto item = reader_.next()) take(*item, clock, sink);

  const MonoTime now = clock.now().mono;
  switch (arrival.status) {
    case bus::ByteStatus::kBytes:
      if (now < deadline_) return now;
      break;
    case bus::ByteStatus::kSilence:
    case bus::ByteStatus::kForeign:
      break;
    case bus::ByteStatus::kInterrupted:
      return Failure{"interrupted"};
    case bus::ByteStatus::kEnd:
    case bus::ByteStatus::kLost:
      if (!trouble_.empty()) return Failure{trouble_};
      return Failure{
          "the microphone's worker ended without a message: starting it again; `yuragi mic-worker --list --verbose` "
          "may show why"};
  }
  sink.refused(decode::Refusal::kTimeout);
  if (!hello_) patience_ = std::min(2 * patience_, kMaxPatience);
  return Failure{hello_ ? fmt::format("{} has been silent for {:g} s: starting it again", hello_->device,
                                      seconds(settings_.sound_timeout))
                        : fmt::format("the microphone's worker has not started within {:g} s: starting it again",
                                      seconds(start_timeout_))};
}

void Sensor::take(const decode::microphone::MicFrameReader::Item& item, const sensor::Clock& clock,
                  sensor::Sink& sink) {
  if (!item.bytes.empty()) sink.raw(sensor::RawDirection::kReceived, item.bytes);
  if (!item.frame) return sink.refused(item.frame.error());
  const Instant now = clock.now();
  if (const auto* trouble = std::get_if<decode::microphone::MicTrouble>(&*item.frame)) {
    trouble_ = trouble->message;
  } else if (const auto* hello = std::get_if<decode::microphone::MicHello>(&*item.frame)) {
    take(*hello);
    patience_ = 1;
    deadline_ = now.mono + settings_.sound_timeout;
  } else {
    deadline_ = now.mono + settings_.sound_timeout;
    take(std::get<decode::microphone::MicBlock>(*item.frame), now, sink);
  }
}

/// Begins a stream. Estimates from an earlier one (the noise of a calm, automatic gain, gusts) are kept if the format
/// is the same.
void Sensor::take(const decode::microphone::MicHello& hello) {
  if (estimator_ && estimator_->hello() == hello) {
    estimator_->restart();
  } else {
    try {
      estimator_.emplace(settings_.estimator, hello);
    } catch (const std::invalid_argument& error) {
      estimator_.reset();
      trouble_ = error.what();
    }
  }
  hello_ = hello;
}

void Sensor::take(const decode::microphone::MicBlock& block, const Instant& now, sensor::Sink& sink) {
  if (!estimator_) return report_unusable(sink, trouble_);
  const auto estimate = estimator_->add(block);
  if (estimate) {
    if (*estimate) publish(**estimate, block, now, sink);
    return;
  }
  sink.refused(estimate.error());
  if (const auto& twins = estimator_->twins()) {
    return report_unusable(
        sink, fmt::format("{}: channels {} and {} carry the same signal, like a mono input opened as stereo: set "
                          "channels = 1, or choose the input that has all microphones (`yuragi mic-worker --list`)",
                          hello_->device, (*twins)[0] + 1, (*twins)[1] + 1));
  }
  report_unusable(
      sink, fmt::format("{}: {}", hello_->device,
                        estimate.error() == decode::Refusal::kImplausible
                            ? "noise at full scale, which is not wind: check cable, plug and sample format"
                        : block.invalid_samples > 0 ? "invalid samples: check the sample format"
                                                    : "digital silence: check that it is not muted, and its plug"));
}

void Sensor::publish(const decode::microphone::MicEstimate& estimate, const decode::microphone::MicBlock& block,
                     const Instant& now, sensor::Sink& sink) {
  // The block's stamp is of the system's monotonic clock; it is used only if that can be ours.
  const MonoTime end{Nanoseconds(block.end_mono_ns)};
  const bool is_ours = end <= now.mono && now.mono - end < kBelievableAge;
  const Nanoseconds age =
      (is_ours ? now.mono - end : Nanoseconds::zero()) + from_seconds(0.5 * settings_.estimator.window_s);

  const bool is_uncertain = !settings_.is_calibrated || estimate.suspects_automatic_gain || estimate.is_clipping ||
                            estimate.silent_channels != 0;
  report_connected(sink, detail(estimate));
  sink.reading({.time = {.mono = now.mono - age, .utc = now.utc - age},
                .speed_m_s = estimate.speed_m_s,
                .direction_deg = estimate.direction_deg,
                .gust_m_s = estimate.gust_m_s,
                .quality = is_uncertain ? wind::ReadingQuality::kUncertain : wind::ReadingQuality::kGood});
}

/// For people; changes only if the advice changes.
std::string Sensor::detail(const decode::microphone::MicEstimate& estimate) const {
  std::string text = hello_->device;
  if (!settings_.is_calibrated) text += "; not calibrated: set gain and exponent, or curve";
  if (estimate.suspects_automatic_gain) text += "; its level hardly follows the wind: switch automatic gain off";
  if (estimate.is_clipping) text += "; it clips: turn its gain down";
  for (std::size_t channel = 0; channel < hello_->channels; ++channel) {
    if ((estimate.silent_channels >> channel & 1U) != 0) text += fmt::format("; channel {} is dead", channel + 1);
  }
  return text;
}

}  // namespace yuragi::drivers::microphone
