#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "engine/base/units.hpp"
#include "tests/answer/scene_run.hpp"
#include "tests/answer/scene_table.hpp"
#include "tests/answer/spectra.hpp"

// A flame. Sources of the bounds: its tilt and its length in the wind (Thomas 1963, The size of flames from natural
// fires: cos = 0.7 u*^-0.49, length as u*^-0.21; American Gas Association 1974: cos = u*^-0.5), and its puffing, 1.5 /
// sqrt(D) Hz over a foot of diameter D (Cetegen and Ahmed 1993), 2.1 Hz of 0.5 m.

namespace yuragi::answer {
namespace {

constexpr double kPuffFrom_hz = 1.6;
constexpr double kPuffTo_hz = 2.7;

constexpr std::array kFlameBounds = {
    Bound{"tilt of the heat, mean", "deg", 1, {{{18, 45}, {50, 72}, {58, 78}, {62, 82}}}},
    Bound{"tilt of the heat, sd", "deg", 1, {{{2, 12}, {1, 9}, {0.8, 8}, {0.6, 7}}}},
    Bound{"length", "m", 3, {}},
    Bound{"length / that in calm", "", 2, {{{0.85, 1.1}, {0.58, 0.85}, {0.48, 0.74}, {0.42, 0.68}}}},
    Bound{"heat > 0.3 Hz, peak", "Hz", 2, {{{kPuffFrom_hz, kPuffTo_hz}, {kPuffFrom_hz, kPuffTo_hz}, kAny, kAny}}},
    Bound{"heat's variance in 1.6-2.7 Hz, share", "", 2, {{at_least(0.35), at_least(0.35), kAny, kAny}}},
    Bound{"heat, sd / mean", "", 3, {{{0.08, 0.35}, {0.08, 0.35}, {0.05, 0.3}, {0.05, 0.3}}}},
    // It is not hollow: so much of a ring is hot; and no ring falls far behind the others.
    Bound{"lower half: hot part of a ring", "", 2, {{at_least(0.8), at_least(0.7), at_least(0.6), at_least(0.6)}}},
    Bound{"lower half: least of these", "", 2, {{at_least(0.6), at_least(0.5), at_least(0.5), at_least(0.5)}}},
    Bound{"in calm: tilt of the heat, mean", "deg", 2, {{at_most(5), kAny, kAny, kAny}}},
};

/// What of a flame is seen to be there, and what is hot: on the ramp of 256 colours.
constexpr float kSeen = 40.0F / 255.0F;
constexpr float kHot = 64.0F / 255.0F;
/// How much of a row is seen where the flame still reaches.
constexpr double kReached = 0.02;

class FlameMeter final : public Meter {
 public:
  explicit FlameMeter(const pose::Skeleton& skeleton)
      : columns_(std::get<pose::SurfaceSkeleton>(skeleton).columns),
        rows_(std::get<pose::SurfaceSkeleton>(skeleton).rows),
        hot_(rows_ / 2, 0.0) {
    const auto& surface = std::get<pose::SurfaceSkeleton>(skeleton);
    for (std::size_t i = 0; i < columns_; ++i) {
      const double part = 1.0 / static_cast<double>(columns_);
      foot_m_[0] += part * static_cast<double>(surface.rest_x_m[i]);
      foot_m_[1] += part * static_cast<double>(surface.rest_y_m[i]);
      foot_m_[2] += part * static_cast<double>(surface.rest_z_m[i]);
    }
  }

  void take(std::size_t /*tick*/, const pose::Pose& pose, const pose::Kinematics& joints) override {
    const auto& heat = std::get<pose::SurfacePose>(pose).heat;
    const auto centroid = centroid_of(pose, joints);
    const auto& [place_m, sum] = centroid;
    const double across_m = std::hypot(place_m[0] - foot_m_[0], place_m[2] - foot_m_[2]);
    tilt_deg_.push_back(static_cast<float>(std::atan2(across_m, place_m[1] - foot_m_[1]) / kRadPerDeg));
    heat_.push_back(static_cast<float>(sum));

    // Up the axis, which goes through the middles of the rows.
    double way_m = 0.0;
    double length_m = 0.0;
    std::array<double, 3> before_m = foot_m_;
    for (std::size_t row = 0; row < rows_; ++row) {
      std::array<double, 3> middle_m = {};
      std::size_t seen = 0;
      std::size_t hot = 0;
      for (std::size_t i = row * columns_; i < (row + 1) * columns_; ++i) {
        const pose::JointPosition place = joints.joint(i);
        middle_m[0] += static_cast<double>(place.x_m);
        middle_m[1] += static_cast<double>(place.y_m);
        middle_m[2] += static_cast<double>(place.z_m);
        if (heat[i] > kSeen) ++seen;
        if (heat[i] > kHot) ++hot;
      }
      const auto count = static_cast<double>(columns_);
      for (double& axis_m : middle_m) axis_m /= count;
      way_m += std::hypot(middle_m[0] - before_m[0], middle_m[1] - before_m[1], middle_m[2] - before_m[2]);
      before_m = middle_m;
      if (static_cast<double>(seen) >= kReached * count) length_m = way_m;
      if (row < hot_.size()) hot_[row] += static_cast<double>(hot) / count;
    }
    length_m_.push_back(static_cast<float>(length_m));
    largest_step_m_ = std::max(largest_step_m_, step_m(joints));
  }

  Horizontal direction(const pose::Pose& pose, const pose::Kinematics& joints) const override {
    const auto place_m = centroid_of(pose, joints).first;
    return {place_m[0] - foot_m_[0], place_m[2] - foot_m_[2]};
  }
  double largest_step_m() const override { return largest_step_m_; }

  Figures figures(const WindRecord& /*wind*/) const override {
    Welch welch(kRate_hz);
    const Spectrum heat = welch.of(heat_);
    std::vector<double> hot = hot_;
    for (double& part : hot) part /= static_cast<double>(heat_.size());
    return {
        {"tilt of the heat, mean", mean(tilt_deg_)},
        {"tilt of the heat, sd", deviation(tilt_deg_)},
        {"length", mean(length_m_)},
        {"heat > 0.3 Hz, peak", heat.peak_hz(0.3, 0.5 * kRate_hz)},
        {"heat's variance in 1.6-2.7 Hz, share",
         heat.variance(kPuffFrom_hz, kPuffTo_hz) / heat.variance(0.0, kRate_hz)},
        {"heat, sd / mean", deviation(heat_) / mean(heat_)},
        {"lower half: hot part of a ring", median(hot)},
        {"lower half: least of these", *std::min_element(hot.begin(), hot.end())},
    };
  }

  std::vector<Trace> traces(const WindRecord& /*wind*/) const override {
    return {{"tilt", "deg", tilt_deg_}, {"length", "m", length_m_}, {"heat", "", heat_}};
  }

 private:
  /// Where the heat is on average, and how much of it there is.
  std::pair<std::array<double, 3>, double> centroid_of(const pose::Pose& pose, const pose::Kinematics& joints) const {
    const auto& heat = std::get<pose::SurfacePose>(pose).heat;
    std::array<double, 3> place_m = {};
    double sum = 0.0;
    for (std::size_t i = 0; i < heat.size(); ++i) {
      const pose::JointPosition place = joints.joint(i);
      const auto hot = static_cast<double>(heat[i]);
      place_m[0] += hot * static_cast<double>(place.x_m);
      place_m[1] += hot * static_cast<double>(place.y_m);
      place_m[2] += hot * static_cast<double>(place.z_m);
      sum += hot;
    }
    for (double& axis_m : place_m) axis_m /= std::max(sum, 1e-9);
    return {place_m, sum};
  }

  /// How far the points of two columns have moved since the moment before.
  double step_m(const pose::Kinematics& joints) {
    double largest_m = 0.0;
    std::vector<pose::JointPosition> now;
    for (std::size_t row = 0; row < rows_; row += 4) {
      for (const std::size_t column : {std::size_t{0}, columns_ / 2})
        now.push_back(joints.joint(row * columns_ + column));
    }
    for (std::size_t i = 0; i < before_.size(); ++i) {
      largest_m =
          std::max(largest_m, static_cast<double>(std::hypot(now[i].x_m - before_[i].x_m, now[i].y_m - before_[i].y_m,
                                                             now[i].z_m - before_[i].z_m)));
    }
    before_ = std::move(now);
    return largest_m;
  }

  std::size_t columns_, rows_;
  std::array<double, 3> foot_m_ = {};
  std::vector<double> hot_;  ///< of each row of the lower half: the part that is hot, summed over time
  Series tilt_deg_, heat_, length_m_;
  std::vector<pose::JointPosition> before_;
  double largest_step_m_ = 0.0;
};

/// A minute in calm air: how long it is there, and that it stands upright.
std::array<Figures, kBeauforts> flame_in_calm(const SceneTable& table, std::uint64_t seed) {
  constexpr int kStartTicks = 600;
  constexpr int kRecordTicks = 3600;
  const std::unique_ptr<scenes::Scene> scene = make_scene(table, seed);
  const std::unique_ptr<Meter> meter = table.make_meter(scene->skeleton());
  pose::Kinematics joints(scene->skeleton());
  WindRecord calm;
  Horizontal sum;
  for (int tick = 0; tick < kStartTicks + kRecordTicks; ++tick) {
    scene->tick(wind::Vector{}, kTick_s);
    if (tick < kStartTicks) continue;
    joints.run(scene->pose());
    meter->take(static_cast<std::size_t>(tick - kStartTicks), scene->pose(), joints);
    const Horizontal off = meter->direction(scene->pose(), joints);
    sum = {sum.east + off.east, sum.south + off.south};
  }
  const double length_m = value_of(meter->figures(calm), "length").value();
  std::array<Figures, kBeauforts> figures;
  for (Figures& column : figures) column = {{"length in calm", length_m}};
  // It flickers to all sides, and a minute's flicker leaves some degrees: the mean of where the heat is counts. Half
  // its height is about where that is.
  figures[0].push_back(
      {"in calm: tilt of the heat, mean", std::atan2(sum.length() / kRecordTicks, 0.5 * length_m) / kRadPerDeg});
  return figures;
}

void compare_with_calm(Figures& figures) {
  const std::optional<double> length_m = value_of(figures, "length");
  const std::optional<double> calm_m = value_of(figures, "length in calm");
  if (length_m && calm_m) figures.push_back({"length / that in calm", *length_m / *calm_m});
}

}  // namespace

SceneTable flame_table() {
  return {.name = "flame",
          .scene = "flame",
          .parameters = {},
          .bounds = {kFlameBounds.begin(), kFlameBounds.end()},
          .make_meter = [](const pose::Skeleton& skeleton) -> std::unique_ptr<Meter> {
            return std::make_unique<FlameMeter>(skeleton);
          },
          .further = flame_in_calm,
          .derive = compare_with_calm};
}

}  // namespace yuragi::answer
