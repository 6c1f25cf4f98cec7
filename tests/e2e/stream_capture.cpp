#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "engine/pose/strand_kinematics.hpp"
#include "engine/wire/wire.hpp"
#include "tests/engine/wire/samples.hpp"

// stream_capture FOLDER: writes stream.bin, a stream as it goes over the wire, and beside it tips.f32, the tips of the
// last frame as our own kinematics has them: x, y, z (float, little-endian) of each strand, scene by scene.
// stream_schema_test.py reads the first by the schema's comments alone, and compares.

namespace {

using namespace yuragi;

void write(const std::filesystem::path& file, const void* data, std::size_t size) {
  std::ofstream out(file, std::ios::binary);
  out.exceptions(std::ios::failbit | std::ios::badbit);
  out.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
}

void capture(const std::filesystem::path& folder) {
  // Hello, scenes, and frames with and without a bend.
  const wire::Scenes scenes = samples::scenes(1000);
  wire::Bytes stream = wire::encode(wire::Hello{.software = "stream_capture", .tick_rate_hz = 60.0});
  const wire::Bytes scenes_message = wire::encode(scenes);
  stream.insert(stream.end(), scenes_message.begin(), scenes_message.end());
  const Skeleton* skeletons[] = {&scenes.scenes[0].skeleton, &scenes.scenes[1].skeleton};
  wire::FrameEncoder encoder;
  wire::Bytes newest;
  for (std::uint64_t i = 0; i < 5; ++i) {
    const auto largest_rad = 0.5f * static_cast<float>(i);
    const Pose meadow = samples::bent(1000, largest_rad);
    const Pose bank = samples::bent(3, largest_rad);
    const Pose* poses[] = {&meadow, &bank};
    wire::FrameInfo info = samples::frame_info();
    info.sequence = info.tick = i + 1;
    info.time_s = static_cast<double>(i + 1) / 60.0;
    const auto bytes = encoder.encode(info, skeletons, poses);
    newest.assign(bytes.begin(), bytes.end());
    stream.insert(stream.end(), newest.begin(), newest.end());
  }

  // The tips of what a client decodes: the quantised pose, not the one that it was made of.
  const auto frame = std::get<wire::Frame>(wire::decode(samples::body(newest)).value());
  std::vector<float> tips;
  for (std::size_t i = 0; i < frame.poses.size(); ++i) {
    const auto& skeleton = std::get<StrandSkeleton>(scenes.scenes[i].skeleton);
    JointPositions joints(skeleton);
    const StrandKinematicsJob job{
        .skeleton = &skeleton, .pose = &std::get<StrandPose>(frame.poses[i]), .row = {}, .joints = &joints};
    if (job.run() != StrandKinematicsJob::Problem::kNone) throw std::logic_error("skeleton and pose do not fit");
    for (std::size_t strand = 0; strand < skeleton.strand_count; ++strand) {
      const JointPosition tip = joints.joint(strand, skeleton.links_per_strand - 1);
      tips.insert(tips.end(), {tip.x_m, tip.y_m, tip.z_m});
    }
  }
  write(folder / "stream.bin", stream.data(), stream.size());
  write(folder / "tips.f32", tips.data(), tips.size() * sizeof(float));
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
