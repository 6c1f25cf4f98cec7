// The daemon as no configuration can bring it about.
#include "daemon/service/service.hpp"

#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/failing_scene.hpp"
#include "tests/support/replaced_allocation.hpp"
#include "tests/support/temporary_folder.hpp"

void* yuragi::test::allocate(std::size_t size) {
  if (is_memory_gone) throw std::bad_alloc();
  return allocate_as_usual(size);
}

namespace yuragi::daemon::service {
namespace {

TEST(Service, EndsWithAFailureAndAWholeRecordingWhereTheAnimationFails) {
  const test::TemporaryFolder folder;
  const auto recording = folder / "wall.windlog";
  Options options;
  options.record = recording;
  Service service(settings::listening_at(config_with_failing_scene(), "127.0.0.1:0"), options);
  std::string why;
  try {
    service.run();
  } catch (const std::runtime_error& error) {
    why = error.what();
  }
  EXPECT_EQ(why, "the animation has failed (std::bad_alloc)");
  EXPECT_TRUE(std::filesystem::exists(recording));
  EXPECT_FALSE(std::filesystem::exists(recording.string() + "-wal")) << "closed in order";
}

}  // namespace
}  // namespace yuragi::daemon::service
