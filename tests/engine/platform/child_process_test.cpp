#include "engine/platform/child_process.hpp"

#include <array>
#include <csignal>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

namespace yuragi::platform {
namespace {

/// A pipe, whose end for writing a child may have.
class Pipe {
 public:
  Pipe() { EXPECT_EQ(pipe2(ends_.data(), O_CLOEXEC), 0); }
  ~Pipe() {
    close_theirs();
    close(ends_[0]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int theirs() const { return ends_[1]; }
  void close_theirs() {
    if (ends_[1] >= 0) close(std::exchange(ends_[1], -1));
  }
  /// Waits until this text has come.
  void wait_for(const std::string& text) {
    std::string all(text.size(), '\0');
    for (std::size_t count = 0; count < all.size();) {
      const ssize_t more = read(ends_[0], all.data() + count, all.size() - count);
      ASSERT_GT(more, 0);
      count += static_cast<std::size_t>(more);
    }
    EXPECT_EQ(all, text);
  }
  /// All that comes until nobody can write any more.
  std::string rest() {
    close_theirs();
    std::string all;
    std::array<char, 256> block{};
    for (ssize_t count = 0; (count = read(ends_[0], block.data(), block.size())) > 0;)
      all.append(block.data(), static_cast<std::size_t>(count));
    return all;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

TEST(ChildProcess, SaysHowItHasEnded) {
  EXPECT_TRUE(ChildProcess({.command = {"true"}}).wait().is_good());
  const ChildEnd failed = ChildProcess({.command = {"sh", "-c", "exit 3"}}).wait();
  EXPECT_EQ(failed.exit_code, 3);
  EXPECT_EQ(text_of(failed), "has failed with exit code 3");
  const ChildEnd killed = ChildProcess({.command = {"sh", "-c", "kill -9 $$"}}).wait();
  EXPECT_EQ(killed.signal, SIGKILL);
  EXPECT_EQ(killed.shell_code(), 137);
  EXPECT_EQ(text_of(killed), "was killed by signal 9 (Killed)");
}

TEST(ChildProcess, ThatCannotBeStartedIsAnErrorWithItsReason) {
  try {
    const ChildProcess child({.command = {"/nowhere/none"}});
    FAIL() << "it was started";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), std::errc::no_such_file_or_directory);
  }
}

TEST(ChildProcess, HasTheseFilesAloneAndThisEnvironment) {
  Pipe pipe;
  const int open_here = open("/dev/null", O_RDONLY);  // without O_CLOEXEC
  ChildProcess child(
      {.command = {"/bin/sh", "-c", "read line; echo \"$?$WORD\"; echo here >&2; ls /proc/self/fd | wc -l"},
       .output = pipe.theirs(),
       .error = pipe.theirs(),
       .environment = {{"WORD=wind", "PATH=/usr/bin:/bin"}}});
  // Three of its own, and that of the folder that ls reads.
  EXPECT_EQ(pipe.rest(), "1wind\nhere\n4\n");
  EXPECT_TRUE(child.wait().is_good());
  close(open_here);
}

TEST(ChildProcess, DoesNotInheritSignalsThatAreIgnoredHere) {
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  EXPECT_EQ(ChildProcess({.command = {"sh", "-c", "kill -PIPE $$"}}).wait().signal, SIGPIPE);
  std::signal(SIGPIPE, before);
}

TEST(ChildProcess, EndsWithThisObjectAndSoDoesItsGroup) {
  Pipe pipe;
  {
    const ChildProcess child({.command = {"sh", "-c", "sleep 1000 & echo started; sleep 1000"},
                              .output = pipe.theirs(),
                              .has_own_group = true});
    pipe.wait_for("started\n");
  }
  EXPECT_EQ(pipe.rest(), "") << "it ends when no process of the group has the pipe any more";
}

TEST(ChildProcess, IsAskedToEndFirstIfItHasTime) {
  Pipe pipe;
  {
    ChildProcess child(
        {.command = {"sh", "-c", "trap 'echo ended; exit' TERM; echo started; while :; do sleep 0.01; done"},
         .output = pipe.theirs(),
         .patience_ms = 60'000});
    child.signal(0);
    pollfd waiting{child.descriptor(), POLLIN, 0};
    EXPECT_EQ(poll(&waiting, 1, 0), 0) << "it still runs";
    EXPECT_FALSE(child.end());
    pipe.wait_for("started\n");
  }
  EXPECT_EQ(pipe.rest(), "ended\n");
}

}  // namespace
}  // namespace yuragi::platform
