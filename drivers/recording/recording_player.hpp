#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "drivers/sensor/sensor.hpp"
#include "drivers/windlog/windlog_player.hpp"

namespace yuragi::drivers::recording {

/// A request to a recording that plays.
struct PlayerOrder {
  enum class Kind : std::uint8_t { kPause, kResume, kStep, kSeek, kRate };
  Kind kind = Kind::kPause;
  std::uint64_t count = 1;  ///< kStep: this many readings
  std::string place = {};   ///< kSeek: as windlog::Player::seek() takes it
  double rate = 1.0;        ///< kRate: above 0
};

/// The status of a recording that plays.
struct PlayerReport {
  std::string file;
  std::optional<windlog::PlayerPosition> position;  ///< nullopt until it has been opened
  std::string failure = {};                         ///< why it cannot be read at present; empty: it can
  std::uint64_t orders_done = 0;                    ///< carried out or refused
  std::string refusal;                              ///< why the last order was not carried out; empty: it was
};

/// The controls of a sensor that plays a recording: such a Sensor is one of these, too. Thread-safe: yes; orders are
/// carried out on the sensor's thread, by its next poll().
class Player {
 public:
  virtual ~Player() = default;

  /// Before the first poll(): begins this many seconds of the clock early, so that the scenes have settled in its wind
  /// by its proper beginning (PlayerOptions::lead_s). Not if it begins paused.
  virtual void begin_early(double lead_s) = 0;

  /// Queues an order and returns its number, counted from 1; nullopt if the queue is full.
  virtual std::optional<std::uint64_t> order(const PlayerOrder& order) = 0;

  /// As of the last poll().
  virtual PlayerReport report() const = 0;
};

/// A sensor that plays a recording, and is a Player, too. The file is opened by its first poll().
std::unique_ptr<sensor::Sensor> play_recording(std::filesystem::path file, windlog::PlayerOptions options);

}  // namespace yuragi::drivers::recording
