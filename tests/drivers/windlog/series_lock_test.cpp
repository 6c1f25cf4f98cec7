#include "drivers/windlog/series_lock.hpp"

#include <csignal>
#include <fstream>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::windlog {
namespace {

TEST(SeriesLock, HasOneHolderWhoIsNamedAndLeavesNoFile) {
  const test::TemporaryFolder folder;
  const auto file = folder / "wall.windlog";
  {
    const auto first = SeriesLock::take(file);
    ASSERT_TRUE(first);
    EXPECT_TRUE(first->is_effective());
    const auto second = SeriesLock::take(file);
    ASSERT_TRUE(second.has_error());
    EXPECT_EQ(second.error().kind, FailureKind::kUnavailable);
    EXPECT_EQ(second.error().message, "another program (process " + std::to_string(getpid()) + ") records to " +
                                          file.string() + ": end it, or choose another file");
    EXPECT_TRUE(SeriesLock::take(folder / "other.windlog"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_TRUE(SeriesLock::take(file));
}

TEST(SeriesLock, IsThatOfTheFileThatALinkRefersTo) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "disk");
  const auto file = folder / "disk/wall.windlog";
  const auto link = folder / "wall.windlog";
  std::filesystem::create_symlink(file, link);
  // Also by a name that exists by now.
  const auto lock = SeriesLock::take(file);
  ASSERT_TRUE(lock);
  std::ofstream(file) << "a recording";
  EXPECT_TRUE(lock->is_of(file));
  EXPECT_TRUE(lock->is_of(link));
  EXPECT_FALSE(SeriesLock::take(link));
  std::filesystem::remove(link);
  EXPECT_FALSE(lock->is_of(link));
}

TEST(SeriesLock, IsNoLongerHeldWhenItsFileWasRemovedAndSparesTheNextOne) {
  const test::TemporaryFolder folder;
  const auto file = folder / "wall.windlog";
  std::optional<SeriesLock> first;
  first.emplace(SeriesLock::take(file).value());
  std::filesystem::remove(file.string() + "-lock");
  EXPECT_FALSE(first->is_of(file));
  const auto second = SeriesLock::take(file);
  ASSERT_TRUE(second);
  first.reset();
  EXPECT_TRUE(second->is_of(file));
  EXPECT_FALSE(SeriesLock::take(file));
}

TEST(SeriesLock, IsReleasedWhenItsProcessIsKilled) {
  const test::TemporaryFolder folder;
  const auto file = folder / "wall.windlog";
  int ready[2];  // NOLINT(*-avoid-c-arrays)
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const auto lock = SeriesLock::take(file);
    static_cast<void>(write(ready[1], lock ? "1" : "0", 1));
    pause();
    _exit(0);
  }
  char taken = '0';
  ASSERT_EQ(read(ready[0], &taken, 1), 1);
  EXPECT_EQ(taken, '1');
  EXPECT_FALSE(SeriesLock::take(file));
  ASSERT_EQ(kill(child, SIGKILL), 0);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  close(ready[0]);
  close(ready[1]);
  EXPECT_TRUE(std::filesystem::exists(file.string() + "-lock"));
  EXPECT_TRUE(SeriesLock::take(file));
}

TEST(SeriesLock, IsRefusedWithTheReasonWhereItCannotBeCreated) {
  const test::TemporaryFolder folder;
  const auto lock = SeriesLock::take(folder / "none/wall.windlog");
  ASSERT_TRUE(lock.has_error());
  EXPECT_EQ(lock.error().kind, FailureKind::kOther);
}

}  // namespace
}  // namespace yuragi::drivers::windlog
