#include "daemon/feeds/dmx_feed.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/feeds/dmx_levels.hpp"
#include "daemon/feeds/dmx_universe.hpp"
#include "daemon/feeds/interval.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::feeds {
namespace {

using settings::feeds::Dmx;
using settings::feeds::DmxGrid;

/// DMX512 sends 512 channels at most 44 times a second (ANSI E1.11-2008, table 6; E1.31-2018 6.6.1).
constexpr double kMaxRate_hz = 44.0;
/// Below this part the hours count as closed: closing is a fade whose end is never quite reached.
constexpr double kClosedBelow = 0.02;
constexpr double kLongestStep_s = 1.0;

class DmxFeed final : public Feed {
 public:
  explicit DmxFeed(const Dmx& config) : config_(config), levels_(config.universe_count()) {
    const ComponentId component = component_id_of(machine_id(), config.name);
    for (std::size_t i = 0; i < levels_.size(); ++i) universes_.emplace_back(config_, i, component);
    for (const settings::feeds::DmxChannel& channel : config_.channels) channels_.emplace_back(channel);
  }

  void send(const values::Moment& moment) override {
    now_ = moment.mono;
    if (!rate_.is_due(moment.time_s)) return;
    const double dt_s = sent_s_ ? std::clamp(moment.time_s - *sent_s_, 0.0, kLongestStep_s) : 0.0;
    sent_s_ = moment.time_s;
    const bool is_closed = moment.openness < kClosedBelow;
    for (DmxChannelLevel& channel : channels_) {
      channel.step(is_closed ? std::nullopt : channel.config().value.value_in(moment, values::Wind::kShaped), dt_s);
      channel.write_to(levels_[0]);
    }
    for (const DmxGrid& grid : config_.grids) write_grid(grid, values_of(grid, moment, is_closed), levels_);
    if (is_closed && std::ranges::all_of(channels_, &DmxChannelLevel::is_at_rest)) return leave();
    has_left_ = false;
    for (std::size_t i = 0; i < levels_.size(); ++i) universes_[i].send(levels_[i], moment.mono);
  }

  void finish() override {
    for (DmxChannelLevel& channel : channels_) {
      channel.reset();
      channel.write_to(levels_[0]);
    }
    for (const DmxGrid& grid : config_.grids) write_grid(grid, {}, levels_);
    leave();
  }

  Status status() const override {
    std::size_t pixels = 0;
    for (const DmxGrid& grid : config_.grids) pixels += grid.grid.size();
    std::string sends = count_text(channels_.size(), "channel");
    if (pixels > 0) sends.append(", ").append(count_text(pixels, "pixel"));
    Status status{.kind = "dmx",
                  .name = config_.name,
                  .target = universes_.front().target().address(),
                  .sends = sends,
                  .last_sent = std::nullopt,
                  .trouble = {}};
    for (const DmxUniverse& universe : universes_) {
      const DatagramTarget& target = universe.target();
      status.messages += target.messages();
      status.bytes += target.bytes();
      status.last_sent = std::max(status.last_sent, target.last_sent());
      if (status.trouble.empty()) status.trouble = target.trouble();
    }
    return status;
  }

 private:
  static std::span<const double> values_of(const DmxGrid& grid, const values::Moment& moment, bool is_closed) {
    const auto found = std::ranges::find(moment.names->grids, grid.grid);
    const auto index = static_cast<std::size_t>(found - moment.names->grids.begin());
    if (is_closed || index >= moment.grids.size()) return {};
    return moment.grids[index];
  }

  /// Once, when the levels are those of rest.
  void leave() {
    if (has_left_ || !now_) return;
    has_left_ = true;
    for (std::size_t i = 0; i < levels_.size(); ++i) universes_[i].finish(levels_[i], *now_);
  }

  Dmx config_;
  std::vector<DmxLevels> levels_;  ///< of each universe
  std::deque<DmxUniverse> universes_;
  std::vector<DmxChannelLevel> channels_;
  Interval rate_{1.0 / kMaxRate_hz};
  std::optional<double> sent_s_;
  std::optional<MonoTime> now_;
  bool has_left_ = false;
};

}  // namespace

std::unique_ptr<Feed> make_dmx_feed(const Dmx& config) {
  return std::make_unique<DmxFeed>(config);
}

}  // namespace yuragi::daemon::feeds
