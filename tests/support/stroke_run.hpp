#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "engine/wind/ground/wind_tapes.hpp"

namespace yuragi {

/// Pens that stand somewhere and write what a test wants them to, tick by tick, while a wind carries the tapes.
class StrokeRun {
 public:
  static constexpr double kTick_s = 1.0 / 60.0;

  explicit StrokeRun(std::vector<wind::Vector> places_east_south_m) {
    stroke_.pen_count = places_east_south_m.size();
    for (std::size_t i = 0; i < stroke_.pen_count; ++i) {
      wind::ground::WindPen& pen = stroke_.pens[i];
      pen.east_m = places_east_south_m[i].u_m_s;
      pen.south_m = places_east_south_m[i].v_m_s;
      pen.part = 1.0 / static_cast<double>(stroke_.pen_count);
      pen.presence = 1.0;
      pen.weights.fill(1.0);
    }
    stroke_.coherence = {.speed_m_s = 7.0, .length_m = 57.0, .decay_along = 1.2};
    for (std::size_t i = 0; i < wind::ground::kTileOctaveCount; ++i) {
      stroke_.octave_hz[i] =
          static_cast<float>(std::ldexp(0.003, static_cast<int>(i % wind::turbulence::GustNoise::kTileOctaves)));
    }
    blow({0.0, 7.0});
  }

  /// From now on the mean wind is this.
  void blow(wind::Vector wind) {
    wind_ = wind;
    const double speed_m_s = speed_of(wind);
    if (speed_m_s > 0.0) stroke_.ahead = (1.0 / speed_m_s) * wind;
    stroke_.coherence.speed_m_s = std::max(speed_m_s, 0.3);
  }

  /// Of all sensors this band is taken alone: what is lost on the way delays nothing.
  void take_only(std::size_t band) {
    for (wind::ground::WindPen& pen : stroke_.pens) {
      pen.weights.fill(0.0);
      pen.weights[1 + band] = 1.0;
    }
  }

  using Set = std::function<void(std::size_t pen, wind::ground::WindSample& now)>;

  /// One tick; `set` says what pens measure now.
  void step(const Set& set) {
    stroke_.way_m += speed_of(wind_) * kTick_s;
    stroke_.carried_east_m += wind_.u_m_s * kTick_s;
    stroke_.carried_south_m -= wind_.v_m_s * kTick_s;
    for (std::size_t i = 0; i < stroke_.pen_count; ++i) {
      wind::ground::WindPen& pen = stroke_.pens[i];
      set(i, pen.now);
      pen.now.mean = wind_;
      pen.now.east_m = pen.east_m - stroke_.carried_east_m;
      pen.now.south_m = pen.south_m - stroke_.carried_south_m;
      pen.written = pen.now;
    }
  }
  /// And written onto the tapes.
  void tick(wind::ground::WindTapes& tapes, const Set& set) {
    step(set);
    tapes.write(stroke_);
  }
  void run_for(wind::ground::WindTapes& tapes, double duration_s, const Set& set) {
    for (int i = 0; i < static_cast<int>(std::lround(duration_s / kTick_s)); ++i) tick(tapes, set);
  }

  wind::Vector wind() const { return wind_; }
  wind::ground::WindStroke& stroke() { return stroke_; }
  wind::ground::WindPen& pen(std::size_t index) { return stroke_.pens[index]; }

 private:
  wind::ground::WindStroke stroke_;
  wind::Vector wind_;
};

/// All bands have this, and know so much of each octave.
inline std::function<void(std::size_t, wind::ground::WindSample&)> steady_gusts(double gust_m_s, double known) {
  return [gust_m_s, known](std::size_t, wind::ground::WindSample& now) {
    for (std::size_t band = 0; band < wind::turbulence::OctaveFollower::kBands; ++band)
      now.north_m_s[band] = static_cast<float>(gust_m_s);
    now.known_along.fill(static_cast<float>(known));
    now.known_across.fill(static_cast<float>(known));
  };
}

}  // namespace yuragi
