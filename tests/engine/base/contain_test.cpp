#include "engine/base/contain.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace yuragi {
namespace {

class ContainTest : public testing::Test {
 protected:
  ContainTest() {
    reported().clear();
    report_faults_to([](std::string_view kind, const char* what) noexcept {
      reported().push_back(std::string(kind) + ": " + what);
    });
  }
  ~ContainTest() override { report_faults_to(nullptr); }

  static std::vector<std::string>& reported() {
    static std::vector<std::string> all;
    return all;
  }
};

TEST_F(ContainTest, WorkThatThrowsNothingIsDone) {
  int done = 0;
  EXPECT_TRUE(contain("work", [&] { ++done; }));
  EXPECT_EQ(done, 1);
  EXPECT_TRUE(reported().empty());
}

TEST_F(ContainTest, AnExceptionIsReportedAndGoesNoFurther) {
  std::string handled;
  EXPECT_FALSE(contain(
      "a request", [] { throw std::runtime_error("bad byte"); }, [&](const char* what) { handled = what; }));
  EXPECT_EQ(reported(), (std::vector<std::string>{"a request: bad byte"}));
  EXPECT_EQ(handled, "bad byte");
}

TEST_F(ContainTest, SoDoesWhatIsNoStandardException) {
  EXPECT_FALSE(contain("a request", [] { throw 1; }));
  EXPECT_EQ(reported(), (std::vector<std::string>{"a request: an exception of unknown type"}));
}

TEST_F(ContainTest, HandlingItMayThrowToo) {
  EXPECT_FALSE(contain(
      "a", [] { throw std::runtime_error("b"); }, [](const char*) { throw std::runtime_error("c"); }));
  EXPECT_EQ(reported().size(), 2u);
}

TEST_F(ContainTest, NobodyNeedListen) {
  report_faults_to(nullptr);
  EXPECT_FALSE(contain("a", [] { throw std::runtime_error("b"); }));
}

}  // namespace
}  // namespace yuragi
