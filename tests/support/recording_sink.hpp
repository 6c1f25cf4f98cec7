#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "drivers/sensor/sensor.hpp"
#include "engine/wind/judging/reading_judge.hpp"

namespace yuragi {

/// Keeps whatever a sensor says.
struct RecordingSink final : SensorSink {
  struct Link {
    LinkState state;
    std::string detail;
  };

  struct Raw {
    RawDirection direction;
    std::vector<std::uint8_t> message;
  };

  std::vector<WindReading> readings;
  std::vector<WindReading> believed;  ///< those of them that a hub would give to the wind
  std::vector<Refusal> refusals;
  std::vector<Link> links;
  std::vector<Raw> raws;
  ReadingJudge judge;

  void reading(const WindReading& reading) override {
    readings.push_back(reading);
    if (is_plausible(reading) && judge.judge(reading)) believed.push_back(reading);
  }
  void refused(Refusal why) override { refusals.push_back(why); }
  void link(LinkState state, std::string_view detail) override { links.push_back({state, std::string(detail)}); }
  void raw(RawDirection direction, std::span<const std::uint8_t> message) override {
    raws.push_back({direction, {message.begin(), message.end()}});
  }

  std::ptrdiff_t count(Refusal why) const { return std::ranges::count(refusals, why); }
  LinkState last_state() const { return links.empty() ? LinkState::kConnecting : links.back().state; }
  std::string last_detail() const { return links.empty() ? "" : links.back().detail; }
};

}  // namespace yuragi
