#include <memory>
#include <string>
#include <vector>

#include "engine/math/philox.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/scenes/meadow.hpp"
#include "engine/scenes/placement.hpp"
#include "engine/scenes/scene.hpp"
#include "engine/scenes/strand_sway.hpp"

// Grass in the wind (Chiba, section 3.1): a meadow laid out by noise, and the wind on the ground that passes over it
// (StrandSway, which says how).

namespace yuragi {
namespace {

/// 256 m in 512 samples are cells of 0.5 m: what is read stays below half the tick rate up to 30 m/s at 60 Hz
/// (|k| U < pi rate), so that in a storm no blade jitters from tick to tick.
constexpr StrandSwaySpec kGrassSway = {};

std::vector<Parameter> grass_parameters() {
  std::vector<Parameter> parameters = {
      {"blades_across", "", std::int64_t{100}, 1, 2000, "blades from west to east"},
      {"blades_deep", "", std::int64_t{100}, 1, 2000, "blades from north to south"},
      {"links", "", std::int64_t{10}, 1, 64, "links of a blade"},
      {"width", "m", 7.0, 0.1, 200, "the meadow from west to east"},
      {"depth", "m", 7.0, 0.1, 200, "the meadow from north to south"},
      {"blade_length", "m", 0.7, 0.05, 3, "length of a blade, on average"},
      {"blade_length_variation", "", 0.25, 0, 0.5, "standard deviation of the length, as a part of it"},
      {"tilt", "deg", 8.0, 0, 60, "how far a blade's foot leans in calm air, on average"},
      {"curl", "deg", 35.0, 0, 180, "how far a blade droops from foot to tip in calm air, on average"},
      {"droop_heading", "deg", 0.0, 0, 360, "where blades droop to on average, clockwise from north"},
      {"droop_spread", "deg", 150.0, 0, 180, "standard deviation of where they droop to"},
  };
  for (const Parameter& parameter : strand_sway_parameters(kGrassSway)) parameters.push_back(parameter);
  return parameters;
}
const std::vector<Parameter> kGrassParameters = grass_parameters();

std::size_t size_in(const ParameterValues& values, std::string_view name) {
  return static_cast<std::size_t>(values.integer(name));
}

Meadow placed_meadow(const ParameterValues& values, const SceneSetup& setup) {
  Meadow meadow = make_meadow({.blades_across = size_in(values, "blades_across"),
                               .blades_deep = size_in(values, "blades_deep"),
                               .links = size_in(values, "links"),
                               .width_m = values.number("width"),
                               .depth_m = values.number("depth"),
                               .length_m = values.number("blade_length"),
                               .length_variation = values.number("blade_length_variation"),
                               .tilt_deg = values.number("tilt"),
                               .curl_deg = values.number("curl"),
                               .heading_deg = values.number("droop_heading"),
                               .heading_spread_deg = values.number("droop_spread"),
                               .seed = setup.seed});
  place(setup.placement, meadow.skeleton);
  return meadow;
}

class Grass final : public Scene {
 public:
  Grass(const ParameterValues& values, const SceneSetup& setup) : Grass(placed_meadow(values, setup), values, setup) {}

  const Skeleton& skeleton() const noexcept override { return skeleton_; }
  const Pose& pose() const noexcept override { return pose_; }
  void shift(WindVector wind, double dt_s) noexcept override { sway_.shift(wind, dt_s); }
  void sample() noexcept override { sway_.sample({}); }
  void project(double dt_s) noexcept override { project_part({}, dt_s); }
  void sample_part(Part part) noexcept override { sway_.sample(part); }
  void project_part(Part part, double dt_s) noexcept override {
    sway_.project(part, dt_s, *std::get_if<StrandPose>(&pose_));
  }
  double largest_joint_step_m(double dt_s) const noexcept override { return sway_.largest_joint_step_m(dt_s); }

 private:
  Grass(Meadow meadow, const ParameterValues& values, const SceneSetup& setup)
      : sway_(meadow.skeleton, meadow.skeleton.root_x_m, meadow.skeleton.root_z_m, std::move(meadow.flexibility),
              strand_sway_spec(values, setup.seed ^ stream_id("grass wind on the ground")), setup.row),
        skeleton_(std::move(meadow.skeleton)),
        pose_(rest_pose(skeleton_)) {}

  StrandSway sway_;
  Skeleton skeleton_;
  Pose pose_;
};

}  // namespace

extern const SceneDescription kGrassScene;
const SceneDescription kGrassScene = {.name = "grass",
                                      .summary = "a meadow in the wind: blades bend as gusts pass over them",
                                      .parameters = kGrassParameters,
                                      .make = [](const ParameterValues& values, const SceneSetup& setup) {
                                        return std::unique_ptr<Scene>(std::make_unique<Grass>(values, setup));
                                      }};

}  // namespace yuragi
