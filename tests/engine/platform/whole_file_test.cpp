#include "engine/platform/whole_file.hpp"

#include <array>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::platform {
namespace {

class OutputFileTest : public testing::Test {
 protected:
  static void write(const std::filesystem::path& file, const std::string& text) { std::ofstream(file) << text; }
  static std::string read(const std::filesystem::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::size_t count_files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "a.csv";
};

TEST_F(OutputFileTest, HasItsNameWhenItIsWholeAndNotBefore) {
  write(file_, "old");
  OutputFile output(file_, true);
  write(output.working_path(), "new");
  EXPECT_EQ(read(file_), "old");
  output.commit().value();
  EXPECT_EQ(read(file_), "new");
  EXPECT_EQ(count_files(), 1U);
}

TEST_F(OutputFileTest, UnfinishedItLeavesNothing) {
  static constexpr std::array<std::string_view, 2> kSuffixes = {"-wal", "-shm"};
  {
    const OutputFile output(file_, false, kSuffixes);
    write(output.working_path(), "half");
    write(output.working_path().string() + "-wal", "more");
    EXPECT_EQ(count_files(), 2U);
  }
  EXPECT_EQ(count_files(), 0U);
}

TEST_F(OutputFileTest, FollowsALink) {
  write(file_, "old");
  const auto link = folder_.path() / "link";
  std::filesystem::create_symlink(file_, link);
  OutputFile output(link, true);
  write(output.working_path(), "new");
  output.commit().value();
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(read(file_), "new");
}

TEST_F(OutputFileTest, RefusesWhatItMustNotReplace) {
  static constexpr std::array<std::string_view, 1> kSuffixes = {"-wal"};
  write(file_, "precious");
  EXPECT_THROW(OutputFile(file_, false), FailureError);
  EXPECT_THROW(OutputFile(folder_.path(), true), FailureError) << "a folder";
  EXPECT_THROW(OutputFile("/dev/null", true), FailureError) << "a device";
  EXPECT_THROW(OutputFile(folder_.path() / "no such folder" / "b", true), FailureError);
  write(file_.string() + "-wal", "newest readings");
  EXPECT_THROW(OutputFile(file_, true, kSuffixes), FailureError) << "somebody is writing it";
  EXPECT_NO_THROW(OutputFile(file_, true));
  EXPECT_EQ(read(file_), "precious");
}

TEST(ReadWhole, TakesRegularFilesUpToALimitAndWaitsForNoPipe) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "a";
  EXPECT_EQ(read_whole(file, 4).error().message, "does not exist");
  std::ofstream(file) << "wind";
  EXPECT_EQ(*read_whole(file, 4), "wind");
  EXPECT_EQ(read_whole(file, 3).error().message, "is too large; allowed: up to 3 bytes");
  const std::string neither = "is not a regular file, but a folder, a pipe or a device";
  EXPECT_EQ(read_whole(folder.path(), 4).error().message, neither);
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(read_whole(folder / "pipe", 4).error().message, neither);
}

TEST(ReadWhole, TakesMemoryForWhatThereIs_NotForTheLimit) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "a";
  std::ofstream(file) << "wind";
  EXPECT_EQ(*read_whole(file, std::size_t{1} << 50), "wind");
  // The kernel states no size of it.
  EXPECT_GT(read_whole("/proc/self/maps", std::size_t{1} << 20)->size(), 4096U);
}

TEST(WriteWhole, SaysWhyAndLeavesWhatWasThere) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "a";
  ASSERT_TRUE(write_whole(file, "before"));
  const test::FileSizeLimit limit(3);
  EXPECT_EQ(write_whole(file, "afterwards").error().message, file.string() + ": cannot be written: File too large");
  EXPECT_EQ(*read_whole(file, 10), "before");
}

}  // namespace
}  // namespace yuragi::platform
