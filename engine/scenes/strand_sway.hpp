#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/fields.hpp"
#include "engine/base/part.hpp"
#include "engine/noise/line_cut.hpp"
#include "engine/noise/noise_tile.hpp"
#include "engine/operators/oscillator_job.hpp"
#include "engine/pose/skeleton.hpp"
#include "engine/scenes/carried_noise.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/scene_wind.hpp"
#include "engine/scenes/wind_grid.hpp"

namespace yuragi::scenes {

/// How strands respond to the wind.
struct StrandSwaySpec {
  double max_bend_rad = 1.4;
  double half_bend_speed_m_s = 7.0;
  double turbulence = 0.4;      ///< own gusts: variation of the wind from place to place, relative to it
  double gust_strength = 0.2;   ///< own gusts: variation along the wind's path, relative to it
  double hybrid = 1.0;          ///< 0: the noise alone; 1: each strand a damped oscillator
  double natural_hz = 2.0;      ///< of an oscillator of mean length; longer strands are slower
  double damping_ratio = 0.2;   ///< above 0, below 1
  double carry = 1.0;           ///< the noise moves with this part of the wind's speed: in a coat the air is slower
  bool has_own_gusts = false;   ///< instead of those of the wind, if the setup has these
  double canopy_waves = 0.15;   ///< with gusts of the wind: its variation by the stand's own waves, relative
  CarriedNoiseSpec noise = {};  ///< the wind on the ground
  double plant_height_m = 0.7;  ///< determines the speed of the stand's own waves (canopy_carry())
  double shortest_canopy_wave_m = 2.0;  ///< the longest is twice as long
  double finest_wind_cell_m = 0.5;      ///< minimum distance of the nodes at which the wind is read (WindGrid)
};

/// Strands in the wind, after N. Chiba, "Development of core technology for a noise-based real-time animation engine
/// for fluctuation phenomena" (Iwate University), section 3.1 and figure 7.
///
///   shift    the wind carries a 2-D noise, "the wind on the ground", over the strands          CarriedNoise
///   sample   each strand reads it where it stands, scaled to a strength of the wind            CarriedNoise
///   project  a 1-D noise (LineCut) gives Wind-speed, the strength along the wind; both bend    BendingJob
///            the links of the strand, and a damped oscillator overshoots and sways on          OscillatorJob
///
/// If the wind has gusts (Setup::gusts), these are the wind on the ground: each strand reads the
/// wind where it stands (WindGrid), and is bent by it (LocalBendingJob). Over a few metres those gusts hardly differ;
/// the visible bands that run over a stand are its own waves, which arise where the plants' tops slow the wind and are
/// a few times as long as the plants are high (Raupach, Finnigan and Brunet 1996, "Coherent eddies and turbulence in
/// vegetation canopies"). They are a band of noise that varies the wind, and run at 1.8 times the wind at the tops
/// (canopy_carry()), half as fast as the wind 10 m up where blades are 0.7 m long. In nature they are longer across the
/// wind than along it; these are not, because a tile cannot turn with the wind.
///
/// Allocates when it is made, never afterwards. Thread-safe: no. Realtime-safe: a tick.
class StrandSway final : public Scene {
 public:
  /// `place_x_m` and `place_z_m`: the place at which each strand reads its own noise; `flexibility`: of each. All have
  /// strands.padded_count() elements.
  StrandSway(pose::StrandSkeleton strands, std::span<const float> place_x_m, std::span<const float> place_z_m,
             std::vector<float> flexibility, const StrandSwaySpec& spec, const Setup& setup);

  const pose::Skeleton& skeleton() const noexcept override { return skeleton_; }
  const pose::Pose& pose() const noexcept override { return pose_; }

  void shift(const wind::ground::Wind& wind, double dt_s) noexcept override;
  void sample() noexcept override { sample_part({}); }
  void project(double dt_s) noexcept override { project_part({}, dt_s); }
  void sample_part(Part part) noexcept override;
  void project_part(Part part, double dt_s) noexcept override;

  /// With s the wind at a strand in half-bend speeds, the bend is max s^2/(1+s^2)
  /// toward the wind: its slope over s, as a vector, is at most 3 sqrt(3)/8 max, so in a tick it changes by at most
  /// that times the largest changes of wind, strength and noise times the maximum of the other factors (of the wind and
  /// the canopy's waves, if the gusts are in the wind), and by at most its whole range. An oscillator moves by at most
  /// its largest gain times that, and by at most its largest rate for a bend within max. A joint moves by at most half
  /// the strand's length (and a link) times that, because link i of n turns by i/n of the bend.
  double largest_joint_step_m(double dt_s) const noexcept override;

  void list_state(StatePass& pass) override {
    pass(wind_, oscillators_);
    if (own_) pass(own_->noise, own_->way);
    if (outside_) pass(outside_->grid, outside_->canopy);
  }

 private:
  /// The scene's own gusts.
  struct OwnGusts {
    OwnGusts(const StrandSwaySpec& spec, std::span<const float> place_x_m, std::span<const float> place_z_m);

    CarriedNoise noise;
    CarriedPlaces places;
    noise::Tile2 along;  ///< Wind-speed, the strength along the wind's way: a line through a noise
    noise::LineCut way;
    double largest_along = 0.0, steepest_along_per_m = 0.0;
    std::vector<float> strength;  ///< of the wind, a factor for each strand
  };

  /// The gusts of the wind.
  struct OutsideGusts {
    OutsideGusts(const pose::StrandSkeleton& strands, const StrandSwaySpec& spec, const Setup& setup);

    WindGrid grid;
    std::vector<float> east_m_s, south_m_s;  ///< each strand's wind
    CarriedNoise canopy;
    CarriedPlaces places;
    std::vector<float> strength;  ///< of that wind, by the canopy's waves
  };

  double largest_bend_input_step(double dt_s) const noexcept;

  SimdRow row_;
  StrandSwaySpec spec_;
  Wind wind_;
  std::optional<OwnGusts> own_;  ///< one of the two
  std::optional<OutsideGusts> outside_;

  std::vector<float> flexibility_;
  operators::Oscillators oscillators_;
  std::vector<float> natural_hz_;
  operators::OscillatorSteps steps_;
  double largest_flexibility_ = 0.0, lever_m_ = 0.0;
  double canopy_carry_ = 0.0;  ///< the canopy's waves run with this part of the wind's speed
  pose::Skeleton skeleton_;
  pose::Pose pose_;
};

/// Its keys (max_bend, half_bend_speed, turbulence ... beta_meaning), with these defaults.
Fields<StrandSwaySpec> strand_sway_fields(const StrandSwaySpec& defaults);

}  // namespace yuragi::scenes
