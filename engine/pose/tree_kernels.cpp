#include "engine/pose/tree_kernels.hpp"

#include "engine/base/kernel.hpp"
#include "engine/math/lanes.hpp"
#include "engine/math/trig.hpp"

// A turn is a unit quaternion. With a = up x b the axis across the unit vector b toward which the parent bends, its
// link i of n (from 1) and the strands on it are turned by exp(a angle i / n) after the turn of its strand's root.

namespace yuragi::pose {
namespace {

constexpr std::size_t kTurnsAtOnce = 16;
constexpr std::uint32_t kBlock = 16;  // kStrandsPerBlock of skeleton.hpp, whose vectors must not be included here

// As in strand_kernels.cpp: limit for longer bends; shorter ones count as none.
constexpr float kMaxComponent_rad = 32.0F;
constexpr float kMaxBend_rad = 0x1.921fb6p1F;
constexpr float kMinBendSquare_rad2 = 1e-30F;

[[gnu::always_inline]] inline float within(float value, float limit) noexcept {
  const float above = value < -limit ? -limit : value;
  return above > limit ? limit : above;
}

/// The bends and turns of some parents, side by side.
struct Parents {
  alignas(64) float east_rad[kTurnsAtOnce], south_rad[kTurnsAtOnce], half_share[kTurnsAtOnce];
  alignas(64) float w[kTurnsAtOnce], x[kTurnsAtOnce], y[kTurnsAtOnce], z[kTurnsAtOnce];
};

/// Loads the turns from `begin` on; after the last turn it is repeated.
[[gnu::always_inline]] inline void load_parents(const TreeKernelArguments& in, std::size_t begin,
                                                Parents& out) noexcept {
  const float half_share_of_a_link = 0.5F / static_cast<float>(in.parent_links);
  for (std::size_t i = 0; i < kTurnsAtOnce; ++i) {
    const std::size_t turn = begin + i < in.turns ? begin + i : in.turns - 1;
    const std::size_t strand = turn * in.turn.strands_per_turn;
    const std::uint32_t parent = in.parent[strand];
    const std::size_t parent_turn = parent / in.parent_turn.strands_per_turn;
    out.east_rad[i] = in.parent_bend_east_rad[parent];
    out.south_rad[i] = in.parent_bend_south_rad[parent];
    out.half_share[i] = half_share_of_a_link * static_cast<float>(in.parent_link[strand] + 1);
    out.w[i] = in.parent_turn.w[parent_turn];
    out.x[i] = in.parent_turn.x[parent_turn];
    out.y[i] = in.parent_turn.y[parent_turn];
    out.z[i] = in.parent_turn.z[parent_turn];
  }
}

void turn(const TreeKernelArguments& arguments) noexcept {
  const TreeKernelArguments in = arguments;
  Parents parents;
  for (std::size_t begin = 0; begin < in.turns; begin += kTurnsAtOnce) {
    load_parents(in, begin, parents);
    float* const __restrict w = in.turn.w + begin;
    float* const __restrict x = in.turn.x + begin;
    float* const __restrict y = in.turn.y + begin;
    float* const __restrict z = in.turn.z + begin;
    for (std::size_t i = 0; i < kTurnsAtOnce; ++i) {
      // The link's share of the bend: (bw, bx, 0, bz). No bend is exactly (1, 0, 0, 0).
      const float east = within(parents.east_rad[i], kMaxComponent_rad);
      const float south = within(parents.south_rad[i], kMaxComponent_rad);
      const float square = east * east + south * south;
      const bool bent = square > kMinBendSquare_rad2;
      const float length = __builtin_sqrtf(bent ? square : 0.0F);
      const float inverse = 1.0F / (bent ? length : 1.0F);
      const float angle = length > kMaxBend_rad ? kMaxBend_rad : length;
      const math::SinCos<float> half = math::sin_cos(angle * parents.half_share[i]);
      const float bw = half.cos;
      const float bx = half.sin * (south * inverse);
      const float bz = -half.sin * (east * inverse);

      // Their product, with its length corrected to first order.
      const float pw = parents.w[i];
      const float px = parents.x[i];
      const float py = parents.y[i];
      const float pz = parents.z[i];
      const float qw = bw * pw - bx * px - bz * pz;
      const float qx = bw * px + bx * pw - bz * py;
      const float qy = bw * py + bz * px - bx * pz;
      const float qz = bw * pz + bz * pw + bx * py;
      const float right = 1.5F - 0.5F * (qw * qw + qx * qx + qy * qy + qz * qz);
      w[i] = qw * right;
      x[i] = qx * right;
      y[i] = qy * right;
      z[i] = qz * right;
    }
  }
}

/// The rotation matrix of a turn, minus the identity, so that no turn keeps every bit of a vector.
struct Rotation {
  math::Lanes xx, xy, xz, yx, yy, yz, zx, zy, zz;
};

[[gnu::always_inline]] inline Rotation rotation(math::Lanes w, math::Lanes x, math::Lanes y, math::Lanes z) noexcept {
  const math::Lanes two_x = x + x;
  const math::Lanes two_y = y + y;
  const math::Lanes two_z = z + z;
  return {.xx = -two_y * y - two_z * z,
          .xy = two_x * y - w * two_z,
          .xz = two_x * z + w * two_y,
          .yx = two_x * y + w * two_z,
          .yy = -two_x * x - two_z * z,
          .yz = two_y * z - w * two_x,
          .zx = two_x * z - w * two_y,
          .zy = two_y * z + w * two_x,
          .zz = -two_x * x - two_y * y};
}

[[gnu::always_inline]] inline void rotate(const Rotation& r, const float* const (&from)[3], std::size_t from_strand,
                                          float* const (&to)[3], std::size_t to_strand) noexcept {
  const math::Lanes x = math::load_lanes(from[0] + from_strand);
  const math::Lanes y = math::load_lanes(from[1] + from_strand);
  const math::Lanes z = math::load_lanes(from[2] + from_strand);
  math::store_lanes(to[0] + to_strand, x + (r.xx * x + r.xy * y + r.xz * z));
  math::store_lanes(to[1] + to_strand, y + (r.yx * x + r.yy * y + r.yz * z));
  math::store_lanes(to[2] + to_strand, z + (r.zx * x + r.zy * y + r.zz * z));
}

/// One number of the turns of kLaneCount strands.
[[gnu::always_inline]] inline math::Lanes turn_part(const float* part, std::size_t strands_per_turn,
                                                    std::size_t strand) noexcept {
  return strands_per_turn == 1 ? math::load_lanes(part + strand) : math::same_lanes(part[strand / kBlock]);
}

void carry(const TreeKernelArguments& arguments) noexcept {
  const TreeKernelArguments in = arguments;
  const std::size_t first_strand = in.first_block * kBlock;
  const auto parent_links = static_cast<std::uint32_t>(in.parent_links);
  float* const __restrict root_x_m = in.carried_root_m[0];
  float* const __restrict root_y_m = in.carried_root_m[1];
  float* const __restrict root_z_m = in.carried_root_m[2];
  for (std::size_t begin = 0; begin < in.blocks * kBlock; begin += kBlock) {
    // The roots move to the joints from which they grow (their order: JointPositions). The indices are computed in SIMD
    // lanes, and only the loads are done one by one.
    alignas(64) std::uint32_t at[kBlock];
    for (std::size_t i = 0; i < kBlock; ++i) {
      const std::uint32_t parent = in.parent[first_strand + begin + i];
      const std::uint32_t link = in.parent_link[first_strand + begin + i];
      at[i] = (parent / kBlock * parent_links + link) * (3 * kBlock) + parent % kBlock;
    }
    for (std::size_t i = 0; i < kBlock; ++i) {
      const float* const joint = in.parent_joints_m + std::size_t{at[i]};
      root_x_m[begin + i] = joint[0];
      root_y_m[begin + i] = joint[kBlock];
      root_z_m[begin + i] = joint[std::size_t{2} * kBlock];
    }

    const std::size_t each = in.turn.strands_per_turn;
    Rotation r = {};
    for (std::size_t i = begin; i < begin + kBlock; i += math::kLaneCount) {
      const std::size_t strand = first_strand + i;
      if (each == 1 || i == begin) {  // otherwise it is that of the whole block
        r = rotation(turn_part(in.turn.w, each, strand), turn_part(in.turn.x, each, strand),
                     turn_part(in.turn.y, each, strand), turn_part(in.turn.z, each, strand));
      }
      rotate(r, in.rest, strand, in.carried_rest, i);
      rotate(r, in.curl, strand, in.carried_curl, i);
    }
  }
}

bool all_below(const std::uint32_t* numbers, std::size_t count, std::uint32_t limit) noexcept {
  // A number that is not has the highest bit, or gives it to the difference.
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < count; ++i) bits |= numbers[i] | (limit - 1 - numbers[i]);
  return bits >> 31U == 0;
}

}  // namespace

const TreeKernels YURAGI_ROW_NAME(tree_kernels) = {all_below, turn, carry};

}  // namespace yuragi::pose
