#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace yuragi::math {

/// The counter-based generator Philox4x32-10: a bijection that scrambles a counter under a key, so that the random
/// number of any address is computed from that address alone, in any order and on any thread. Source: Salmon, Moraes,
/// Dror and Shaw 2011, "Parallel random numbers: as easy as 1, 2, 3" (SC '11). Thread-safe and realtime-safe: yes, it
/// has no state.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key) noexcept;

/// A number for a stream's name (FNV-1a, 64 bits), so that two users of one seed do not draw the same numbers:
/// `RandomStream(seed, stream_id("grass layout"))`.
constexpr std::uint64_t stream_id(std::string_view name) noexcept {
  std::uint64_t hash = 14695981039346656037U;
  for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 1099511628211U;
  return hash;
}

/// The random numbers of one stream of one seed, each addressed by its index.
///
/// Same seed, stream and index: the same bits. An element is half a Philox block, so the elements 2 i and 2 i + 1 are
/// those of pair i. uniform() and normal() of the same pair are made from the same bits: take one stream for each
/// purpose. Thread-safe: yes. Realtime-safe: yes, but normal() calls libm: it is for set-up, not for inner loops.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream) noexcept : seed_(seed), stream_(stream) {}

  /// Uniform on [0, 1), a multiple of 2^-53.
  double uniform(std::uint64_t index) const noexcept { return uniform_pair(index / 2)[index % 2]; }

  /// Standard normal, by Box and Muller 1958, "A note on the generation of random normal deviates". At most 8.6 in
  /// magnitude.
  double normal(std::uint64_t index) const noexcept { return normal_pair(index / 2)[index % 2]; }

  /// Two independent elements at the cost of one.
  std::array<double, 2> uniform_pair(std::uint64_t pair) const noexcept;
  std::array<double, 2> normal_pair(std::uint64_t pair) const noexcept;

 private:
  std::uint64_t seed_;
  std::uint64_t stream_;
};

}  // namespace yuragi::math
