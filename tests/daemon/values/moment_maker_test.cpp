#include "daemon/values/moment_maker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/wind/turbulence/gust_noise.hpp"

namespace yuragi::daemon::values {
namespace {

wind::ground::DrivingWind a_wind(double u_m_s) {
  wind::ground::DrivingWind wind;
  wind.state.wind = {u_m_s, 0.0};
  wind.state.source = wind::Source::kLive;
  wind.state.live_weight = 1.0;
  wind.ground = wind::ground::Wind(wind.state.wind);
  return wind;
}

class MomentMakerTest : public testing::Test {
 protected:
  std::shared_ptr<const Moment> make(double shaped_m_s = 3.0, double real_m_s = 6.0) {
    const auto real = a_wind(real_m_s);
    const auto shaped = a_wind(shaped_m_s);
    return maker_.make({.real = real, .shaped = shaped, .dt_s = 1.0 / 60.0}, {}, {});
  }

  MomentMaker maker_{std::make_shared<const wind::turbulence::GustNoise>(wind::turbulence::GustNoiseSettings{})};
};

TEST_F(MomentMakerTest, HasBothWindsAndCountsTicks) {
  const auto first = make();
  const auto second = make();
  EXPECT_EQ(first->shaped[Quantity::kSpeed], 3.0);
  EXPECT_EQ(first->real[Quantity::kSpeed], 6.0);
  EXPECT_EQ(first->tick + 1, second->tick);
  EXPECT_GT(second->time_s, first->time_s);
  EXPECT_TRUE(first->shaped_places.empty());
}

TEST_F(MomentMakerTest, APlaceHasTheWindOfTheGroundThere) {
  const std::array places = {Place{"door", 3.0, -1.5}, Place{"gate", -30.0, 8.0}};
  maker_.set_places(places, false);
  const auto moment = make();
  ASSERT_EQ(moment->shaped_places.size(), 2U);
  EXPECT_EQ(moment->names->places, (std::vector<std::string>{"door", "gate"}));
  EXPECT_NEAR(moment->shaped_places[0][Quantity::kU], 3.0, 1e-9) << "without noise it is the wind of all places";
  EXPECT_TRUE(moment->real_places.empty());
  maker_.set_places(places, true);
  EXPECT_NEAR(make()->real_places.at(1)[Quantity::kU], 6.0, 1e-9);
}

TEST_F(MomentMakerTest, APlaceThatStaysKeepsWhatIsKnownOfIt) {
  const Place door{"door", 3.0, -1.5}, gate{"gate", -30.0, 8.0};
  maker_.set_places(std::array{gate, door}, false);
  for (int i = 0; i < 600; ++i) make(8.0);
  maker_.set_places(std::array{door}, false);
  const auto moment = make(2.0);
  EXPECT_NEAR(moment->shaped_places.at(0)[Quantity::kPeak], 8.0, 1e-6);
  EXPECT_LT(moment->shaped_places.at(0)[Quantity::kSpeed], 2.1);
}

TEST(GridTest, ItsPointsAreInRowsFromTheNorthWest) {
  const Grid grid{.columns = 3, .rows = 2, .spacing_m = 2.0, .east_m = 10.0, .south_m = 20.0};
  EXPECT_EQ(grid.size(), 6U);
  EXPECT_NEAR(grid.at(0).east_m, 8.0, 1e-9);
  EXPECT_NEAR(grid.at(0).south_m, 19.0, 1e-9);
  EXPECT_NEAR(grid.at(5).east_m, 12.0, 1e-9);
  EXPECT_NEAR(grid.at(5).south_m, 21.0, 1e-9);
  Grid turned = grid;
  turned.turn_deg = 90.0;  // the north side is in the east
  EXPECT_NEAR(turned.at(0).east_m, 11.0, 1e-9);
  EXPECT_NEAR(turned.at(0).south_m, 18.0, 1e-9);
}

TEST_F(MomentMakerTest, AGridHasTheValueOfEachOfItsPoints) {
  const Grid speeds{.columns = 4, .rows = 2, .quantity = Quantity::kSpeed};
  Grid peaks = speeds, norms = speeds, live = speeds;
  peaks.quantity = Quantity::kPeak;
  norms.quantity = Quantity::kNorm;
  live.quantity = Quantity::kLive;
  maker_.set_grids(std::array{speeds, peaks, norms, live});
  for (int i = 0; i < 600; ++i) make(8.0);
  for (int i = 0; i < 120; ++i) make(3.0);  // as smooth as a scene's wind
  const auto moment = make(3.0);
  ASSERT_EQ(moment->names->grids.size(), 4U);
  EXPECT_EQ(moment->names->grids[1], peaks);
  const auto all = [](double value) {
    return testing::AllOf(testing::SizeIs(8), testing::Each(testing::DoubleNear(value, 1e-4)));
  };
  EXPECT_THAT(moment->grids.at(0), all(3.0));
  EXPECT_THAT(moment->grids.at(1), all(8.0));
  EXPECT_THAT(moment->grids.at(2), all(0.25));
  EXPECT_THAT(moment->grids.at(3), all(1.0));
  maker_.set_grids(std::array{peaks});
  EXPECT_THAT(make(3.0)->grids.at(0), all(8.0)) << "what is known of it is kept";
}

TEST_F(MomentMakerTest, AMomentKeepsTheNamesOfItsTime) {
  maker_.set_scenes({"meadow"});
  const auto before = make();
  maker_.set_scenes({"flag"});
  EXPECT_EQ(before->names->scenes.front(), "meadow");
  EXPECT_EQ(make()->names->scenes.front(), "flag");
}

}  // namespace
}  // namespace yuragi::daemon::values
