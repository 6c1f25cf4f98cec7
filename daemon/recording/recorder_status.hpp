#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/recording/clock_judge.hpp"

namespace yuragi::daemon::recording {

enum class RecorderState : std::uint8_t {
  kWriting,   ///< no fault
  kRetrying,  ///< writing failed, and is tried again at growing intervals
  kHanging,   ///< the disk has not answered for RecorderLimits::hang_after
};

/// What a recorder does if it cannot open its recording at the start.
enum class RecorderStart : std::uint8_t {
  kMustOpen,  ///< it throws, except if another program records to it
  kRetries,   ///< it is in kRetrying, as if writing had failed later
};

struct RecorderStatus {
  RecorderState state = RecorderState::kWriting;
  std::uint64_t written = 0;                ///< readings committed to the disk
  std::uint64_t waiting = 0;                ///< readings that are not yet written
  std::uint64_t lost = 0;                   ///< readings that were dropped
  std::uint64_t recorded_elsewhere = 0;     ///< readings left to another program that recorded to the same file
  std::string error;                        ///< why it cannot write at present, and since when; empty while it can
  std::optional<std::uint64_t> free_bytes;  ///< on the recording's disk, for this user; nullopt if it is not known
  std::optional<ClockDoubt> clock_doubt;    ///< while it lasts, age deletes nothing
};

}  // namespace yuragi::daemon::recording
