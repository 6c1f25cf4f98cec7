#include "daemon/tools/report/report_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/tools/report/wind_rose.hpp"

namespace yuragi {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(WindRoseDrawing, HasAWedgeForEachShareThatTellsItsNumbers) {
  WindRose rose;
  rose.count = 100;
  rose.calm_share = 0.25;
  rose.share[4][1] = 0.5;
  rose.share[12][5] = 0.25;
  const std::string svg = draw_wind_rose(rose);
  EXPECT_THAT(svg, HasSubstr("<title>from E, 2 to 4 m/s: 50.0 %</title>"));
  EXPECT_THAT(svg, HasSubstr("<title>from W, 11 m/s and more: 25.0 %</title>"));
  EXPECT_THAT(svg, HasSubstr("calm, below 0.5 m/s: 25.0 %"));
  std::size_t wedges = 0;
  for (std::size_t at = svg.find("<path"); at != std::string::npos; at = svg.find("<path", at + 1)) ++wedges;
  EXPECT_EQ(wedges, 2U);
}

TEST(WindRoseDrawing, AWindFromOneSideAloneStaysInItsRings) {
  WindRose rose;
  rose.count = 1;
  rose.share[0][0] = 1.0;
  EXPECT_THAT(draw_wind_rose(rose), Not(HasSubstr("nan")));
}

TEST(EmbeddedSvg, IsAnElementOfAPage) {
  const auto svg = embedded_svg(
      "<?xml version=\"1.0\"?>\n<svg \n viewBox=\"0 0 10 20\"\n xmlns=\"http://www.w3.org/2000/svg\"\n>\n"
      "<title>Gnuplot</title>\n<g id=\"gnuplot_canvas\">\n<rect x=\"0\" y=\"0\" width=\"10\" height=\"20\" "
      "fill=\"#ffffff\"/>\n<defs><circle id='gpDot'/></defs>\n<g id=\"gnuplot_plot_1\" ><title>gnuplot_plot_1</title>"
      "<use xlink:href='#gpDot'/></g></g>\n</svg>\n",
      "a1", "Speed");
  EXPECT_EQ(
      svg.value(),
      "<svg viewBox=\"0 0 10 20\" role=\"img\" aria-label=\"Speed\" class=\"plot\">\n<g id=\"a1gnuplot_canvas\">\n\n"
      "<defs><circle id='a1gpDot'/></defs>\n<g id=\"a1plot_1\" ><use href='#a1gpDot'/></g></g>\n</svg>\n");
  EXPECT_FALSE(embedded_svg("nonsense", "a1", "Speed"));
}

}  // namespace
}  // namespace yuragi
