#include <array>
#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include "engine/base/units.hpp"
#include "tests/answer/cloth_threads.hpp"
#include "tests/answer/scene_table.hpp"
#include "tests/answer/spectra.hpp"

// A nobori: its cross-arm turns with the wind as a vane does, which turns by 0.8 of the turbulence intensity, rad;
// waves run down its free side, carried as those of a flag are. Its lower end, which loops hold alone, goes the
// farthest, and is seen to go in a breeze. No measurement of a nobori is known: the other bounds are what looks right.

namespace yuragi::answer {
namespace {

constexpr std::array kBannerBounds = {
    Bound{"arm against the wind of 3 s, rms", "deg", 1, {{kAny, at_most(15), at_most(12), at_most(12)}}},
    Bound{"free corner across, sd / width", "", 3, {{at_most(0.03), {0.12, 0.24}, {0.14, 0.26}, {0.16, 0.28}}}},
    Bound{"free edge > 0.3 Hz, centroid", "Hz", 2, {{kAny, {1.0, 2.0}, {2.1, 4.1}, {3.4, 6.5}}}},
    Bound{"phase speed / U", "", 2, {{kAny, {0.4, 0.75}, {0.4, 0.75}, {0.4, 0.75}}}},
    Bound{"correlation at that lag", "", 2, {}},
    Bound{"growth: mid height over the bottom", "", 2, {{kAny, {0.45, 1}, {0.45, 1}, {0.45, 1}}}},
    Bound{"free corner, speed", "m/s", 2, {}},
    Bound{"free corner, speed / the number before", "", 2, {{kAny, at_least(2), at_least(1.2), at_least(1)}}},
};

class BannerMeter final : public Meter {
 public:
  explicit BannerMeter(const pose::Skeleton& skeleton) : BannerMeter(std::get<pose::GridSkeleton>(skeleton)) {}

  void take(std::size_t /*tick*/, const pose::Pose& /*pose*/, const pose::Kinematics& joints) override {
    sides_.tracks().take(joints);
  }
  Horizontal direction(const pose::Pose& /*pose*/, const pose::Kinematics& joints) const override {
    const pose::JointPosition pole = joints.joint(0);
    const pose::JointPosition end = joints.joint(columns_ - 1);
    return {static_cast<double>(end.x_m - pole.x_m), static_cast<double>(end.z_m - pole.z_m)};
  }
  double largest_step_m() const override { return sides_.tracks().largest_step_m(); }

  Figures figures(const WindRecord& wind) const override {
    Welch welch(kRate_hz);
    std::vector<double> edge_hz;
    for (const Joint joint : {Joint::kQuarter, Joint::kHalf, Joint::kLate, Joint::kTip}) {
      edge_hz.push_back(welch.of(across_m(joint)).centroid_hz(kAcrossFrom_hz));
    }
    const auto quick_sd_m = [&](Joint joint) { return welch.of(across_m(joint)).deviation_above(kAcrossFrom_hz); };
    // Of ways aside, not of slopes down the thread: a wave that grows slopes with a phase of its own.
    const Lag lag = lag_of(quick_m(Joint::kHalf), quick_m(Joint::kLate), kRate_hz, -kMaxLag_s, kMaxLag_s);
    return {
        {"arm against the wind of 3 s, rms", arm_against_wind_deg(wind)},
        {"free corner across, sd / width", quick_sd_m(Joint::kTip) / width_m_},
        {"free edge > 0.3 Hz, centroid", median(edge_hz)},
        {"phase speed / U", sides_.speed_m_s(lag) / wind.mean_speed_m_s()},
        {"correlation at that lag", lag.correlation},
        {"growth: mid height over the bottom", quick_sd_m(Joint::kHalf) / quick_sd_m(Joint::kTip)},
        {"free corner, speed", sides_.tracks().speed_m_s(sides_.at(kFree, Joint::kTip), kRate_hz)},
    };
  }

  std::vector<Trace> traces(const WindRecord& wind) const override {
    Series wind_deg, arm_deg;
    for (std::size_t k = 0; k < wind.east_m_s().size(); ++k) {
      wind_deg.push_back(static_cast<float>(heading_deg(wind_at(wind, k))));
      arm_deg.push_back(static_cast<float>(heading_deg(arm(k))));
    }
    return {
        {"wind toward", "deg", wind_deg}, {"arm", "deg", arm_deg}, {"free corner across", "m", across_m(Joint::kTip)}};
  }

 private:
  using Joint = ClothThreads::Joint;
  static constexpr std::size_t kPole = 0, kFree = 1;  ///< its two sides
  static constexpr double kMaxLag_s = 1.5;

  explicit BannerMeter(const pose::GridSkeleton& grid)
      : columns_(grid.columns),
        width_m_(static_cast<double>(std::hypot(grid.rest_x_m[columns_ - 1] - grid.rest_x_m[0],
                                                grid.rest_z_m[columns_ - 1] - grid.rest_z_m[0]))),
        sides_(grid, {0, grid.columns - 1}) {}

  static double heading_deg(Horizontal way) { return std::atan2(way.east, way.south) / kRadPerDeg; }
  static Horizontal wind_at(const WindRecord& wind, std::size_t k) {
    return {static_cast<double>(wind.east_m_s()[k]), static_cast<double>(wind.south_m_s()[k])};
  }

  /// The cross-arm at a moment.
  Horizontal arm(std::size_t k) const { return way(Joint::kFirst, k); }

  Horizontal way(Joint joint, std::size_t k) const {
    const JointTracks& tracks = sides_.tracks();
    const std::size_t pole = sides_.at(kPole, joint);
    const std::size_t free = sides_.at(kFree, joint);
    return {static_cast<double>(tracks.x_m(free)[k] - tracks.x_m(pole)[k]),
            static_cast<double>(tracks.z_m(free)[k] - tracks.z_m(pole)[k])};
  }

  /// How far a joint of the free side is aside of the arm as it stands at that moment.
  Series across_m(Joint joint) const {
    Series across(sides_.tracks().x_m(0).size());
    for (std::size_t k = 0; k < across.size(); ++k) {
      across[k] = static_cast<float>(way(joint, k).dot(arm(k).unit().aside()));
    }
    return across;
  }

  /// The part of it that is quicker than the turns of the whole.
  Series quick_m(Joint joint) const { return high_passed(across_m(joint), kRate_hz, kAcrossFrom_hz); }

  /// Against the wind's mean of the 3 s about each moment.
  double arm_against_wind_deg(const WindRecord& wind) const {
    constexpr std::size_t kMeanTicks = 181;
    const Series east_m_s = running_mean(wind.east_m_s(), kMeanTicks);
    const Series south_m_s = running_mean(wind.south_m_s(), kMeanTicks);
    double sum = 0.0;
    for (std::size_t k = 0; k < east_m_s.size(); ++k) {
      const Horizontal air{static_cast<double>(east_m_s[k]), static_cast<double>(south_m_s[k])};
      const Horizontal now = arm(k + kMeanTicks / 2);
      const double turn_rad = std::atan2(now.dot(air.aside()), now.dot(air));
      sum += turn_rad * turn_rad;
    }
    return std::sqrt(sum / static_cast<double>(east_m_s.size())) / kRadPerDeg;
  }

  std::size_t columns_;
  double width_m_;
  ClothThreads sides_;
};

}  // namespace

SceneTable banner_table() {
  return {.name = "banner",
          .scene = "banner",
          .parameters = {{"columns", std::int64_t{32}}, {"rows", std::int64_t{128}}},
          .bounds = {kBannerBounds.begin(), kBannerBounds.end()},
          .make_meter = [](const pose::Skeleton& skeleton) -> std::unique_ptr<Meter> {
            return std::make_unique<BannerMeter>(skeleton);
          }};
}

}  // namespace yuragi::answer
