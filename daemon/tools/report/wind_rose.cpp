#include "daemon/tools/report/wind_rose.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <fmt/format.h>

#include "engine/base/compass.hpp"
#include "engine/base/units.hpp"

namespace yuragi::daemon::tools::report {
namespace {

constexpr double kSize_px = 480.0;
constexpr double kMiddle_px = kSize_px / 2.0;
constexpr double kRadius_px = 195.0;
/// A disc in the middle for the calm; wedges begin at its edge.
constexpr double kCalmRadius_px = 26.0;
/// The part of its sector's angle that a wedge fills.
constexpr double kFill = 0.86;

struct RosePoint {
  double x = 0.0, y = 0.0;
};

RosePoint rose_point(double radius_px, double direction_deg) {
  const double angle_rad = direction_deg * kRadPerDeg;
  return {kMiddle_px + radius_px * std::sin(angle_rad), kMiddle_px - radius_px * std::cos(angle_rad)};
}

/// The share at the outermost ring: a round number above the largest sector's.
double outer_share(const WindRose& rose) {
  double largest = 0.0;
  for (const auto& sector : rose.share) largest = std::max(largest, std::accumulate(sector.begin(), sector.end(), 0.0));
  for (const double round : {0.04, 0.08, 0.12, 0.16, 0.2, 0.24, 0.32, 0.4, 0.48, 0.6, 0.8}) {
    if (largest <= round) return round;
  }
  return 1.0;
}

void add_piece(std::string& svg, double from_px, double to_px, double middle_deg, std::string_view color,
               const std::string& label) {
  const double half_deg = 0.5 * kFill * 360.0 / kRoseSectors;
  const RosePoint a = rose_point(from_px, middle_deg - half_deg);
  const RosePoint b = rose_point(to_px, middle_deg - half_deg);
  const RosePoint c = rose_point(to_px, middle_deg + half_deg);
  const RosePoint d = rose_point(from_px, middle_deg + half_deg);
  fmt::format_to(std::back_inserter(svg),
                 "<path fill=\"{}\" d=\"M{:.1f},{:.1f}L{:.1f},{:.1f}A{:.1f},{:.1f} 0 0 1 {:.1f},{:.1f}L{:.1f},{:.1f}"
                 "A{:.1f},{:.1f} 0 0 0 {:.1f},{:.1f}Z\"><title>{}</title></path>\n",
                 color, a.x, a.y, b.x, b.y, to_px, to_px, c.x, c.y, d.x, d.y, from_px, from_px, a.x, a.y, label);
}

}  // namespace

std::string rose_class_text(const WindRose& rose, std::size_t speed_class) {
  const double from_m_s = rose.class_from_m_s(speed_class);
  if (speed_class + 1 == kRoseClasses) return fmt::format("{:g} m/s and more", from_m_s);
  return fmt::format("{:g} to {:g} m/s", from_m_s, rose.class_from_m_s(speed_class + 1));
}

std::string draw_wind_rose(const WindRose& rose) {
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {0} {0}\" role=\"img\" aria-label=\"Wind rose\" class=\"rose\" font-size=\"14\">\n",
      kSize_px);
  const auto out = std::back_inserter(svg);
  const double outer = outer_share(rose);
  const double px_per_share = (kRadius_px - kCalmRadius_px) / outer;

  // Rings with their shares, and the points of the compass.
  constexpr int kRings = 4;
  for (int ring = 1; ring <= kRings; ++ring) {
    const double share = outer * ring / kRings;
    fmt::format_to(out, "<circle class=\"ring\" cx=\"{0}\" cy=\"{0}\" r=\"{1:.1f}\"/>\n", kMiddle_px,
                   kCalmRadius_px + share * px_per_share);
  }
  for (std::size_t sector = 0; sector < kRoseSectors; sector += 2) {
    const RosePoint place = rose_point(kRadius_px + 20.0, 360.0 / kRoseSectors * static_cast<double>(sector));
    fmt::format_to(out, "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\"{}>{}</text>\n", place.x, place.y + 5.0,
                   sector % 4 == 0 ? " font-weight=\"bold\"" : "", kCompassPoints.at(sector));
  }

  for (std::size_t sector = 0; sector < kRoseSectors; ++sector) {
    double share = 0.0;
    for (std::size_t speed = 0; speed < kRoseClasses; ++speed) {
      const double part = rose.share[sector][speed];
      if (part <= 0.0) continue;
      add_piece(
          svg, kCalmRadius_px + share * px_per_share, kCalmRadius_px + (share + part) * px_per_share,
          360.0 / kRoseSectors * static_cast<double>(sector), kRoseColors.at(speed),
          fmt::format("from {}, {}: {:.1f} %", kCompassPoints.at(sector), rose_class_text(rose, speed), 100.0 * part));
      share += part;
    }
  }

  // The rings' labels are drawn over the wedges, between two of them; the calm in the middle.
  for (int ring = 1; ring <= kRings; ++ring) {
    const double share = outer * ring / kRings;
    const RosePoint place = rose_point(kCalmRadius_px + share * px_per_share, 360.0 / kRoseSectors * 1.5);
    fmt::format_to(
        out, "<text class=\"halo\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" font-size=\"12\">{:g} %</text>\n",
        place.x, place.y + 4.0, 100.0 * share);
  }
  fmt::format_to(
      out,
      "<g><title>calm, below {1:g} m/s: {2:.1f} %</title><circle class=\"calm\" cx=\"{0}\" cy=\"{0}\" "
      "r=\"{3}\"/><text x=\"{0}\" y=\"{4}\" text-anchor=\"middle\" font-size=\"11\">calm</text><text x=\"{0}\" "
      "y=\"{5}\" text-anchor=\"middle\" font-size=\"12\">{2:.1f} %</text></g>\n</svg>",
      kMiddle_px, kRoseCalm_m_s, 100.0 * rose.calm_share, kCalmRadius_px - 1.0, kMiddle_px - 2.0, kMiddle_px + 12.0);
  return svg;
}

}  // namespace yuragi::daemon::tools::report
