#include "engine/workers/worker_pool.hpp"

#include <atomic>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "engine/pose/pose_hash.hpp"
#include "engine/scenes/scene.hpp"
#include "tests/support/scripted_wind.hpp"

namespace yuragi::workers {
namespace {

TEST(WorkerPool, DoesEachPartOfEachWorkOnceAndWaitsForAll) {
  for (const std::size_t threads : {0U, 1U, 2U, 3U, 7U}) {
    Pool pool(threads);
    EXPECT_EQ(pool.size(), std::max<std::size_t>(threads, 1));
    std::vector<int> done(1000, 0);
    for (int work = 0; work < 300; ++work) {
      pool.run([&done](Part part) {
        for (std::size_t i = part.begin(done.size()); i < part.end(done.size()); ++i) ++done[i];
      });
      ASSERT_EQ(std::accumulate(done.begin(), done.end(), 0), 1000 * (work + 1));
    }
  }
}

TEST(WorkerPool, EndsWhileItsThreadsSleepOrHaveJustBegun) {
  for (int i = 0; i < 50; ++i) Pool(3);
  Pool pool(3);
  std::atomic<int> calls = 0;
  pool.run([&calls](Part) { ++calls; });
  EXPECT_EQ(calls, 3);
}

TEST(WorkerPool, AScenesPoseIsTheSameBitForBitHoweverManyThreadsShareIt) {
  for (const scenes::Description* kind : scenes::scene_table()) {
    const auto values = ParameterValues::resolve(kind->parameters, {}).value();
    const auto hash_with = [&](std::size_t threads) {
      Pool pool(threads);
      const auto scene = kind->make(values, {.seed = 1});
      std::uint64_t hash = pose::kPoseHashSeed;
      for (std::uint64_t tick = 0; tick < 15; ++tick) {
        scene->shift(scripted_wind(tick), 1.0 / 60.0);
        pool.run([&scene](Part part) { scene->sample_part(part); });
        pool.run([&scene](Part part) { scene->project_part(part, 1.0 / 60.0); });
        hash = pose::pose_hash(hash, scene->pose());
      }
      return hash;
    };
    const std::uint64_t alone = hash_with(1);
    EXPECT_EQ(hash_with(2), alone) << kind->name;
    EXPECT_EQ(hash_with(5), alone) << kind->name;
  }
}

}  // namespace
}  // namespace yuragi::workers
