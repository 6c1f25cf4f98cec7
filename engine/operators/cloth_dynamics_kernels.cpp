#include "engine/operators/cloth_dynamics_kernels.hpp"

#include "engine/base/kernel.hpp"
#include "engine/math/lanes.hpp"

namespace yuragi::operators {
namespace {

/// Below any relevant square: keeps quotients finite.
constexpr float kTiny = 1e-12F;

/// The factor by which a thread can exceed the length of its links before its long-range attachment holds it.
constexpr float kSlack = 1.001F;

struct Lanes3 {
  math::Lanes x, y, z;
};
[[gnu::always_inline]] inline Lanes3 operator+(Lanes3 a, Lanes3 b) noexcept {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[gnu::always_inline]] inline Lanes3 operator-(Lanes3 a, Lanes3 b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[gnu::always_inline]] inline Lanes3 operator*(math::Lanes a, Lanes3 b) noexcept {
  return {a * b.x, a * b.y, a * b.z};
}
[[gnu::always_inline]] inline math::Lanes dot(Lanes3 a, Lanes3 b) noexcept {
  return a.x * b.x + (a.y * b.y + a.z * b.z);
}
[[gnu::always_inline]] inline Lanes3 cross(Lanes3 a, Lanes3 b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Vectors in the cloth's layout: all x, then all y, then all z, `apart` from one another.
[[gnu::always_inline]] inline Lanes3 load3(const float* from, std::size_t apart) noexcept {
  return {math::load_lanes(from), math::load_lanes(from + apart), math::load_lanes(from + 2 * apart)};
}
[[gnu::always_inline]] inline void store3(float* to, std::size_t apart, Lanes3 value) noexcept {
  math::store_lanes(to, value.x);
  math::store_lanes(to + apart, value.y);
  math::store_lanes(to + 2 * apart, value.z);
}

/// `value`, each part cut to `most`.
[[gnu::always_inline]] inline Lanes3 limited(Lanes3 value, float most) noexcept {
  return {math::clamp_lanes(value.x, most), math::clamp_lanes(value.y, most), math::clamp_lanes(value.z, most)};
}

/// Computes where each point would go: weight, its neighbours, and the air.
void predict(const ClothDynamicsKernelArguments& in) noexcept {
  const std::size_t count = in.rows * in.stride;
  for (std::size_t row = 1; row < in.rows; ++row) {
    const bool is_last = row + 1 == in.rows;
    const std::size_t below = is_last ? 0 : in.stride;  // the last has none below it: uses itself, without weight
    const auto links_below = static_cast<float>(in.rows - 1 - row);
    const math::Lanes weight_above = math::same_lanes(in.weight_s2 * (links_below + 1.0F) * in.substep_s);
    const math::Lanes weight_below = math::same_lanes(in.weight_s2 * links_below * in.substep_s);
    const math::Lanes across_s = math::same_lanes(in.across_s2 * in.substep_s);
    for (std::size_t i = 0; i < in.stride; i += math::kLaneCount) {
      const std::size_t at = row * in.stride + i;
      const Lanes3 here = load3(in.offset_m + at, count);
      const Lanes3 up = load3(in.offset_m + at - in.stride, count);
      const Lanes3 down = load3(in.offset_m + at + below, count);
      const Lanes3 west = load3(in.offset_m + at - 1, count);
      const Lanes3 east = load3(in.offset_m + at + 1, count);
      Lanes3 speed = load3(in.speed_m_s + at, count);
      speed = speed + weight_above * (up - here) + weight_below * (down - here);
      speed = speed + across_s * ((west - here) + (east - here));

      // The cloth's normal, of no length in particular, and the air that blows past.
      const Lanes3 rest_link = load3(in.rest_link_m + i, in.stride);
      const Lanes3 along = (is_last ? math::same_lanes(1.0F) : math::same_lanes(2.0F)) * rest_link + (down - up);
      const Lanes3 across = load3(in.across_m + i, in.stride) +
                            math::same_lanes(static_cast<float>(row)) * load3(in.across_growth_m + i, in.stride) +
                            (east - west);
      const Lanes3 normal = cross(along, across);
      const Lanes3 past = {math::load_lanes(in.air_east_m_s + i) - speed.x, -speed.y,
                           math::load_lanes(in.air_south_m_s + i) - speed.z};

      // Drag through the cloth, quadratic and implicit: with d the relative speed along the normal n and a the drag per
      // distance, the cloth takes the share a |d| / (1 + a |d|) of it. In one division, for n of any length.
      const math::Lanes along_normal = dot(past, normal);
      const math::Lanes drag = in.normal_drag * (along_normal < 0.0F ? -along_normal : along_normal);
      const math::Lanes square = dot(normal, normal) + kTiny;
      const math::Lanes normal_share = drag * along_normal / ((math::sqrt_lanes(square) + drag) * square);
      const Lanes3 skin = past - normal_share * normal;
      speed = speed + normal_share * normal + math::load_lanes(in.skin_share + i) * skin;
      speed = (math::load_lanes(in.mobility + i) * in.speed_kept) * limited(speed, in.largest_speed_m_s);
      store3(in.predicted_m + at, count, here + math::same_lanes(in.substep_s) * speed);
    }
  }
}

/// Corrects the links' lengths, from the fixed edge on, and derives the speeds.
void constrain(const ClothDynamicsKernelArguments& in) noexcept {
  const std::size_t count = in.rows * in.stride;
  const float per_s = 1.0F / in.substep_s;
  const math::Lanes half = math::same_lanes(0.5F);
  for (std::size_t link = 0; link + 1 < in.rows; ++link) {
    const bool is_first = link == 0;
    const auto links = static_cast<float>(link + 1);
    for (std::size_t i = 0; i < in.stride; i += math::kLaneCount) {
      const std::size_t above = link * in.stride + i;
      const std::size_t below = above + in.stride;
      const Lanes3 rest_link = load3(in.rest_link_m + i, in.stride);
      const math::Lanes mobility = math::load_lanes(in.mobility + i);
      Lanes3 from = load3(in.predicted_m + above, count);
      Lanes3 to = load3(in.predicted_m + below, count);

      // The distance constraint; the fixed edge leaves it all to the point below.
      const Lanes3 way = rest_link + (to - from);
      const math::Lanes rest_m = math::load_lanes(in.rest_length_m + i);
      const math::Lanes excess = mobility * (1.0F - rest_m / math::sqrt_lanes(dot(way, way)));
      const math::Lanes share = is_first ? excess : half * excess;
      if (!is_first) from = from + share * way;
      to = to - share * way;

      // The long-range attachment to the thread's own fixed joint, to first order: 1 - sqrt(q) is (1 - q) / 2.
      const Lanes3 reach = math::same_lanes(links) * rest_link + to;
      const math::Lanes limit_m = (links * kSlack) * rest_m;
      const math::Lanes beyond = half * (1.0F - limit_m * limit_m / (dot(reach, reach) + kTiny));
      to = to - (beyond > 0.0F ? beyond : math::same_lanes(0.0F)) * (mobility * reach);
      store3(in.predicted_m + below, count, to);
      if (is_first) continue;

      // The new position of the point above.
      const Lanes3 was = load3(in.offset_m + above, count);
      const Lanes3 speed = limited(per_s * mobility * (from - was), in.largest_speed_m_s);
      store3(in.speed_m_s + above, count, speed);
      store3(in.offset_m + above, count, was + math::same_lanes(in.substep_s) * speed);
    }
  }
  for (std::size_t i = 0; i < in.stride; i += math::kLaneCount) {
    const std::size_t at = (in.rows - 1) * in.stride + i;
    const Lanes3 was = load3(in.offset_m + at, count);
    const math::Lanes mobility = math::load_lanes(in.mobility + i);
    const Lanes3 speed = limited(per_s * mobility * (load3(in.predicted_m + at, count) - was), in.largest_speed_m_s);
    store3(in.speed_m_s + at, count, speed);
    store3(in.offset_m + at, count, was + math::same_lanes(in.substep_s) * speed);
  }

  // Ghosts copy their neighbours.
  for (float* values : {in.offset_m, in.speed_m_s}) {
    for (std::size_t row = 0; row < 3 * in.rows; ++row) {
      float* const ghost = values + row * in.stride;
      ghost[0] = ghost[1];
      for (std::size_t i = in.columns + 1; i < in.stride; ++i) ghost[i] = ghost[in.columns];
    }
  }
}

/// Computes the links' leans beyond rest, limited by the rate per tick.
void lean(const ClothDynamicsKernelArguments& in) noexcept {
  const std::size_t count = in.rows * in.stride;
  for (std::size_t link = 0; link + 1 < in.rows; ++link) {
    for (std::size_t i = 0; i < in.stride; i += math::kLaneCount) {
      const std::size_t above = link * in.stride + i;
      const Lanes3 rest_link = load3(in.rest_link_m + i, in.stride);
      const Lanes3 way =
          rest_link + (load3(in.offset_m + above + in.stride, count) - load3(in.offset_m + above, count));
      // A link that points nearly straight up would have an infinite lean; it is limited to 2.
      const auto per_lean = [](Lanes3 link_m) {
        const math::Lanes length_m = math::sqrt_lanes(dot(link_m, link_m) + kTiny * kTiny);
        const math::Lanes below_top_m = length_m - link_m.y;
        const math::Lanes least_m = 0.4F * length_m;
        return 1.0F / (below_top_m > least_m ? below_top_m : least_m);
      };
      const math::Lanes now = per_lean(way);
      const math::Lanes rest = per_lean(rest_link);
      float* const east = in.lean + link * 2 * in.stride + i;
      float* const south = east + in.stride;
      const math::Lanes east_before = math::load_lanes(east);
      const math::Lanes south_before = math::load_lanes(south);
      const math::Lanes east_step = (way.x * now - rest_link.x * rest) - east_before;
      const math::Lanes south_step = (way.z * now - rest_link.z * rest) - south_before;
      math::store_lanes(east, east_before + math::clamp_lanes(east_step, in.largest_lean_step));
      math::store_lanes(south, south_before + math::clamp_lanes(south_step, in.largest_lean_step));
    }
  }
}

void step(const ClothDynamicsKernelArguments& in) noexcept {
  for (std::size_t substep = 0; substep < in.substeps; ++substep) {
    predict(in);
    constrain(in);
  }
  lean(in);
}

void spread(const ClothSpreadKernelArguments& in) noexcept {
  constexpr std::size_t kBlock = 16;
  for (std::size_t block = 0; block < in.blocks; ++block) {
    const float* const coarse = in.coarse + in.first[block];
    const float* const weights = in.weights + block * in.taps * kBlock;
    for (std::size_t i = 0; i < kBlock; i += math::kLaneCount) {
      math::Lanes sum = {};
      for (std::size_t tap = 0; tap < in.taps; ++tap) {
        sum = sum + math::same_lanes(coarse[tap]) * math::load_lanes(weights + tap * kBlock + i);
      }
      math::store_lanes(in.fine + block * kBlock + i, sum);
    }
  }
}

void add(const ClothAddKernelArguments& arguments) noexcept {
  const ClothAddKernelArguments in = arguments;
  float* const __restrict out = in.out;
  for (std::size_t i = 0; i < in.count; ++i) {
    out[i] = out[i] + ((in.weight[0] * in.row[0][i] + in.weight[1] * in.row[1][i]) +
                       (in.weight[2] * in.row[2][i] + in.weight[3] * in.row[3][i]));
  }
}

}  // namespace

const ClothDynamicsKernels YURAGI_ROW_NAME(cloth_dynamics_kernels) = {step, spread, add};

}  // namespace yuragi::operators
