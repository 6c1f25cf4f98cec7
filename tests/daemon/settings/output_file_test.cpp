#include "daemon/settings/output_file.hpp"

#include <array>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::settings {
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

}  // namespace
}  // namespace yuragi::daemon::settings
