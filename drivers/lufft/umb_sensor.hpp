#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "drivers/bus/byte_port.hpp"
#include "drivers/decode/lufft/umb_assembler.hpp"
#include "drivers/sensor/reopening_sensor.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::drivers::lufft {

struct UmbSettings {
  bus::BytePortAddress address;
  std::uint16_t device = 0;        ///< its address on the line (decode::lufft::umb_address)
  Nanoseconds poll_interval{};     ///< from request to request
  Nanoseconds response_timeout{};  ///< at most the poll interval
};

/// The values of kUmbDriver's parameters. Throws std::runtime_error if they cannot work together.
UmbSettings umb_settings_of(const ParameterValues& values);

/// A device of Lufft's that is asked for its channels, again and again.
class UmbSensor final : public sensor::ReopeningSensor {
 public:
  UmbSensor(const UmbSettings& settings, std::unique_ptr<bus::BytePort> port);

  void interrupt() noexcept override { port_->interrupt(); }

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override;
  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) override;
  void close() noexcept override { port_->close(); }

 private:
  bool ask(MonoTime now, sensor::Sink& sink);
  void drop_old_input();
  void take(decode::ByteSpan bytes, const Instant& now, sensor::Sink& sink);
  void take_frame(decode::ByteSpan frame, const Instant& now, sensor::Sink& sink);
  void take_reply(const decode::lufft::UmbReply& reply, const Instant& now, sensor::Sink& sink);
  void refuse(decode::Refusal why, const std::string& trouble, sensor::Sink& sink);
  Result<void, Failure> give_up_reply(MonoTime now, sensor::Sink& sink);
  std::string silence_trouble() const;

  UmbSettings settings_;
  std::string name_;   // of the device, for people
  std::string where_;  // of the port
  std::unique_ptr<bus::BytePort> port_;
  std::array<std::uint8_t, 512> buffer_{};
  decode::lufft::UmbAssembler assembler_;

  bool asks_for_all_ = true;  // all channels are read, not only those of the wind
  bool awaits_reply_ = false;
  MonoTime next_request_{};
  MonoTime reply_due_{};
  int vain_requests_ = 0;  // since a reply came
  MonoTime last_reading_{};
  std::string trouble_;    // why there are no readings
  bool is_there_ = false;  // it replies, but has no wind
};

}  // namespace yuragi::drivers::lufft
