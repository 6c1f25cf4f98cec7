#include "engine/pose/strand_kernels.hpp"

#include "engine/base/kernel.hpp"
#include "engine/math/lanes.hpp"
#include "engine/math/trig.hpp"

// The plane of the bend. With b the unit vector toward which a strand bends and a = up x b the axis across it, a vector
// is written (h, y, g): its parts along b, up and a. Turning by an angle about a does not change g, and turns (y, h)
// like a complex number y + i h that is multiplied by exp(i angle).
//
// The rest direction of link k (from 0) is rest cos(k c) + curl sin(k c), and link k is turned by (k + 1) d, where c is
// the curl between links and d the bend between links. In the plane, with r = rest and q = curl as complex numbers,
//   (r cos(k c) + q sin(k c)) exp(i (k+1) d)
//     = (r - i q)/2 exp(i d) exp(i k (d + c))  +  (r + i q)/2 exp(i d) exp(i k (d - c)),
// and across it, g = real part of (r_g - i q_g) exp(i k c). So a chain is two phasors, each turned by a constant angle
// from link to link, and one harmonic g, which advances by its second difference: g(k+1) - 2 g(k) + g(k-1) = -2
// versine(c) g(k). Stored as g and its difference, this is as exact for small c as for large. Only the first sine and
// cosine are computed.

namespace yuragi::pose {
namespace {

constexpr std::size_t kStrandsPerBlock = 16;  // as in skeleton.hpp, whose vectors must not be included here

/// Limit for the components of a bend: bends longer than pi are cut to pi anyway.
constexpr float kMaxComponent_rad = 32.0F;
constexpr float kMaxBend_rad = 0x1.921fb6p1F;

/// From this number of links on a link's share of the bend is at most pi/4.
constexpr std::size_t kLinksOfSmallAngles = 4;

/// A smaller bend counts as none.
constexpr float kMinSquare_rad2 = 1e-30F;

struct Phasor {
  math::Lanes re;
  math::Lanes im;
};

[[gnu::always_inline]] inline Phasor operator*(Phasor a, Phasor b) noexcept {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/// A phasor of length 1, its length corrected to first order, so that it stays correct through many products.
[[gnu::always_inline]] inline Phasor normalised(Phasor a) noexcept {
  const math::Lanes correction = 1.5F - 0.5F * (a.re * a.re + a.im * a.im);
  return {a.re * correction, a.im * correction};
}

/// exp(i angle), angle in [0, pi].
template <bool is_small>
[[gnu::always_inline]] inline Phasor unit_phasor(math::Lanes angle_rad) noexcept {
  const math::SinCos<math::Lanes> turn =
      is_small ? math::sin_cos_within_quarter_pi(angle_rad) : math::sin_cos<math::LaneBits>(angle_rad);
  return {turn.cos, turn.sin};
}

/// The constants along kLaneCount chains.
struct Turns {
  math::Lanes b_east, b_south;  ///< where they bend to
  Phasor with, against;
  math::Lanes stiffness;  ///< 2 versine(c)
};

/// kLaneCount chains at one of their links.
struct Links {
  Phasor with, against;
  math::Lanes across, across_step;  ///< g, and its next difference
  math::Lanes x_m, y_m, z_m;        ///< where the link begins
};

struct Chains {
  Turns turns;
  Links first;
};

/// The chains from strand `strand` on, at their first link.
template <bool is_small>
[[gnu::always_inline]] inline Chains first_links(const StrandKernelArguments& in, std::size_t strand) noexcept {
  // The bend's direction b and angle. No bend (or one whose square is lost to underflow) has no direction: any will do,
  // and east it is.
  const math::Lanes east = math::clamp_lanes(math::load_lanes(in.bend_east_rad + strand), kMaxComponent_rad);
  const math::Lanes south = math::clamp_lanes(math::load_lanes(in.bend_south_rad + strand), kMaxComponent_rad);
  const math::Lanes square = east * east + south * south;
  const auto bent = square > kMinSquare_rad2;
  const math::Lanes one = math::same_lanes(1.0F);
  const math::Lanes length = math::sqrt_lanes(bent ? square : math::same_lanes(0.0F));
  const math::Lanes inverse = 1.0F / (bent ? length : one);
  const math::Lanes b_east = bent ? east * inverse : one;
  const math::Lanes b_south = bent ? south * inverse : math::same_lanes(0.0F);
  const math::Lanes angle = length > kMaxBend_rad ? math::same_lanes(kMaxBend_rad) : length;

  // Half of rest and curl, in the plane of the bend and across it; the link's length is carried in them.
  const math::Lanes half = 0.5F * math::load_lanes(in.link_length_m + strand);
  const math::Lanes half_east = half * b_east;
  const math::Lanes half_south = half * b_south;
  const math::Lanes rest_x = math::load_lanes(in.rest_x + strand);
  const math::Lanes rest_z = math::load_lanes(in.rest_z + strand);
  const math::Lanes curl_x = math::load_lanes(in.curl_x + strand);
  const math::Lanes curl_z = math::load_lanes(in.curl_z + strand);
  const math::Lanes rest_y = half * math::load_lanes(in.rest_y + strand);
  const math::Lanes curl_y = half * math::load_lanes(in.curl_y + strand);
  const math::Lanes rest_h = half_east * rest_x + half_south * rest_z;
  const math::Lanes curl_h = half_east * curl_x + half_south * curl_z;
  const math::Lanes half_rest_g = half_south * rest_x - half_east * rest_z;
  const math::Lanes half_curl_g = half_south * curl_x - half_east * curl_z;
  const math::Lanes rest_g = half_rest_g + half_rest_g;
  const math::Lanes curl_g = half_curl_g + half_curl_g;

  // The turns from link to link, and the first link.
  const Phasor bend = unit_phasor<is_small>(angle * (1.0F / static_cast<float>(in.links)));
  const math::Lanes versine = math::load_lanes(in.curl_versine + strand);
  const Phasor curl{1.0F - versine, math::load_lanes(in.curl_sin + strand)};
  return {.turns = {.b_east = b_east,
                    .b_south = b_south,
                    .with = normalised(bend * curl),
                    .against = normalised(bend * Phasor{curl.re, -curl.im}),
                    .stiffness = versine + versine},
          .first = {.with = Phasor{rest_y + curl_h, rest_h - curl_y} * bend,
                    .against = Phasor{rest_y - curl_h, rest_h + curl_y} * bend,
                    .across = rest_g,
                    .across_step = curl_g * curl.im - rest_g * versine,
                    .x_m = math::load_lanes(in.root_x_m + strand),
                    .y_m = math::load_lanes(in.root_y_m + strand),
                    .z_m = math::load_lanes(in.root_z_m + strand)}};
}

/// Computes the chains from root to tip. Joints are written to `out`, with the axes 16 floats apart.
[[gnu::always_inline]] inline void follow(const Chains& chains, std::size_t links, float* out) noexcept {
  // The variables from link to link fill the registers of AVX2. The turns are read from memory in each round: otherwise
  // gcc spills some of the links instead, which is slower (measured: 6.1 ns per link and eight strands, against 3.5).
  const Turns* turns = &chains.turns;
  __asm__("" : "+r"(turns) : : "memory");
  Links at = chains.first;
  for (std::size_t link = 0; link < links; ++link) {
    const math::Lanes h = at.with.im + at.against.im;
    at.x_m += turns->b_east * h + turns->b_south * at.across;
    at.y_m += at.with.re + at.against.re;
    at.z_m += turns->b_south * h - turns->b_east * at.across;
    math::store_lanes(out, at.x_m);
    math::store_lanes(out + kStrandsPerBlock, at.y_m);
    math::store_lanes(out + 2 * kStrandsPerBlock, at.z_m);
    out += 3 * kStrandsPerBlock;

    at.with = at.with * turns->with;
    at.against = at.against * turns->against;
    at.across += at.across_step;
    at.across_step -= turns->stiffness * at.across;
  }
}

template <bool is_small>
[[gnu::always_inline]] inline void all_joint_positions(const StrandKernelArguments& in) noexcept {
  for (std::size_t block = 0; block < in.blocks; ++block) {
    // All first links of a block before its chains, so that the arithmetic of one fills the waits of the other.
    Chains chains[kStrandsPerBlock / math::kLaneCount];
    for (std::size_t part = 0; part < kStrandsPerBlock / math::kLaneCount; ++part) {
      chains[part] = first_links<is_small>(in, block * kStrandsPerBlock + part * math::kLaneCount);
    }
    float* out = in.joints_m + block * in.links * 3 * kStrandsPerBlock;
    for (std::size_t part = 0; part < kStrandsPerBlock / math::kLaneCount; ++part) {
      follow(chains[part], in.links, out + part * math::kLaneCount);
    }
  }
}

void joint_positions(const StrandKernelArguments& arguments) noexcept {
  const StrandKernelArguments in = arguments;  // a copy, which stores to the joints cannot change
  if (in.links >= kLinksOfSmallAngles) {
    all_joint_positions<true>(in);
  } else {
    all_joint_positions<false>(in);
  }
}

}  // namespace

const StrandKernels YURAGI_ROW_NAME(strand_kernels) = {joint_positions};

}  // namespace yuragi::pose
