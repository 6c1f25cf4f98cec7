#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "engine/pose/point_kinematics.hpp"
#include "engine/pose/strand_kinematics.hpp"
#include "engine/pose/tree_kinematics.hpp"
#include "engine/wire/wire.hpp"
#include "tests/engine/wire/samples.hpp"

// stream_capture FOLDER: writes stream.bin, a stream as it goes over the wire, and beside it points.f32: x, y, z
// (float, little-endian) of what our own kinematics makes of the last frame, scene by scene: the tips of strands and of
// each level of a tree, all joints of a cloth, all points of a surface. stream_schema_test.py reads the first by the
// schema's comments alone, and compares.

namespace {

using namespace yuragi;

void write(const std::filesystem::path& file, const void* data, std::size_t size) {
  std::ofstream out(file, std::ios::binary);
  out.exceptions(std::ios::failbit | std::ios::badbit);
  out.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
}

template <class Job>
void run(const Job& job) {
  if (job.run() != Job::Problem::kNone) throw std::logic_error("skeleton and pose do not fit");
}

void add_tips(const pose::StrandSkeleton& skeleton, const pose::JointPositions& joints,
              std::vector<pose::JointPosition>& points) {
  for (std::size_t strand = 0; strand < skeleton.strand_count; ++strand)
    points.push_back(joints.joint(strand, skeleton.links_per_strand - 1));
}

/// What our own kinematics makes of a pose that a client decoded.
void add_points(const pose::Skeleton& skeleton, const pose::Pose& pose, std::vector<pose::JointPosition>& points) {
  if (const auto* strands = std::get_if<pose::StrandSkeleton>(&skeleton)) {
    pose::JointPositions joints(*strands);
    run(pose::StrandKinematicsJob{
        .skeleton = strands, .pose = &std::get<pose::StrandPose>(pose), .row = {}, .joints = &joints});
    add_tips(*strands, joints, points);
  } else if (const auto* grid = std::get_if<pose::GridSkeleton>(&skeleton)) {
    pose::PointPositions joints(*grid);
    run(pose::GridKinematicsJob{.skeleton = grid, .pose = &std::get<pose::GridPose>(pose), .points = &joints});
    for (std::size_t i = 0; i < joints.size(); ++i)
      if (i % grid->stride() < grid->columns) points.push_back(joints.point(i));
  } else if (const auto* tree = std::get_if<pose::TreeSkeleton>(&skeleton)) {
    pose::TreeJoints joints(*tree);
    run(pose::TreeKinematicsJob{
        .skeleton = tree, .pose = &std::get<pose::TreePose>(pose), .row = {}, .joints = &joints});
    for (std::size_t i = 0; i < tree->levels.size(); ++i) add_tips(tree->levels[i].strands, joints.level(i), points);
  } else {
    const auto& surface = std::get<pose::SurfaceSkeleton>(skeleton);
    pose::PointPositions moved(surface);
    run(pose::SurfaceKinematicsJob{.skeleton = &surface, .pose = &std::get<pose::SurfacePose>(pose), .points = &moved});
    for (std::size_t i = 0; i < moved.size(); ++i) points.push_back(moved.point(i));
  }
}

void capture(const std::filesystem::path& folder) {
  // Two meadows, one scene of each kind, and a hidden one.
  wire::Scenes scenes{{{"bank", "grass", samples::meadow(3, 1)}}};
  for (const wire::SceneModel& scene : samples::all_kinds().scenes) scenes.scenes.push_back(scene);
  scenes.scenes[1].skeleton = samples::meadow(1000);
  scenes.scenes.push_back({"nobody's", "grass", samples::meadow(5)});
  const std::vector<float> opacities{1.0f, 1.0f, 0.5f, 1.0f, 0.25f, 1.0f, 0.0f};

  // Hello, scenes, and frames with and without a bend.
  wire::Bytes stream = wire::encode(wire::Hello{.software = "stream_capture", .tick_rate_hz = 60.0});
  const wire::Bytes scenes_message = wire::encode(scenes);
  stream.insert(stream.end(), scenes_message.begin(), scenes_message.end());
  wire::FrameEncoder encoder;
  wire::Bytes newest;
  for (std::uint64_t i = 0; i < 5; ++i) {
    const auto largest_rad = 0.5f * static_cast<float>(i);
    std::vector<pose::Pose> moved{samples::bent(3, largest_rad)};
    for (const pose::Pose& pose : samples::all_moved()) moved.push_back(pose);
    moved[1] = samples::bent(1000, largest_rad);
    moved.emplace_back(samples::bent(5));
    std::vector<const pose::Skeleton*> skeletons;
    std::vector<const pose::Pose*> poses;
    for (std::size_t scene = 0; scene < moved.size(); ++scene) {
      skeletons.push_back(&scenes.scenes[scene].skeleton);
      poses.push_back(&moved[scene]);
    }
    wire::FrameInfo info = samples::frame_info();
    info.sequence = info.tick = i + 1;
    info.time_s = static_cast<double>(i + 1) / 60.0;
    const auto bytes = encoder.encode(info, skeletons, poses, opacities);
    newest.assign(bytes.begin(), bytes.end());
    stream.insert(stream.end(), newest.begin(), newest.end());
  }

  // The points of what a client decodes: the quantised pose, not the one that it was made of.
  const auto frame = std::get<wire::Frame>(wire::decode(samples::body(newest)).value());
  std::vector<pose::JointPosition> points;
  for (std::size_t i = 0; i < frame.poses.size(); ++i)
    if (frame.opacities[i] > 0.0f) add_points(scenes.scenes[i].skeleton, frame.poses[i], points);
  write(folder / "stream.bin", stream.data(), stream.size());
  write(folder / "points.f32", points.data(), points.size() * sizeof(pose::JointPosition));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: stream_capture FOLDER\n");
    return 64;
  }
  try {
    capture(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stream_capture: %s\n", error.what());
    return 70;
  }
}
