#include "daemon/tools/calibration/calibration_ways.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::daemon::tools::calibration {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(CalibrationWays, APreparationHasTheNumberThatIsGiven_AndNoOther) {
  for (const Way& way : ways()) {
    const bool has_number = way.given == Given::kBearing || way.given == Given::kSpeed;
    EXPECT_EQ(way.preparation.find(kNumber) != std::string_view::npos, has_number) << way.calibration;
    EXPECT_THAT(preparation_of(way, 21.5), Not(HasSubstr(std::string(kNumber))));
    EXPECT_EQ(preparation_of(way, 21.5).find(" 21.5 ") != std::string::npos, has_number);
    EXPECT_EQ(&way_of(way.calibration, way.given), &way);
  }
}

}  // namespace
}  // namespace yuragi::daemon::tools::calibration
