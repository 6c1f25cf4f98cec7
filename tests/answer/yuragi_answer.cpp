#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/tools/plot/plot.hpp"
#include "tests/answer/calm.hpp"
#include "tests/answer/directions.hpp"
#include "tests/answer/repeats.hpp"
#include "tests/answer/scene_run.hpp"
#include "tests/answer/scene_table.hpp"
#include "tests/answer/verdicts.hpp"

// yuragi-answer: how each scene answers the wind, measured from its poses, against what nature does.

namespace yuragi::answer {
namespace {

struct Options {
  std::vector<std::string> scenes;
  std::vector<int> beauforts;
  double duration_s = 0.0;
  WindChoice wind;
  unsigned threads = std::max(std::thread::hardware_concurrency(), 1U);
  bool is_json = false;
  bool is_long = false;
  bool has_further_winds = false;
  std::string record, from, plot, wind_file;
};

/// What is recorded and judged of a scene.
struct Asked {
  const SceneTable* table = nullptr;
  MeasuredScene measured;
  std::array<std::vector<Trace>, kBeauforts> traces;
};

/// Runs all tasks on so many threads; the first exception is thrown on.
void run_all(const std::vector<std::function<void()>>& tasks, unsigned threads) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> errors(tasks.size());
  const auto work = [&] {
    for (std::size_t i = next++; i < tasks.size(); i = next++) {
      try {
        tasks[i]();
      } catch (...) {
        errors[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (unsigned i = 1; i < threads; ++i) others.emplace_back(work);
    work();
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

void append(Figures& all, const Figures& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Records what is asked for. Each scene and Beaufort number is a task, the long ones first.
void record(std::vector<Asked>& all, const std::array<bool, kBeauforts>& is_asked, const Options& options) {
  test_gusts();  // made once, before there are threads
  std::vector<std::function<void()>> tasks;
  std::vector<std::array<Figures, kBeauforts>> further(all.size());
  std::vector<std::array<Figures, kBeauforts>> turns(all.size());
  for (std::size_t number = 0; number < kBeauforts; ++number) {
    if (!is_asked[number]) continue;
    for (std::size_t i = 0; i < all.size(); ++i) {
      tasks.emplace_back([&, number, i] {
        RecordLength length = usual_length(number);
        if (options.duration_s > 0.0) length.record_s = options.duration_s;
        SceneRecord found = record_scene(*all[i].table, number, length, options.wind);
        all[i].measured[number] = std::move(found.figures);
        all[i].traces[number] = std::move(found.traces);
      });
      tasks.emplace_back([&, number, i] { turns[i][number] = turn_figures(*all[i].table, number, options.wind.seed); });
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    tasks.emplace_back([&, i] {
      const SceneTable& table = *all[i].table;
      if (table.further != nullptr) further[i] = table.further(table, options.wind.seed);
      append(further[i][0], calm_figures(table, options.wind.seed));
    });
  }
  run_all(tasks, options.threads);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t number = 0; number < kBeauforts; ++number) {
      if (!all[i].measured[number]) continue;
      append(*all[i].measured[number], further[i][number]);
      append(*all[i].measured[number], turns[i][number]);
      if (all[i].table->derive != nullptr) all[i].table->derive(*all[i].measured[number]);
    }
  }
}

/// The first minute of a scene's traces, a panel each, with a curve for each Beaufort number.
void draw(const Asked& asked, const std::string& folder) {
  constexpr double kShown_s = 60.0;
  std::vector<daemon::tools::plot::Panel> panels;
  for (std::size_t number = 0; number < kBeauforts; ++number) {
    for (std::size_t i = 0; i < asked.traces[number].size(); ++i) {
      const Trace& trace = asked.traces[number][i];
      if (panels.size() <= i) {
        panels.push_back({.title = fmt::format("{}: {}", asked.table->name, trace.name),
                          .x_label = "time, s",
                          .y_label = trace.unit,
                          .curves = {}});
      }
      daemon::tools::plot::Curve curve{.title = fmt::format("Beaufort {}", kBeaufort[number]), .x = {}, .y = {}};
      for (std::size_t k = 0; k < trace.values.size() && static_cast<double>(k) < kShown_s * kRate_hz; ++k) {
        curve.x.push_back(static_cast<double>(k) / kRate_hz);
        curve.y.push_back(static_cast<double>(trace.values[k]));
      }
      panels[i].curves.push_back(std::move(curve));
    }
  }
  daemon::tools::plot::draw_plot(fmt::format("{}/{}.png", folder, asked.table->name), panels, 1600).value();
}

void load(std::vector<Asked>& all, const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file + ": cannot be read");
  const nlohmann::json saved = nlohmann::json::parse(stream);
  for (Asked& asked : all) {
    for (const nlohmann::json& scene : saved) {
      if (scene.at("scene") == asked.table->name) asked.measured = measured_of(scene);
    }
  }
}

std::vector<Asked> asked_scenes(const Options& options) {
  std::vector<Asked> all;
  for (const SceneTable& table : scene_tables()) {
    const auto& names = options.scenes;
    if (names.empty() || std::find(names.begin(), names.end(), table.name) != names.end()) {
      all.push_back({.table = &table, .measured = {}, .traces = {}});
    }
  }
  return all;
}

std::array<bool, kBeauforts> asked_numbers(const Options& options) {
  std::array<bool, kBeauforts> is_asked{};
  for (std::size_t number = 0; number < kBeauforts; ++number) {
    const auto& numbers = options.beauforts;
    is_asked[number] = numbers.empty() || std::find(numbers.begin(), numbers.end(), kBeaufort[number]) != numbers.end();
  }
  return is_asked;
}

/// The tables, each cell judged.
int measure(const Options& options) {
  std::vector<Asked> all = asked_scenes(options);
  const std::array<bool, kBeauforts> is_asked = asked_numbers(options);
  if (options.from.empty()) {
    record(all, is_asked, options);
  } else {
    load(all, options.from);
  }
  if (!options.record.empty()) {
    nlohmann::json figures = nlohmann::json::array();
    for (const Asked& asked : all) figures.push_back(to_json(*asked.table, asked.measured, {}));
    std::ofstream(options.record) << figures.dump(1) << '\n';
    return 0;
  }

  nlohmann::json json = nlohmann::json::array();
  std::size_t failed = 0;
  std::size_t judged = 0;
  for (const Asked& asked : all) {
    const std::vector<JudgedRow> rows = judge(*asked.table, asked.measured, is_asked);
    failed += failures(rows);
    judged += judgements(rows);
    json.push_back(to_json(*asked.table, asked.measured, rows));
    if (!options.is_json) fmt::print("{}\n", table_text(*asked.table, rows, is_asked));
    if (!options.plot.empty()) draw(asked, options.plot);
  }
  if (options.is_json) {
    fmt::print("{}\n", json.dump(1));
  } else {
    fmt::print("{}\n", failed == 0 ? fmt::format("all {} figures are within their bounds", judged)
                                   : fmt::format("{} of {} figures are not within their bounds", failed, judged));
  }
  return failed == 0 && judged > 0 ? 0 : 1;
}

/// The winds that the bounds are made for: what fails in each, but for the wind's own scatter.
int measure_further_winds(const Options& options) {
  const std::array<bool, kBeauforts> is_asked = asked_numbers(options);
  std::size_t failed = 0;
  for (const double speed : {0.9, 1.0, 1.1}) {
    for (const double intensity : {0.15, 0.2, 0.25}) {
      Options here = options;
      here.wind.speed = speed;
      here.wind.intensity = intensity;
      std::vector<Asked> all = asked_scenes(here);
      record(all, is_asked, here);
      fmt::print("wind of {:g} times the mean, intensity {:g}\n", speed, intensity);
      for (const Asked& asked : all) {
        std::vector<JudgedRow> rows = judge(*asked.table, asked.measured, is_asked);
        std::erase_if(
            rows, [](const JudgedRow& row) { return row.bound.figure.starts_with("wind, ") || failures({row}) == 0; });
        failed += failures(rows);
        if (!rows.empty()) fmt::print("{}", table_text(*asked.table, rows, is_asked));
      }
      std::fflush(stdout);
    }
  }
  fmt::print("{}\n", failed == 0 ? "all figures are within their bounds" : fmt::format("{} are not", failed));
  return failed == 0 ? 0 : 1;
}

/// The wind of a Beaufort number's record and its start, as a table of a sensor that speaks ten times a second.
int write_wind(const Options& options) {
  if (options.beauforts.size() != 1) throw std::runtime_error("--write-wind asks for one --beaufort");
  const auto found = std::find(kBeaufort.begin(), kBeaufort.end(), options.beauforts.front());
  const auto number = static_cast<std::size_t>(std::distance(kBeaufort.begin(), found));
  TestWind wind = record_wind(number, options.wind);
  RecordLength length = usual_length(number);
  if (options.duration_s > 0.0) length.record_s = options.duration_s;
  constexpr int kTicksAReading = 6;
  const auto ticks = static_cast<int>((length.start_s + length.record_s) * kRate_hz);
  std::ofstream file(options.wind_file);
  file << "time_s,u_m_s,v_m_s\n";
  for (int tick = 0; tick < ticks; ++tick) {
    wind.step(kTick_s);
    if (tick % kTicksAReading != 0) continue;
    const wind::Vector now = wind.at_origin();
    file << fmt::format("{:.1f},{:.4f},{:.4f}\n", tick * kTick_s, now.u_m_s, now.v_m_s);
  }
  return file ? 0 : 1;
}

/// Ten minutes of each scene: does anything come again?
int seek_repeats(Options options) {
  if (options.duration_s == 0.0) options.duration_s = 600.0;
  std::vector<Asked> all = asked_scenes(options);
  record(all, asked_numbers(options), options);
  std::size_t found = 0;
  for (const Asked& asked : all) {
    for (std::size_t number = 0; number < kBeauforts; ++number) {
      for (const Trace& trace : asked.traces[number]) {
        const Repeat repeat = largest_repeat(trace.values, kRate_hz, kSwing_s);
        const bool is_repeat = repeat.correlation >= kRepeats;
        found += is_repeat ? 1U : 0U;
        fmt::print("{:<8} Beaufort {}  {:<28} largest correlation with itself {:5.2f}, {:6.1f} s later  {}\n",
                   asked.table->name, kBeaufort[number], trace.name, repeat.correlation, repeat.lag_s,
                   is_repeat ? "REPEATS" : "ok");
      }
    }
  }
  fmt::print("{}\n", found == 0 ? "nothing repeats" : fmt::format("{} repeat", found));
  return found == 0 ? 0 : 1;
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Measures how each scene answers the wind: records its poses in a fixed test wind, faster than real time, and "
      "compares\n"
      "what they show (angles, frequencies, speeds of waves) with what nature does at Beaufort 1, 3, 5 and 7");
  app.footer(
      "Examples:\n"
      "  yuragi-answer                                  all tables\n"
      "  yuragi-answer --scene flag --beaufort 3        a column of one\n"
      "  yuragi-answer --scene tree --plot /tmp         and a picture of the first minute, /tmp/tree.png\n"
      "  yuragi-answer --record figures.json            keeps the figures, to be judged later:\n"
      "  yuragi-answer --from figures.json --scene fur\n"
      "  yuragi-answer --long --scene grass             does anything come again in ten minutes?\n"
      "  yuragi-answer --further-winds                  minutes of work: are the bounds kept in other winds too?\n"
      "A cell is the value, its bounds, and ok, LOW, HIGH or NONE (it could not be measured); without bounds it is "
      "only\n"
      "shown. `sd` is a standard deviation; `L` a cloth's length; `U` the record's mean wind; \"the number before\" "
      "the\n"
      "Beaufort number before. Ends with 1 where a bound does not hold.");
  std::vector<std::string> names;
  for (const SceneTable& table : scene_tables()) names.emplace_back(table.name);
  app.add_option("--scene", options.scenes, "only this one; may be given several times")->check(CLI::IsMember(names));
  app.add_option("--beaufort", options.beauforts, "only this one; may be given several times")
      ->check(CLI::IsMember(std::vector<int>(kBeaufort.begin(), kBeaufort.end())));
  app.add_option("--duration", options.duration_s, "of a record, s; by default 300, and 600 at Beaufort 1")
      ->check(CLI::Range(60.0, 7200.0));
  app.add_option("--seed", options.wind.seed, "another wind and another model for each; bounds are for 1")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--speed", options.wind.speed, "times the mean wind of each number; bounds are for 0.9 to 1.1")
      ->check(CLI::Range(0.1, 3.0))
      ->capture_default_str();
  app.add_option("--intensity", options.wind.intensity, "of its turbulence; bounds are for 0.15 to 0.25")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  app.add_flag(
      "--further-winds", options.has_further_winds,
      "goes through the nine winds of 0.9, 1 and 1.1 times the mean and intensities of 0.15, 0.2 and 0.25, and\n"
      "prints what fails in them");
  app.add_flag("--long", options.is_long,
               "records ten minutes instead, and seeks what comes again: the largest correlation of each trace with\n"
               "itself, from 10 s to 5 min later")
      ->excludes("--further-winds");
  app.add_option("--threads", options.threads, "how many records at a time")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_flag("--json", options.is_json, "prints JSON instead of tables");
  app.add_option("--record", options.record, "writes the figures into a file, and judges nothing");
  app.add_option("--from", options.from, "judges what --record has kept, and records nothing")
      ->check(CLI::ExistingFile);
  app.add_option("--write-wind", options.wind_file,
                 "writes the wind of a --beaufort as a CSV table, for the daemon: yuragi import, yuragi replay");
  app.add_option("--plot", options.plot, "draws a picture a scene into this folder")->check(CLI::ExistingDirectory);
  CLI11_PARSE(app, argc, argv);
  if (!options.wind_file.empty()) return write_wind(options);
  if (options.is_long) return seek_repeats(options);
  if (options.has_further_winds) return measure_further_winds(options);
  return measure(options);
}

}  // namespace
}  // namespace yuragi::answer

int main(int argc, char** argv) {
  try {
    return yuragi::answer::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "yuragi-answer: %s\n", error.what());
    return 1;
  }
}
