#include <array>
#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include "tests/answer/cloth_threads.hpp"
#include "tests/answer/scene_table.hpp"
#include "tests/answer/spectra.hpp"

// A flag hangs in its own length from hoist to fly, L. Sources of the bounds: the lift is the balance of drag and
// weight (drag coefficient of fluttering flags 0.1 to 0.15: Munson, Fundamentals of Fluid Mechanics, figure 9.30), and
// at Beaufort 3 the "wind extends light flag" (WMO); flutter grows to the fly as one travelling wave (Taneda 1968;
// Shelley and Zhang 2011), at a Strouhal number 2 A f / U of 0.1 to 0.3, and its frequency and its phase speed are
// proportional to the wind.

namespace yuragi::answer {
namespace {

constexpr std::array kFlagBounds = {
    Bound{"lift, mean", "deg", 1, {{{4, 20}, {54, 72}, {78, 88}, {83, 90}}}},
    Bound{"lift, sd", "deg", 1, {{at_most(5), {3, 16}, {0.8, 9}, {0.3, 4}}}},
    Bound{"tip across, sd / L", "", 3, {{at_most(0.02), {0.04, 0.10}, {0.07, 0.14}, {0.08, 0.16}}}},
    Bound{"growth: L/4", "", 2, {{kAny, {0.1, 0.35}, {0.1, 0.35}, {0.1, 0.35}}}},
    Bound{"growth: L/2", "", 2, {{kAny, {0.4, 0.75}, {0.4, 0.75}, {0.4, 0.75}}}},
    Bound{"tip across > 0.3 Hz, centroid", "Hz", 2, {{kAny, {0.8, 1.6}, {1.6, 3.2}, {2.4, 5.3}}}},
    Bound{"phase speed / U", "", 2, {{kAny, {0.45, 0.75}, {0.45, 0.75}, {0.45, 0.75}}}},
    Bound{"correlation at that lag", "", 2, {{kAny, at_least(0.75), at_least(0.75), at_least(0.75)}}},
    Bound{"answer", "", 2, {{kAny, at_least(0.5), kAny, kAny}}},
    Bound{"free corner, speed", "m/s", 2, {}},
    Bound{"free corner, speed / the number before", "", 2, {{kAny, at_least(2), at_least(1.2), at_least(1)}}},
};

class FlagMeter final : public Meter {
 public:
  explicit FlagMeter(const pose::Skeleton& skeleton) : threads_(std::get<pose::GridSkeleton>(skeleton), kThreads) {}

  void take(std::size_t /*tick*/, const pose::Pose& /*pose*/, const pose::Kinematics& joints) override {
    threads_.tracks().take(joints);
  }
  Horizontal direction(const pose::Pose& /*pose*/, const pose::Kinematics& joints) const override {
    return threads_.tip_way(joints);
  }
  double largest_step_m() const override { return threads_.tracks().largest_step_m(); }

  Figures figures(const WindRecord& wind) const override {
    const JointTracks& tracks = threads_.tracks();
    const std::size_t middle = kThreads / 2;
    const Series lift_deg = threads_.chord_deg(middle);

    Welch welch(kRate_hz);
    std::vector<double> tip, quarter, half, centroid_hz, speed_m_s, alike;
    for (std::size_t thread = 0; thread < kThreads; ++thread) {
      const Horizontal aside =
          tracks.mean_way_m(threads_.at(thread, Joint::kFirst), threads_.at(thread, Joint::kTip)).unit().aside();
      const auto across = [&](Joint joint) {
        return welch.of(tracks.way_m(threads_.at(thread, Joint::kFirst), threads_.at(thread, joint), aside));
      };
      const Spectrum tip_across = across(Joint::kTip);
      tip.push_back(tip_across.deviation_above(kAcrossFrom_hz));
      quarter.push_back(across(Joint::kQuarter).deviation_above(kAcrossFrom_hz) / tip.back());
      half.push_back(across(Joint::kHalf).deviation_above(kAcrossFrom_hz) / tip.back());
      centroid_hz.push_back(tip_across.centroid_hz(kAcrossFrom_hz));
      const Lag lag = threads_.lag(thread, aside);
      speed_m_s.push_back(threads_.speed_m_s(lag));
      alike.push_back(lag.correlation);
    }
    const double corner_m_s = std::hypot(tracks.speed_m_s(threads_.at(0, Joint::kTip), kRate_hz),
                                         tracks.speed_m_s(threads_.at(kThreads - 1, Joint::kTip), kRate_hz)) /
                              std::sqrt(2.0);
    return {
        {"lift, mean", mean(lift_deg)},
        {"lift, sd", deviation(lift_deg)},
        {"tip across, sd / L", median(tip) / threads_.length_m()},
        {"growth: L/4", median(quarter)},
        {"growth: L/2", median(half)},
        {"tip across > 0.3 Hz, centroid", median(centroid_hz)},
        {"phase speed / U", median(speed_m_s) / wind.mean_speed_m_s()},
        {"correlation at that lag", median(alike)},
        {"answer", wind.answer_of(lift_deg)},
        {"free corner, speed", corner_m_s},
    };
  }

  std::vector<Trace> traces(const WindRecord& /*wind*/) const override {
    const std::size_t middle = kThreads / 2;
    const std::size_t first = threads_.at(middle, Joint::kFirst);
    const std::size_t tip = threads_.at(middle, Joint::kTip);
    const Horizontal aside = threads_.tracks().mean_way_m(first, tip).unit().aside();
    return {{"lift", "deg", threads_.chord_deg(middle)},
            {"tip across", "m", threads_.tracks().way_m(first, tip, aside)}};
  }

 private:
  static constexpr std::size_t kThreads = 9;
  using Joint = ClothThreads::Joint;

  ClothThreads threads_;
};

}  // namespace

SceneTable flag_table() {
  return {.name = "flag",
          .scene = "flag",
          .parameters = {{"columns", std::int64_t{48}}, {"rows", std::int64_t{76}}},
          .bounds = {kFlagBounds.begin(), kFlagBounds.end()},
          .make_meter = [](const pose::Skeleton& skeleton) -> std::unique_ptr<Meter> {
            return std::make_unique<FlagMeter>(skeleton);
          }};
}

}  // namespace yuragi::answer
