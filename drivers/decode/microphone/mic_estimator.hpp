#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "drivers/decode/microphone/mic_block.hpp"
#include "drivers/decode/microphone/mic_calibration.hpp"
#include "drivers/decode/microphone/mic_direction.hpp"
#include "drivers/decode/microphone/mic_gain_watch.hpp"
#include "drivers/decode/microphone/mic_noise_floor.hpp"
#include "drivers/decode/refusal.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::decode::microphone {

struct MicEstimatorOptions {
  MicCalibration calibration = MicPowerLaw{};
  /// Of a calm, dB re full scale; nullopt: found while running (MicNoiseFloor). A curve needs none.
  std::optional<double> noise_floor_db = std::nullopt;
  double noise_memory_s = 86400.0;
  /// Treats signals that all microphones record equally as sound, not wind. One microphone alone cannot distinguish
  /// them.
  bool ignores_sound = true;
  double window_s = 1.0;            ///< over which level and coherence are taken
  std::vector<double> faces_deg{};  ///< where each microphone faces; empty: no direction
  double direction_smoothing_s = 5.0;
  double least_confidence = 0.3;  ///< of a direction; below it there is none
};

/// The estimate after one block.
struct MicEstimate {
  double speed_m_s = 0.0;
  std::optional<double> direction_deg;  ///< wind direction, clockwise from north, [0, 360)
  std::optional<double> gust_m_s;       ///< strongest mean over 3 s of the last 10 min (WMO-No. 8, 2021, I.5)
  double direction_confidence = 0.0;    ///< 0 to 1
  double level_db = 0.0;                ///< of the wind in its band, without sound; used for calibration
  double floor_db = 0.0;                ///< the level used for a calm; -200: none
  double sound_part = 0.0;              ///< of the band's power that was taken for sound, 0 to 1
  unsigned silent_channels = 0;         ///< a bit for each that is digitally silent
  bool is_clipping = false;
  bool suspects_automatic_gain = false;
};

/// From blocks of sound to wind. Wind noise arises at each microphone independently, so that it is incoherent between
/// two of them, while ambient sound is coherent: of each band's power the part 1 - |gamma| is wind, with gamma the
/// complex coherence (drivers/SOURCES.md S6.2). With few averages even noise looks coherent by 1/N in |gamma|^2, which
/// is taken off (Carter, Knapp and Nuttall 1973, "Estimation of the magnitude-squared coherence function via overlapped
/// FFT processing").
///
/// Clipping reduces the recorded power: a Gaussian signal that is at full scale for a part p of the time
/// has the standard deviation 1 / Phi^-1(1 - p/2), and the level is raised to that; it is never lowered. Pure: no
/// clock, no I/O. Thread-safe: no. Realtime-safe: no (it keeps ten minutes of gusts in a deque).
class MicEstimator {
 public:
  /// Throws std::invalid_argument for faces that are no direction's, or more than there are channels.
  MicEstimator(const MicEstimatorOptions& options, const MicHello& hello);

  /// Returns nullopt until a whole window has been recorded. Refuses: kInvalid (digital silence: muted, or unplugged
  /// without an error; or samples that are no numbers; or a window in which two channels carry the same signal,
  /// twins()), kImplausible (noise at full scale, as strong above the wind's band as in it: a broken cable or a wrong
  /// sample format). A refused block empties the window.
  Result<std::optional<MicEstimate>, Refusal> add(const MicBlock& block);

  /// Two channels, counted from 0, that carry the same signal: a mono input that was opened with more channels. All of
  /// it would be taken for sound, and a storm for a calm. Of the last window; nullopt while sound is not ignored.
  const std::optional<std::array<std::size_t, 2>>& twins() const noexcept { return twins_; }

  const MicHello& hello() const noexcept { return hello_; }

  /// The stream starts again: empties the window; the knowledge of the microphone is kept.
  void restart() noexcept;

 private:
  struct Levels {
    std::array<double, kMicMaxChannels> power{};  ///< of the wind, in its band
    double power_with_sound = 0.0;                ///< mean over the channels that live
    double wind_power = 0.0;                      ///< likewise
    double high_power = 0.0;
    unsigned silent_channels = 0;
    bool is_clipping = false;
  };

  std::optional<Refusal> refuse(const MicBlock& block) const;
  Levels levels_of_window() const;
  double coherence(std::size_t a, std::size_t b, std::size_t band) const;
  std::optional<std::array<std::size_t, 2>> find_twins() const;
  bool are_twins(std::size_t a, std::size_t b) const;
  std::optional<double> add_gust(double speed_m_s, double duration_s);

  MicEstimatorOptions options_;
  MicHello hello_;
  std::vector<MicBlock> window_;  ///< a ring
  std::size_t next_ = 0;
  std::size_t filled_ = 0;
  std::uint64_t last_sample_ = 0;
  std::optional<std::array<std::size_t, 2>> twins_;

  MicNoiseFloor floor_;
  MicGainWatch gain_watch_;
  std::optional<MicDirection> direction_;

  struct Gust {
    double time_s, speed_m_s;
  };
  double time_s_ = 0.0;
  std::deque<Gust> recent_;  ///< of the last 3 s
  std::deque<Gust> gusts_;   ///< falling from front to back: the front is the strongest of 10 min
};

}  // namespace yuragi::drivers::decode::microphone
