#include "engine/pose/strand_kernels.hpp"

#include "engine/base/kernel.hpp"
#include "engine/math/lanes.hpp"
#include "engine/math/trig.hpp"

// The plane of the bend. With b the unit vector toward which a strand bends and a = up x b the axis across it, a vector
// is written (h, y, g): its parts along b, up and a. Turning by an angle about a leaves g alone and turns (y, h) like a
// complex number y + i h that is multiplied by exp(i angle).
//
// The rest direction of link k (from 0) is rest cos(k c) + curl sin(k c), and link k is turned by (k + 1) d, where c is
// the curl between links and d the bend between links. In the plane, with r = rest and q = curl as complex numbers,
//   (r cos(k c) + q sin(k c)) exp(i (k+1) d)
//     = (r - i q)/2 exp(i d) exp(i k (d + c))  +  (r + i q)/2 exp(i d) exp(i k (d - c)),
// and across it, g = real part of (r_g - i q_g) exp(i k c). So a chain is three phasors, each turned by a constant
// angle from link to link: three complex products a link, and no sine or cosine but the first two.

namespace yuragi {
namespace {

constexpr std::size_t kStrandsPerBlock = 16;  // as skeleton.hpp, whose vectors may not come in here

/// Larger angles are taken as this: sin_cos is good up to 50 rad, and sqrt(2) times this is below.
constexpr float kLargestAngle_rad = 32.0F;

/// A smaller bend is none.
constexpr float kSmallestSquare_rad2 = 1e-30F;

struct Phasor {
  Lanes re;
  Lanes im;
};

[[gnu::always_inline]] inline Phasor operator*(Phasor a, Phasor b) noexcept {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/// A phasor of length 1 whose length is put right to first order, so that it stays right through many products.
[[gnu::always_inline]] inline Phasor normalised(Phasor a) noexcept {
  const Lanes correction = 1.5F - 0.5F * (a.re * a.re + a.im * a.im);
  return {a.re * correction, a.im * correction};
}

[[gnu::always_inline]] inline Phasor unit_phasor(Lanes angle_rad) noexcept {
  const SinCos<Lanes> turn = sin_cos<LaneBits>(angle_rad);
  return {turn.cos, turn.sin};
}

/// kLaneCount chains at one of their links.
struct Chains {
  Lanes b_east, b_south;  ///< where they bend to
  Phasor with, with_turn;
  Phasor against, against_turn;
  Phasor across, across_turn;
  Lanes x_m, y_m, z_m;  ///< where the link begins
};

/// The chains from strand `strand` on, at their first link.
[[gnu::always_inline]] inline Chains first_links(const StrandKernelArguments& in, std::size_t strand) noexcept {
  // The bend's direction b and angle. No bend (or one whose square is lost to underflow) has no direction: any will do,
  // and east it is.
  const Lanes east = clamp_lanes(load_lanes(in.bend_east_rad + strand), kLargestAngle_rad);
  const Lanes south = clamp_lanes(load_lanes(in.bend_south_rad + strand), kLargestAngle_rad);
  const Lanes square = east * east + south * south;
  const auto bent = square > kSmallestSquare_rad2;
  const Lanes one = same_lanes(1.0F);
  const Lanes angle = sqrt_lanes(bent ? square : same_lanes(0.0F));
  const Lanes inverse = 1.0F / (bent ? angle : one);
  const Lanes b_east = bent ? east * inverse : one;
  const Lanes b_south = bent ? south * inverse : same_lanes(0.0F);

  // Half of rest and curl, in the plane of the bend and across it; the link's length is carried in them.
  const Lanes half = 0.5F * load_lanes(in.link_length_m + strand);
  const Lanes half_east = half * b_east;
  const Lanes half_south = half * b_south;
  const Lanes rest_x = load_lanes(in.rest_x + strand);
  const Lanes rest_z = load_lanes(in.rest_z + strand);
  const Lanes curl_x = load_lanes(in.curl_x + strand);
  const Lanes curl_z = load_lanes(in.curl_z + strand);
  const Lanes rest_y = half * load_lanes(in.rest_y + strand);
  const Lanes curl_y = half * load_lanes(in.curl_y + strand);
  const Lanes rest_h = half_east * rest_x + half_south * rest_z;
  const Lanes curl_h = half_east * curl_x + half_south * curl_z;
  const Lanes rest_g = half_south * rest_x - half_east * rest_z;
  const Lanes curl_g = half_south * curl_x - half_east * curl_z;

  // The three turns from link to link, and the first link.
  const Phasor bend = unit_phasor(angle * (1.0F / static_cast<float>(in.links)));
  const Phasor curl = unit_phasor(clamp_lanes(load_lanes(in.rest_curl_rad + strand), kLargestAngle_rad));
  return {.b_east = b_east,
          .b_south = b_south,
          .with = Phasor{rest_y + curl_h, rest_h - curl_y} * bend,
          .with_turn = normalised(bend * curl),
          .against = Phasor{rest_y - curl_h, rest_h + curl_y} * bend,
          .against_turn = normalised(bend * Phasor{curl.re, -curl.im}),
          .across = {rest_g + rest_g, -curl_g - curl_g},
          .across_turn = curl,
          .x_m = load_lanes(in.root_x_m + strand),
          .y_m = load_lanes(in.root_y_m + strand),
          .z_m = load_lanes(in.root_z_m + strand)};
}

/// Goes along the chains from root to tip, all in registers. Joints go to `out`, an axis 16 floats behind the other.
[[gnu::always_inline]] inline void follow(Chains chains, std::size_t links, float* out) noexcept {
  for (std::size_t link = 0; link < links; ++link) {
    const Lanes h = chains.with.im + chains.against.im;
    const Lanes g = chains.across.re;
    chains.x_m += chains.b_east * h + chains.b_south * g;
    chains.y_m += chains.with.re + chains.against.re;
    chains.z_m += chains.b_south * h - chains.b_east * g;
    store_lanes(out, chains.x_m);
    store_lanes(out + kStrandsPerBlock, chains.y_m);
    store_lanes(out + 2 * kStrandsPerBlock, chains.z_m);
    out += 3 * kStrandsPerBlock;

    chains.with = chains.with * chains.with_turn;
    chains.against = chains.against * chains.against_turn;
    chains.across = chains.across * chains.across_turn;
  }
}

void joint_positions(const StrandKernelArguments& in) noexcept {
  for (std::size_t block = 0; block < in.blocks; ++block) {
    float* out = in.joints_m + block * in.links * 3 * kStrandsPerBlock;
    for (std::size_t lane = 0; lane < kStrandsPerBlock; lane += kLaneCount) {
      follow(first_links(in, block * kStrandsPerBlock + lane), in.links, out + lane);
    }
  }
}

}  // namespace

const StrandKernels YURAGI_ROW_NAME(strand_kernels) = {joint_positions};

}  // namespace yuragi
