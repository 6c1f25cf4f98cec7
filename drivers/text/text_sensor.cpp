#include "drivers/text/text_sensor.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "drivers/bus/sender_filter.hpp"
#include "drivers/text/driver_of_line.hpp"
#include "engine/base/printable_text.hpp"

namespace yuragi::drivers::text {
namespace {

using namespace std::chrono_literals;

/// A read returns at least this often, so that timeouts are checked.
constexpr Nanoseconds kMaxRead = 200ms;
/// The messages of one burst follow each other faster.
constexpr Nanoseconds kBurstEnd = 200ms;
/// The bytes of one line follow each other faster; a line that pauses for longer was cut off.
constexpr Nanoseconds kLineCut = 500ms;
/// Without a reading for this time, or for five times the usual pause, something is wrong.
constexpr Nanoseconds kPatience = 3s;
/// A device whose usual pause is not known yet is opened again after this.
constexpr Nanoseconds kFirstSilence = 120s;
/// A reply that is later than this is not expected any more.
constexpr Nanoseconds kLatestReply = 2s;
/// Maximum number of doublings of the silence after which a device is opened again.
constexpr int kMaxDoublings = 6;
/// A device that does not reply gets fewer requests: the interval grows up to this many times.
constexpr int kRarestRequest = 8;
/// So many blocks at most are discarded at the beginning; a device that sends more does not stop.
constexpr int kForgottenBlocks = 64;
constexpr std::size_t kShownOfLine = 60;
constexpr Nanoseconds kForAges = 1h;

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

std::string shown(std::string_view line) {
  std::string text(line.substr(0, kShownOfLine));
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c == '\x7f'; }, '.');
  return text;
}

bool is_text(std::string_view line) noexcept {
  constexpr std::string_view kOthers("\0\x02\x03\t", 4);
  constexpr char kDegreeSign = '\xB0';  // in Latin-1; in UTF-8 it is the second of two bytes
  constexpr char kBeforeIt = '\xC2';
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    const bool begins_degree_sign = c == kBeforeIt && i + 1 < line.size() && line[i + 1] == kDegreeSign;
    if ((c < ' ' || c > '~') && c != kDegreeSign && !begins_degree_sign && kOthers.find(c) == std::string_view::npos)
      return false;
  }
  return true;
}

sensor::ValueSelection text_selection(const SensorSettings& settings, std::vector<sensor::SelectedPart> own) {
  std::string request = settings.poll_interval > Nanoseconds::zero() ? settings.request : "";
  make_printable(request);
  const bool has_senders = settings.address.kind == bus::BytePortKind::kUdp;
  own.push_back({.key = "sender", .value = has_senders ? settings.address.senders : "", .covers = bus::senders_cover});
  own.push_back({.key = "request", .value = std::move(request)});
  return sensor::selection_at(settings.address, std::move(own));
}

Sensor::Sensor(const SensorSettings& settings, std::unique_ptr<bus::BytePort> port)
    : sensor::ReopeningSensor(sensor::seed_of(describe(settings.address))),
      settings_(settings),
      where_(describe(settings.address)),
      port_(std::move(port)),
      assembler_(settings.ending, settings.longest_line),
      buffer_(bus::kMaxDatagram) {
  settings_.response_timeout = std::min(settings_.response_timeout, settings_.poll_interval);
}

bool Sensor::is_played() const noexcept {
  return settings_.address.kind == bus::BytePortKind::kFile && settings_.address.is_played;
}

Result<MonoTime, Failure> Sensor::open(const sensor::Clock& clock) {
  if (const auto opened = port_->open(); !opened) return opened.error();
  const MonoTime now = clock.now().mono;
  is_fresh_ = settings_.delay_after_open > 0ns;
  is_greeted_ = settings_.greeting.empty() || !can_send();
  skips_line_ = settings_.doubts_first_line;
  awaits_reply_ = false;
  next_request_ = now;
  last_bytes_ = now;
  readings_.restart(now);
  bytes_ = readable_lines_ = cut_lines_ = garbled_lines_ = foreign_datagrams_ = late_lines_ = 0;
  refused_ = {};
  begin();
  return now + settings_.delay_after_open;
}

void Sensor::close() noexcept {
  port_->close();
  assembler_.clear();
  rest_ = {};
}

Result<MonoTime, Failure> Sensor::work(const sensor::Clock& clock, sensor::Sink& sink) {
  if (is_finished_) return clock.now().mono + kForAges;
  if (std::exchange(is_fresh_, false)) {
    for (int i = 0; i < kForgottenBlocks && port_->read(buffer_, 0ns).status == bus::ByteStatus::kBytes; ++i) {
    }
  }
  if (!std::exchange(is_greeted_, true) && !greet(sink))
    return Failure{where_ + " does not accept messages: reopening it"};
  if (is_polled() && !request_if_due(clock.now().mono, sink))
    return Failure{where_ + " does not accept requests: reopening it"};

  // Read the next bytes, unless some of a played file are left.
  bus::ByteArrival arrival{bus::ByteStatus::kBytes};
  if (rest_.empty()) {
    arrival = port_->read(buffer_, longest_read(clock.now().mono));
    if (arrival.overrun > 0) sink.refused(decode::Refusal::kOverrun, arrival.overrun);
    if (arrival.status == bus::ByteStatus::kBytes) {
      rest_ = std::span(buffer_).first(arrival.size);
      ends_with_rest_ = arrival.is_whole_datagram;
    }
  }

  const Instant now = clock.now();
  switch (arrival.status) {
    case bus::ByteStatus::kInterrupted:
      return now.mono;
    case bus::ByteStatus::kLost:
      return Failure{where_ + " is gone: it is reopened when it is back; check its plug, its power and the network"};
    case bus::ByteStatus::kEnd:
      if (const auto line = assembler_.finish()) take_line(**line, now, sink);
      if (const auto held = take_held()) publish(*held, sink);
      is_finished_ = true;
      report_finished(sink, where_ + " has been read to its end");
      return now.mono + kForAges;
    case bus::ByteStatus::kForeign:
      ++foreign_datagrams_;
      last_bytes_ = now.mono;
      sink.refused(decode::Refusal::kNotMine);
      break;
    case bus::ByteStatus::kSilence:
      if (now.mono - last_bytes_ >= kBurstEnd) {
        if (const auto held = take_held()) publish(*held, sink);
      }
      break;
    case bus::ByteStatus::kBytes:
      if (take_bytes(now, sink)) return now.mono + from_seconds(1.0 / settings_.play_rate_hz);
      break;
  }

  // Only after all received bytes have been read.
  if (awaits_reply_ && now.mono >= reply_due_) give_up_reply(now.mono, sink);
  if (!is_played() && now.mono - last_bytes_ >= silence_limit()) {
    sink.refused(decode::Refusal::kTimeout);
    vain_openings_ = std::min(vain_openings_ + 1, kMaxDoublings);
    return Failure{fmt::format("{} has been silent for {:.0f} s: reopening it; check the device's power and cable",
                               where_, seconds(now.mono - last_bytes_))};
  }
  judge_device(now.mono, sink);
  return now.mono;
}

bool Sensor::is_connection() const noexcept {
  return settings_.address.kind == bus::BytePortKind::kSerial ||
         settings_.address.kind == bus::BytePortKind::kTcpClient;
}

bool Sensor::can_send() const noexcept {
  return is_connection() || settings_.address.kind == bus::BytePortKind::kWebSocket;
}

/// Returns false if the port is lost.
bool Sensor::greet(sensor::Sink& sink) {
  if (!port_->write(bytes_of(settings_.greeting))) return false;
  sink.raw(sensor::RawDirection::kSent, bytes_of(settings_.greeting));
  return true;
}

/// Returns false if the port is lost.
bool Sensor::request_if_due(MonoTime now, sensor::Sink& sink) {
  if (awaits_reply_ || now < next_request_) return true;
  drop_cut_line(sink);
  if (!port_->write(bytes_of(settings_.request))) return false;
  sink.raw(sensor::RawDirection::kSent, bytes_of(settings_.request));
  awaits_reply_ = true;
  reply_due_ = now + settings_.response_timeout;
  next_request_ = now + settings_.poll_interval;
  return true;
}

/// The next request waits until a late reply has passed, which must not be taken for the next one.
void Sensor::give_up_reply(MonoTime now, sensor::Sink& sink) {
  awaits_reply_ = false;
  missed_replies_ = std::min(missed_replies_ + 1, kRarestRequest);
  next_request_ = now + std::max<Nanoseconds>(kLatestReply, missed_replies_ * settings_.poll_interval);
  refuse(decode::Refusal::kTimeout, "", sink);
}

Nanoseconds Sensor::longest_read(MonoTime now) const {
  if (!is_polled()) return kMaxRead;
  const MonoTime due = awaits_reply_ ? reply_due_ : next_request_;
  return std::clamp<Nanoseconds>(due - now, 0ns, kMaxRead);
}

bool Sensor::take_bytes(const Instant& now, sensor::Sink& sink) {
  // On a line in which bytes follow each other, a pause within a line means that its end is missing. Files and pipes
  // come in blocks that end anywhere, and datagrams end by themselves.
  const bool flows = is_connection();
  if (flows && now.mono - last_bytes_ >= kLineCut) drop_cut_line(sink);
  last_bytes_ = now.mono;

  bool has_published = false;
  while (!rest_.empty() && !has_published) {
    const std::span<const std::uint8_t> before = rest_;
    const auto line = assembler_.next(rest_);
    const auto taken = before.first(before.size() - rest_.size());
    bytes_ += taken.size();
    if (line && !*line) {
      take_broken_line(line->error(), taken, sink);
    } else if (line) {
      has_published = take_line(**line, now, sink) && is_played();
    }
  }
  if (rest_.empty() && ends_with_rest_) {
    if (const auto line = assembler_.finish()) take_line(**line, now, sink);
  }
  return has_published;
}

/// Takes a line that was too long, or was cut off by the next one; only its last bytes are kept.
void Sensor::take_broken_line(decode::Refusal why, std::span<const std::uint8_t> end, sensor::Sink& sink) {
  if (std::exchange(skips_line_, false)) return;
  ++(why == decode::Refusal::kTooShort ? cut_lines_ : garbled_lines_);
  sink.raw(sensor::RawDirection::kReceived, end);
  refuse(why, "", sink);
}

bool Sensor::take_line(std::string_view line, const Instant& now, sensor::Sink& sink) {
  if (std::exchange(skips_line_, false)) return false;
  sink.raw(sensor::RawDirection::kReceived, bytes_of(line));
  if (is_polled() && !awaits_reply_) {
    ++late_lines_;
    refuse(decode::Refusal::kNotMine, line, sink);
    return false;
  }

  if (auto quantities = quantities_of(line)) {
    quantities->time = now;
    sink.quantities(*quantities);
  }
  const Judgement judgement = judge(line, now);
  if (!judgement) {
    const bool is_readable = is_text(line);
    ++(is_readable ? readable_lines_ : garbled_lines_);
    // A foreign line may be our own request, echoed by a line with one pair of wires: the reply is still to come.
    if (judgement.error() != decode::Refusal::kNotMine) awaits_reply_ = false;
    refuse(is_readable ? judgement.error() : decode::Refusal::kMalformed, line, sink);
    return false;
  }
  awaits_reply_ = false;
  missed_replies_ = 0;
  if (*judgement) publish(**judgement, sink);
  return judgement->has_value();
}

/// Refuses the received part of an incomplete line.
void Sensor::drop_cut_line(sensor::Sink& sink) {
  const auto cut = assembler_.finish();
  if (!cut) return;
  sink.raw(sensor::RawDirection::kReceived, bytes_of(**cut));
  if (std::exchange(skips_line_, false)) return;
  ++cut_lines_;
  refuse(decode::Refusal::kTooShort, **cut, sink);
}

void Sensor::publish(const wind::Reading& reading, sensor::Sink& sink) {
  const bool can_flood =
      settings_.address.kind == bus::BytePortKind::kUdp || settings_.address.kind == bus::BytePortKind::kCan;
  if (can_flood && !limit_.admits(reading.time.mono)) return sink.refused(decode::Refusal::kTooFrequent);
  readings_.arrive(reading.time.mono);
  vain_openings_ = 0;
  bytes_ = readable_lines_ = cut_lines_ = garbled_lines_ = foreign_datagrams_ = late_lines_ = 0;
  refused_ = {};
  report_connected(sink, name() + " at " + where_);
  sink.reading(reading);
}

void Sensor::refuse(decode::Refusal why, std::string_view line, sensor::Sink& sink) {
  Refused& refused = refused_[static_cast<std::size_t>(why)];
  if (refused.count++ == 0) refused.first_line = line;
  sink.refused(why);
}

/// Each opening without a reading doubles the limit: so a device that is slow at first, or that restarts whenever it is
/// opened, gets enough time in the end.
Nanoseconds Sensor::silence_limit() const {
  if (settings_.silence_timeout > 0ns) return settings_.silence_timeout;
  const Nanoseconds usual = readings_.usual_pause();
  const Nanoseconds first = usual > 0ns ? std::max<Nanoseconds>(2 * kPatience, 10 * usual) : kFirstSilence;
  return first * (1 << vain_openings_);
}

/// Reports the cause if there are no readings.
void Sensor::judge_device(MonoTime now, sensor::Sink& sink) {
  const Nanoseconds patience = std::max<Nanoseconds>(kPatience, 5 * readings_.usual_pause());
  if (readings_.quiet_for(now) < patience) return;
  if (const std::string told = reported_trouble(); !told.empty()) return report_unusable(sink, told);
  if (now - last_bytes_ >= kPatience) return report_unusable(sink, silence_trouble());
  const decode::Refusal why = main_refusal();
  const std::string& line = refused_[static_cast<std::size_t>(why)].first_line;
  const bool has_lines = readable_lines_ + cut_lines_ > 0 && readable_lines_ + cut_lines_ >= garbled_lines_;
  if (late_lines_ > 0 || !has_lines) {
    report_unusable(sink, trouble_without_lines());
  } else if (why == decode::Refusal::kInvalid || why == decode::Refusal::kImplausible) {
    // It is there and sends: whether that is valid is checked elsewhere.
    report_connected(sink, advice(why, line));
  } else if (const auto other = driver_of_line(line); other && *other != driver()) {
    report_unusable(
        sink, fmt::format("lines arrive from {} that the driver {} reads (the first: \"{}\"): set driver = \"{}\"",
                          where_, *other, shown(line), *other));
  } else {
    report_unusable(sink, advice(why, line));
  }
}

/// The reason why most lines were refused: lines of other formats count only if there are no others.
decode::Refusal Sensor::main_refusal() const {
  constexpr auto kOthers = static_cast<std::size_t>(decode::Refusal::kNotMine);
  std::size_t most = kOthers;
  for (std::size_t why = 0; why < refused_.size(); ++why) {
    if (why == kOthers || refused_[why].count == 0) continue;
    if (most == kOthers || refused_[why].count > refused_[most].count) most = why;
  }
  return static_cast<decode::Refusal>(most);
}

std::string Sensor::silence_trouble() const {
  std::string_view suspects = "the device's power and network settings";
  if (settings_.address.kind == bus::BytePortKind::kSerial)
    suspects = "the device's power, its wires (TX and RX crossed?) and baud";
  if (settings_.address.kind == bus::BytePortKind::kCan)
    suspects = "the power, terminators and bit rate of the bus, and that its device sends (candump)";
  if (settings_.address.kind == bus::BytePortKind::kWebSocket)
    suspects = "that the server has wind data, and whether it requires a token";
  return fmt::format("{} {}: check {}", where_, is_polled() ? "does not reply" : "is open, but silent", suspects);
}

/// Bytes arrive, but no lines.
std::string Sensor::trouble_without_lines() const {
  if (late_lines_ > 0) {
    return fmt::format("{} replies, but not within {:g} s: increase response_timeout", where_,
                       seconds(settings_.response_timeout));
  }
  if (foreign_datagrams_ > 0 && bytes_ == 0) {
    return fmt::format("datagrams arrive at {}, but none from {}: check sender", where_, settings_.address.senders);
  }
  const bool is_serial = settings_.address.kind == bus::BytePortKind::kSerial;
  return fmt::format("bytes arrive from {}, but no lines: check {}", where_,
                     is_serial ? "baud, data_bits and parity" : "that this is the device, and that it sends text");
}

std::string Sensor::advice(decode::Refusal why, std::string_view line) const {
  // Whole lines that are too short have another format; a bad cable also cuts lines.
  if (why == decode::Refusal::kTooShort && cut_lines_ == 0) why = decode::Refusal::kMalformed;
  switch (why) {
    case decode::Refusal::kInvalid:
      return fmt::format("{} reports that it cannot measure (\"{}\"): check the device", where_, shown(line));
    case decode::Refusal::kImplausible:
      return fmt::format("{} sends an impossible wind (\"{}\"): check its unit and its settings", where_, shown(line));
    case decode::Refusal::kBadChecksum:
      return fmt::format("lines arrive from {} with wrong checksums: check its cable and baud", where_);
    case decode::Refusal::kTooShort:
      return fmt::format("lines from {} end too early (\"{}\"): check its cable", where_, shown(line));
    case decode::Refusal::kTimeout:
      return fmt::format("{} does not reply: check its address, and request", where_);
    default:
      return fmt::format("lines arrive from {}, but without wind (the first: \"{}\"): check that the settings match",
                         where_, shown(line));
  }
}

}  // namespace yuragi::drivers::text
