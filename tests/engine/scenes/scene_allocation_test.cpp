#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include "engine/pose/kinematics.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/support/gusty_wind.hpp"
#include "tests/support/measured_wind.hpp"
#include "tests/support/stroke_run.hpp"

namespace {

std::atomic<std::size_t> allocations = 0;

void* counted(std::size_t bytes, std::size_t alignment) {
  ++allocations;
  const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
  if (void* memory = std::aligned_alloc(alignment, whole == 0 ? alignment : whole)) return memory;
  throw std::bad_alloc();
}

}  // namespace

[[gnu::noinline]] void* operator new(std::size_t bytes) {
  return counted(bytes, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted(bytes, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(bytes);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace yuragi::scenes {
namespace {

TEST(SceneAllocationTest, NoSceneAllocatesInATickNorDoForwardKinematics) {
  for (const Description* description : scene_table()) {
    const auto scene = description->make(ParameterValues::resolve(description->parameters, {}).value(),
                                         {.seed = 1, .gusts = shared_gusts()});
    GustyWind wind({5.0, 2.0}, 0.4F);
    MeasuredWind measured(shared_gusts(), {5.0, 2.0});
    wind::ground::WindTapes tapes(1);
    pose::Kinematics kinematics(scene->skeleton());
    EXPECT_GT(allocations, 0U) << "the counter does not count";

    const std::size_t before = allocations;
    for (std::uint64_t tick = 0; tick < 20; ++tick) {
      scene->tick(wind.step(1.0 / 60.0), 1.0 / 60.0);
      scene->tick(written_to(tapes, measured.step()), 1.0 / 60.0);
      EXPECT_TRUE(kinematics.run(scene->pose()));
    }
    EXPECT_EQ(allocations, before) << description->name;
  }
}

TEST(SceneAllocationTest, NoSceneAllocatesInATickUnderAWindThatIsMeasuredAtOneOrSeveralPlaces) {
  for (const std::size_t pens : {1U, 3U}) {
    StrokeRun run(std::vector<wind::Vector>(pens, wind::Vector{0.0, 20.0}));
    wind::ground::WindTapes tapes;
    const StrokeRun::Set measure = steady_gusts(0.3, 0.7);
    for (const Description* description : scene_table()) {
      const auto scene = description->make(ParameterValues::resolve(description->parameters, {}).value(),
                                           {.seed = 1, .gusts = shared_gusts()});
      GustyWind wind({0.0, 7.0}, 0.4F);
      const std::size_t before = allocations;
      for (std::uint64_t tick = 0; tick < 20; ++tick) {
        run.step(measure);
        const wind::ground::Wind ground =
            written_to(tapes, {.state = {}, .ground = wind.step(1.0 / 60.0), .stroke = run.stroke()});
        scene->tick(ground, 1.0 / 60.0);
      }
      EXPECT_EQ(allocations, before) << description->name << ", " << pens;
    }
  }
}

}  // namespace
}  // namespace yuragi::scenes
