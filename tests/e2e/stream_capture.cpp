#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "engine/pose/kinematics.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "engine/wire/wire.hpp"
#include "tests/engine/wire/samples.hpp"

// stream_capture FOLDER: writes stream.bin, a stream as it goes over the wire, and beside it joints.f32: x, y, z
// (float, little-endian) of what our own kinematics makes of the last frame: every joint, scene by scene.
// stream_schema_test.py reads the first by the schema's comments alone, and compares.

namespace {

using namespace yuragi;

void write(const std::filesystem::path& file, const void* data, std::size_t size) {
  std::ofstream out(file, std::ios::binary);
  out.exceptions(std::ios::failbit | std::ios::badbit);
  out.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
}

/// What our own kinematics makes of a pose that a client decoded.
void add_joints(const pose::Skeleton& skeleton, const pose::Pose& pose, std::vector<pose::JointPosition>& joints) {
  pose::Kinematics kinematics(skeleton);
  if (!kinematics.run(pose)) throw std::logic_error("skeleton and pose do not fit");
  for (std::size_t i = 0; i < pose::node_count(skeleton); ++i) joints.push_back(kinematics.joint(i));
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

  // The joints of what a client decodes: the quantised pose, not the one that it was made of.
  const auto frame = std::get<wire::Frame>(wire::decode(samples::body(newest)).value());
  std::vector<pose::JointPosition> joints;
  for (std::size_t i = 0; i < frame.poses.size(); ++i)
    if (frame.opacities[i] > 0.0f) add_joints(scenes.scenes[i].skeleton, frame.poses[i], joints);
  write(folder / "stream.bin", stream.data(), stream.size());
  write(folder / "joints.f32", joints.data(), joints.size() * sizeof(pose::JointPosition));
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
