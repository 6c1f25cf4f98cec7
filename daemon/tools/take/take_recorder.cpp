#include "daemon/tools/take/take_recorder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

// Debian's header needs this for the library's implementation; images are not used.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include "engine/base/version.hpp"

namespace yuragi::daemon::tools::take {
namespace {

/// What does not move farther than this in the whole take has no curve.
constexpr float kStill_m = 1e-6F;

/// Where the joints are, picture after picture.
struct Pictures {
  std::span<const float> places_m;
  std::size_t joints, frames;

  std::array<float, 3> place(std::size_t joint, std::size_t frame) const {
    const std::size_t at = (frame * joints + joint) * 3;
    return {places_m[at], places_m[at + 1], places_m[at + 2]};
  }
  bool moves(std::size_t joint) const {
    const auto first = place(joint, 0);
    for (std::size_t frame = 1; frame < frames; ++frame) {
      const auto at = place(joint, frame);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (std::abs(at.at(axis) - first.at(axis)) > kStill_m) return true;
      }
    }
    return false;
  }
};

/// One buffer, and accessors that look into it.
class GltfBuffer {
 public:
  explicit GltfBuffer(tinygltf::Model& model) : model_(&model) { model.buffers.emplace_back(); }

  template <class T>
  int add(std::span<const T> values, int component, int type, std::size_t count, int target = 0) {
    return accessor(add_view(values, target), 0, component, type, count);
  }
  template <class T>
  std::size_t add_view(std::span<const T> values, int target = 0) {
    std::vector<unsigned char>& data = model_->buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = values.size_bytes();
    view.target = target;
    const auto* const bytes = reinterpret_cast<const unsigned char*>(values.data());
    data.insert(data.end(), bytes, bytes + values.size_bytes());
    data.resize((data.size() + 3) / 4 * 4);
    model_->bufferViews.push_back(std::move(view));
    return model_->bufferViews.size() - 1;
  }
  /// Looks into a view that is there.
  int accessor(std::size_t view, std::size_t offset, int component, int type, std::size_t count) {
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(view);
    accessor.byteOffset = offset;
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    model_->accessors.push_back(std::move(accessor));
    return static_cast<int>(model_->accessors.size() - 1);
  }

 private:
  tinygltf::Model* model_;
};

constexpr int kFloat = TINYGLTF_COMPONENT_TYPE_FLOAT;
constexpr int kVec3 = TINYGLTF_TYPE_VEC3;

void add_mesh(tinygltf::Model& model, GltfBuffer& buffer, const Mesh& mesh, const std::string& name) {
  std::vector<std::array<float, 3>> places;
  std::vector<std::array<std::uint16_t, 4>> joints;
  std::vector<std::array<float, 4>> weights(mesh.vertices.size(), {1.0F, 0.0F, 0.0F, 0.0F});
  std::vector<double> least(3, 0.0), most(3, 0.0);
  for (const Vertex& vertex : mesh.vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<double>(vertex.place_m.at(axis));
      least[axis] = places.empty() ? value : std::min(least[axis], value);
      most[axis] = places.empty() ? value : std::max(most[axis], value);
    }
    places.push_back(vertex.place_m);
    joints.push_back({static_cast<std::uint16_t>(vertex.joint), 0, 0, 0});
  }
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = 0;
  const std::size_t count = mesh.vertices.size();
  primitive.attributes["POSITION"] =
      buffer.add(std::span<const std::array<float, 3>>(places), kFloat, kVec3, count, TINYGLTF_TARGET_ARRAY_BUFFER);
  model.accessors.back().minValues = least;
  model.accessors.back().maxValues = most;
  primitive.attributes["JOINTS_0"] =
      buffer.add(std::span<const std::array<std::uint16_t, 4>>(joints), TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                 TINYGLTF_TYPE_VEC4, count, TINYGLTF_TARGET_ARRAY_BUFFER);
  primitive.attributes["WEIGHTS_0"] = buffer.add(std::span<const std::array<float, 4>>(weights), kFloat,
                                                 TINYGLTF_TYPE_VEC4, count, TINYGLTF_TARGET_ARRAY_BUFFER);
  primitive.indices = buffer.add(std::span<const std::uint32_t>(mesh.indices), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                 TINYGLTF_TYPE_SCALAR, mesh.indices.size(), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  tinygltf::Mesh made;
  made.name = name;
  made.primitives.push_back(std::move(primitive));
  model.meshes.push_back(std::move(made));

  tinygltf::Material material;
  material.name = name;
  material.doubleSided = true;
  model.materials.push_back(std::move(material));
}

/// A node for each joint, below one of their own, and the skin; the nodes stand as in the first picture.
void add_skeleton(tinygltf::Model& model, GltfBuffer& buffer, const Mesh& mesh, const Pictures& pictures,
                  const std::string& name) {
  const std::size_t count = mesh.joints.size();
  std::vector<std::array<float, 16>> inverse_binds;
  tinygltf::Skin skin;
  tinygltf::Node root;
  for (std::size_t joint = 0; joint < count; ++joint) {
    const auto& rest = mesh.joints[joint].rest_m;
    inverse_binds.push_back({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -rest[0], -rest[1], -rest[2], 1});
    const auto at = pictures.place(joint, 0);
    tinygltf::Node node;
    node.name = "joint " + std::to_string(joint);
    node.translation.assign(at.begin(), at.end());
    model.nodes.push_back(std::move(node));
    skin.joints.push_back(static_cast<int>(joint));
    root.children.push_back(static_cast<int>(joint));
  }
  root.name = name + " joints";
  model.nodes.push_back(std::move(root));
  skin.name = name;
  skin.skeleton = static_cast<int>(count);
  skin.inverseBindMatrices =
      buffer.add(std::span<const std::array<float, 16>>(inverse_binds), kFloat, TINYGLTF_TYPE_MAT4, count);
  model.skins.push_back(std::move(skin));

  tinygltf::Node body;
  body.name = name;
  body.mesh = 0;
  body.skin = 0;
  model.nodes.push_back(std::move(body));
  tinygltf::Scene scene;
  scene.nodes = {static_cast<int>(count), static_cast<int>(count + 1)};
  model.scenes.push_back(std::move(scene));
  model.defaultScene = 0;
}

/// A curve for each joint that moves.
void add_animation(tinygltf::Model& model, GltfBuffer& buffer, const Pictures& pictures, double fps,
                   const std::string& name) {
  std::vector<std::array<float, 3>> curves;
  std::vector<std::size_t> moving;
  for (std::size_t joint = 0; joint < pictures.joints; ++joint) {
    if (!pictures.moves(joint)) continue;
    moving.push_back(joint);
    for (std::size_t frame = 0; frame < pictures.frames; ++frame) curves.push_back(pictures.place(joint, frame));
  }
  if (moving.empty()) return;

  std::vector<float> times_s;
  for (std::size_t frame = 0; frame < pictures.frames; ++frame)
    times_s.push_back(static_cast<float>(static_cast<double>(frame) / fps));
  const int times = buffer.add(std::span<const float>(times_s), kFloat, TINYGLTF_TYPE_SCALAR, pictures.frames);
  model.accessors.back().minValues.assign(1, static_cast<double>(times_s.front()));
  model.accessors.back().maxValues.assign(1, static_cast<double>(times_s.back()));

  const std::size_t view = buffer.add_view(std::span<const std::array<float, 3>>(curves));
  tinygltf::Animation animation;
  animation.name = name;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    tinygltf::AnimationSampler sampler;
    sampler.input = times;
    sampler.output = buffer.accessor(view, i * pictures.frames * sizeof(curves[0]), kFloat, kVec3, pictures.frames);
    sampler.interpolation = "LINEAR";
    animation.samplers.push_back(std::move(sampler));
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(i);
    channel.target_node = static_cast<int>(moving[i]);
    channel.target_path = "translation";
    animation.channels.push_back(std::move(channel));
  }
  model.animations.push_back(std::move(animation));
}

}  // namespace

Result<void, Failure> checked_size(std::size_t joints, double pictures) {
  const double most = std::floor(kMaxPlaces / static_cast<double>(joints));
  if (pictures <= most) return {};
  return Failure{"the take is too large: with " + std::to_string(joints) + " joints it has room for " +
                     std::to_string(static_cast<std::size_t>(most)) +
                     " pictures; take a shorter --duration, fewer --fps, or a larger --every",
                 FailureKind::kUsage};
}

Recorder::Recorder(const pose::Skeleton& skeleton, std::string name, std::size_t every, double fps)
    : name_(std::move(name)), fps_(fps), mesh_(take_mesh_of(skeleton, every)), kinematics_(skeleton) {}

bool Recorder::add(const pose::Pose& pose) {
  if (!kinematics_.run(pose)) return false;
  for (const Joint& joint : mesh_.joints) {
    const pose::JointPosition at = joint.number ? kinematics_.joint(*joint.number) : pose::JointPosition{};
    places_m_.insert(places_m_.end(), {at.x_m, at.y_m, at.z_m});
  }
  ++frames_;
  return true;
}

Result<void, Failure> Recorder::write_glb(std::ostream& out) const {
  if (frames_ == 0) return Failure{"the take has no picture: the recording ends before it begins"};
  const Pictures pictures{.places_m = places_m_, .joints = mesh_.joints.size(), .frames = frames_};
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = with_version("yuragi");
  GltfBuffer buffer(model);
  add_mesh(model, buffer, mesh_, name_);
  add_skeleton(model, buffer, mesh_, pictures, name_);
  add_animation(model, buffer, pictures, fps_, name_);
  tinygltf::TinyGLTF writer;
  if (!writer.WriteGltfSceneToStream(&model, out, false, true) || !out.flush())
    return Failure{"cannot be written: is the disk full?", FailureKind::kCannotCreate};
  return {};
}

}  // namespace yuragi::daemon::tools::take
