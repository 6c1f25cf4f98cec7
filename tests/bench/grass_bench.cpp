#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/noise/spectral_noise.hpp"
#include "engine/operators/bending_job.hpp"
#include "engine/operators/sample_job.hpp"
#include "engine/operators/shift_job.hpp"
#include "engine/pose/strand_kinematics.hpp"
#include "engine/scenes/meadow.hpp"

// The grass of the paper's table 1 (100 x 100 blades of 10 links), operator by operator and as a whole, on each SIMD
// row that this machine can run: `yuragi-bench --benchmark_filter=x86-64-v3`. The counter per_node is the time of one
// frame divided by its 100,000 nodes; the paper's total, 0.35 ms, is 3.5 ns. The floor stores the same 12 bytes a node
// and computes nothing.

namespace {

using namespace yuragi;

constexpr double kTick_s = 1.0 / 60.0;
constexpr double kPeriod_m = 256.0;
constexpr double kWindEast_m_s = 6.0;
constexpr double kWindSouth_m_s = -3.0;

/// A meadow with all that its operators need.
struct Bench {
  Bench()
      : meadow(make_meadow({.seed = 1})),
        tile(make_noise_2d({.size = 512, .seed = 2}).value()),
        strength(meadow.flexibility.size(), 1.0F),
        pose{std::vector<float>(strength.size()), std::vector<float>(strength.size())},
        joints(meadow.skeleton) {
    for (std::size_t i = 0; i < strength.size(); ++i) {
      place_x.push_back(torus_phase(static_cast<double>(meadow.skeleton.root_x_m[i]), kPeriod_m));
      place_z.push_back(torus_phase(static_cast<double>(meadow.skeleton.root_z_m[i]), kPeriod_m));
    }
  }

  void shift() {
    ShiftJob{.wind_east_m_s = kWindEast_m_s,
             .wind_south_m_s = kWindSouth_m_s,
             .dt_s = kTick_s,
             .period_m = kPeriod_m,
             .offset = &offset}
        .run();
  }

  void sample(SimdRow row) {
    const NoiseLayer layer{.tile = &tile, .place_x = place_x, .place_z = place_z, .offset = offset.phase()};
    SampleJob{.layers = {&layer, 1}, .scale = 0.4F, .bias = 1.0F, .low = 0.0F, .row = row, .out = strength}.run();
  }

  void bend(SimdRow row) {
    BendingJob{.wind_east_m_s = kWindEast_m_s,
               .wind_south_m_s = kWindSouth_m_s,
               .strength = strength,
               .flexibility = meadow.flexibility,
               .row = row,
               .bend_east_rad = pose.bend_east_rad,
               .bend_south_rad = pose.bend_south_rad}
        .run();
  }

  void forward(SimdRow row) {
    StrandKinematicsJob{.skeleton = &meadow.skeleton, .pose = &pose, .row = row, .joints = &joints}.run();
  }

  Meadow meadow;
  NoiseTile2 tile;
  std::vector<std::uint32_t> place_x, place_z;
  TorusOffset offset;
  std::vector<float> strength;
  StrandPose pose;
  JointPositions joints;
};

/// Runs `frame` again and again, and counts its time by the node.
template <class Frame>
void measure(benchmark::State& state, const Bench& bench, const Frame& frame) {
  for (auto iteration : state) {
    static_cast<void>(iteration);
    frame();
    benchmark::ClobberMemory();
  }
  const auto nodes = static_cast<double>(bench.meadow.skeleton.strand_count * bench.meadow.skeleton.links_per_strand);
  using benchmark::Counter;
  state.counters["per_node"] = Counter(nodes, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

template <class Frame>
void add(const std::string& name, Bench& bench, Frame frame) {
  benchmark::RegisterBenchmark(name.c_str(), [&bench, frame](benchmark::State& state) {
    measure(state, bench, frame);
  })->Unit(benchmark::kMicrosecond);
}

void add_grass(Bench& bench) {
  add("grass/floor", bench, [&bench] {
    static float value = 0.0F;
    value += 1.0F;
    std::fill(bench.joints.data().begin(), bench.joints.data().end(), value);
  });
  add("grass/shifting", bench, [&bench] { bench.shift(); });
  for (const SimdRow row : kSimdRows) {
    if (!is_runnable(row)) continue;
    const std::string on_row = std::string("/").append(name_of(row));
    add("grass/sampling" + on_row, bench, [&bench, row] { bench.sample(row); });
    add("grass/bending" + on_row, bench, [&bench, row] { bench.bend(row); });
    add("grass/joints" + on_row, bench, [&bench, row] { bench.forward(row); });
    add("grass/projection" + on_row, bench, [&bench, row] { bench.bend(row), bench.forward(row); });
    add("grass/total" + on_row, bench, [&bench, row] {
      bench.shift();
      bench.sample(row);
      bench.bend(row);
      bench.forward(row);
    });
  }
}

}  // namespace

int main(int argc, char** argv) {
  Bench bench;
  add_grass(bench);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return EXIT_FAILURE;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return EXIT_SUCCESS;
}
