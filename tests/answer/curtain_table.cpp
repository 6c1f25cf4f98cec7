#include <array>
#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include "tests/answer/cloth_threads.hpp"
#include "tests/answer/scene_run.hpp"
#include "tests/answer/scene_table.hpp"
#include "tests/answer/spectra.hpp"
#include "tests/answer/swing.hpp"

// A curtain hangs from a rail across the wind; L is its height. Its chord is the balance of the wind's force on its
// face and its weight. Left to itself it swings as a hanging chain, at 1.2024 sqrt(g / L) / 2 pi (Bernoulli), 0.387 Hz
// at 2.4 m. No measurement of a curtain's hem is known: those bounds are what looks right.

namespace yuragi::answer {
namespace {

/// The hem's own motion counts from here on.
constexpr double kHemFrom_hz = 0.5;

constexpr std::array kCurtainBounds = {
    Bound{"chord angle, mean", "deg", 1, {{{0.8, 3}, {18, 33}, {40, 57}, {53, 70}}}},
    Bound{"chord angle, sd", "deg", 1, {{{0.2, 1.6}, {2.5, 11}, {2.5, 11}, {2, 9}}}},
    Bound{"billow, mean / L", "", 3, {{{0, 0.01}, {0.03, 0.08}, {0.045, 0.10}, {0.04, 0.10}}}},
    Bound{"hem shape, sd / L", "", 3, {{kAny, at_least(0.012), at_least(0.012), at_least(0.010)}}},
    Bound{"hem > 0.5 Hz, sd / L", "", 4, {{at_most(0.003), {0.01, 0.06}, {0.01, 0.05}, {0.008, 0.045}}}},
    Bound{"hem > 0.5 Hz, centroid", "Hz", 2, {{kAny, {0.6, 1.2}, {0.9, 2.4}, {1.2, 3.7}}}},
    Bound{"after a step to calm: frequency", "Hz", 3, {{{0.33, 0.45}, kAny, kAny, kAny}}},
    Bound{"after a step to calm: damping", "", 2, {{{0.1, 0.4}, kAny, kAny, kAny}}},
    Bound{"answer", "", 2, {{kAny, at_least(0.5), kAny, kAny}}},
    Bound{"free corner, speed", "m/s", 2, {}},
    // In a storm it lies in the wind, and may move less than in a fresh breeze.
    Bound{"free corner, speed / the number before", "", 2, {{kAny, at_least(2), at_least(1.2), at_least(0.4)}}},
};

/// The hem of a curtain: how far its joints are from their places at rest.
class Hem {
 public:
  explicit Hem(const pose::GridSkeleton& grid) : Hem(grid, spread(grid.columns, kJoints)) {}

  JointTracks& tracks() { return tracks_; }
  const JointTracks& tracks() const { return tracks_; }

  /// The distance of the hem from the straight line that fits it best at a moment, as the root of its mean square over
  /// joints and time. Of how far joints are from rest: what it is gathered in at rest is no motion. It is measured in
  /// the plane across the rail.
  double shape_m(Horizontal normal) const {
    double sum_m2 = 0.0;
    const std::size_t moments = tracks_.x_m(0).size();
    std::vector<double> way(tracks_.count()), out_m(way.size()), up_m(way.size());
    for (std::size_t k = 0; k < moments; ++k) {
      for (std::size_t i = 0; i < way.size(); ++i) {
        const Horizontal moved{static_cast<double>(tracks_.x_m(i)[k] - rest_x_m_[i]),
                               static_cast<double>(tracks_.z_m(i)[k] - rest_z_m_[i])};
        way[i] = static_cast<double>(i);
        out_m[i] = moved.dot(normal);
        up_m[i] = static_cast<double>(tracks_.y_m(i)[k] - rest_y_m_[i]);
      }
      sum_m2 += off_line(way, out_m) + off_line(way, up_m);
    }
    return std::sqrt(sum_m2 / static_cast<double>(moments));
  }

 private:
  static constexpr std::size_t kJoints = 33;

  Hem(const pose::GridSkeleton& grid, const std::vector<std::size_t>& columns) : tracks_(joints_of(grid, columns)) {
    for (const std::size_t column : columns) {
      const std::size_t at = (grid.rows - 1) * grid.stride() + column;
      rest_x_m_.push_back(grid.rest_x_m[at]);
      rest_y_m_.push_back(grid.rest_y_m[at]);
      rest_z_m_.push_back(grid.rest_z_m[at]);
    }
  }

  static std::vector<std::size_t> joints_of(const pose::GridSkeleton& grid, std::vector<std::size_t> columns) {
    for (std::size_t& column : columns) column += (grid.rows - 1) * grid.columns;
    return columns;
  }

  /// The mean square of what a straight line leaves.
  static double off_line(const std::vector<double>& x, const std::vector<double>& y) {
    const double x_mean = mean_of(x);
    const double y_mean = mean_of(y);
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      xx += (x[i] - x_mean) * (x[i] - x_mean);
      xy += (x[i] - x_mean) * (y[i] - y_mean);
      yy += (y[i] - y_mean) * (y[i] - y_mean);
    }
    return (yy - xy * xy / xx) / static_cast<double>(x.size());
  }

  std::vector<float> rest_x_m_, rest_y_m_, rest_z_m_;
  JointTracks tracks_;
};

/// The distance of a joint from the straight line through two others, meaned over time.
double mean_distance_m(const JointTracks& tracks, std::size_t joint, std::size_t from, std::size_t to) {
  double sum_m = 0.0;
  const std::size_t moments = tracks.x_m(joint).size();
  for (std::size_t k = 0; k < moments; ++k) {
    const auto way = [&](std::size_t end, std::size_t begin) {
      return std::array{static_cast<double>(tracks.x_m(end)[k] - tracks.x_m(begin)[k]),
                        static_cast<double>(tracks.y_m(end)[k] - tracks.y_m(begin)[k]),
                        static_cast<double>(tracks.z_m(end)[k] - tracks.z_m(begin)[k])};
    };
    const auto chord = way(to, from);
    const auto side = way(joint, from);
    const double cross_m2 = std::hypot(chord[1] * side[2] - chord[2] * side[1], chord[2] * side[0] - chord[0] * side[2],
                                       chord[0] * side[1] - chord[1] * side[0]);
    sum_m += cross_m2 / std::hypot(chord[0], chord[1], chord[2]);
  }
  return sum_m / static_cast<double>(moments);
}

class CurtainMeter final : public Meter {
 public:
  explicit CurtainMeter(const pose::Skeleton& skeleton) : CurtainMeter(std::get<pose::GridSkeleton>(skeleton)) {}

  void take(std::size_t /*tick*/, const pose::Pose& /*pose*/, const pose::Kinematics& joints) override {
    threads_.tracks().take(joints);
    hem_.tracks().take(joints);
  }
  Horizontal direction(const pose::Pose& /*pose*/, const pose::Kinematics& joints) const override {
    return threads_.tip_way(joints);
  }
  double largest_step_m() const override { return hem_.tracks().largest_step_m(); }

  Figures figures(const WindRecord& wind) const override {
    const double length_m = threads_.length_m();
    std::vector<double> chord_mean, chord_sd, billow;
    for (std::size_t thread = 0; thread < kThreads; ++thread) {
      const Series chord_deg = threads_.chord_deg(thread);
      chord_mean.push_back(mean(chord_deg));
      chord_sd.push_back(deviation(chord_deg));
      billow.push_back(mean_distance_m(threads_.tracks(), threads_.at(thread, Joint::kHalf),
                                       threads_.at(thread, Joint::kFirst), threads_.at(thread, Joint::kTip)) /
                       length_m);
    }

    // The hem may swing out or up: its motion in all directions counts.
    Welch welch(kRate_hz);
    std::vector<double> quick_m, quick_hz;
    for (std::size_t i = 0; i < hem_.tracks().count(); ++i) {
      Spectrum spectrum = welch.of(hem_.tracks().x_m(i));
      spectrum += welch.of(hem_.tracks().y_m(i));
      spectrum += welch.of(hem_.tracks().z_m(i));
      quick_m.push_back(spectrum.deviation_above(kHemFrom_hz));
      quick_hz.push_back(spectrum.centroid_hz(kHemFrom_hz));
    }
    const std::size_t last = hem_.tracks().count() - 1;
    const double corner_m_s =
        std::hypot(hem_.tracks().speed_m_s(0, kRate_hz), hem_.tracks().speed_m_s(last, kRate_hz)) / std::sqrt(2.0);
    return {
        {"chord angle, mean", median(chord_mean)},
        {"chord angle, sd", median(chord_sd)},
        {"billow, mean / L", median(billow)},
        {"hem shape, sd / L", hem_.shape_m(wind.downwind()) / length_m},
        {"hem > 0.5 Hz, sd / L", median(quick_m) / length_m},
        {"hem > 0.5 Hz, centroid", median(quick_hz)},
        {"answer", wind.answer_of(mean_chord_deg())},
        {"free corner, speed", corner_m_s},
    };
  }

  std::vector<Trace> traces(const WindRecord& wind) const override {
    const std::size_t first = threads_.at(kThreads / 2, Joint::kFirst);
    const std::size_t tip = threads_.at(kThreads / 2, Joint::kTip);
    return {{"chord angle", "deg", mean_chord_deg()},
            {"hem, downwind of the rail", "m", threads_.tracks().way_m(first, tip, wind.downwind())}};
  }

 private:
  static constexpr std::size_t kThreads = 9;
  using Joint = ClothThreads::Joint;

  explicit CurtainMeter(const pose::GridSkeleton& grid) : threads_(grid, kThreads), hem_(grid) {}

  Series mean_chord_deg() const {
    std::vector<Series> chords;
    for (std::size_t thread = 0; thread < kThreads; ++thread) chords.push_back(threads_.chord_deg(thread));
    return mean_at_each_moment(chords);
  }

  ClothThreads threads_;
  Hem hem_;
};

/// Blown out by a steady gentle breeze, then left to itself.
std::array<Figures, kBeauforts> curtain_after_a_step(const SceneTable& table, std::uint64_t seed) {
  constexpr int kBlownTicks = 1200;
  constexpr int kCalmTicks = 1200;
  const std::unique_ptr<scenes::Scene> scene = make_scene(table, seed);
  ClothThreads threads(std::get<pose::GridSkeleton>(scene->skeleton()), 9);
  pose::Kinematics joints(scene->skeleton());
  const wind::ground::Wind breeze = wind::wind_from(kMeanSpeed_m_s[1], 0.0);
  for (int tick = 0; tick < kBlownTicks; ++tick) scene->tick(breeze, kTick_s);
  Series way_m;
  for (int tick = 0; tick < kCalmTicks; ++tick) {
    scene->tick(wind::Vector{}, kTick_s);
    joints.run(scene->pose());
    way_m.push_back(static_cast<float>(threads.tip_way(joints).south));
  }
  const Swing swing = swing_of(way_m, kRate_hz);
  std::array<Figures, kBeauforts> figures;
  figures[0] = {{"after a step to calm: frequency", swing.frequency_hz},
                {"after a step to calm: damping", swing.damping}};
  return figures;
}

}  // namespace

SceneTable curtain_table() {
  return {.name = "curtain",
          .scene = "curtain",
          .parameters = {{"columns", std::int64_t{96}}, {"rows", std::int64_t{50}}},
          .bounds = {kCurtainBounds.begin(), kCurtainBounds.end()},
          .make_meter = [](const pose::Skeleton& skeleton) -> std::unique_ptr<Meter> {
            return std::make_unique<CurtainMeter>(skeleton);
          },
          .further = curtain_after_a_step,
          .gives_way_along_east = 0.25};
}

}  // namespace yuragi::answer
