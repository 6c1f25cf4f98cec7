#include "engine/wind/blend/pen_places.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "engine/wind/ground/wind_stroke.hpp"

namespace yuragi::wind::blend {
namespace {

SourceSettings source_at(double east_m, double south_m = 0.0, double lead_m = 0.0) {
  return {.has_place = true, .east_m = east_m, .south_m = south_m, .lead_m = lead_m};
}

PenPlaces places_of(const std::vector<SourceSettings>& sources) {
  return PenPlaces(sources);
}

TEST(PenPlaces, WithoutSourcesThereAreNone) {
  EXPECT_EQ(places_of({}).count(), 0U);
}

TEST(PenPlaces, AllThatWereNotToldAPlaceShareTheEdge) {
  const PenPlaces places = places_of({{}, {.east_m = 30.0}, {}});
  ASSERT_EQ(places.count(), 1U);
  EXPECT_TRUE(places.place(0).is_edge);
  EXPECT_EQ(places.place(0).lead_m, 0.0);
  for (const std::size_t source : {0U, 1U, 2U}) EXPECT_EQ(places.pen_of(source), 0U);
}

TEST(PenPlaces, AToldPlaceIsNoEdgeWhereverItIs) {
  const PenPlaces places = places_of({{}, source_at(0.0, 0.0, 5.0), {}});
  ASSERT_EQ(places.count(), 2U);
  EXPECT_TRUE(places.place(0).is_edge);
  EXPECT_FALSE(places.place(1).is_edge);
  EXPECT_EQ(places.place(1).lead_m, 5.0);
  EXPECT_EQ(places.pen_of(1), 1U);
  EXPECT_EQ(places.pen_of(2), 0U);
}

TEST(PenPlaces, SensorsOnOneMastShareAPlace) {
  const PenPlaces places = places_of({source_at(3.0, 4.0), source_at(3.3, 4.39), source_at(3.0, 4.51)});
  ASSERT_EQ(places.count(), 2U);
  EXPECT_EQ(places.pen_of(0), places.pen_of(1));
  EXPECT_NE(places.pen_of(0), places.pen_of(2));
  EXPECT_EQ(places.place(0).east_m, 3.0);
  EXPECT_EQ(places.place(0).south_m, 4.0);
}

TEST(PenPlaces, OfMoreThanItHoldsTheLastShareTheNearest) {
  const PenPlaces places = places_of(
      {source_at(-30.0), source_at(-10.0), source_at(10.0), source_at(30.0), source_at(12.0), source_at(-99.0)});
  ASSERT_EQ(places.count(), ground::WindStroke::kMaxPens);
  EXPECT_EQ(places.pen_of(4), 2U);
  EXPECT_EQ(places.pen_of(5), 0U);
}

TEST(PenPlaces, ARelativeSourceHasNoPlaceOfItsOwnBesideAnAbsoluteOne) {
  SourceSettings microphone = source_at(50.0);
  microphone.is_relative = true;
  const PenPlaces places = places_of({microphone, source_at(-5.0), source_at(5.0)});
  ASSERT_EQ(places.count(), 2U);
  EXPECT_EQ(places.place(places.pen_of(0)).east_m, -5.0) << "that of the first absolute one";
}

TEST(PenPlaces, ARelativeSourceAloneHasItsOwn) {
  SourceSettings microphone = source_at(50.0);
  microphone.is_relative = true;
  const PenPlaces places = places_of({microphone});
  ASSERT_EQ(places.count(), 1U);
  EXPECT_EQ(places.place(0).east_m, 50.0);
}

}  // namespace
}  // namespace yuragi::wind::blend
