#include "daemon/feeds/osc_feed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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
using values::Quantity;

using Message = std::vector<std::uint8_t>;

constexpr std::size_t kMaxDatagram = 1400;
constexpr std::size_t kBundleHead = 16, kElementHead = 4;
constexpr double kSensorsEvery_s = 0.1;
constexpr double kStatesEvery_s = 1.0;

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
      const bool with_states = states_.is_due(moment.time_s);
      if (sends_wind_) add_wind(moment, with_states);
      if (sends_sensors_) add_sensors(moment, with_states);
      if (sends_places_) add_places(moment);
      if (sends_scenes_) add_scenes(moment, with_states);
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
    sensors_ = osc_parts_of(names_->sensors);
    places_ = osc_parts_of(names_->places);
    scenes_ = osc_parts_of(names_->scenes);
    states_sent_.assign(sensors_.size(), std::nullopt);
    opacities_sent_.assign(scenes_.size(), std::nullopt);
  }

  void add(const std::string& address, std::initializer_list<double> numbers) {
    std::vector<float> floats;
    for (const double number : numbers) floats.push_back(static_cast<float>(number));
    messages_.push_back(drivers::bus::encode_osc(config_.prefix + address, floats));
  }

  void add_text(const std::string& address, std::string_view text) {
    messages_.push_back(drivers::bus::encode_osc(config_.prefix + address, std::string(text)));
  }

  /// First speed and direction together, then each value by itself.
  void add_readout(const std::string& address, const values::Readout& readout) {
    add(address, {readout[Quantity::kSpeed], readout[Quantity::kDirection]});
    for (std::size_t i = 0; i < values::kQuantityCount; ++i) {
      const auto quantity = static_cast<Quantity>(i);
      add(fmt::format("{}/{}", address, values::description_of(quantity).name), {readout[quantity]});
    }
  }

  void add_wind(const values::Moment& moment, bool with_state) {
    add_readout("/wind", moment.wind(config_.wind));
    if (!with_state && source_sent_ == moment.source) return;
    source_sent_ = moment.source;
    add_text("/wind/state", values::name_of(moment.source));
  }

  void add_sensors(const values::Moment& moment, bool with_states) {
    const bool with_values = sensor_values_.is_due(moment.time_s);
    for (std::size_t i = 0; i < std::min(moment.sensors.size(), sensors_.size()); ++i) {
      const values::SensorValue& sensor = moment.sensors[i];
      const std::string address = "/sensor/" + sensors_[i];
      const std::array<std::pair<std::string_view, double>, 3> parts = {
          {{"/speed", sensor.speed_m_s}, {"/direction", sensor.direction_deg}, {"/age", sensor.age_s}}};
      for (const auto& [part, value] : parts) {
        if (with_values && std::isfinite(value)) add(address + std::string(part), {value});
      }
      if (!with_states && states_sent_[i] == sensor.state) continue;
      states_sent_[i] = sensor.state;
      add_text(address + "/state", wind::judging::name_of(sensor.state));
    }
  }

  void add_places(const values::Moment& moment) {
    const std::span<const values::Readout> places = moment.places(config_.wind);
    for (std::size_t i = 0; i < std::min(places.size(), places_.size()); ++i)
      add_readout("/place/" + places_[i], places[i]);
  }

  void add_scenes(const values::Moment& moment, bool with_states) {
    for (std::size_t i = 0; i < std::min(moment.opacities.size(), scenes_.size()); ++i) {
      if (!with_states && opacities_sent_[i] == moment.opacities[i]) continue;
      opacities_sent_[i] = moment.opacities[i];
      add(fmt::format("/scene/{}/opacity", scenes_[i]), {moment.opacities[i]});
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
  const bool sends_wind_ = config_.sends("wind"), sends_sensors_ = config_.sends("sensors"),
             sends_places_ = config_.sends("places"), sends_scenes_ = config_.sends("scenes");
  DatagramTarget target_;
  std::vector<Mapping> maps_;
  std::vector<CueTrigger> cues_;
  std::optional<Interval> ticks_;  ///< nullopt: each tick
  Interval sensor_values_{kSensorsEvery_s}, states_{kStatesEvery_s};
  std::optional<double> mapped_s_;
  std::shared_ptr<const values::Names> names_;
  std::vector<std::string> sensors_, places_, scenes_;  ///< as parts of addresses
  std::optional<wind::Source> source_sent_;
  std::vector<std::optional<wind::judging::SensorState>> states_sent_;
  std::vector<std::optional<double>> opacities_sent_;
  std::vector<Message> messages_;
};

}  // namespace

std::unique_ptr<Feed> make_osc_feed(const Osc& config) {
  return std::make_unique<OscFeed>(config);
}

}  // namespace yuragi::daemon::feeds
