#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "tests/answer/field.hpp"
#include "tests/answer/joint_speeds.hpp"
#include "tests/answer/scene_table.hpp"
#include "tests/answer/spectra.hpp"

// A meadow. Sources of the bounds: waves that run over a field of plants lock to the plants' own frequency (Py, de
// Langre and Moulia 2006; Doare and others 2004), and go at 1.8 times the wind at the top of the plants, 3.3 u*, over a
// stand of height h with d = 0.67 h and z0 = 0.1 h (Raupach, Finnigan and Brunet 1996); plants that lie flat wave less
// (Finnigan 1979). How far blades bend is what looks right.

namespace yuragi::answer {
namespace {

constexpr std::array kGrassBounds = {
    Bound{"bend along, mean", "deg", 1, {{at_most(4), {15, 32}, {40, 60}, {56, 74}}}},
    Bound{"bend along, sd", "deg", 1, {{at_most(2), {4, 13}, {6, 17}, {3, 12}}}},
    Bound{"differences at one moment", "deg", 1, {{kAny, {3, 9}, {4.5, 13}, {2, 8}}}},
    Bound{"bend along > 0.3 Hz, peak", "Hz", 2, {{kAny, {0.6, 2.0}, {1.2, 2.6}, {1.3, 2.8}}}},
    Bound{"phase speed / U", "", 2, {}},
    Bound{"answer", "", 2, {{kAny, at_least(0.5), kAny, kAny}}},
    Bound{"tip, speed", "m/s", 3, {}},
    // In a storm it lies down, and may move less than in a fresh breeze.
    Bound{"tip, speed / the number before", "", 2, {{kAny, at_least(2), at_least(1.2), at_least(0.4)}}},
};

/// The law's constants are means over many kinds of plants.
constexpr Bound kWaveBound = {
    "stand's waves, speed / its law", "", 2, {{kAny, {0.85, 1.15}, {0.85, 1.15}, {0.85, 1.15}}}};

class GrassMeter final : public Meter {
 public:
  explicit GrassMeter(const pose::Skeleton& skeleton) : GrassMeter(std::get<pose::StrandSkeleton>(skeleton)) {}

  bool needs_joints(std::size_t tick) const override { return JointSpeeds::needs_joints(tick); }

  void take(std::size_t tick, const pose::Pose& pose, const pose::Kinematics& joints) override {
    blades_.take(pose);
    tips_.take(tick, joints);
  }

  Horizontal direction(const pose::Pose& pose, const pose::Kinematics& /*joints*/) const override {
    const auto& bends = std::get<pose::StrandPose>(pose);
    Horizontal sum;
    for (std::size_t i = 0; i < blades_.count(); ++i) {
      sum.east += static_cast<double>(bends.bend_east_rad[blades_.strand(i)]);
      sum.south += static_cast<double>(bends.bend_south_rad[blades_.strand(i)]);
    }
    return sum;
  }
  double largest_step_m() const override { return tips_.largest_step_m(); }

  Figures figures(const WindRecord& wind) const override {
    const Horizontal downwind = wind.downwind();
    const std::vector<Series> along_deg = blades_.along_deg(downwind);
    Welch welch(kRate_hz);
    std::vector<double> means, deviations, peaks_hz;
    std::vector<FieldPoint> field, waves;
    const Series whole_deg = mean_at_each_moment(along_deg);
    for (std::size_t i = 0; i < along_deg.size(); ++i) {
      means.push_back(mean(along_deg[i]));
      deviations.push_back(deviation(along_deg[i]));
      peaks_hz.push_back(welch.of(along_deg[i]).peak_hz(kPeakFrom_hz, 0.5 * kRate_hz));
      field.push_back({.along_m = places_[i].dot(downwind),
                       .across_m = places_[i].dot(downwind.aside()),
                       .values = high_passed(along_deg[i], kRate_hz, kFieldFrom_hz)});
      waves.push_back({.along_m = field.back().along_m,
                       .across_m = field.back().across_m,
                       .values = signs_of_waves(along_deg[i], whole_deg)});
    }
    const auto speed_over_u = [&wind](const std::vector<FieldPoint>& points) {
      std::vector<double> speeds_m_s;
      for (const double distance_m : {1.0, 2.0, 3.0}) {
        speeds_m_s.push_back(
            field_speed_m_s(points, {.distance_m = distance_m}, kRate_hz, kSlowest * wind.mean_speed_m_s()));
      }
      return median(speeds_m_s) / wind.mean_speed_m_s();
    };
    return {
        {"bend along, mean", median(means)},
        {"bend along, sd", median(deviations)},
        {"differences at one moment", difference_at_one_moment(along_deg)},
        {"bend along > 0.3 Hz, peak", median(peaks_hz)},
        {"phase speed / U", speed_over_u(field)},
        {"stand's waves, speed / its law", speed_over_u(waves) / stand_wave_speed(height_m_)},
        {"answer", wind.answer_of(mean_at_each_moment(along_deg))},
        {"tip, speed", tips_.median_m_s(kRate_hz)},
    };
  }

  std::vector<Trace> traces(const WindRecord& wind) const override {
    const std::vector<Series> along_deg = blades_.along_deg(wind.downwind());
    return {{"mean bend", "deg", mean_at_each_moment(along_deg)},
            {"bend of a blade", "deg", along_deg[along_deg.size() / 2]}};
  }

 private:
  static constexpr double kPeakFrom_hz = 0.3;
  static constexpr double kFieldFrom_hz = 0.5;
  static constexpr double kSlowest = 0.25;  ///< of the wind: what goes slower is not carried by it

  /// Of a blade's bend less what all blades do at once, since gusts from above are longer than the meadow, and faster.
  /// By the sign alone: the waves of strong gusts, which run faster, bend a blade several times as far as those of the
  /// mean wind, and would count more by the square of that.
  static Series signs_of_waves(Series along_deg, const Series& whole_deg) {
    for (std::size_t i = 0; i < along_deg.size(); ++i) along_deg[i] -= whole_deg[i];
    Series signs = high_passed(along_deg, kRate_hz, kFieldFrom_hz);
    for (float& value : signs) value = std::copysign(1.0F, value);
    return signs;
  }

  explicit GrassMeter(const pose::StrandSkeleton& strands) : GrassMeter(strands, blades_of(strands)) {}
  GrassMeter(const pose::StrandSkeleton& strands, const std::vector<std::size_t>& blades)
      : blades_(blades), tips_(tips_of(strands, blades)), height_m_(mean_length_m(strands)) {
    for (const std::size_t blade : blades) {
      places_.push_back({static_cast<double>(strands.root_x_m[blade]), static_cast<double>(strands.root_z_m[blade])});
    }
  }

  static double mean_length_m(const pose::StrandSkeleton& strands) {
    double sum_m = 0.0;
    for (std::size_t i = 0; i < strands.strand_count; ++i) sum_m += static_cast<double>(strands.link_length_m[i]);
    return static_cast<double>(strands.links_per_strand) * sum_m / static_cast<double>(strands.strand_count);
  }
  /// Over the wind 10 m up.
  static double stand_wave_speed(double height_m) {
    const double friction = 0.41 / std::log((10.0 - 0.67 * height_m) / (0.1 * height_m));
    return 1.8 * 3.3 * friction;
  }

  /// Blades near the nodes of a coarse grid: rows downwind, of which some pairs stand whole metres apart.
  static std::vector<std::size_t> blades_of(const pose::StrandSkeleton& strands) {
    std::vector<std::size_t> blades;
    for (double east_m = -2.7; east_m < 3.0; east_m += 0.9) {
      for (double south_m = -3.0; south_m < 3.1; south_m += 0.5) blades.push_back(nearest(strands, {east_m, south_m}));
    }
    return blades;
  }
  static std::size_t nearest(const pose::StrandSkeleton& strands, Horizontal place) {
    std::size_t best = 0;
    double best_m = 1e9;
    for (std::size_t i = 0; i < strands.strand_count; ++i) {
      const Horizontal off{static_cast<double>(strands.root_x_m[i]) - place.east,
                           static_cast<double>(strands.root_z_m[i]) - place.south};
      if (off.length() < best_m) {
        best_m = off.length();
        best = i;
      }
    }
    return best;
  }
  static std::vector<std::size_t> tips_of(const pose::StrandSkeleton& strands, std::vector<std::size_t> blades) {
    for (std::size_t& blade : blades) blade = blade * strands.links_per_strand + strands.links_per_strand - 1;
    return blades;
  }

  BendTracks blades_;
  JointSpeeds tips_;
  double height_m_;                 ///< of the stand
  std::vector<Horizontal> places_;  ///< of the blades
};

/// Fewer blades than a meadow is shown with, on as much ground.
SceneTable table_of(std::string_view name, double blade_length_m, std::vector<Bound> bounds) {
  return {.name = name,
          .scene = "grass",
          .parameters = {{"blades_across", std::int64_t{50}},
                         {"blades_deep", std::int64_t{50}},
                         {"blade_length", blade_length_m}},
          .bounds = std::move(bounds),
          .make_meter = [](const pose::Skeleton& skeleton) -> std::unique_ptr<Meter> {
            return std::make_unique<GrassMeter>(skeleton);
          }};
}

}  // namespace

SceneTable grass_table() {
  std::vector<Bound> bounds(kGrassBounds.begin(), kGrassBounds.end());
  bounds.push_back(kWaveBound);
  return table_of("grass", 0.7, std::move(bounds));
}

SceneTable short_grass_table() {
  return table_of("short_grass", 0.3, {kWaveBound});
}

SceneTable tall_grass_table() {
  return table_of("tall_grass", 1.0, {kWaveBound});
}

}  // namespace yuragi::answer
