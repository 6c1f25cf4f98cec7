#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include "daemon/tools/take/take_mesh.hpp"
#include "daemon/tools/take/take_recorder.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "tests/engine/wire/samples.hpp"

namespace yuragi::daemon::tools::take {
namespace {

constexpr std::size_t kStrands = 20;

struct Sample {
  const char* name;
  pose::Skeleton skeleton;
};
std::vector<Sample> every_kind() {
  return {{"strands", samples::meadow(kStrands)},
          {"grid", samples::cloth()},
          {"tree", samples::tree()},
          {"surface", samples::bowl(true)}};
}

TEST(TakeMesh, IsWhole_OfEveryKindAndThinness) {
  for (const Sample& sample : every_kind()) {
    for (const std::size_t every : {1U, 2U, 3U, 7U}) {
      SCOPED_TRACE(std::string(sample.name) + " every " + std::to_string(every));
      const Mesh mesh = take_mesh_of(sample.skeleton, every);
      ASSERT_FALSE(mesh.indices.empty());
      EXPECT_EQ(mesh.indices.size() % 3, 0U);
      EXPECT_LT(*std::ranges::max_element(mesh.indices), mesh.vertices.size());
      EXPECT_FALSE(mesh.joints[0].number.has_value()) << "the one that stands still";
      std::vector<bool> is_used(mesh.joints.size(), false);
      for (const Vertex& vertex : mesh.vertices) {
        ASSERT_LT(vertex.joint, mesh.joints.size());
        is_used[vertex.joint] = true;
        for (const float value : vertex.place_m) EXPECT_TRUE(std::isfinite(value));
      }
      EXPECT_EQ(std::count(is_used.begin() + 1, is_used.end(), false), 0) << "a joint that moves nothing";
    }
  }
}
TEST(TakeMesh, EachStrandIsARibbonFromItsRoot) {
  const auto strands = samples::meadow(kStrands);
  const Mesh mesh = take_mesh_of(strands, 1);
  EXPECT_EQ(mesh.joints.size(), 1 + kStrands * strands.links_per_strand);
  EXPECT_EQ(mesh.vertices.size(), kStrands * 2 * (strands.links_per_strand + 1));
  const auto middle = [&mesh](std::size_t vertex, std::size_t axis) {
    return 0.5F * (mesh.vertices[vertex].place_m.at(axis) + mesh.vertices[vertex + 1].place_m.at(axis));
  };
  EXPECT_NEAR(middle(0, 0), strands.root_x_m[0], 1e-5);
  EXPECT_EQ(mesh.vertices[0].joint, 0U) << "the root stays";
}
TEST(TakeMesh, EveryWithin_IsEnoughAndNotFarTooMuch) {
  for (const Sample& sample : every_kind()) {
    const std::size_t all = take_mesh_of(sample.skeleton, 1).joints.size();
    EXPECT_EQ(every_within(sample.skeleton, all), 1U) << sample.name;
    const auto every = every_within(sample.skeleton, all - 1);
    ASSERT_TRUE(every) << sample.name;
    EXPECT_EQ(*every, 2U) << sample.name;
    EXPECT_LE(take_mesh_of(sample.skeleton, *every).joints.size(), all - 1) << sample.name;
    EXPECT_FALSE(every_within(sample.skeleton, 1)) << sample.name;
  }
}

tinygltf::Model read_back(const Recorder& take) {
  std::ostringstream out;
  take.write_glb(out).value();
  const std::string bytes = out.str();
  tinygltf::Model model;
  tinygltf::TinyGLTF reader;
  std::string error, warning;
  EXPECT_TRUE(reader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(bytes.data()),
                                          static_cast<unsigned>(bytes.size())))
      << error;
  EXPECT_EQ(error + warning, "");
  return model;
}
/// A value of an accessor of floats.
float value_of(const tinygltf::Model& model, int accessor, std::size_t index) {
  const tinygltf::Accessor& a = model.accessors.at(static_cast<std::size_t>(accessor));
  const tinygltf::BufferView& view = model.bufferViews.at(static_cast<std::size_t>(a.bufferView));
  float value = 0.0F;
  std::memcpy(&value, model.buffers.at(0).data.data() + view.byteOffset + a.byteOffset + index * sizeof value,
              sizeof value);
  return value;
}

TEST(TakeRecorder, HoldsWhereEachJointWasInEachPicture) {
  for (const Sample& sample : every_kind()) {
    SCOPED_TRACE(sample.name);
    Recorder take(sample.skeleton, sample.name, 1, 25.0);
    pose::Pose pose = pose::rest_pose(sample.skeleton);
    ASSERT_TRUE(take.add(pose));
    // What every kind takes: each of its arrays a little further on.
    pose::for_each_array(pose, [](std::span<float> values) {
      for (std::size_t i = 0; i < values.size(); ++i) values[i] += 0.02F + 0.001F * static_cast<float>(i % 7);
    });
    ASSERT_TRUE(take.add(pose));
    pose::Kinematics kinematics(sample.skeleton);
    ASSERT_TRUE(kinematics.run(pose));

    const tinygltf::Model model = read_back(take);
    const Mesh mesh = take_mesh_of(sample.skeleton, 1);
    ASSERT_EQ(model.skins.at(0).joints.size(), mesh.joints.size());
    ASSERT_EQ(model.animations.size(), 1U);
    const tinygltf::Animation& animation = model.animations[0];
    ASSERT_FALSE(animation.channels.empty());
    EXPECT_LT(animation.channels.size(), mesh.joints.size()) << "the one that stands still has no curve";
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      const auto& sampler = animation.samplers.at(static_cast<std::size_t>(channel.sampler));
      const auto& joint = mesh.joints.at(static_cast<std::size_t>(channel.target_node));
      const pose::JointPosition at = kinematics.joint(joint.number.value());
      EXPECT_EQ(value_of(model, sampler.output, 3), at.x_m);
      EXPECT_EQ(value_of(model, sampler.output, 4), at.y_m);
      EXPECT_EQ(value_of(model, sampler.output, 5), at.z_m);
      EXPECT_FLOAT_EQ(value_of(model, sampler.input, 1), 0.04F);
      // At rest the skin leaves its vertices where they are: the joint's place and the inverse bind cancel.
      EXPECT_EQ(value_of(model, sampler.output, 0), joint.rest_m[0]);
      EXPECT_EQ(
          value_of(model, model.skins[0].inverseBindMatrices, 16 * static_cast<std::size_t>(channel.target_node) + 12),
          -joint.rest_m[0]);
    }
  }
}
TEST(TakeRecorder, AStillSceneHasNoAnimation_AndATakeOfNothingIsNone) {
  const pose::Skeleton cloth = samples::cloth();
  Recorder take(cloth, "cloth", 1, 30.0);
  std::ostringstream out;
  EXPECT_FALSE(take.write_glb(out));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(take.add(pose::rest_pose(cloth)));
  EXPECT_TRUE(read_back(take).animations.empty());
  EXPECT_FALSE(take.add(pose::rest_pose(samples::meadow(kStrands)))) << "a pose of another scene";
  out.setstate(std::ios::badbit);
  EXPECT_FALSE(take.write_glb(out)) << "a full disk";
}

TEST(TakeRecorder, IsRefusedBeforeItsWorkIfItsFileWouldBeTooLarge) {
  EXPECT_TRUE(checked_size(kMaxJoints, 1220.0));
  const auto large = checked_size(kMaxJoints, 1221.0);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().message,
            "the take is too large: with 65535 joints it has room for 1220 pictures; take a shorter --duration, fewer "
            "--fps, or a larger --every");
  EXPECT_EQ(large.error().kind, FailureKind::kUsage);
  EXPECT_FALSE(checked_size(1, 1e300));
}

}  // namespace
}  // namespace yuragi::daemon::tools::take
