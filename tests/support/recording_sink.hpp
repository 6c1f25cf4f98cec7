#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "drivers/sensor/sensor.hpp"
#include "engine/wind/judging/reading_judge.hpp"

namespace yuragi {

/// Keeps whatever a sensor says.
struct RecordingSink final : drivers::sensor::Sink {
  struct Link {
    wind::LinkState state;
    std::string detail;
  };

  struct Raw {
    drivers::sensor::RawDirection direction;
    std::vector<std::uint8_t> message;
  };

  std::vector<wind::Reading> readings;
  std::vector<wind::Reading> believed;  ///< those of them that a hub would give to the wind
  std::vector<wind::StationQuantities> station_quantities;
  std::vector<drivers::decode::Refusal> refusals;
  std::vector<Link> links;
  std::vector<Raw> raws;
  wind::judging::ReadingJudge judge;

  void reading(const wind::Reading& reading) override {
    readings.push_back(reading);
    if (wind::is_plausible(reading) && judge.judge(reading)) believed.push_back(reading);
  }
  void quantities(const wind::StationQuantities& said) override { station_quantities.push_back(said); }
  void refused(drivers::decode::Refusal why, std::uint64_t times = 1) override {
    refusals.insert(refusals.end(), times, why);
  }
  void link(wind::LinkState state, std::string_view detail) override { links.push_back({state, std::string(detail)}); }
  void raw(drivers::sensor::RawDirection direction, std::span<const std::uint8_t> message) override {
    raws.push_back({direction, {message.begin(), message.end()}});
  }

  /// Forgets what was kept; what the judge knows stays.
  void clear() {
    readings.clear();
    believed.clear();
    station_quantities.clear();
    refusals.clear();
    links.clear();
    raws.clear();
  }

  std::ptrdiff_t count(drivers::decode::Refusal why) const { return std::ranges::count(refusals, why); }
  wind::LinkState last_state() const { return links.empty() ? wind::LinkState::kConnecting : links.back().state; }
  std::string last_detail() const { return links.empty() ? "" : links.back().detail; }
};

}  // namespace yuragi
