#include "daemon/feeds/osc_feed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "daemon/feeds/datagram_target.hpp"
#include "daemon/feeds/interval.hpp"
#include "daemon/feeds/osc_addresses.hpp"
#include "daemon/feeds/osc_cue.hpp"
#include "drivers/bus/osc_message.hpp"
#include "engine/base/count_text.hpp"

namespace yuragi::daemon::feeds {
namespace {

using settings::feeds::Osc;
using settings::feeds::OscMap;

using Message = std::vector<std::uint8_t>;

constexpr std::size_t kMaxDatagram = 1400;
constexpr std::size_t kBundleHead = 16, kElementHead = 4;
/// What is sent when it changes also comes at this interval, for a receiver that begins later.
constexpr double kUnchangedEvery_s = 1.0;

/// An [[osc.map]] as it runs.
struct Mapping {
  OscMap config;
  std::optional<double> smoothed;
};

class OscFeed final : public Feed {
 public:
  explicit OscFeed(const Osc& config)
      : config_(config),
        target_(config.name, config.to),
        ticks_(config.rate_hz ? std::optional(Interval(1.0 / *config.rate_hz)) : std::nullopt) {
    for (const OscMap& map : config_.maps) maps_.push_back({map, std::nullopt});
    for (const settings::feeds::OscCue& cue : config_.cues) cues_.emplace_back(cue);
  }

  void send(const values::Moment& moment) override {
    rename(moment);
    messages_.clear();
    add_cues(moment);
    if (!ticks_ || ticks_->is_due(moment.time_s)) {
      add_values(moment);
      add_maps(moment);
    }
    send_messages(moment);
  }

  Status status() const override {
    std::string sends = config_.send == settings::feeds::kOscMappedOnly ? "" : config_.send;
    const auto add = [&sends](const std::string& what) { sends.append(sends.empty() ? "" : ", ").append(what); };
    if (!maps_.empty()) add(count_text(maps_.size(), "mapped value"));
    if (!cues_.empty()) add(count_text(cues_.size(), "cue"));
    return {.kind = "osc",
            .name = config_.name,
            .target = target_.address(),
            .sends = sends,
            .messages = target_.messages(),
            .bytes = target_.bytes(),
            .last_sent = target_.last_sent(),
            .trouble = target_.trouble()};
  }

 private:
  void rename(const values::Moment& moment) {
    if (moment.names == names_) return;
    names_ = moment.names;
    addresses_ = osc_addresses_of(*names_);
    std::erase_if(addresses_, [this](const OscAddress& address) { return !config_.sends(address.part); });
    sent_.assign(addresses_.size(), {});
  }

  void add_values(const values::Moment& moment) {
    const bool with_tenths = tenths_.is_due(moment.time_s), with_unchanged = unchanged_.is_due(moment.time_s);
    for (std::size_t i = 0; i < addresses_.size(); ++i) {
      const OscAddress& address = addresses_[i];
      if (address.pace == OscPace::kTenTimesASecond && !with_tenths) continue;
      auto message = address.message(moment, config_.wind, config_.prefix);
      if (!message) continue;
      if (address.pace == OscPace::kOnChange) {
        if (!with_unchanged && sent_[i] == *message) continue;
        sent_[i] = *message;
      }
      messages_.push_back(std::move(*message));
    }
  }

  void add_maps(const values::Moment& moment) {
    for (Mapping& map : maps_) {
      const std::optional<double> value = map.config.value.value_in(moment, config_.wind);
      if (!value) continue;
      const OscMap& config = map.config;
      const double wanted = config.to.at(std::pow(config.from.part_of(*value), config.curve));
      const double past_s = mapped_s_ ? moment.time_s - *mapped_s_ : 0.0;
      const double share = config.smooth_s > 0.0 ? 1.0 - std::exp(-past_s / config.smooth_s) : 1.0;
      map.smoothed = map.smoothed ? *map.smoothed + share * (wanted - *map.smoothed) : wanted;
      messages_.push_back(drivers::bus::encode_osc(config.address, std::array{static_cast<float>(*map.smoothed)}));
    }
    mapped_s_ = moment.time_s;
  }

  void add_cues(const values::Moment& moment) {
    for (std::size_t i = 0; i < cues_.size(); ++i) {
      if (cues_[i].is_due(moment, config_.wind))
        messages_.push_back(drivers::bus::encode_osc(config_.cues[i].address, std::span<const float>()));
    }
  }

  void send_messages(const values::Moment& moment) {
    if (!config_.bundles) {
      for (const Message& message : messages_) target_.send(message, moment.mono);
      return;
    }
    const std::optional<UtcTime> tag = config_.time_tags ? std::optional(moment.utc) : std::nullopt;
    for (std::size_t first = 0; first < messages_.size();) {
      std::size_t end = first, size = kBundleHead;
      while (end < messages_.size() && (end == first || size + kElementHead + messages_[end].size() <= kMaxDatagram))
        size += kElementHead + messages_[end++].size();
      target_.send(drivers::bus::encode_osc_bundle(std::span(messages_).subspan(first, end - first), tag), moment.mono);
      first = end;
    }
  }

  Osc config_;
  DatagramTarget target_;
  std::vector<Mapping> maps_;
  std::vector<CueTrigger> cues_;
  std::optional<Interval> ticks_;  ///< nullopt: each tick
  Interval tenths_{kOscTenth_s}, unchanged_{kUnchangedEvery_s};
  std::optional<double> mapped_s_;
  std::shared_ptr<const values::Names> names_;
  std::vector<OscAddress> addresses_;
  std::vector<Message> sent_;  ///< of each address that is sent when it changes, the last message
  std::vector<Message> messages_;
};

}  // namespace

std::unique_ptr<Feed> make_osc_feed(const Osc& config) {
  return std::make_unique<OscFeed>(config);
}

}  // namespace yuragi::daemon::feeds
