#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/look/camera.hpp"

namespace yuragi::viewer::picture {

/// The view of a picture: a camera of the daemon's at a moment, or, without one, the user's own.
struct Shot {
  std::optional<look::Camera> camera;
  double utc_s = 0.0;  ///< of the daemon's clock, which moves the camera

  /// Empty for the camera by hand.
  std::string name() const { return camera ? camera->name : std::string(); }
};

/// Selects the camera: the daemon's of this hour, the requested one, or the user's own; with a cross-fade from one to
/// the next. Nothing jumps: during a cross-fade the next one waits, and if the daemon's clock is set the picture
/// cross-fades, too. Pure: time is a parameter. Thread-safe: no.
class CameraKeeper {
 public:
  /// Duration of a cross-fade that is not due to the hour: by a key, or to the configuration's camera.
  static constexpr double kFade_s = 1.0;

  /// Sets the first camera, to which reset() returns: by hand, the camera of this name, or the hour's.
  void begin_by_hand() { is_by_hand_ = is_by_hand_at_first_ = true; }
  void begin_with(const std::string& name) { asked_ = asked_at_first_ = name; }

  /// The daemon's cameras, and the one of this hour; the first time without a cross-fade.
  void set_cameras(const std::vector<look::Camera>& cameras, std::size_t on);
  const std::vector<look::Camera>& cameras() const { return cameras_; }
  bool has(const std::string& name) const { return find(name) != nullptr; }

  /// Takes the time of the daemon's newest frame, seconds since 1970.
  void hear_clock(double utc_s);

  /// The user moves the camera: it is by hand from now on, without a cross-fade.
  void take_by_hand();
  /// Shows the daemon's camera of this number, from 1, regardless of the hour; does nothing if it does not exist.
  void show(std::size_t number);
  /// Shows the next of the daemon's cameras, regardless of the hour.
  void next();
  /// Back to the first. Is it one of the daemon's cameras?
  bool reset();

  void advance(double dt_s);

  const Shot& now() const { return now_; }
  /// What fades out.
  const Shot& before() const { return before_; }
  bool is_fading() const { return faded_s_ < fade_s_; }
  /// The progress of now(), 0 to 1; it is slower at the beginning and the end.
  double share() const;

 private:
  const look::Camera* find(const std::string& name) const;
  /// None: by hand.
  const look::Camera* wanted() const;

  std::vector<look::Camera> cameras_;
  std::size_t on_ = 0;
  bool has_cameras_ = false;
  bool is_by_hand_ = false;
  bool is_by_hand_at_first_ = false;
  std::optional<std::string> asked_;
  std::optional<std::string> asked_at_first_;

  Shot now_;
  Shot before_;
  double next_fade_s_ = kFade_s;  // of the waiting change
  double fade_s_ = 0.0;
  double faded_s_ = 0.0;
  double clock_ahead_s_ = 0.0;  // of the daemon, relative to now_
  bool has_clock_ = false;
};

}  // namespace yuragi::viewer::picture
