#include "daemon/tools/report/report_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/tools/report/wind_rose.hpp"

namespace yuragi::daemon::tools::report {
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
  EXPECT_THAT(svg, HasSubstr("<title>from W, 10 m/s and more: 25.0 %</title>"));
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

TEST(EmbeddedPlot, IsAnElementOfAPageThatHoldsTheFileAsItIs) {
  EXPECT_EQ(embedded_plot("<svg/>", 10, 20, "Speed", "<rect/>"),
            "<svg viewBox=\"0 0 10 20\" role=\"img\" aria-label=\"Speed\" class=\"plot\">\n<image width=\"10\" "
            "height=\"20\" href=\"data:image/svg+xml;base64,PHN2Zy8+\"/>\n<rect/></svg>\n");
  // RFC 4648, section 10.
  EXPECT_THAT(embedded_plot("f", 1, 1, ""), HasSubstr("base64,Zg==\""));
  EXPECT_THAT(embedded_plot("fo", 1, 1, ""), HasSubstr("base64,Zm8=\""));
  EXPECT_THAT(embedded_plot("foobar", 1, 1, ""), HasSubstr("base64,Zm9vYmFy\""));
  EXPECT_THAT(embedded_plot("\xFF\xFE", 1, 1, ""), HasSubstr("base64,//4=\""));
}

}  // namespace
}  // namespace yuragi::daemon::tools::report
