#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>
#include <optional>

#include <gtest/gtest.h>

#include "tests/engine/wind/blend/blend_run.hpp"

namespace {

std::atomic<std::size_t> blend_allocations = 0;

}  // namespace

[[gnu::noinline]] void* operator new(std::size_t bytes) {
  ++blend_allocations;
  if (void* memory = std::malloc(bytes == 0 ? 1 : bytes)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace yuragi::wind::blend {
namespace {

TEST(BlendAllocation, NeitherAReadingNorATickAllocates) {
  Settings settings = BlendRun::usual();
  settings.sources = {{.priority = 1, .east_m = -5.0},
                      {.priority = 1, .east_m = 5.0, .averaging_s = 10.0},
                      {.priority = 2, .value = ReadingValue::kInstant, .direction_step_deg = 45.0},
                      {.is_relative = true}};
  BlendedEstimator estimator(4, settings, shared_gust_noise());
  EXPECT_GT(blend_allocations, 0U) << "the counter does not count";

  // All speak, fall silent and return; enough for fits and scales.
  MonoTime now{std::chrono::hours(1)};
  const std::size_t before = blend_allocations;
  for (int tick = 0; tick < 3000; ++tick) {
    now += from_seconds(0.1);
    const bool is_silence = tick > 1000 && tick < 2000;
    for (std::size_t source = 0; source < 4 && !is_silence; ++source) {
      Reading reading;
      reading.time.mono = now;
      reading.speed_m_s = 6.0 + std::sin(0.1 * tick + static_cast<double>(source));
      if (source != 3) reading.direction_deg = 45.0 * (tick / 50 % 3);
      estimator.accept(source, reading);
    }
    estimator.advance(now);
  }
  EXPECT_EQ(blend_allocations, before);
}

}  // namespace
}  // namespace yuragi::wind::blend
