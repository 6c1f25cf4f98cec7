#include "daemon/feeds/dmx_universe.hpp"

#include "daemon/feeds/artnet_packet.hpp"

namespace yuragi::daemon::feeds {
namespace {

using settings::feeds::DmxProtocol;

/// Of levels that do not change: at first, and again at this interval.
constexpr int kTimes = 4;  // once when they change, and three times more
constexpr auto kAgainAfter = std::chrono::milliseconds(900);
constexpr int kLastTimes = 3;

}  // namespace

DmxUniverse::DmxUniverse(const settings::feeds::Dmx& feed, std::size_t index, const ComponentId& component)
    : protocol_(feed.protocol),
      source_("Yuragi " + feed.name),
      component_(component),
      priority_(static_cast<std::uint8_t>(feed.priority)),
      number_(static_cast<std::uint16_t>(static_cast<std::size_t>(feed.universe) + index)),
      target_(feed.name, feed.target(index), feed.interface) {}

void DmxUniverse::send(const DmxLevels& levels, MonoTime now) {
  if (levels != levels_) times_ = 0;
  if (times_ >= kTimes && sent_ && now - *sent_ < kAgainAfter) return;
  if (times_ < kTimes) ++times_;
  send_now(levels, now);
}

void DmxUniverse::send_now(const DmxLevels& levels, MonoTime now, bool is_terminated) {
  levels_ = levels;
  sent_ = now;
  ++sequence_;
  if (protocol_ == DmxProtocol::kArtNet) {
    if (sequence_ == 0) sequence_ = 1;
    return target_.send(encode_artdmx(number_, has_sequence_ ? sequence_ : std::uint8_t{0}, levels), now);
  }
  target_.send(encode_e131({.component = component_,
                            .source = source_,
                            .priority = priority_,
                            .sequence = sequence_,
                            .is_terminated = is_terminated,
                            .universe = number_},
                           levels),
               now);
}

void DmxUniverse::finish(const DmxLevels& levels, MonoTime now) {
  for (int i = 0; i < kLastTimes; ++i) send_now(levels, now);
  if (protocol_ != DmxProtocol::kSacn) return;
  for (int i = 0; i < kLastTimes; ++i) send_now(levels, now, true);
}

}  // namespace yuragi::daemon::feeds
