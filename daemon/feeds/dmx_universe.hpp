#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "daemon/feeds/component_id.hpp"
#include "daemon/feeds/datagram_target.hpp"
#include "daemon/feeds/e131_packet.hpp"
#include "daemon/settings/feeds/dmx.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::feeds {

/// Sends the levels of one universe to its receivers. Never waits. Thread-safe: no.
class DmxUniverse {
 public:
  /// `index`: counted from the feed's first universe.
  DmxUniverse(const settings::feeds::Dmx& feed, std::size_t index, const ComponentId& component);

  /// Sends the levels if they have changed or have been sent fewer than three times since, and otherwise each 0.9 s
  /// (E1.31 6.6.2 and Art-Net: every 0.8 to 1 s).
  void send(const DmxLevels& levels, MonoTime now);

  /// Sends them in any case. `is_terminated`: marks the end of the stream (E1.31 alone).
  void send_now(const DmxLevels& levels, MonoTime now, bool is_terminated = false);

  /// Sends them three times; by E1.31 three "terminated" packets follow.
  void finish(const DmxLevels& levels, MonoTime now);

  /// Art-Net: receivers take packets in any order from now on. E1.31 cannot do so.
  void leave_sequence() noexcept { has_sequence_ = false; }

  const DatagramTarget& target() const noexcept { return target_; }

 private:
  settings::feeds::DmxProtocol protocol_;
  std::string source_;
  ComponentId component_;
  std::uint8_t priority_;
  std::uint16_t number_;
  DatagramTarget target_;
  std::uint8_t sequence_ = 0;
  bool has_sequence_ = true;
  DmxLevels levels_{};
  int times_ = 0;  ///< these levels were sent, counted up to a few
  std::optional<MonoTime> sent_;
};

}  // namespace yuragi::daemon::feeds
