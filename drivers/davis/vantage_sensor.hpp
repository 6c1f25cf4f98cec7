#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "drivers/bus/byte_port.hpp"
#include "drivers/decode/davis/vantage_assembler.hpp"
#include "drivers/sensor/reopening_sensor.hpp"
#include "engine/base/parameter.hpp"

namespace yuragi::drivers::davis {

/// Which packets a console is asked for.
enum class VantagePackets : std::uint8_t {
  kAuto,   ///< LOOP2, or LOOP if the console does not support it
  kLoop,   ///< by the command LOOP
  kLoop2,  ///< by the command LPS
};

struct VantageSettings {
  bus::BytePortAddress address;
  VantagePackets packets = VantagePackets::kAuto;
};

/// The values of kDavisDriver's parameters. Throws std::runtime_error if they cannot work together.
VantageSettings vantage_settings_of(const ParameterValues& values);

/// A console of a Davis station. It is woken, and asked for its rain collector and for a number of packets; before the
/// last of them it is woken and asked again. So a console that is no longer asked soon stops, which saves its battery.
class VantageSensor final : public sensor::ReopeningSensor {
 public:
  VantageSensor(const VantageSettings& settings, std::unique_ptr<bus::BytePort> port);
  ~VantageSensor() override;
  VantageSensor(const VantageSensor&) = delete;
  VantageSensor& operator=(const VantageSensor&) = delete;

  void interrupt() noexcept override { port_->interrupt(); }

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override;
  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) override;
  void close() noexcept override;

 private:
  /// The dialogue: waking, asking for the setup once after each opening, asking for packets, receiving them.
  enum class Phase : std::uint8_t { kWake, kSetup, kAsk, kReceive };

  void enter(Phase phase, MonoTime now);
  bool send_request(MonoTime now, sensor::Sink& sink);
  std::string request() const;
  void drop_old_input();
  Result<void, Failure> take(decode::ByteSpan bytes, const Instant& now, sensor::Sink& sink);
  Result<void, Failure> take_reply(decode::ByteSpan bytes, const Instant& now, sensor::Sink& sink);
  void take_setup(decode::ByteSpan reply, MonoTime now, sensor::Sink& sink);
  void take_packets(decode::ByteSpan bytes, const Instant& now, sensor::Sink& sink);
  void take_packet(decode::ByteSpan packet, const Instant& now, sensor::Sink& sink);
  Result<void, Failure> give_up_reply(MonoTime now, sensor::Sink& sink);
  Result<void, Failure> give_up_asking(MonoTime now);
  Result<void, Failure> doubt_packets(MonoTime now, sensor::Sink& sink);

  VantageSettings settings_;
  std::string where_;
  std::unique_ptr<bus::BytePort> port_;
  std::array<std::uint8_t, 512> buffer_{};

  Phase phase_ = Phase::kWake;
  bool awaits_reply_ = false;
  MonoTime next_request_{};
  MonoTime reply_due_{};
  std::array<std::uint8_t, 8> reply_{};
  std::size_t reply_size_ = 0;
  int wake_tries_ = 0;
  int vain_requests_ = 0;  ///< requests for packets since the last packet

  bool asks_for_loop2_ = true;
  bool has_asked_for_setup_ = false;
  std::optional<double> rain_of_a_tip_mm_;

  decode::davis::VantageAssembler assembler_;
  int packets_left_ = 0;
  bool has_damaged_packets_ = false;  ///< since the last good one
  MonoTime last_bytes_{};
  MonoTime last_packet_{};
  MonoTime last_reading_{};
};

}  // namespace yuragi::drivers::davis
