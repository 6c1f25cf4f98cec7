#include "viewer/app/own_token.hpp"

#include <cstdlib>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/platform/secret_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::viewer::app {
namespace {

class OwnTokenTest : public testing::Test {
 protected:
  ~OwnTokenTest() override { unsetenv("YURAGI_TOKEN_FILE"); }  // NOLINT(concurrency-mt-unsafe): no other thread
  std::filesystem::path file_with(const std::string& content) {
    auto file = folder_.path() / "token";
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }
  test::TemporaryFolder folder_;
};

TEST_F(OwnTokenTest, IsTheOneLineOfTheFile) {
  for (const char* const content : {"correct horse", "correct horse\n", "correct horse\r\n"})
    EXPECT_EQ(platform::secret_in_file(file_with(content)).value(), Secret("correct horse"));
}
TEST_F(OwnTokenTest, AnythingElseIsRefusedWithoutItsContent) {
  for (const std::string& content : {std::string(), std::string("\n"), std::string("secret\nsecret\n"),
                                     std::string("secret\0secret", 13), std::string(5000, 's')}) {
    const auto token = platform::secret_in_file(file_with(content));
    ASSERT_FALSE(token);
    EXPECT_THAT(token.error().message, testing::Not(testing::HasSubstr("secret")));
  }
  EXPECT_FALSE(platform::secret_in_file(folder_.path()));
  EXPECT_FALSE(platform::secret_in_file("/dev/zero"));
  EXPECT_FALSE(platform::secret_in_file(folder_.path() / "nowhere"));
}
TEST_F(OwnTokenTest, TheVariableNamesTheFile_AndIsNotNeeded) {
  EXPECT_TRUE(own_token().is_empty());
  setenv("YURAGI_TOKEN_FILE", file_with("correct horse\n").c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_EQ(own_token(), Secret("correct horse"));
  setenv("YURAGI_TOKEN_FILE", "/nowhere", 1);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_TRUE(own_token().is_empty()) << "the wall goes on";
}

}  // namespace
}  // namespace yuragi::viewer::app
