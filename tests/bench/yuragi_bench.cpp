// yuragi-bench: the paper's table 1, measured here. `yuragi-bench` prints the table and how it stands against what we
// ask of it; `--json` prints the same as JSON, with a word about each of its numbers; `--row x86-64` leaves AVX out;
// everything else goes to Google Benchmark (--benchmark_filter, --benchmark_repetitions ...). Rows "with gusts" are in
// the wind that the daemon ships: gusts that differ from place to place, of BenchWind; the others have their own noise,
// as in the paper. Times are the fastest of all repetitions, which are shuffled, so that what disturbs the machine for
// a while disturbs all rows alike.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>

#include "engine/noise/spectral_noise.hpp"
#include "engine/pose/quantise.hpp"
#include "engine/scenes/meadow.hpp"
#include "engine/scenes/wind_grid.hpp"
#include "engine/workers/sharing_choice.hpp"
#include "tests/bench/bench_wind.hpp"
#include "tests/bench/plain_strands.hpp"
#include "tests/bench/table1.hpp"
#include "tests/bench/workload.hpp"
#include "tests/support/places.hpp"

namespace yuragi::bench {
namespace {

constexpr PaperRow kPaperGrass = {0.1, 0.05, 0.2, 0.35};
constexpr PaperRow kPaperFur = {0.3, 0.15, 0.57, 1.02};
constexpr PaperRow kPaperTree = {0.1, 0.05, 0.13, 0.23};
constexpr PaperRow kPaperCurtain = {0.03, 0.015, 0.09, 0.135};
constexpr PaperRow kPaperFlag = {0.03, 0.015, 0.105, 0.15};

struct Case {
  std::string name;
  std::vector<BenchScene> scenes;
  std::optional<PaperRow> paper = std::nullopt;
  bool has_plain = false;
  bool has_gusts = false;  ///< from outside
  bool is_paced = false;
};

Case own_noise(const std::string& name, std::string_view kind, const ParameterValues::Map& given = {},
               std::optional<PaperRow> paper = std::nullopt, bool has_plain = false) {
  return {.name = name, .scenes = {bench_scene(kind, given)}, .paper = paper, .has_plain = has_plain};
}

/// Of angles that are quantised at once.
constexpr std::size_t kQuantised = 100'000;

ParameterValues::Map meadow(std::int64_t across, std::int64_t deep) {
  return {{"blades_across", across}, {"blades_deep", deep}};
}

std::vector<Case> all_cases() {
  std::vector<Case> cases = {
      own_noise("grass, one tile", "grass", {{"tiles", std::int64_t{1}}, {"hybrid", 0.0}}, kPaperGrass),
      own_noise("grass", "grass", {}, kPaperGrass, true),
      own_noise("fur", "fur", {}, kPaperFur, true),
      own_noise("tree", "tree", {}, kPaperTree),
      own_noise("curtain", "curtain", {{"hybrid", 0.0}}, kPaperCurtain),
      own_noise("flag", "flag", {{"hybrid", 0.0}}, kPaperFlag),
      own_noise("curtain, hybrid", "curtain", {{"hybrid", 1.0}}, kPaperCurtain),
      own_noise("flag, hybrid", "flag", {{"hybrid", 1.0}}, kPaperFlag),
      own_noise("banner", "banner"),
      own_noise("ripple", "ripple"),
      own_noise("flame", "flame"),
      own_noise("grass 10,000", "grass", meadow(50, 20)),
      own_noise("grass 1,000,000", "grass", meadow(400, 250)),
  };
  for (Case& one : cases) one.is_paced = one.paper.has_value();
  // As the daemon ships them.
  for (const scenes::Description* kind : scenes::scene_table()) {
    const std::string name(kind->name);
    cases.push_back({.name = name + ", gusts", .scenes = {bench_scene(name)}, .has_gusts = true, .is_paced = true});
  }
  cases.push_back(
      {.name = "grass 1,000,000, gusts", .scenes = {bench_scene("grass", meadow(400, 250))}, .has_gusts = true});
  cases.push_back({.name = "garden, gusts",
                   .scenes = scenes_of(test::source_path("config/garden.toml")),
                   .has_gusts = true,
                   .is_paced = true});
  return cases;
}

/// The plain implementation of the same strands.
std::unique_ptr<PlainStrands> make_plain(const pose::Skeleton& skeleton) {
  const auto& strands = std::get<pose::StrandSkeleton>(skeleton);
  return std::make_unique<PlainStrands>(strands, std::vector<float>(strands.padded_count(), 1.0F),
                                        noise::make_noise_2d({.size = 512, .seed = 1}).value(),
                                        noise::make_noise_2d({.size = 512, .seed = 2}).value(), 256.0, 414.0);
}

/// A grid of the wind over a square meadow.
struct BenchGrid {
  BenchGrid(double side_m, SimdRow row, const std::shared_ptr<const wind::turbulence::GustNoise>& gusts, bool has_tape)
      : wind(gusts, has_tape), grid(gusts, places(side_m), places(side_m), row) {}
  /// Two places, in opposite corners.
  static std::vector<float> places(double side_m) {
    return {static_cast<float>(-0.5 * side_m), static_cast<float>(0.5 * side_m)};
  }

  BenchWind wind;
  scenes::WindGrid grid;
};

/// Collects the fastest time of each benchmark, and says on standard error how far it is.
class FastestReporter final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.iterations == 0) continue;
      const double time_s = run.real_accumulated_time / static_cast<double>(run.iterations);
      const std::string name = run.run_name.function_name;
      const auto [entry, is_new] = times.try_emplace(name, time_s);
      if (!is_new) entry->second = std::min(entry->second, time_s);
      std::cerr << '.' << std::flush;
    }
  }
  void Finalize() override { std::cerr << '\n'; }

  Times times;
};

void add(const std::string& name, std::function<void()> part) {
  benchmark::RegisterBenchmark(name.c_str(), [part = std::move(part)](benchmark::State& state) {
    for (auto iteration : state) {
      static_cast<void>(iteration);
      part();
      benchmark::ClobberMemory();
    }
  })->UseRealTime();
}

/// A frame each 1/60 s.
void add_paced(const std::string& name, std::function<void()> frame) {
  benchmark::RegisterBenchmark(
      name.c_str(),
      [frame = std::move(frame)](benchmark::State& state) {
        for (auto iteration : state) {
          static_cast<void>(iteration);
          std::this_thread::sleep_for(std::chrono::duration<double>(kBenchTick_s));
          const auto begin = std::chrono::steady_clock::now();
          frame();
          state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
        }
      })
      ->UseManualTime()
      ->Iterations(30);
}

std::vector<Target> targets_of(const Times& times) {
  std::vector<Target> targets;
  const auto at = [&times](const std::string& name) {
    const auto found = times.find(name);
    return found == times.end() ? std::nan("") : found->second;
  };
  const auto add = [&targets](const Target& target) {
    if (!std::isnan(target.value)) targets.push_back(target);
  };
  const auto add_ratio = [&add](const std::string& what, double value, double limit, bool is_at_least = false) {
    add({what, value, limit, is_at_least, true});
  };
  const auto add_of_machine = [&add](const std::string& what, double value, double limit, bool is_at_least = false) {
    add({what, value, limit, is_at_least, false});
  };
  add_ratio("grass, one tile: total in floors", at("grass, one tile/total") / at("grass, one tile/floor"), 4.0);
  for (const std::string name : {"grass", "fur"}) {
    add_ratio(name + " as shipped: total in floors", at(name + "/total") / at(name + "/floor"), 8.0);
    add_ratio(name + " as shipped: times faster than the plain one", at(name + "/plain") / at(name + "/total"), 6.0,
              true);
  }
  // As a ratio to a floor of the same run: the part of the paper's time depends on how fast the machine is.
  for (const std::string name : {"curtain", "flag"}) {
    add_ratio(name + ", noise alone: total in floors", at(name + "/total") / at(name + "/floor"), 8.0);
  }
  add_of_machine("curtain, hybrid: part of the paper's total",
                 at("curtain, hybrid/total") * 1e3 / kPaperCurtain.total_ms, 1.0);
  add_of_machine("flag, hybrid: part of the paper's total", at("flag, hybrid/total") * 1e3 / kPaperFlag.total_ms, 1.0);
  add_of_machine("tree: total, ms", at("tree/total") * 1e3, 0.153);
  add_of_machine("grass 1,000,000: a second thread, times faster back to back",
                 at("two threads/alone") / at("two threads/shared"), 1.7, true);
  add_of_machine("grass 1,000,000: a second thread, times faster paced at 60 Hz ",
                 at("two threads/alone, paced") / at("two threads/shared, paced"), 0.0, true);
  add_ratio("grass 1,000,000: shared or not as is chosen, over alone, paced",
            at("two threads/as chosen, paced") / at("two threads/alone, paced"), 1.05);
  // As the daemon does it, a fifth of the nodes each tick.
  for (const auto& [side, limit] : {std::pair("7 m", 1.6), std::pair("60 m", 2.0)}) {
    const std::string name = std::string("wind grid ") + side;
    add_ratio(name + ": a step with the tape over one without", at(name + "/with tape") / at(name + "/without"), limit);
  }
  add_of_machine("wind, what is measured: a tick of the estimator, us", at("wind/estimator") * 1e6, 10.0);
  add_of_machine("quantising a bend or a way, ns", at("quantise/bends") * 1e9 / static_cast<double>(kQuantised), 0.25);
  // Over what storing them takes: that is more where they leave the caches.
  std::vector<double> computing_s;
  for (const auto& [name, nodes] :
       {std::pair("grass 10,000", 1e4), std::pair("grass", 1e5), std::pair("grass 1,000,000", 1e6)}) {
    const std::string row = name;
    computing_s.push_back((at(row + "/total") - at(row + "/floor")) / nodes);
  }
  const bool are_all_there = std::ranges::none_of(computing_s, [](double time_s) { return std::isnan(time_s); });
  const auto [least_s, most_s] = std::ranges::minmax(computing_s);
  add_ratio("grass: most ns a node, beside storing, over least, 10,000 to 1,000,000 nodes",
            are_all_there ? most_s / least_s : std::nan(""), 1.2);
  for (const auto& [name, paper] :
       {std::pair("grass", kPaperGrass), std::pair("fur", kPaperFur), std::pair("tree", kPaperTree),
        std::pair("curtain", kPaperCurtain), std::pair("flag", kPaperFlag)}) {
    add_of_machine(std::string(name) + ": part of the paper's total",
                   at(std::string(name) + "/total") * 1e3 / paper.total_ms, 1.0);
  }
  return targets;
}

int run(int argc, char** argv) {
  bool is_json = false;
  SimdRow row = best_simd_row();
  std::vector<std::string> words = {argv[0], "--benchmark_enable_random_interleaving=true", "--benchmark_repetitions=7",
                                    "--benchmark_min_time=0.05"};
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--json") {
      is_json = true;
    } else if (word == "--row" && i + 1 < argc) {
      const std::string_view wanted = argv[++i];
      const auto found = std::find_if(std::begin(kSimdRows), std::end(kSimdRows),
                                      [wanted](SimdRow one) { return name_of(one) == wanted && is_runnable(one); });
      if (found == std::end(kSimdRows)) {
        std::cerr << "yuragi-bench: no row " << wanted << " on this machine; rows:";
        for (const SimdRow one : kSimdRows) std::cerr << ' ' << name_of(one);
        std::cerr << '\n';
        return 64;
      }
      row = *found;
    } else {
      words.emplace_back(word);
    }
  }
  std::vector<char*> arguments;
  arguments.reserve(words.size());
  for (std::string& word : words) arguments.push_back(word.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 64;

  std::vector<std::unique_ptr<Workload>> workloads;
  std::vector<std::unique_ptr<PlainStrands>> plains;
  std::vector<TableRow> rows;
  const auto gusts =
      std::make_shared<const wind::turbulence::GustNoise>(wind::turbulence::GustNoiseSettings{.evolves = true});
  for (const Case& one : all_cases()) {
    Workload& workload = *workloads.emplace_back(std::make_unique<Workload>(
        one.scenes, row, one.has_gusts ? gusts : std::shared_ptr<const wind::turbulence::GustNoise>()));
    rows.push_back({one.name, workload.nodes(), one.paper});
    add(one.name + "/floor", [&workload] { workload.store_in_a_loop(); });
    add(one.name + "/memset", [&workload] { workload.store_by_memset(); });
    add(one.name + "/streamed", [&workload] { workload.store_past_caches(); });
    add(one.name + "/shifting", [&workload] { workload.shift(); });
    add(one.name + "/sampling", [&workload] { workload.sample(); });
    add(one.name + "/projection", [&workload] { workload.project(); });
    add(one.name + "/total", [&workload] { workload.frame(); });
    if (one.is_paced) add_paced(one.name + "/paced", [&workload] { workload.frame(); });
    if (!one.has_plain) continue;
    PlainStrands& plain = *plains.emplace_back(make_plain(workload.first_skeleton()));
    add(one.name + "/plain",
        [&plain] { plain.frame(BenchWind::kBreeze.u_m_s, -BenchWind::kBreeze.v_m_s, kBenchTick_s, 0.6); });
  }

  std::vector<float> angles_rad;
  for (std::size_t i = 0; i < kQuantised; ++i) angles_rad.push_back(std::sin(0.37F * static_cast<float>(i)));
  std::vector<std::int16_t> units(angles_rad.size());
  add("quantise/bends", [&angles_rad, &units, row] { pose::quantise(angles_rad, units, row); });

  // A step of the grid of the wind with the tape and without; writing the tape, once a tick for all scenes; one place
  // of it; and the estimator's tick, with one sensor.
  std::vector<std::unique_ptr<BenchGrid>> grids;
  for (const double side_m : {7.0, 60.0}) {
    for (const bool has_tape : {true, false}) {
      BenchGrid& one = *grids.emplace_back(std::make_unique<BenchGrid>(side_m, row, gusts, has_tape));
      const std::string name = side_m < 10.0 ? "wind grid 7 m" : "wind grid 60 m";
      add(name + (has_tape ? "/with tape" : "/without"), [&one, wind = one.wind.next()]() mutable {
        ++*wind.tick;  // a part of the nodes is read at each
        one.grid.step(wind, kBenchTick_s);
      });
    }
  }
  BenchWind& taped = grids.front()->wind;
  add("wind/write", [&taped] { taped.write(); });
  add("wind/smooth at a place", [wind = taped.next()] { benchmark::DoNotOptimize(wind.smooth_at(1.0, 2.0)); });
  add("wind/measured at a place", [wind = taped.next()] { benchmark::DoNotOptimize(wind.measured_at(1.0, 2.0)); });
  add("wind/at a place", [wind = taped.next(), &gusts] { benchmark::DoNotOptimize(wind.at(*gusts, 1.0, 2.0)); });
  MeasuredWind measured(gusts, BenchWind::kBreeze);
  for (int tick = 0; tick < 600; ++tick) measured.step();
  add("wind/estimator", [&measured] { benchmark::DoNotOptimize(measured.step()); });
  add("wind/copy", [wind = measured.step()] {
    const wind::ground::DrivingWind copy = wind;
    benchmark::DoNotOptimize(&copy);
  });

  // A second thread, on the largest meadow: back to back, and a frame at a time 60 times a second.
  workers::Pool pool(2);
  const std::vector<BenchScene> largest = {bench_scene("grass", meadow(400, 250))};
  Workload alone(largest, row);
  Workload shared(largest, row);
  add("two threads/alone", [&alone] { alone.frame(); });
  add("two threads/shared", [&shared, &pool] { shared.frame(pool); });
  add_paced("two threads/alone, paced", [&alone] { alone.frame(); });
  add_paced("two threads/shared, paced", [&shared, &pool] { shared.frame(pool); });
  workers::SharingChoice choice;
  add_paced("two threads/as chosen, paced", [&shared, &pool, &choice] {
    const auto begin = std::chrono::steady_clock::now();
    choice.is_shared() ? shared.frame(pool) : shared.frame();
    choice.took(std::chrono::steady_clock::now() - begin);
  });

  FastestReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::Shutdown();
  if (reporter.times.empty()) return 64;
  const std::vector<Target> targets = targets_of(reporter.times);
  if (is_json) {
    print_json(std::cout, rows, reporter.times, targets);
    return 0;
  }
  std::cout << "SIMD row " << name_of(row) << ", one thread; the fastest of all repetitions\n\n";
  print_table(std::cout, rows, reporter.times);
  std::cout << '\n';
  print_targets(std::cout, targets);
  return 0;
}

}  // namespace
}  // namespace yuragi::bench

int main(int argc, char** argv) {
  return yuragi::bench::run(argc, argv);
}
