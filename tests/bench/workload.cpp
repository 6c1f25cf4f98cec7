#include "tests/bench/workload.hpp"

#include <algorithm>
#include <stdexcept>

#include "engine/pose/pose_arrays.hpp"

namespace yuragi::bench {
namespace {

const SceneDescription& scene_named(std::string_view kind) {
  for (const SceneDescription* scene : scene_table()) {
    if (scene->name == kind) return *scene;
  }
  throw std::invalid_argument("no scene is called " + std::string(kind));
}

}  // namespace

Workload::Workload(std::string_view kind, const ParameterValues::Map& given, SimdRow row, bool has_gusts) {
  if (has_gusts) {
    gusts_ = std::make_shared<const GustNoise>(GustNoiseSettings{.evolves = true});
    wind_.gusts.ahead = (1.0 / speed_of(kBreeze)) * kBreeze;
    wind_.gusts.along_m_s.fill(0.3F);
    wind_.gusts.across_m_s.fill(0.3F);
  }
  const SceneDescription& description = scene_named(kind);
  scene_ = description.make(ParameterValues::resolve(description.parameters, given).value(),
                            {.seed = 1, .row = row, .gusts = gusts_});
  kinematics_ = std::make_unique<Kinematics>(scene_->skeleton(), row);
  nodes_ = node_count(scene_->skeleton());
  for (int i = 0; i < 60; ++i) frame();  // it moves when it is measured
}

void Workload::frame(WorkerPool& pool) {
  shift();
  pool.run([this](Part part) { scene_->sample_part(part); });
  pool.run([this](Part part) {
    scene_->project_part(part, kBenchTick_s);
    kinematics_->run(scene_->pose(), part);
  });
}

void Workload::store_only() {
  value_ += 1.0F;
  const auto fill = [this](std::span<float> joints) { std::fill(joints.begin(), joints.end(), value_); };
  Kinematics::Joints& joints = kinematics_->joints();
  if (auto* strands = std::get_if<JointPositions>(&joints)) return fill(strands->data());
  if (auto* points = std::get_if<PointPositions>(&joints)) return fill(points->data());
  auto& tree = std::get<TreeJoints>(joints);
  for (std::size_t level = 0; level < tree.level_count(); ++level) fill(tree.level(level).data());
}

}  // namespace yuragi::bench
