#include "daemon/tools/take/take_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/units.hpp"
#include "engine/pose/kinematics.hpp"
#include "engine/pose/pose_arrays.hpp"

namespace yuragi::daemon::tools::take {
namespace {

using Vector = std::array<float, 3>;

constexpr float kRibbonHalfWidthShare = 0.012F;  ///< of a strand's length
constexpr std::size_t kTubeSides = 5;
constexpr std::uint32_t kStill = 0;  ///< the joint of what does not move

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
float length_of(const Vector& v) {
  return std::hypot(v[0], v[1], v[2]);
}
Vector moved(const Vector& from, float by, const Vector& along) {
  return {from[0] + by * along[0], from[1] + by * along[1], from[2] + by * along[2]};
}
/// Of length 1 and across `along`: `wish`, or if that is along it, any.
Vector across(const Vector& along, const Vector& wish) {
  for (const Vector& candidate :
       {cross(along, wish), cross(along, {1.0F, 0.0F, 0.0F}), cross(along, {0.0F, 0.0F, 1.0F})}) {
    const float length = length_of(candidate);
    if (length > 1e-4F) return {candidate[0] / length, candidate[1] / length, candidate[2] / length};
  }
  return {1.0F, 0.0F, 0.0F};
}

class MeshBuilder {
 public:
  explicit MeshBuilder(const pose::Skeleton& skeleton) : kinematics_(skeleton) {
    kinematics_.run(pose::rest_pose(skeleton));
  }

  std::uint32_t joint(std::size_t number) {
    mesh_.joints.push_back({number, place(number)});
    return static_cast<std::uint32_t>(mesh_.joints.size() - 1);
  }
  Vector place(std::size_t number) const {
    const pose::JointPosition at = kinematics_.joint(number);
    return {at.x_m, at.y_m, at.z_m};
  }
  std::uint32_t vertex(const Vector& place_m, std::uint32_t joint) {
    mesh_.vertices.push_back({place_m, joint});
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh_.indices.insert(mesh_.indices.end(), {a, b, c, a, c, d});
  }
  Mesh take() { return std::move(mesh_); }

 private:
  pose::Kinematics kinematics_;
  Mesh mesh_;
};

/// A place along a strand at rest.
struct Station {
  Vector place_m{};
  std::uint32_t joint = kStill;
  float radius_m = 0.0F;
};

void add_ribbon(MeshBuilder& builder, const std::vector<Station>& stations, const Vector& side) {
  std::array<std::uint32_t, 2> before{};
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Station& at = stations[i];
    const std::array<std::uint32_t, 2> here = {builder.vertex(moved(at.place_m, -at.radius_m, side), at.joint),
                                               builder.vertex(moved(at.place_m, at.radius_m, side), at.joint)};
    if (i > 0) builder.quad(before[0], before[1], here[1], here[0]);
    before = here;
  }
}

void add_tube(MeshBuilder& builder, const std::vector<Station>& stations, const Vector& along, const Vector& side) {
  const Vector other = cross(along, side);
  std::array<std::uint32_t, kTubeSides> before{};
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const Station& at = stations[i];
    std::array<std::uint32_t, kTubeSides> here{};
    for (std::size_t k = 0; k < kTubeSides; ++k) {
      const auto turn_rad = static_cast<float>(2.0 * kPi * static_cast<double>(k) / static_cast<double>(kTubeSides));
      here.at(k) = builder.vertex(
          moved(moved(at.place_m, at.radius_m * std::cos(turn_rad), side), at.radius_m * std::sin(turn_rad), other),
          at.joint);
    }
    for (std::size_t k = 0; i > 0 && k < kTubeSides; ++k) {
      const std::size_t next = (k + 1) % kTubeSides;
      builder.quad(before.at(k), before.at(next), here.at(next), here.at(k));
    }
    before = here;
  }
}

Vector along_of(const pose::StrandSkeleton& strands, std::size_t i) {
  return {strands.rest_x[i], strands.rest_y[i], strands.rest_z[i]};
}
Vector curl_of(const pose::StrandSkeleton& strands, std::size_t i) {
  return {strands.curl_x[i], strands.curl_y[i], strands.curl_z[i]};
}

void add(MeshBuilder& builder, const pose::StrandSkeleton& strands, std::size_t every) {
  const std::size_t links = strands.links_per_strand;
  std::vector<Station> stations(links + 1);
  for (std::size_t i = 0; i < strands.strand_count; i += every) {
    const float half_width_m =
        kRibbonHalfWidthShare * strands.link_length_m[i] * static_cast<float>(links) * static_cast<float>(every);
    stations[0] = {{strands.root_x_m[i], strands.root_y_m[i], strands.root_z_m[i]}, kStill, half_width_m};
    for (std::size_t link = 0; link < links; ++link) {
      const float taper = 1.0F - static_cast<float>(link + 1) / static_cast<float>(links);
      stations[link + 1] = {builder.place(i * links + link), builder.joint(i * links + link), half_width_m * taper};
    }
    add_ribbon(builder, stations, across(along_of(strands, i), curl_of(strands, i)));
  }
}

/// Which strands of each level are shown: of what grows on limbs (twigs, leaves) each so-manyth, and nothing whose
/// parent is not.
std::vector<std::vector<bool>> shown_of(const pose::TreeSkeleton& tree, std::size_t every) {
  constexpr std::size_t kWholeLevels = 2;
  std::vector<std::vector<bool>> shown(tree.levels.size());
  for (std::size_t number = 0; number < tree.levels.size(); ++number) {
    const pose::TreeLevel& level = tree.levels[number];
    shown[number].resize(level.strands.strand_count);
    std::size_t candidates = 0;
    for (std::size_t i = 0; i < level.strands.strand_count; ++i) {
      if (number > 0 && !shown[level.parent_level][level.parent[i]]) continue;
      shown[number][i] = number < kWholeLevels || candidates++ % every == 0;
    }
  }
  return shown;
}

void add(MeshBuilder& builder, const pose::TreeSkeleton& tree, std::size_t every) {
  const auto shown = shown_of(tree, every);
  std::size_t first = 0;  // number of the level's first joint
  std::vector<std::vector<std::uint32_t>> joints(tree.levels.size());
  for (std::size_t number = 0; number < tree.levels.size(); ++number) {
    const pose::TreeLevel& level = tree.levels[number];
    const std::size_t links = level.strands.links_per_strand;
    joints[number].resize(level.strands.strand_count * links, kStill);
    std::vector<Station> stations(links + 1);
    for (std::size_t i = 0; i < level.strands.strand_count; ++i) {
      if (!shown[number][i]) continue;
      const float wider = level.is_leaves ? static_cast<float>(every) : 1.0F;
      const auto radius_m = [&](std::size_t joint) {
        const float share = static_cast<float>(joint) / static_cast<float>(links);
        return wider * (level.base_radius_m[i] + share * (level.tip_radius_m[i] - level.base_radius_m[i]));
      };
      std::uint32_t foot = kStill;
      if (number > 0) {
        const std::size_t links_of_parent = tree.levels[level.parent_level].strands.links_per_strand;
        foot = joints[level.parent_level][level.parent[i] * links_of_parent + level.parent_link[i]];
      }
      stations[0] = {
          {level.strands.root_x_m[i], level.strands.root_y_m[i], level.strands.root_z_m[i]}, foot, radius_m(0)};
      for (std::size_t link = 0; link < links; ++link) {
        const std::size_t joint = i * links + link;
        joints[number][joint] = builder.joint(first + joint);
        stations[link + 1] = {builder.place(first + joint), joints[number][joint], radius_m(link + 1)};
      }
      const Vector along = along_of(level.strands, i);
      const Vector side = across(along, curl_of(level.strands, i));
      level.is_leaves ? add_ribbon(builder, stations, side) : add_tube(builder, stations, along, side);
    }
    first += level.strands.strand_count * links;
  }
}

/// 0, every, 2 every ... below `count`, and the last.
std::vector<std::size_t> picked(std::size_t count, std::size_t every) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < count; i += every) all.push_back(i);
  if (count > 0 && all.back() + 1 < count) all.push_back(count - 1);
  return all;
}

/// Columns of a row, or of a ring of it, and whether the last is followed by the first.
struct Run {
  std::vector<std::size_t> columns;
  bool is_closed = false;
};

std::vector<Run> runs_of(const pose::GridSkeleton& grid, std::size_t every) {
  return {{picked(grid.columns, every)}};
}
std::vector<Run> runs_of(const pose::SurfaceSkeleton& surface, std::size_t every) {
  if (!surface.is_closed) return {{picked(surface.columns, every)}};
  std::vector<Run> rings(surface.shells);
  const std::size_t around = surface.columns / surface.shells;
  for (std::size_t ring = 0; ring < surface.shells; ++ring) {
    rings[ring].is_closed = true;
    for (std::size_t i = 0; i < around; i += every) rings[ring].columns.push_back(ring * around + i);
  }
  return rings;
}

/// A net of points: of rows and columns each so-manyth.
template <class Net>
void add_net(MeshBuilder& builder, const Net& net, std::size_t every) {
  for (const Run& run : runs_of(net, every)) {
    const std::size_t across = run.columns.size();
    std::vector<std::uint32_t> before;
    for (const std::size_t row : picked(net.rows, every)) {
      std::vector<std::uint32_t> here;
      for (const std::size_t column : run.columns) {
        const std::size_t number = row * net.columns + column;
        here.push_back(builder.vertex(builder.place(number), builder.joint(number)));
      }
      for (std::size_t i = 0; !before.empty() && i < (run.is_closed ? across : across - 1); ++i) {
        const std::size_t next = (i + 1) % across;
        builder.quad(before[i], before[next], here[next], here[i]);
      }
      before = std::move(here);
    }
  }
}
void add(MeshBuilder& builder, const pose::GridSkeleton& grid, std::size_t every) {
  add_net(builder, grid, every);
}
void add(MeshBuilder& builder, const pose::SurfaceSkeleton& surface, std::size_t every) {
  add_net(builder, surface, every);
}

std::size_t joints_of(const pose::StrandSkeleton& strands, std::size_t every) {
  return (strands.strand_count + every - 1) / every * strands.links_per_strand;
}
template <class Net>
std::size_t joints_of_net(const Net& net, std::size_t every) {
  std::size_t columns = 0;
  for (const Run& run : runs_of(net, every)) columns += run.columns.size();
  return columns * picked(net.rows, every).size();
}
std::size_t joints_of(const pose::GridSkeleton& grid, std::size_t every) {
  return joints_of_net(grid, every);
}
std::size_t joints_of(const pose::SurfaceSkeleton& surface, std::size_t every) {
  return joints_of_net(surface, every);
}
std::size_t joints_of(const pose::TreeSkeleton& tree, std::size_t every) {
  const auto shown = shown_of(tree, every);
  std::size_t all = 0;
  for (std::size_t level = 0; level < shown.size(); ++level)
    all +=
        static_cast<std::size_t>(std::ranges::count(shown[level], true)) * tree.levels[level].strands.links_per_strand;
  return all;
}

}  // namespace

Mesh take_mesh_of(const pose::Skeleton& skeleton, std::size_t every) {
  MeshBuilder builder(skeleton);
  std::visit([&](const auto& kind) { add(builder, kind, std::max<std::size_t>(every, 1)); }, skeleton);
  return builder.take();
}

std::optional<std::size_t> every_within(const pose::Skeleton& skeleton, std::size_t most_joints) {
  constexpr std::size_t kLargest = 4096;
  for (std::size_t every = 1; every <= kLargest; every += 1 + every / 16) {
    const std::size_t joints = std::visit([every](const auto& kind) { return joints_of(kind, every); }, skeleton);
    if (1 + joints <= most_joints) return every;
  }
  return std::nullopt;
}

}  // namespace yuragi::daemon::tools::take
