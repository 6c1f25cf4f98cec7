#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/modbus/modbus_bus.hpp"
#include "drivers/modbus/modbus_plan.hpp"
#include "drivers/modbus/modbus_profile.hpp"
#include "drivers/sensor/reopening_sensor.hpp"

namespace yuragi::drivers::modbus {

/// A wind sensor of one or two Modbus slaves, read in rounds, one exchange per poll(): the speed, then what did not
/// come along with it (direction, gust).
///
/// Each round publishes one reading at most, timed when the speed arrived. Without a speed there is none; without a
/// direction or gust it goes without. A slave that gives no valid reply (silence, damaged bytes, another
/// protocol, an exception) gets fewer requests, so that it neither slows the others down nor is flooded itself: after
/// waits that double from 0.25 s up to 10 s, until the next valid reply.
///
/// The station's other quantities are published once in the profile's `quantities_interval`. Those that stand beside
/// the wind come along with it; the others are asked for in that round, after its wind has been published, and, if no
/// valid reply comes, after waits that double up to 10 minutes.
class Sensor final : public sensor::ReopeningSensor {
 public:
  /// `direction_bus`: the vane's own line; nullptr if it is on the same. `seed` makes the waits of several sensors
  /// differ.
  Sensor(Profile profile, std::shared_ptr<Bus> bus, const std::shared_ptr<Bus>& direction_bus, std::uint32_t seed);

  void interrupt() noexcept override;

 protected:
  Result<MonoTime, Failure> open(const sensor::Clock& clock) override;
  Result<MonoTime, Failure> work(const sensor::Clock& clock, sensor::Sink& sink) override;
  /// The line can be shared: the bus itself closes it when it has failed.
  void close() noexcept override {}

 private:
  /// One of the requests of a round.
  struct Read {
    RegisterRead what;
    Bus* bus;
    platform::Backoff backoff;
    MonoTime not_before{};  ///< after a missing reply: no request before this
    std::string trouble;    ///< why the readings come without it; empty if they do not
  };

  Result<MonoTime, Failure> read_first(const sensor::Clock& clock, sensor::Sink& sink);
  void read_more(Read& read, const sensor::Clock& clock, sensor::Sink& sink);
  Bus::Reply exchange(const Read& read, const sensor::Clock& clock, sensor::Sink& sink);
  /// The next read of this round that is due, or the end of the round.
  MonoTime go_on(const Instant& now, sensor::Sink& sink);
  void publish_wind(sensor::Sink& sink);
  MonoTime end_round(const Instant& now, sensor::Sink& sink);
  MonoTime next_round(MonoTime now) const;

  void take(Read& read, const decode::modbus::Registers& registers, sensor::Sink& sink);
  void take_direction(Read& read, std::span<const std::uint16_t> registers, sensor::Sink& sink);
  void take_gust(Read& read, std::span<const std::uint16_t> registers, sensor::Sink& sink);
  /// A model without that instrument marks the value as none, which is no fault.
  void take_station(const StationQuantity& station, std::span<const std::uint16_t> registers, sensor::Sink& sink);
  std::string explain(const Read& read, const Trouble& trouble) const;

  const Profile profile_;
  const std::shared_ptr<Bus> bus_;
  const std::shared_ptr<Bus> direction_bus_;
  bus::Interruption interruption_;
  std::vector<Read> reads_;     ///< the first one reads the speed
  std::size_t wind_reads_ = 0;  ///< number of them that have the wind; the others have only other quantities

  MonoTime opened_at_{};
  MonoTime round_start_{};
  std::size_t step_ = 0;   ///< which of the reads is next
  wind::Reading reading_;  ///< of the present round

  MonoTime quantities_due_{};
  bool takes_quantities_ = false;       ///< in the present round
  wind::StationQuantities quantities_;  ///< of the present round
};

}  // namespace yuragi::drivers::modbus
