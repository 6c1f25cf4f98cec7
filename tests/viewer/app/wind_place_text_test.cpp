#include "viewer/app/wind_place_text.hpp"

#include <gtest/gtest.h>

namespace yuragi::viewer::app {
namespace {

TEST(WindPlaceText, SaysInFewWordsWhereTheWindIs) {
  EXPECT_EQ(wind_place_text({}), "") << "a wind without a place";
  EXPECT_EQ(wind_place_text({.wind = {}, .upwind_m = 5.0, .to_middle_s = 0.694}), "at the edge, 0.7 s to the middle");
  EXPECT_EQ(wind_place_text({.wind = {}, .upwind_m = 42.0, .to_middle_s = 41.8}), "at the edge, 42 s to the middle");
  EXPECT_EQ(wind_place_text({.wind = {}, .upwind_m = 12.0, .to_middle_s = 1.71, .is_place_configured = true}),
            "at the sensors, 1.7 s to the middle");
  EXPECT_EQ(wind_place_text({.wind = {}, .upwind_m = -12.0, .is_place_configured = true}),
            "at the sensors, 12 m downwind");
  EXPECT_EQ(wind_place_text({.wind = {}, .is_place_configured = true}), "at the sensors");
}

}  // namespace
}  // namespace yuragi::viewer::app
