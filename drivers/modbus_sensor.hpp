#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "drivers/bus/backoff.hpp"
#include "drivers/bus/modbus_connection.hpp"
#include "drivers/modbus_profile.hpp"
#include "drivers/sensor.hpp"

namespace yuragi {

/// A wind sensor of one or two Modbus slaves, asked in rounds: the speed, then the direction, one exchange a poll().
///
/// Each round publishes one reading at most, timed when the speed arrived. Without a speed there is none; without a
/// direction it goes without. A vane that does not answer is asked less and less often, so that it cannot slow the
/// speed down. A connection that fails, or on which three requests in a row met silence, is opened again, for ever,
/// after waits that double from 0.25 s up to 10 s.
class ModbusSensor final : public Sensor {
 public:
  /// `where` names the line, for people. `seed` makes the waits of several sensors differ.
  ModbusSensor(ModbusProfile profile, ModbusFraming framing, std::string where, std::uint32_t seed,
               std::unique_ptr<ModbusConnection> connection);

  MonoTime poll(const Clock& clock, SensorSink& sink) override;
  void interrupt() noexcept override { connection_->interrupt(); }

 private:
  enum class Step : std::uint8_t { kSpeed, kDirection };
  /// The registers, or what to tell people about their absence (which has been counted).
  using Answer = Result<ModbusRegisters, Failure>;

  MonoTime open(const Clock& clock, SensorSink& sink);
  MonoTime ask_speed(const Clock& clock, SensorSink& sink);
  MonoTime ask_direction(const Clock& clock, SensorSink& sink);
  Answer ask(ModbusRequest request, SensorSink& sink);
  Failure fail(BusStatus status, std::uint8_t unit, bool heard_others, SensorSink& sink);
  Failure refuse(const ModbusRefusal& refusal, std::uint8_t unit, SensorSink& sink);

  void take_direction(std::span<const std::uint16_t> registers, SensorSink& sink);
  MonoTime end_round(MonoTime now, SensorSink& sink);
  MonoTime next_round(MonoTime now);
  void tell(SensorSink& sink, LinkState state, const std::string& detail);
  std::string name_of_slave(std::uint8_t unit) const;

  ModbusProfile profile_;
  ModbusFraming framing_;
  std::string where_;
  std::unique_ptr<ModbusConnection> connection_;
  ModbusRequest speed_request_;                     ///< also brings the direction, if both can be read at once
  std::optional<ModbusRequest> direction_request_;  ///< a request of its own

  Backoff reopen_backoff_;
  Backoff direction_backoff_;
  MonoTime next_poll_{};
  MonoTime next_direction_{};
  MonoTime believe_from_{};  ///< the end of the warm-up
  MonoTime round_start_{};
  Step step_ = Step::kSpeed;
  WindReading reading_;  ///< of the round that is under way
  std::uint16_t transaction_ = 0;
  int silent_requests_ = 0;  ///< in a row

  LinkState told_state_ = LinkState::kConnecting;
  std::string told_detail_;
  std::string direction_trouble_;  ///< why the readings come without direction; empty if they do not
  std::array<std::uint8_t, kModbusMaxMessage> buffer_{};
};

}  // namespace yuragi
