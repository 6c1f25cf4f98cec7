#include "tests/bench/workload.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include <emmintrin.h>
#include <toml++/toml.h>

#include "engine/pose/pose_arrays.hpp"

namespace yuragi::bench {
namespace {

/// The arrays in which joints lie.
void add_joints(pose::Kinematics::Joints& joints, std::vector<std::span<float>>& all) {
  if (auto* strands = std::get_if<pose::JointPositions>(&joints)) {
    all.emplace_back(strands->data());
  } else if (auto* points = std::get_if<pose::PointPositions>(&joints)) {
    all.emplace_back(points->data());
  } else {
    auto& tree = std::get<pose::TreeJoints>(joints);
    for (std::size_t level = 0; level < tree.level_count(); ++level) all.emplace_back(tree.level(level).data());
  }
}

/// A table's values, as a scene's parameters take them.
ParameterValues::Map parameters_in(const toml::table& table) {
  ParameterValues::Map given;
  for (const auto& [key, node] : table) {
    node.visit([&, name = std::string(key.str())](const auto& value) {
      if constexpr (requires { ParameterValue(*value); }) given.emplace(name, *value);
    });
  }
  return given;
}

}  // namespace

BenchScene bench_scene(std::string_view kind, const ParameterValues::Map& given) {
  for (const scenes::Description* scene : scenes::scene_table()) {
    if (scene->name == kind) {
      return {.kind = scene, .values = ParameterValues::resolve(scene->parameters, given).value()};
    }
  }
  throw std::invalid_argument("no scene is called " + std::string(kind));
}

std::vector<BenchScene> scenes_of(const std::filesystem::path& config_file) {
  const toml::table config = toml::parse_file(config_file.string());
  const auto seed = config["seed"].value_or(std::uint64_t{1});
  std::vector<BenchScene> scenes;
  for (const toml::node& entry : *config["scene"].as_array()) {
    toml::table scene = *entry.as_table();
    const auto number = [&scene](const char* key, double otherwise) { return scene[key].value_or(otherwise); };
    const auto kind = scene["kind"].value_or(std::string());
    const bool is_shown = scene["shown"].value_or(true);
    const scenes::Placement placement{.x_m = number("x", 0.0),
                                      .y_m = number("y", 0.0),
                                      .z_m = number("z", 0.0),
                                      .heading_deg = number("heading", 0.0)};
    const double gain = number("gain", 1.0);
    for (const char* key : {"kind", "name", "x", "y", "z", "heading", "gain", "shown"}) scene.erase(key);
    if (!is_shown) continue;

    BenchScene& next = scenes.emplace_back(bench_scene(kind, parameters_in(scene)));
    next.seed = seed + scenes.size() - 1;
    next.placement = placement;
    next.gain = gain;
  }
  return scenes;
}

Workload::Workload(const std::vector<BenchScene>& scenes, SimdRow row,
                   std::shared_ptr<const wind::turbulence::GustNoise> gusts)
    : wind_(gusts) {
  for (const BenchScene& scene : scenes) {
    Placed& placed = parts_.emplace_back();
    placed.gain = scene.gain;
    placed.scene =
        scene.kind->make(scene.values, {.seed = scene.seed, .placement = scene.placement, .row = row, .gusts = gusts});
    placed.kinematics = std::make_unique<pose::Kinematics>(placed.scene->skeleton(), row);
    add_joints(placed.kinematics->joints(), joints_);
    nodes_ += pose::node_count(placed.scene->skeleton());
  }
  for (int i = 0; i < 60; ++i) frame();  // it moves when it is measured
}

void Workload::shift() {
  const wind::ground::Wind& wind = wind_.next();
  for (Placed& part : parts_) part.scene->shift(part.gain * wind, kBenchTick_s);
}

void Workload::sample() {
  for (Placed& part : parts_) part.scene->sample();
}

void Workload::project() {
  for (Placed& part : parts_) {
    part.scene->project(kBenchTick_s);
    part.kinematics->run(part.scene->pose());
  }
}

void Workload::frame(workers::Pool& pool) {
  shift();
  for (Placed& placed : parts_) {
    pool.run([&placed](Part part) { placed.scene->sample_part(part); });
    pool.run([&placed](Part part) {
      placed.scene->project_part(part, kBenchTick_s);
      placed.kinematics->run(placed.scene->pose(), part);
    });
  }
}

void Workload::store_in_a_loop() {
  value_ += 1.0F;
  for (const std::span<float> joints : joints_) std::fill(joints.begin(), joints.end(), value_);
}

void Workload::store_by_memset() {
  value_ = value_ == 0.0F ? 1.0F : 0.0F;
  for (const std::span<float> joints : joints_) std::memset(joints.data(), value_ == 0.0F ? 0 : 1, joints.size_bytes());
}

void Workload::store_past_caches() {
  value_ += 1.0F;
  const __m128 four = _mm_set1_ps(value_);
  for (const std::span<float> joints : joints_) {
    float* at = joints.data();
    float* const end = at + joints.size();
    while (at != end && reinterpret_cast<std::uintptr_t>(at) % sizeof four != 0) *at++ = value_;
    for (; end - at >= 4; at += 4) _mm_stream_ps(at, four);
    while (at != end) *at++ = value_;
  }
  _mm_sfence();
}

}  // namespace yuragi::bench
