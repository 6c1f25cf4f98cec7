#include "engine/wind/field/wind_field.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace yuragi::wind::field {
namespace {

/// Says where it was asked.
class PlaceField final : public WindField {
 public:
  explicit PlaceField(int dims) : dims_(dims) {}
  int dims() const noexcept override { return dims_; }
  WindVector3 at(WindPlace place) const noexcept override { return {place.x_m, place.y_m, place.z_m}; }

 private:
  int dims_;
};

TEST(SampleField, GoesThroughComponentsThenSouthThenUpThenEast) {
  const Grid grid{.count_x = 4, .count_y = 2, .count_z = 3, .spacing_m = 0.5};
  std::vector<float> values(3 * grid.size());
  sample_field(PlaceField(3), grid, values);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < 2; ++j) {
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t sample = (k * 2 + j) * 4 + i;
        EXPECT_EQ(values[sample], 0.5F * (static_cast<float>(i) - 2.0F)) << "east of the middle";
        EXPECT_EQ(values[24 + sample], 0.5F * static_cast<float>(j)) << "above the ground";
        EXPECT_EQ(values[48 + sample], 0.5F * (static_cast<float>(k) - 1.0F)) << "south of the middle";
      }
    }
  }
}

TEST(SampleField, OfTwoDimensionsHasTwoComponents) {
  const Grid grid{.count_x = 2, .count_y = 1, .count_z = 2, .spacing_m = 1.0};
  std::vector<float> values(2 * grid.size() + 1, -1.0F);
  sample_field(PlaceField(2), grid, std::span(values).first(2 * grid.size()));
  EXPECT_EQ(values.back(), -1.0F);
  EXPECT_EQ(values[0], -1.0F);
  EXPECT_EQ(values[3], 0.0F);
}

TEST(GroundWindField, IsTheWindOverTheGroundAtEveryHeight) {
  const turbulence::GustNoise noise({.period_m = 64.0, .samples = 256, .seed = 2});
  ground::Wind ground(Vector{3.0, -2.0});
  ground.gusts.along_m_s.fill(0.3F);
  ground.gusts.across_m_s.fill(0.2F);
  const GroundWindField field(ground, noise);
  EXPECT_EQ(field.dims(), 2);
  for (int i = 0; i < 20; ++i) {
    const Vector there = ground.at(noise, 1.7 * i, -0.9 * i);
    const WindVector3 low = field.at({1.7 * i, 0.0, -0.9 * i});
    EXPECT_EQ(low.u_m_s, there.u_m_s);
    EXPECT_EQ(low.v_m_s, there.v_m_s);
    EXPECT_EQ(low.w_m_s, 0.0);
    EXPECT_EQ(field.at({1.7 * i, 8.0, -0.9 * i}).u_m_s, there.u_m_s);
  }
  // The same ground::Wind goes on: the field is of its moment.
  ground.everywhere = {5.0, -2.0};
  EXPECT_EQ(field.at({}).u_m_s, ground.at(noise, 0.0, 0.0).u_m_s);
}

}  // namespace
}  // namespace yuragi::wind::field
