// `yuragi field`: exports the wind over a scene for other programs.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "daemon/commands/command.hpp"
#include "daemon/commands/exit.hpp"
#include "daemon/commands/lock_recording.hpp"
#include "daemon/commands/run_options.hpp"
#include "daemon/tools/offline/field_frames.hpp"
#include "daemon/tools/offline/npy.hpp"
#include "daemon/tools/plot/plot.hpp"
#include "daemon/tools/plot/plot_map.hpp"
#include "daemon/tools/plot/plot_script.hpp"
#include "drivers/windlog/format.hpp"
#include "drivers/windlog/recording_parts.hpp"
#include "engine/base/json_text.hpp"
#include "engine/noise/spectral_noise.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::commands {

extern const Command kFieldCommand;

namespace {

constexpr const char* kFieldFooter =
    "Writes the wind at every point of a grid, at one time or many, as float32 in m/s, with the axes\n"
    "\n"
    "  [frame, component, z, y, x]   component: u toward east, v toward north, w up (w with --dims 3 only)\n"
    "                                x toward east, y up, z toward south; with --dims 2, y is one sample\n"
    "\n"
    "FILE.json describes the places and times of the samples, and the wind.\n"
    "\n"
    "Every point has von Karman's spectrum with the given mean speed, direction, turbulence intensity (standard\n"
    "deviation along the wind over the mean speed) and length L. Across the wind the standard deviation is 0.8 of\n"
    "that and the length a third, upward 0.5 and a twelfth (IEC 61400-1). The mean wind carries the gusts, which\n"
    "change on the way, unless --frozen is given. With --dims 3, --stress is the covariance of u along the wind and\n"
    "w over both standard deviations; it does not change variances and spectra.\n"
    "\n"
    "The wind is made on a tile that repeats: --tile samples per edge. For statistics make it 8 L or longer. Gusts\n"
    "of less than two samples are missing; FILE.json has the remaining variance.\n"
    "With --windlog the result is the wind over the ground that the daemon would have had during that recording.\n"
    "\n"
    "  yuragi field --speed 8 --size 256 --spacing 0.5 --frames 100 --rate 20 -o gusts.npy --plot gusts.png\n"
    "  yuragi field --dims 3 --size 64,32,64 --turbulence 0.15 -o box.npy\n"
    "  yuragi field --windlog mast.windlog --time 600 --size 50m --spacing 0.25 -o meadow.npy\n"
    "  python3 -c 'import numpy; print(numpy.load(\"gusts.npy\")[0, 0].std())'";

/// The default of `--stress` (Panofsky and Dutton 1984, chapter 6).
constexpr double kStressNearTheGround = -0.3;

struct FieldOptions {
  wind::field::WindFieldSettings wind;
  std::vector<std::string> size;
  std::optional<std::size_t> tile;
  std::optional<double> stress;
  tools::offline::FieldFrames frames;
  bool is_frozen = false;
  bool is_evolving = false;  ///< false by default, unless a configuration sets it
  std::optional<std::uint64_t> seed;
  std::optional<std::filesystem::path> recording;
  drivers::windlog::PlaybackOptions playback;
  std::optional<std::filesystem::path> config_file;
  std::filesystem::path output;
  std::string plot;
  bool force = false;
};

/// An edge of the grid: samples ("256"), or metres ("128m").
std::size_t parse_edge(const std::string& text, double spacing_m) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  const bool is_metres = rest != end && std::string_view(rest, end) == "m";
  const double samples = is_metres ? std::ceil(number / spacing_m) : number;
  const bool is_allowed = error == std::errc() && (is_metres || rest == end) && samples >= 1.0 && samples <= 1e6 &&
                          samples == std::floor(samples);
  if (!is_allowed) {
    throw ExitError(kExitUsage, "--size: is \"" + text +
                                    "\"; allowed: a whole number of samples (256) or metres (128m), 1 to 1000000 "
                                    "samples");
  }
  return static_cast<std::size_t>(samples);
}

wind::field::Grid grid_of(const FieldOptions& options) {
  wind::field::Grid grid;
  grid.spacing_m = options.wind.spacing_m;
  std::vector<std::size_t> edges;
  for (const std::string& edge : options.size) edges.push_back(parse_edge(edge, grid.spacing_m));
  const bool is_space = options.wind.dims == 3;
  const std::size_t all = is_space ? 3 : 2;
  if (edges.empty()) edges.assign(1, is_space ? 64 : 256);
  if (edges.size() == 1) edges.assign(all, edges[0]);
  if (edges.size() != all) {
    throw ExitError(kExitUsage, is_space ? "--size: a field of 3 dimensions takes N or X,Y,Z (east, up, south)"
                                         : "--size: a field of 2 dimensions takes N or X,Z (east, south)");
  }
  grid.count_x = edges.front();
  grid.count_z = edges.back();
  grid.count_y = is_space ? edges[1] : 1;
  return grid;
}

/// The tile size given by an option, or one that is large enough for the grid.
std::size_t tile_of(const FieldOptions& options, const wind::field::Grid& grid) {
  const bool is_space = options.wind.dims == 3;
  const std::size_t largest = is_space ? noise::kMaxNoiseSize3 : noise::kMaxNoiseSize2;
  const std::size_t edge = std::max({grid.count_x, grid.count_y, grid.count_z});
  if (options.tile) {
    if (!std::has_single_bit(*options.tile) || *options.tile < noise::kMinNoiseSize || *options.tile > largest) {
      throw ExitError(kExitUsage, fmt::format("--tile: is {}; allowed with --dims {}: a power of two from {} to {}",
                                              *options.tile, options.wind.dims, noise::kMinNoiseSize, largest));
    }
    return *options.tile;
  }
  if (edge > largest) {
    throw ExitError(kExitUsage, fmt::format("--size: {} samples exceed the largest tile, {} with --dims {}; choose "
                                            "fewer, or --tile {} for a wind that repeats",
                                            edge, largest, options.wind.dims, largest));
  }
  return std::min(largest, std::bit_ceil(std::max<std::size_t>(2 * edge, is_space ? 64 : 256)));
}

/// Writes values as they are computed. Throws if the disk does not take them.
class FieldFile {
 public:
  FieldFile(std::string name, const std::filesystem::path& path, const std::vector<std::size_t>& shape)
      : name_(std::move(name)), file_(std::fopen(path.c_str(), "wbe")) {
    if (!file_) throw ExitError(kExitCannotCreate, name_ + ": cannot be created; is its folder writable?");
    const std::string header = tools::offline::npy_header(shape);
    check(std::fwrite(header.data(), 1, header.size(), file_.get()) == header.size());
  }
  void add(std::span<const float> values) {
    check(std::fwrite(values.data(), sizeof(float), values.size(), file_.get()) == values.size());
  }
  void end() { check(std::fclose(file_.release()) == 0); }

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { static_cast<void>(std::fclose(file)); }
  };
  void check(bool is_written) const {
    if (!is_written) throw ExitError(kExitCannotCreate, name_ + ": could not be written completely; is the disk full?");
  }

  std::string name_;
  std::unique_ptr<std::FILE, Close> file_;
};

nlohmann::ordered_json description_of(const FieldOptions& options, const wind::field::Grid& grid,
                                      const std::vector<std::size_t>& shape) {
  const auto axis = [&](const char* toward, double first_m) {
    return nlohmann::ordered_json{{"toward", toward}, {"first_m", first_m}, {"step_m", grid.spacing_m}};
  };
  const wind::field::WindPlace first = grid.place(0, 0, 0);
  nlohmann::ordered_json text;
  text["file"] = options.output.filename().string();
  text["unit"] = "m/s";
  text["axes"] = {"frame", "component", "z", "y", "x"};
  text["shape"] = shape;
  text["components"] = {"u toward east", "v toward north"};
  if (options.wind.dims == 3) text["components"].push_back("w up");
  text["x"] = axis("east", first.x_m);
  text["y"] = axis("up", first.y_m);
  text["z"] = axis("south", first.z_m);
  text["time"] = {{"first_s", options.frames.first_s}, {"step_s", 1.0 / options.frames.rate_hz}};
  return text;
}

/// The speed of a frame's lowest level, seen from above, and the wind at some places.
tools::plot::Map map_of(std::span<const float> frame, const wind::field::Grid& grid, const std::string& title) {
  constexpr std::size_t kMaxSamples = 500;
  constexpr std::size_t kArrows = 24;
  const std::size_t longest = std::max(grid.count_x, grid.count_z);
  const std::size_t thin = (longest + kMaxSamples - 1) / kMaxSamples;
  const std::size_t apart = std::max<std::size_t>(1, longest / kArrows);
  const auto u_at = [&](std::size_t i, std::size_t k) {
    return static_cast<double>(frame[k * grid.count_y * grid.count_x + i]);
  };
  const auto v_at = [&](std::size_t i, std::size_t k) {
    return static_cast<double>(frame[grid.size() + k * grid.count_y * grid.count_x + i]);
  };

  const wind::field::WindPlace first = grid.place(0, 0, 0);
  tools::plot::Map map{.title = title,
                       .x_label = "east of the middle, m",
                       .y_label = "north of the middle, m",
                       .value_label = "wind speed, m/s",
                       .columns = (grid.count_x + thin - 1) / thin,
                       .first_x = first.x_m,
                       .step_x = grid.spacing_m * static_cast<double>(thin),
                       .first_y = -first.z_m,
                       .step_y = -grid.spacing_m * static_cast<double>(thin),
                       .values = {},
                       .arrows = {}};
  double strongest_m_s = 1e-9;
  for (std::size_t k = 0; k < grid.count_z; k += thin) {
    for (std::size_t i = 0; i < grid.count_x; i += thin) {
      map.values.push_back(std::hypot(u_at(i, k), v_at(i, k)));
      strongest_m_s = std::max(strongest_m_s, map.values.back());
    }
  }
  // The arrow of the strongest wind reaches the next place.
  const double metres_per_m_s = static_cast<double>(apart) * grid.spacing_m / strongest_m_s;
  for (std::size_t k = apart / 2; k < grid.count_z; k += apart) {
    for (std::size_t i = apart / 2; i < grid.count_x; i += apart) {
      const wind::field::WindPlace place = grid.place(i, 0, k);
      map.arrows.push_back({place.x_m, -place.z_m, metres_per_m_s * u_at(i, k), metres_per_m_s * v_at(i, k)});
    }
  }
  return map;
}

void write_text(const std::filesystem::path& file, const std::string& text, bool force) {
  platform::OutputFile output(file, force, drivers::windlog::kSideSuffixes);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(output.working_path().c_str(), "we"),
                                                            &std::fclose);
  if (!out || std::fputs(text.c_str(), out.get()) < 0 || std::fflush(out.get()) != 0) {
    throw ExitError(kExitCannotCreate, file.string() + ": could not be written; is the disk full?");
  }
  output.commit().value();
}

void run_field(FieldOptions options) {
  if (!options.plot.empty()) tools::plot::check_plot_name(options.plot).value();
  options.wind.evolves = !options.is_frozen;
  if (options.stress && options.wind.dims != 3) {
    throw ExitError(kExitUsage,
                    "--stress: needs the vertical wind, which a field of 2 dimensions does not have; add --dims 3");
  }
  if (options.wind.dims == 3) options.wind.stress = options.stress.value_or(kStressNearTheGround);
  const wind::field::Grid grid = grid_of(options);
  const std::vector<std::size_t> shape = {options.frames.count, static_cast<std::size_t>(options.wind.dims),
                                          grid.count_z, grid.count_y, grid.count_x};
  double bytes = sizeof(float);
  for (const std::size_t edge : shape) bytes *= static_cast<double>(edge);
  if (bytes > 1e11) {
    throw ExitError(kExitUsage, fmt::format("--size, --frames: too large: {:.0f} GB (maximum 100 GB)", bytes / 1e9));
  }
  if (options.recording && !drivers::windlog::recording_exists(*options.recording)) {
    throw ExitError(kExitNoInput, options.recording->string() + ": the recording does not exist");
  }
  const std::filesystem::path beside = std::filesystem::path(options.output).replace_extension(".json");
  if (beside == options.output) {
    throw ExitError(kExitUsage, "-o: " + options.output.string() +
                                    ": this name is needed for the description; choose a name that ends with .npy");
  }

  nlohmann::ordered_json description = description_of(options, grid, shape);
  const auto lock = lock_output(options.output);
  platform::OutputFile output(options.output, options.force, drivers::windlog::kSideSuffixes);
  if (!options.force && std::filesystem::exists(beside)) {
    throw ExitError(kExitCannotCreate, beside.string() + ": exists already; --force overwrites it");
  }
  FieldFile file(options.output.string(), output.working_path(), shape);

  // Each frame is written as it is computed; the first is kept for the picture.
  const bool is_watched = isatty(STDERR_FILENO) != 0;
  std::vector<float> first;
  std::size_t written = 0;
  const tools::offline::UseField use = [&](std::span<const float> values) {
    if (written == 0 && !options.plot.empty()) first.assign(values.begin(), values.end());
    file.add(values);
    ++written;
    if (is_watched) fmt::print(stderr, "\r\x1b[Kframe {} of {}", written, options.frames.count);
  };
  std::string title;
  if (options.recording) {
    settings::Config config = configuration_of(options.config_file);
    config.sensors.resize(1);
    if (options.seed) config.seed = *options.seed;
    if (options.is_frozen || options.is_evolving) config.wind.is_evolving = options.is_evolving;
    description["wind"] = {{"recording", options.recording->filename().string()},
                           {"evolves", config.wind.is_evolving},
                           {"seed", config.seed}};
    title = fmt::format("Wind over the ground, {:g} s after the start of {}", options.frames.first_s,
                        options.recording->filename().string());
    tools::offline::make_recorded_frames(*options.recording, options.playback, config, grid, options.frames, use)
        .value();
  } else {
    options.wind.samples = tile_of(options, grid);
    options.wind.seed = options.seed.value_or(options.wind.seed);
    if (is_watched) fmt::print(stderr, "making a tile of {} samples per edge", options.wind.samples);
    wind::field::SpectralWindField field(options.wind);
    const wind::field::WindFieldSettings& wind = options.wind;
    description["wind"] = {{"speed_m_s", wind.speed_m_s},
                           {"direction_deg", wind.direction_deg},
                           {"turbulence_intensity", wind.turbulence_intensity},
                           {"length_m", wind.length_m},
                           {"evolves", wind.evolves},
                           {"seed", wind.seed},
                           {"period_m", field.period_m()},
                           {"variance_m2_s2",
                            {{"along", field.variance_m2_s2(wind::turbulence::WindComponent::kAlong)},
                             {"across", field.variance_m2_s2(wind::turbulence::WindComponent::kAcross)},
                             {"up", field.variance_m2_s2(wind::turbulence::WindComponent::kUpward)}}}};
    if (wind.dims == 3) {
      description["wind"]["stress"] = wind.stress;
      description["wind"]["covariance_m2_s2"] = {{"along_up", field.along_up_covariance_m2_s2()}};
    }
    title = fmt::format("Wind of {:g} m/s from {:g} degrees, TI {:g}, L {:g} m, at {:g} s", wind.speed_m_s,
                        wind.direction_deg, wind.turbulence_intensity, wind.length_m, options.frames.first_s);
    tools::offline::make_spectral_frames(field, grid, options.frames, use);
  }
  if (is_watched) fmt::print(stderr, "\r\x1b[K");

  file.end();
  output.commit().value();
  write_text(beside, json_text(description, 2) + "\n", true);
  fmt::print("{}: float32 [frame {}, component {}, z {}, y {}, x {}], m/s; described in {}\n", options.output.string(),
             shape[0], shape[1], shape[2], shape[3], shape[4], beside.string());
  if (options.plot.empty()) return;
  tools::plot::draw_map(options.plot, map_of(first, grid, title)).value();
  fmt::print("{}: speed and wind time of the first frame, seen from above\n", options.plot);
}

void add_field(CLI::App& app) {
  CLI::App* command = app.add_subcommand("field", "Write the wind over a scene as a float32 NumPy file");
  command->footer(kFieldFooter);
  auto options = std::make_shared<FieldOptions>();
  wind::field::WindFieldSettings& wind = options->wind;
  std::vector<CLI::Option*> of_statistics;  // which a recording makes superfluous
  of_statistics.push_back(command->add_option("--speed", wind.speed_m_s, "mean speed, m/s")
                              ->check(CLI::Range(0.0, 100.0))
                              ->capture_default_str());
  of_statistics.push_back(
      command->add_option("--direction", wind.direction_deg, "direction that it comes from, degrees from north")
          ->check(CLI::Range(0.0, 360.0))
          ->capture_default_str());
  of_statistics.push_back(
      command->add_option("--turbulence", wind.turbulence_intensity, "turbulence intensity along the wind")
          ->check(CLI::Range(0.0, 2.0))
          ->capture_default_str());
  of_statistics.push_back(command->add_option("--length", wind.length_m, "integral length scale along the wind, m")
                              ->check(CLI::Range(0.1, 10000.0))
                              ->capture_default_str());
  of_statistics.push_back(
      command->add_option("--dims", wind.dims, "2: over the ground; 3: in space, with the vertical component")
          ->check(CLI::IsMember({2, 3}))
          ->capture_default_str());
  of_statistics.push_back(command
                              ->add_option("--stress", options->stress,
                                           "with --dims 3: cov(u, w) / (sigma_u sigma_w), u along the wind; 0 is none "
                                           "[-0.3, as near the ground]")
                              ->check(CLI::Range(-wind::field::kMaxStress, wind::field::kMaxStress)));
  of_statistics.push_back(command->add_option("--tile", options->tile, "samples per edge of the tile: a power of two"));
  command
      ->add_option("--size", options->size, "N or X,Z (2-D), N or X,Y,Z (3-D): samples, or metres such as 50m; 256, 64")
      ->delimiter(',')
      ->type_name("N");
  command->add_option("--spacing", wind.spacing_m, "distance between samples, m")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  command->add_option("--time", options->frames.first_s, "time of the first frame, s")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  command->add_option("--frames", options->frames.count, "number of frames")
      ->check(CLI::Range(std::size_t{1}, std::size_t{10'000'000}))
      ->capture_default_str();
  command->add_option("--rate", options->frames.rate_hz, "frames per second")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  auto* const frozen = command->add_flag("--frozen", options->is_frozen, "gusts are carried along unchanged");
  command->add_flag("--evolving", options->is_evolving, "gusts change while they are carried along (the default)")
      ->excludes(frozen);
  command->add_option("--seed", options->seed, "seed of the random numbers; default 1, or that of the configuration");
  auto* const recording =
      command->add_option("--windlog", options->recording, "the live wind over the ground of this recording")
          ->type_name("FILE.windlog");
  for (CLI::Option* option : of_statistics) recording->excludes(option);
  command
      ->add_option("--sensor", options->playback.sensor,
                   "sensor of the recording; default: the one with the first reading")
      ->type_name("NAME")
      ->needs(recording);
  command->add_option("--start", options->playback.start, "where to begin: seconds, or a UTC time (ISO 8601)")
      ->type_name("T")
      ->needs(recording);
  command->add_option("--config", options->config_file, "with --windlog: use [wind] of this configuration")
      ->type_name("FILE.toml")
      ->needs(recording);
  command->add_option("-o,--output", options->output, "FILE.npy")->required();
  command->add_option("--plot", options->plot, "draw the first frame into FILE.png or FILE.svg");
  command->add_flag("--force", options->force, "overwrite the output");
  command->callback([options] { run_field(*options); });
}

}  // namespace

const Command kFieldCommand{add_field};

}  // namespace yuragi::daemon::commands
