#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/bus/byte_port.hpp"
#include "drivers/decode/text/line_assembler.hpp"
#include "drivers/sensor/reading_limit.hpp"
#include "drivers/sensor/reopening_sensor.hpp"
#include "drivers/sensor/value_selection.hpp"
#include "drivers/text/arrival_watch.hpp"
#include "engine/wind/station_quantities.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::drivers::text {

/// How a device that sends lines of text is read.
struct SensorSettings {
  bus::BytePortAddress address;
  decode::text::LineEnding ending = decode::text::LineEnding::kNewline;
  std::size_t longest_line = decode::text::LineAssembler::kMaxLine;  ///< longer ones are refused
  bool doubts_first_line = false;                                    ///< the first line may lack its beginning
  Nanoseconds delay_after_open{};                                    ///< messages before that are discarded
  Nanoseconds silence_timeout{};   ///< after which the device is opened again; zero: from its usual pauses
  double play_rate_hz = 0.0;       ///< of a file that is played
  std::string greeting;            ///< what to send once after opening, if the transport can send
  std::string request;             ///< what to send for one reply
  Nanoseconds poll_interval{};     ///< zero: the device sends without requests
  Nanoseconds response_timeout{};  ///< at most the poll interval
};

/// What a sensor of such settings reads: `own` are the driver's parts, to which senders and the request are added.
sensor::ValueSelection text_selection(const SensorSettings& settings, std::vector<sensor::SelectedPart> own);

/// A device that sends one line per reading, by itself or on request. This base assembles lines from the bytes, sends
/// requests, detects silence and invalid lines, and reports them; a driver decodes a line.
class Sensor : public sensor::ReopeningSensor {
 public:
  void interrupt() noexcept final { port_->interrupt(); }

 protected:
  /// Decodes a line: a reading, or nothing to publish for now, or a refusal.
  using Judgement = Result<std::optional<wind::Reading>, decode::Refusal>;

  Sensor(const SensorSettings& settings, std::unique_ptr<bus::BytePort> port);

  virtual Judgement judge(std::string_view line, const Instant& now) = 0;
  /// Returns the other quantities in a line, with or without a wind; the caller sets their time.
  virtual std::optional<wind::StationQuantities> quantities_of(std::string_view /*line*/) const { return {}; }
  /// After a pause that ends a burst of messages: a reading that was held until then.
  virtual std::optional<wind::Reading> take_held() { return {}; }
  /// The device was opened again: forget the messages before.
  virtual void begin() {}
  /// What the device is, for people.
  virtual std::string name() const = 0;
  /// The driver of the configuration: "nmea".
  virtual std::string_view driver() const = 0;
  /// Returns a trouble that the device itself reports, and what to do; empty: none. Reported before the causes that its
  /// silence or its lines suggest.
  virtual std::string reported_trouble() const { return {}; }
  /// Lines come, but all are refused like this one: what is wrong, and what to do.
  virtual std::string advice(decode::Refusal why, std::string_view line) const;

  const SensorSettings& settings() const noexcept { return settings_; }

 private:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) final;
  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) final;
  void close() noexcept final;

  bool is_polled() const noexcept { return settings_.poll_interval > Nanoseconds::zero(); }
  bool is_played() const noexcept;
  /// Serial or TCP: bytes follow each other, and can be sent.
  bool is_connection() const noexcept;
  bool can_send() const noexcept;
  bool greet(sensor::Sink& sink);
  bool request_if_due(MonoTime now, sensor::Sink& sink);
  void give_up_reply(MonoTime now, sensor::Sink& sink);
  Nanoseconds longest_read(MonoTime now) const;

  /// Splits received bytes into lines. Returns whether a reading was published, after which a file that is played has
  /// to wait.
  bool take_bytes(const Instant& now, sensor::Sink& sink);
  bool take_line(std::string_view line, const Instant& now, sensor::Sink& sink);
  void take_broken_line(decode::Refusal why, std::span<const std::uint8_t> end, sensor::Sink& sink);
  void drop_cut_line(sensor::Sink& sink);
  void publish(const wind::Reading& reading, sensor::Sink& sink);
  void refuse(decode::Refusal why, std::string_view line, sensor::Sink& sink);

  Nanoseconds silence_limit() const;
  void judge_device(MonoTime now, sensor::Sink& sink);
  decode::Refusal main_refusal() const;
  std::string silence_trouble() const;
  std::string trouble_without_lines() const;

  SensorSettings settings_;
  std::string where_;
  std::unique_ptr<bus::BytePort> port_;
  decode::text::LineAssembler assembler_;
  std::vector<std::uint8_t> buffer_;
  std::span<const std::uint8_t> rest_;  // of the buffer: not processed yet
  bool ends_with_rest_ = false;         // rest_ is the end of a datagram
  bool is_fresh_ = false;
  bool is_greeted_ = false;
  bool skips_line_ = false;
  bool is_finished_ = false;

  bool awaits_reply_ = false;
  MonoTime next_request_{};
  MonoTime reply_due_{};
  int missed_replies_ = 0;

  MonoTime last_bytes_{};
  ArrivalWatch readings_;
  sensor::ReadingLimit limit_;  ///< UDP and CAN: anybody can send
  int vain_openings_ = 0;

  // Received since the last reading: to report the cause if none follows.
  struct Refused {
    std::size_t count = 0;
    std::string first_line;
  };
  std::array<Refused, decode::kRefusalCount> refused_{};
  std::size_t bytes_ = 0;
  std::size_t readable_lines_ = 0;
  std::size_t cut_lines_ = 0;  // without their end: it was not received
  std::size_t garbled_lines_ = 0;
  std::size_t foreign_datagrams_ = 0;
  std::size_t late_lines_ = 0;
};

/// The beginning of a line for the status, with unprintable characters replaced.
std::string shown(std::string_view line);

/// Returns true if every byte is one of text, including NUL, STX, ETX, tab and the degree sign of UTF-8 and Latin-1.
bool is_text(std::string_view line) noexcept;

}  // namespace yuragi::drivers::text
