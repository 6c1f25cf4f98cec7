#include "viewer/meshes/flame_gas.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"

namespace yuragi::viewer::meshes {
namespace {

constexpr std::size_t kLayerCells = FlameGas::kAcross * FlameGas::kAcross;

/// The visible edge of a flame rises at this part of sqrt(g h); at the foot it is slower. The gas on its axis is
/// faster: by 1.9 Q^0.2 m/s, Q in kW (B. McCaffrey 1979, "Purely buoyant diffusion flames", the intermittent flame),
/// which is 1.4 sqrt(g h) for a flame of h = 0.2 Q^0.4 m.
constexpr double kRise = 0.77;
constexpr double kRiseAtFoot = 0.45;
constexpr double kFreeAt = 0.6;  ///< part of the height at which it reaches its full speed
constexpr double kGravity_m_s2 = 9.81;

/// A fire puffs (B. Cetegen, T. Ahmed 1993, "Experiments on the periodic instability of buoyant plumes and pool
/// fires").
constexpr double kPuff_hz_sqrt_m = 1.5;
constexpr double kPinch_per_s = 3.9;  ///< how fast a puff narrows the gas above it, at most
constexpr double kPuffless_m_s = 8.0;

/// Speed of the gas's eddies, and the wind's contribution.
constexpr double kEddy_m_s = 0.20;
constexpr double kEddyPerWind = 0.006;
constexpr std::size_t kEddyCells = 6;

/// The heat that the gas loses per second, and the time in which soot thins.
constexpr double kBurn_per_s = 0.66;
constexpr double kSootLasts_s = 1.1;
/// Streamed heat is 0.42 on average; gas that leaves the foot is all aflame.
constexpr float kHeatPerStreamed = 1.5F;
/// The shown gas follows the computed one with a time constant of 0.11 s, like a picture with a long exposure: flashes
/// are weaker (flame_flash_test.cpp: in 20 s of calm 0.22 of a field flashes).
constexpr float kShownPerStep = 0.145F;
constexpr float kMinHeat = 0.06F;
constexpr float kMinSoot = 0.02F;
/// Soot disappears before it reaches the grid's sides and its end, so that these are never visible: from these parts of
/// the way on.
constexpr float kSootThins = 0.55F;
constexpr float kSootIsGone = 0.95F;
constexpr float kSootThinsUp = 0.45F;

/// Beyond it a step is no longer an integer number of its unit.
constexpr double kMaxTime_s = 1e12;

bool is_time(double time_s) {
  return std::abs(time_s) <= kMaxTime_s;  // not of a NaN
}

double sound_wind_m_s(double wind_m_s) {
  return std::isfinite(wind_m_s) ? std::clamp(wind_m_s, 0.0, FlameGas::kMaxWind_m_s) : 0.0;
}

/// (std::lerp is exact at both ends, and slow.)
float mix(float from, float to, float part) {
  return from + part * (to - from);
}

float smooth(float t) {
  t = std::clamp(t, 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

/// Three smooth random fields on the grid, each repeating upward: a vector potential.
std::vector<std::array<float, 3>> potential() {
  constexpr std::size_t n = FlameGas::kAcross;
  constexpr std::size_t lattice_up = 4;  // cells of 16 layers: changes at a place must be slow enough not to flash
  const math::RandomStream random(0, math::stream_id("flame eddies"));
  std::vector<std::array<float, 3>> values(kLayerCells * FlameGas::kLayers);
  constexpr std::size_t across = n / kEddyCells + 2;
  const auto at = [&](std::size_t layer, std::size_t z, std::size_t x, std::size_t axis) {
    const std::size_t index = (((layer % lattice_up) * across + z) * across + x) * 3 + axis;
    return static_cast<float>(random.uniform(index)) - 0.5F;
  };
  for (std::size_t layer = 0; layer < FlameGas::kLayers; ++layer) {
    const float up = static_cast<float>(layer * lattice_up) / static_cast<float>(FlameGas::kLayers);
    const auto k = static_cast<std::size_t>(up);
    const float fk = smooth(up - static_cast<float>(k));
    for (std::size_t z = 0; z < n; ++z) {
      const std::size_t j = z / kEddyCells;
      const float fj = smooth(static_cast<float>(z % kEddyCells) / static_cast<float>(kEddyCells));
      for (std::size_t x = 0; x < n; ++x) {
        const std::size_t i = x / kEddyCells;
        const float fi = smooth(static_cast<float>(x % kEddyCells) / static_cast<float>(kEddyCells));
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const auto line = [&](std::size_t kk, std::size_t jj) {
            return mix(at(kk, jj, i, axis), at(kk, jj, i + 1, axis), fi);
          };
          const auto plane = [&](std::size_t kk) { return mix(line(kk, j), line(kk, j + 1), fj); };
          values[(layer * n + z) * n + x][axis] = mix(plane(k), plane(k + 1), fk);
        }
      }
    }
  }
  return values;
}

}  // namespace

FlameGas::FlameGas(const FlameVolume& volume)
    : height_m_(static_cast<double>(volume.height_m())),
      width_m_(2.0 * static_cast<double>(volume.thickest_m())),
      cells_(kLayerCells * kLayers),
      next_(cells_.size()),
      shown_(cells_.size()),
      eddies_(cells_.size()),
      texels_(2 * cells_.size()) {
  const auto from_middle = [](std::size_t cell) {
    return (2.0F * static_cast<float>(cell) + 1.0F) / static_cast<float>(kAcross) - 1.0F;
  };
  for (std::size_t i = 0; i < kLayerCells; ++i) {
    to_side_[i] = std::hypot(from_middle(i % kAcross), from_middle(i / kAcross));
  }
  const double fastest_m_s = kRise * std::sqrt(kGravity_m_s2 * height_m_);
  const double layer_m = height_m_ * static_cast<double>(FlameVolume::kReach) / (kLayers - 1);
  double risen_s = 0.0;
  for (std::size_t layer = 0; layer < kLayers; ++layer) {
    const double v = static_cast<double>(layer) * layer_m / height_m_;
    const double rise_m_s = fastest_m_s * (kRiseAtFoot + (1.0 - kRiseAtFoot) * std::min(v / kFreeAt, 1.0));
    rise_m_s_[layer] = static_cast<float>(rise_m_s);
    rises_for_s_[layer] = static_cast<float>(risen_s);
    risen_s += layer_m / rise_m_s;
  }

  // The curl of a potential has no divergence: it moves gas, and creates none.
  const std::vector<std::array<float, 3>> of = potential();
  constexpr std::size_t n = kAcross;
  const auto at = [&](std::size_t layer, std::size_t z, std::size_t x) -> const std::array<float, 3>& {
    return of[(layer % kLayers * n + std::min(z, n - 1)) * n + std::min(x, n - 1)];
  };
  double squares = 0.0;
  for (std::size_t layer = 0; layer < kLayers; ++layer) {
    for (std::size_t z = 0; z < n; ++z) {
      for (std::size_t x = 0; x < n; ++x) {
        const auto& here = at(layer, z, x);
        const auto& east = at(layer, z, x + 1);
        const auto& south = at(layer, z + 1, x);
        const auto& above = at(layer + 1, z, x);
        Velocity& eddy = eddies_[(layer * n + z) * n + x];
        // Axes: 0 east, 1 up, 2 south.
        eddy.x = (south[1] - here[1]) - (above[2] - here[2]);
        eddy.up = (east[2] - here[2]) - (south[0] - here[0]);
        eddy.z = (above[0] - here[0]) - (east[1] - here[1]);
        squares += static_cast<double>(eddy.x * eddy.x + eddy.up * eddy.up + eddy.z * eddy.z);
      }
    }
  }
  const auto scale = static_cast<float>(1.0 / std::sqrt(squares / 3.0 / static_cast<double>(eddies_.size())));
  for (Velocity& eddy : eddies_) eddy = {eddy.x * scale, eddy.z * scale, eddy.up * scale};
}

void FlameGas::settle_at(double time_s, double wind_m_s, const FlameVolume& volume) {
  if (!is_time(time_s)) return;
  std::ranges::fill(cells_, Cell{});
  std::ranges::fill(shown_, Cell{});
  const auto now = static_cast<std::int64_t>(std::floor(time_s / kStep_s)) + 1;
  const auto settling = static_cast<std::int64_t>(kSettling_s / kStep_s);
  risen_ = carried_ = 0.0;
  for (steps_ = now - settling; steps_ < now;) {
    ++steps_;
    step(static_cast<double>(steps_) * kStep_s, wind_m_s, volume);
  }
  time_s_ = time_s;
  has_begun_ = true;
  write_texels(static_cast<float>(time_s / kStep_s - static_cast<double>(steps_ - 1)));
}

void FlameGas::advance_to(double time_s, double wind_m_s, const FlameVolume& volume) {
  if (!is_time(time_s)) return;
  const double passed_s = time_s - time_s_;
  if (!has_begun_ || passed_s < 0.0 || passed_s > kJump_s) {
    settle_at(time_s, wind_m_s, volume);
    return;
  }
  if (passed_s == 0.0) return;
  time_s_ = time_s;
  // The picture is between the last two steps.
  const auto needed = static_cast<std::int64_t>(std::floor(time_s / kStep_s)) + 1;
  while (steps_ < needed) {
    ++steps_;
    step(static_cast<double>(steps_) * kStep_s, wind_m_s, volume);
  }
  write_texels(static_cast<float>(time_s / kStep_s - static_cast<double>(steps_ - 1)));
}

void FlameGas::step(double time_s, double given_wind_m_s, const FlameVolume& volume) {
  const double wind_m_s = sound_wind_m_s(given_wind_m_s);
  constexpr std::size_t n = kAcross;
  constexpr float middle = 0.5F * static_cast<float>(n - 1);
  constexpr auto dt_s = static_cast<float>(kStep_s);
  const float windy = static_cast<float>(wind_m_s / kPuffless_m_s);
  // The wind draws out a flame that leans.
  const float faster = 1.0F + 0.15F * windy / (1.0F + 0.3F * windy);
  const auto pinch = static_cast<float>(kPinch_per_s) / std::sqrt(1.0F + windy * windy);
  const auto eddy_m_s = static_cast<float>(kEddy_m_s + kEddyPerWind * wind_m_s);
  const double puff_hz = kPuff_hz_sqrt_m / std::sqrt(width_m_);
  const double puffs =
      puff_hz * time_s + 0.08 * std::sin(2.0 * kPi * 0.17 * time_s) + 0.03 * std::sin(2.0 * kPi * 0.41 * time_s + 1.0);
  const auto turned = static_cast<float>(0.9 * time_s);
  const float tilt_x = 0.7F * std::cos(turned);
  const float tilt_z = 0.7F * std::sin(turned);
  const double layer_m = height_m_ * static_cast<double>(FlameVolume::kReach) / (kLayers - 1);
  const double full_m_s = static_cast<double>(rise_m_s_.back()) * static_cast<double>(faster);
  risen_ = std::fmod(risen_ + full_m_s * kStep_s / height_m_, kRisenPeriod);
  carried_ = std::fmod(carried_ + full_m_s * kStep_s / layer_m, 4.0 * static_cast<double>(kLayers));

  for (std::size_t i = 0; i < cells_.size(); ++i) {
    shown_[i] = {mix(shown_[i].heat, cells_[i].heat, kShownPerStep),
                 mix(shown_[i].soot, cells_[i].soot, kShownPerStep)};
  }
  const std::span<const std::uint8_t> streamed = volume.heat();
  const auto rows = volume.layer_rows();
  const auto per_v = static_cast<float>(volume.layers() - 1);
  for (std::size_t layer = 0; layer < kLayers; ++layer) {
    const float v = static_cast<float>(layer) * static_cast<float>(layer_m / height_m_);
    const auto row = std::min(static_cast<std::size_t>(std::lrint(v * per_v)), rows.size() - 1);
    const float cells_per_m = 0.5F * static_cast<float>(n) / rows[row].half_m;
    const float up_cells = rise_m_s_[layer] * faster * dt_s / static_cast<float>(layer_m);
    const auto phase_rad = 2.0 * kPi * (puffs - puff_hz * static_cast<double>(rises_for_s_[layer] / faster));
    const auto phase = static_cast<float>(phase_rad - 2.0 * kPi * std::floor(phase_rad / (2.0 * kPi)));
    const float grown = smooth(v / 0.5F);
    const float stir = eddy_m_s * (0.25F + 0.75F * smooth(v / 0.7F)) * dt_s;
    // Two sets of eddies, one of which rises more slowly, so that they change on their way.
    const auto flight = [&](double carried, std::size_t from) {
      const double at = static_cast<double>(layer + 8 * kLayers + from) - carried;
      const auto whole = static_cast<std::size_t>(at);
      return std::pair{whole % kLayers, static_cast<float>(at - static_cast<double>(whole))};
    };
    const auto [one, one_part] = flight(carried_, 0);
    const auto [two, two_part] = flight(0.75 * carried_, 29);
    const Velocity* const one_low = eddies_.data() + one * kLayerCells;
    const Velocity* const one_high = eddies_.data() + (one + 1) % kLayers * kLayerCells;
    const Velocity* const two_low = eddies_.data() + two * kLayerCells;
    const Velocity* const two_high = eddies_.data() + (two + 1) % kLayers * kLayerCells;
    const std::uint8_t* const source = row < volume.layers() ? streamed.data() + row * kLayerCells : nullptr;
    const float feeds = source == nullptr ? 0.0F : dt_s * (30.0F * smooth((0.26F - v) / 0.2F));
    // A leaning flame meets less of its own heat, and burns on far to the lee.
    const float burnt = static_cast<float>(kBurn_per_s) * dt_s / (1.0F + 0.8F * std::max(windy - 0.4F, 0.0F));
    const float clears = dt_s / static_cast<float>(kSootLasts_s);

    for (std::size_t z = 0; z < n; ++z) {
      const float qz = (static_cast<float>(z) - middle) / (0.5F * static_cast<float>(n));
      for (std::size_t x = 0; x < n; ++x) {
        const float qx = (static_cast<float>(x) - middle) / (0.5F * static_cast<float>(n));
        const std::size_t i = z * n + x;
        const std::size_t mirrored = x * n + (n - 1 - z);
        const float near = std::max(1.0F - (qx * qx + qz * qz), 0.0F);
        const float wave = grown * std::cos(phase + tilt_x * qx + tilt_z * qz);
        const float inward = pinch * wave * (0.35F + 0.65F * near) * dt_s;
        const float by_x = stir * (mix(one_low[i].x, one_high[i].x, one_part) +
                                   mix(two_low[mirrored].z, two_high[mirrored].z, two_part));
        const float by_z = stir * (mix(one_low[i].z, one_high[i].z, one_part) -
                                   mix(two_low[mirrored].x, two_high[mirrored].x, two_part));
        const float by_up = stir * (mix(one_low[i].up, one_high[i].up, one_part) +
                                    mix(two_low[mirrored].up, two_high[mirrored].up, two_part));
        const float from_x = static_cast<float>(x) - by_x * cells_per_m + inward * (static_cast<float>(x) - middle);
        const float from_z = static_cast<float>(z) - by_z * cells_per_m + inward * (static_cast<float>(z) - middle);
        const float from_up = static_cast<float>(layer) - up_cells - by_up / static_cast<float>(layer_m);

        Cell cell;
        const float cx = std::clamp(from_x, 0.0F, static_cast<float>(n) - 1.001F);
        const float cz = std::clamp(from_z, 0.0F, static_cast<float>(n) - 1.001F);
        const float ck = std::clamp(from_up, 0.0F, static_cast<float>(kLayers) - 1.001F);
        const auto ix = static_cast<std::size_t>(cx);
        const auto iz = static_cast<std::size_t>(cz);
        const auto ik = static_cast<std::size_t>(ck);
        const float fx = cx - static_cast<float>(ix);
        const float fz = cz - static_cast<float>(iz);
        const float fk = ck - static_cast<float>(ik);
        const Cell* const low = cells_.data() + (ik * n + iz) * n + ix;
        const Cell* const high = low + kLayerCells;
        const auto read = [&](float Cell::*what) {
          const auto plane = [&](const Cell* at) {
            const float north = at[0].*what + fx * (at[1].*what - at[0].*what);
            const float south = at[n].*what + fx * (at[n + 1].*what - at[n].*what);
            return north + fz * (south - north);
          };
          const float below = plane(low);
          return below + fk * (plane(high) - below);
        };
        cell.heat = read(&Cell::heat);
        cell.soot = read(&Cell::soot);
        // Thin gas meets more air, and burns out sooner.
        const float left = std::max(cell.heat - burnt * (0.55F + 0.9F * (1.0F - cell.heat)), 0.0F);
        cell.soot += 1.2F * (cell.heat - left) * smooth((0.5F - left) / 0.3F) - clears * cell.soot;
        cell.heat = left;
        if (feeds > 0.0F) {
          const float wanted = std::min(kHeatPerStreamed * static_cast<float>(source[i]) / 255.0F, 1.0F);
          cell.heat += std::min(feeds, 1.0F) * (wanted - cell.heat);
        }
        next_[layer * kLayerCells + i] = cell;
      }
    }
  }
  std::swap(cells_, next_);
}

void FlameGas::write_texels(float part) {
  const auto byte_of = [](float value) {
    return static_cast<std::uint8_t>(std::lrint(255.0F * std::clamp(value, 0.0F, 1.0F)));
  };
  for (std::size_t layer = 0; layer < kLayers; ++layer) {
    float farthest = 0.0F;
    const float up = static_cast<float>(layer) / static_cast<float>(kLayers - 1);
    const float left_up = smooth((kSootIsGone - up) / (kSootIsGone - kSootThinsUp));
    for (std::size_t i = 0; i < kLayerCells; ++i) {
      const std::size_t at = layer * kLayerCells + i;
      const float heat = mix(shown_[at].heat, cells_[at].heat, kShownPerStep * part);
      const float left = left_up * smooth((kSootIsGone - to_side_[i]) / (kSootIsGone - kSootThins));
      const float soot = left * mix(shown_[at].soot, cells_[at].soot, kShownPerStep * part);
      texels_[2 * at] = byte_of(heat);
      texels_[2 * at + 1] = byte_of(soot);
      if (heat < kMinHeat && soot < kMinSoot) continue;
      farthest = std::max(farthest, to_side_[i]);
    }
    extents_[layer] = farthest > 0.0F ? std::min(farthest + 2.0F / static_cast<float>(kAcross), 1.1F) : 0.0F;
  }
}

}  // namespace yuragi::viewer::meshes
