#include "drivers/usb/usb_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace yuragi::drivers::usb {
namespace {

/// A device that hangs looks like one that is slow: after this many rounds in a row without a sample it counts as hung.
constexpr int kRoundsBeforeReopen = 3;
/// Two counts give a speed only if the time between them is at least this many times its uncertainty: to within 20 %.
constexpr int kMinTimesOfDoubt = 5;
constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

}  // namespace

void MeanDirection::add(double direction_deg) {
  east_ += std::sin(direction_deg * kRadiansPerDegree);
  north_ += std::cos(direction_deg * kRadiansPerDegree);
}

std::optional<double> MeanDirection::mean_deg() const {
  constexpr double kCancelled = 1e-6;
  if (std::hypot(east_, north_) < kCancelled) return std::nullopt;
  const double mean_deg = std::atan2(east_, north_) / kRadiansPerDegree;
  const double turned_deg = mean_deg < 0.0 ? mean_deg + 360.0 : mean_deg;
  return turned_deg < 360.0 ? turned_deg : 0.0;  // a tiny negative value rounds up to a whole turn
}

Sensor::Sensor(Settings settings, std::uint32_t seed, std::unique_ptr<bus::UsbDevice> device)
    : sensor::ReopeningSensor(seed), settings_(std::move(settings)), device_(std::move(device)) {}

Sensor::~Sensor() {
  device_->close();
}

Result<MonoTime, Failure> Sensor::open(const sensor::Clock& clock) {
  // Select the device among those plugged in.
  auto plugged = device_->plugged();
  if (!plugged) return plugged.error();
  std::erase_if(*plugged, [this](const bus::PluggedUsbDevice& device) { return !is_wanted(device); });
  if (plugged->empty()) {
    return Failure{fmt::format("{} is not plugged in: plug it in, and check with `yuragi sensors list` or lsusb",
                               name_of_wanted())};
  }

  // Where one cannot be opened or turns out to be another, the next one is tried.
  const bus::PluggedUsbDevice& chosen = (*plugged)[turn_ % plugged->size()];
  const DaqModel& model = model_of(chosen.id);
  if (const std::string wrong = wrong_wiring(model, settings_.wiring); !wrong.empty()) {
    ++turn_;
    return Failure{wrong};
  }
  if (const auto opened = device_->open(chosen); !opened) {
    ++turn_;
    return opened.error();
  }

  name_ = fmt::format("{} at USB port {}{}{}", model.what, chosen.port, chosen.serial.empty() ? "" : ", serial number ",
                      chosen.serial);
  daq_ = model.make(settings_.wiring, settings_.timeout);
  is_started_ = false;
  is_jumpy_ = false;
  failures_ = 0;
  cup_ = {};
  direction_.clear();
  return clock.now().mono;
}

Result<MonoTime, Failure> Sensor::work(const sensor::Clock& clock, sensor::Sink& sink) {
  const MonoTime begin = clock.now().mono;
  if (!is_started_) {
    const auto identity = daq_->start(*device_, sink);
    if (!identity) return suffer(identity.error(), clock.now().mono + settings_.period, sink);
    if (const std::string& serial = identity->serial; !serial.empty()) {
      if (!settings_.serial.empty() && serial != settings_.serial) return wrong_device(serial);
      name_ += ", serial number " + serial;
    }
    is_started_ = true;
  }

  const MonoTime requested_at = clock.now().mono;
  const auto sample = daq_->sample(*device_, sink);
  const Instant now = clock.now();
  const MonoTime next = std::max(begin + settings_.period, now.mono);
  if (!sample) return suffer(sample.error(), next, sink);
  failures_ = 0;
  take(*sample, requested_at, now, sink);
  return next;
}

void Sensor::take(const DaqSample& sample, MonoTime requested_at, Instant now, sensor::Sink& sink) {
  // The device counted at some moment since the request. If bus or scheduler delayed it, the count is kept for the next
  // one: a delayed thread must not appear as a lull or a gust.
  const Nanoseconds doubt = now.mono - requested_at;
  const bool is_too_vague = kMinTimesOfDoubt * (doubt + counted_doubt_) > now.mono - counted_at_;
  if (cup_.last_count && is_too_vague) return;
  counted_doubt_ = doubt;
  const double elapsed_s = seconds(now.mono - std::exchange(counted_at_, now.mono));
  const auto speed_m_s = decode::usb::advance_cup(cup_, settings_.cup, sample.count, elapsed_s);

  // A direction that came with an impossible count is discarded, too.
  if (speed_m_s && !*speed_m_s) {
    sink.refused(speed_m_s->error());
    direction_.clear();
    is_jumpy_ = true;
    return report_unusable(sink, name_ +
                                     " has an impossible count: check whether it was reset, whether the cup's contact "
                                     "bounces, and metres_per_pulse");
  }
  if (sample.wiper_v) {
    const double reference_v = sample.reference_v.value_or(settings_.reference_v);
    if (const auto direction_deg = decode::usb::vane_direction_deg(settings_.vane, *sample.wiper_v, reference_v)) {
      direction_.add(*direction_deg);
    }
  }
  if (speed_m_s) is_jumpy_ = false;
  if (!is_jumpy_) report_connected(sink, name_);
  if (!speed_m_s) return;
  sink.reading({.time = now,
                .speed_m_s = **speed_m_s,
                .direction_deg = direction_.mean_deg(),
                .gust_m_s = std::nullopt,
                .quality = wind::ReadingQuality::kGood});
  direction_.clear();
}

/// There was no sample. The pulses counted meanwhile are in the next one, over the time that has passed.
Result<MonoTime, Failure> Sensor::suffer(const DaqTrouble& trouble, MonoTime again, sensor::Sink& sink) {
  const std::string detail = name_ + " " + trouble.message;
  if (trouble.is_lost || ++failures_ >= kRoundsBeforeReopen) return Failure{detail};
  report_unusable(sink, detail);
  return again;
}

bool Sensor::is_wanted(const bus::PluggedUsbDevice& device) const {
  const bool is_kind = std::ranges::count(settings_.models, device.id, &DaqModel::id) != 0;
  const bool is_there = settings_.port.empty() || device.port == settings_.port;
  // One that shows no serial number on the bus sends it on request.
  const bool may_be_it = settings_.serial.empty() || device.serial.empty() || device.serial == settings_.serial;
  return is_kind && is_there && may_be_it;
}

const DaqModel& Sensor::model_of(const bus::UsbId& id) const {
  return **std::ranges::find(settings_.models, id, &DaqModel::id);
}

std::string Sensor::name_of_wanted() const {
  std::string what;
  for (const DaqModel* const model : settings_.models) {
    what += fmt::format("{}{} ({})", what.empty() ? "" : " or ", model->what, describe(model->id));
  }
  if (!settings_.serial.empty()) what += " with serial number " + settings_.serial;
  if (!settings_.port.empty()) what += " at USB port " + settings_.port;
  return what;
}

Failure Sensor::wrong_device(const std::string& serial) {
  ++turn_;
  return Failure{fmt::format("{} has serial number {}, not {}: plug that one in, or correct `serial`", name_, serial,
                             settings_.serial)};
}

}  // namespace yuragi::drivers::usb
