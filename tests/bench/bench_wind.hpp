#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "engine/wind/ground/ground_wind.hpp"
#include "tests/support/measured_wind.hpp"

namespace yuragi::bench {

inline constexpr double kBenchTick_s = 1.0 / 60.0;

/// The wind that all rows are measured in: a steady breeze, with gusts that differ from place to place where there is a
/// noise for them, and on the tape what a sensor of 0.1 s has written. What the daemon's wind has besides belongs here
/// and nowhere else.
class BenchWind {
 public:
  static constexpr wind::Vector kBreeze = {6.0, 3.0};

  /// With `gusts`: every octave that a tile holds has a strength, and is carried and turned as the daemon does it.
  /// `has_tape`: or nothing is measured, and the breeze is the same everywhere.
  explicit BenchWind(std::shared_ptr<const wind::turbulence::GustNoise> gusts = nullptr, bool has_tape = true)
      : gusts_(std::move(gusts)) {
    wind_.advection = kBreeze;
    if (!gusts_) return;
    wind_.gusts.ahead = (1.0 / speed_of(kBreeze)) * kBreeze;
    wind_.gusts.along_m_s.fill(kOctave_m_s);
    wind_.gusts.across_m_s.fill(kOctave_m_s);
    if (!has_tape) return;
    MeasuredWind measured(gusts_, kBreeze);
    for (int tick = 0; tick < kTicksOfATape; ++tick) {
      stroke_ = measured.step().stroke;
      tapes_.write(stroke_);
    }
    wind_.tapes = &tapes_;
  }
  BenchWind(const BenchWind&) = delete;
  BenchWind& operator=(const BenchWind&) = delete;

  /// The wind of the next tick.
  const wind::ground::Wind& next() noexcept {
    if (gusts_) gusts_->carry(wind_.gusts.carried, kBreeze.u_m_s, -kBreeze.v_m_s, kBenchTick_s, kTurnover_m23_s);
    if (wind_.tapes != nullptr) write();
    wind_.tick = ++tick_;
    return wind_;
  }

  /// What one tick adds to the tapes.
  void write() noexcept {
    wind::ground::WindPen& pen = stroke_.pens[0];
    const auto carry = [&](double& carried_m, double& sample_m, double& written_m, double speed_m_s) {
      carried_m += speed_m_s * kBenchTick_s;
      sample_m -= speed_m_s * kBenchTick_s;
      written_m = sample_m;
    };
    carry(stroke_.carried_east_m, pen.now.east_m, pen.written.east_m, kBreeze.u_m_s);
    carry(stroke_.carried_south_m, pen.now.south_m, pen.written.south_m, -kBreeze.v_m_s);
    stroke_.way_m += speed_of(kBreeze) * kBenchTick_s;
    tapes_.write(stroke_);
  }

 private:
  static constexpr float kOctave_m_s = 0.3F;
  static constexpr double kTurnover_m23_s = 0.3;
  static constexpr int kTicksOfATape = 2400;  ///< its 256 m are written

  std::shared_ptr<const wind::turbulence::GustNoise> gusts_;
  wind::ground::WindTapes tapes_{1};
  wind::ground::WindStroke stroke_;
  wind::ground::Wind wind_ = kBreeze;
  std::uint64_t tick_ = 0;
};

}  // namespace yuragi::bench
