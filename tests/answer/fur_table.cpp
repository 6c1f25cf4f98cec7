#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <variant>
#include <vector>

#include "tests/answer/field.hpp"
#include "tests/answer/joint_speeds.hpp"
#include "tests/answer/scene_table.hpp"
#include "tests/answer/spectra.hpp"

// Fur on a body. No measurement of fur in the wind is known: all bounds are what looks right, but that hairs shall not
// all move as one.

namespace yuragi::answer {
namespace {

constexpr std::array kFurBounds = {
    Bound{"bend of exposed hairs, mean", "deg", 1, {{at_most(4), {15, 32}, {38, 62}, {52, 76}}}},
    Bound{"differences at one moment", "deg", 1, {{at_most(1), {2.5, 8}, {6, 15}, {8, 18}}}},
    Bound{"differences > 0.3 Hz, centroid", "Hz", 2, {{kAny, {1.2, 3}, {2.4, 4.6}, {2.6, 4.8}}}},
    Bound{"speed of partings", "m/s", 2, {{kAny, {0.4, 0.9}, {0.9, 1.9}, {1.0, 2.0}}}},
    Bound{"sd of the hairs' mean / the hairs' sd", "", 2, {{kAny, at_most(0.9), at_most(0.75), at_most(0.6)}}},
    Bound{"hair tip, speed", "m/s", 3, {}},
    Bound{"hair tip, speed / the number before", "", 2, {{kAny, at_least(2), at_least(1.2), at_least(1)}}},
};

/// Where a hair stands on the body, as its roots show it: the upper half of an ellipsoid that lies from west to east.
struct HairPlace {
  std::array<double, 3> normal = {};  ///< of the skin: unit vector
  double along_body_m = 0.0;          ///< to the east
  double around_body_m = 0.0;         ///< over the back, from north to south: 0 on the ridge
};

class Body {
 public:
  explicit Body(const pose::StrandSkeleton& hairs) {
    const auto half_range = [&](const std::vector<float>& place_m) {
      const auto end = place_m.begin() + static_cast<std::ptrdiff_t>(hairs.strand_count);
      const auto [least, most] = std::minmax_element(place_m.begin(), end);
      return 0.5 * static_cast<double>(*most - *least);
    };
    half_m_ = {half_range(hairs.root_x_m), 0.0, half_range(hairs.root_z_m)};
    const auto end = hairs.root_y_m.begin() + static_cast<std::ptrdiff_t>(hairs.strand_count);
    half_m_[1] = static_cast<double>(*std::max_element(hairs.root_y_m.begin(), end));
  }

  HairPlace place(const pose::StrandSkeleton& hairs, std::size_t hair) const {
    const std::array at_m = {static_cast<double>(hairs.root_x_m[hair]), static_cast<double>(hairs.root_y_m[hair]),
                             static_cast<double>(hairs.root_z_m[hair])};
    HairPlace place;
    for (std::size_t axis = 0; axis < 3; ++axis) place.normal[axis] = at_m[axis] / (half_m_[axis] * half_m_[axis]);
    const double length = std::hypot(place.normal[0], place.normal[1], place.normal[2]);
    for (double& part : place.normal) part /= length;
    place.along_body_m = at_m[0];
    place.around_body_m = std::atan2(at_m[2] / half_m_[2], at_m[1] / half_m_[1]) * 0.5 * (half_m_[1] + half_m_[2]);
    return place;
  }

  std::array<double, 3> half_m() const { return half_m_; }

 private:
  std::array<double, 3> half_m_ = {};
};

class FurMeter final : public Meter {
 public:
  explicit FurMeter(const pose::Skeleton& skeleton) : FurMeter(std::get<pose::StrandSkeleton>(skeleton)) {}

  bool needs_joints(std::size_t tick) const override { return JointSpeeds::needs_joints(tick); }

  void take(std::size_t tick, const pose::Pose& pose, const pose::Kinematics& joints) override {
    hairs_.take(pose);
    tips_.take(tick, joints);
  }

  Horizontal direction(const pose::Pose& pose, const pose::Kinematics& /*joints*/) const override {
    const auto& bends = std::get<pose::StrandPose>(pose);
    Horizontal sum;
    for (std::size_t i = 0; i < hairs_.count(); ++i) {
      sum.east += static_cast<double>(bends.bend_east_rad[hairs_.strand(i)]);
      sum.south += static_cast<double>(bends.bend_south_rad[hairs_.strand(i)]);
    }
    return sum;
  }
  double largest_step_m() const override { return tips_.largest_step_m(); }

  Figures figures(const WindRecord& wind) const override {
    const Horizontal downwind = wind.downwind();
    const std::vector<Series> along_deg = hairs_.along_deg(downwind);
    const Series common_deg = mean_at_each_moment(along_deg);

    Welch welch(kRate_hz);
    std::vector<double> exposed_deg, deviations_deg, centroids_hz;
    std::vector<FieldPoint> field;
    for (std::size_t i = 0; i < along_deg.size(); ++i) {
      const auto& normal = places_[i].normal;
      if (normal[0] * downwind.east + normal[2] * downwind.south <= kExposed) exposed_deg.push_back(mean(along_deg[i]));
      deviations_deg.push_back(deviation(along_deg[i]));

      Series own_deg = along_deg[i];
      for (std::size_t k = 0; k < own_deg.size(); ++k) own_deg[k] -= common_deg[k];
      centroids_hz.push_back(welch.of(own_deg).centroid_hz(kOwnFrom_hz));
      // The wind of the record blows across the body: what goes with it goes around.
      field.push_back({.along_m = downwind.south < 0.0 ? -places_[i].around_body_m : places_[i].around_body_m,
                       .across_m = places_[i].along_body_m,
                       .values = high_passed(own_deg, kRate_hz, kOwnFrom_hz)});
    }
    std::vector<double> speeds_m_s;
    for (const double distance_m : {0.13, 0.195, 0.26}) {
      speeds_m_s.push_back(field_speed_m_s(
          field, {.distance_m = distance_m, .along_tolerance_m = 0.02, .across_tolerance_m = 0.03, .most = kMaxPairs},
          kRate_hz, kSlowest_m_s));
    }
    return {
        {"bend of exposed hairs, mean", median(exposed_deg)},
        {"differences at one moment", difference_at_one_moment(along_deg)},
        {"differences > 0.3 Hz, centroid", median(centroids_hz)},
        {"speed of partings", median(speeds_m_s)},
        {"sd of the hairs' mean / the hairs' sd", deviation(common_deg) / median(deviations_deg)},
        {"hair tip, speed", tips_.median_m_s(kRate_hz)},
    };
  }

  std::vector<Trace> traces(const WindRecord& wind) const override {
    const std::vector<Series> along_deg = hairs_.along_deg(wind.downwind());
    return {{"mean bend", "deg", mean_at_each_moment(along_deg)},
            {"bend of a hair", "deg", along_deg[along_deg.size() / 2]}};
  }

 private:
  /// A hair is exposed where the skin faces the wind, or turns away from it by no more than 10 degrees beyond a right
  /// angle: the part of the skin's normal that is downwind is at most this.
  static constexpr double kExposed = 1.0 / 6.0;
  static constexpr double kOwnFrom_hz = 0.3;
  static constexpr double kSlowest_m_s = 0.15;
  static constexpr std::size_t kMaxPairs = 48;

  explicit FurMeter(const pose::StrandSkeleton& hairs) : FurMeter(hairs, hairs_of(hairs)) {}
  FurMeter(const pose::StrandSkeleton& strands, const std::vector<std::size_t>& hairs)
      : hairs_(hairs), tips_(tips_of(strands, hairs)) {
    const Body body(strands);
    for (const std::size_t hair : hairs) places_.push_back(body.place(strands, hair));
  }

  /// Hairs near the nodes of a grid over the body: six rings, hairs 6.5 cm apart in each.
  static std::vector<std::size_t> hairs_of(const pose::StrandSkeleton& strands) {
    constexpr double kPitch_m = 0.065;
    const Body body(strands);
    std::vector<HairPlace> places;
    for (std::size_t i = 0; i < strands.strand_count; ++i) places.push_back(body.place(strands, i));
    const double reach_m = 0.25 * std::numbers::pi * (body.half_m()[1] + body.half_m()[2]);
    std::vector<std::size_t> hairs;
    for (const double part : {-0.7, -0.45, -0.15, 0.15, 0.45, 0.7}) {
      for (double around_m = -reach_m; around_m < reach_m; around_m += kPitch_m) {
        const auto off_m = [&](const HairPlace& place) {
          return std::hypot(place.along_body_m - part * body.half_m()[0], place.around_body_m - around_m);
        };
        const auto nearest = std::min_element(
            places.begin(), places.end(), [&](const HairPlace& a, const HairPlace& b) { return off_m(a) < off_m(b); });
        hairs.push_back(static_cast<std::size_t>(std::distance(places.begin(), nearest)));
      }
    }
    return hairs;
  }
  static std::vector<std::size_t> tips_of(const pose::StrandSkeleton& strands, std::vector<std::size_t> hairs) {
    for (std::size_t& hair : hairs) hair = hair * strands.links_per_strand + strands.links_per_strand - 1;
    return hairs;
  }

  BendTracks hairs_;
  JointSpeeds tips_;
  std::vector<HairPlace> places_;
};

}  // namespace

/// Fewer hairs than a coat is shown with, on as large a body.
SceneTable fur_table() {
  return {.name = "fur",
          .scene = "fur",
          .parameters = {{"hairs_along", std::int64_t{120}}, {"hairs_around", std::int64_t{80}}},
          .bounds = {kFurBounds.begin(), kFurBounds.end()},
          .make_meter = [](const pose::Skeleton& skeleton) -> std::unique_ptr<Meter> {
            return std::make_unique<FurMeter>(skeleton);
          }};
}

}  // namespace yuragi::answer
