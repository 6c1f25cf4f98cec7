#include "daemon/tools/report/report_figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "daemon/tools/plot/plot.hpp"
#include "daemon/tools/report/report_text.hpp"
#include "daemon/tools/report/wind_rose.hpp"
#include "engine/wind/turbulence/turbulence_fit.hpp"
#include "engine/wind/turbulence/von_karman.hpp"
#include "engine/wind/wind_vector.hpp"

namespace yuragi::daemon::tools::report {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr int kWidth_px = 1000;
/// Fewer than these are points, not a line.
constexpr std::size_t kFewReadings = 100;
constexpr const char* kWindColor = "#2f7fc1";
constexpr const char* kGustColor = "#e07b00";
constexpr const char* kFitColor = "#c2453d";
constexpr const char* kSlopeColor = "#7b52ab";
constexpr const char* kPaleColor = "#8fb8da";

/// Reads the whole file.
std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Figures {
 public:
  Figures(const RecordingNumbers& recording, const SensorNumbers& sensor, std::filesystem::path scratch)
      : recording_(recording), sensor_(sensor), scratch_(std::move(scratch)) {
    scratch_ += ".svg";
  }

  Result<std::string, Failure> series() {
    if (sensor_.believed == 0) return {};
    std::vector<plot::Panel> panels = {speed_panel()};
    if (sensor_.directed > 0) panels.push_back(direction_panel());
    panels.push_back(state_panel());
    return draw(panels, "Speed, direction and state over time", kWidth_px, event_titles(height_of(panels)));
  }

  Result<std::string, Failure> distribution();
  Result<std::string, Failure> spectrum();
  Result<std::string, Failure> diurnal();

 private:
  static int height_of(std::span<const plot::Panel> panels) {
    int height_px = 0;
    for (const plot::Panel& panel : panels) height_px += panel.height_px;
    return height_px;
  }

  Result<std::string, Failure> draw(std::span<const plot::Panel> panels, std::string_view label,
                                    int width_px = kWidth_px, std::string_view over = {}) {
    const auto drawn = plot::draw_plot(scratch_, panels, width_px, plot::Background::kNone);
    if (!drawn) return drawn.error();
    const std::string text = text_of_file(scratch_);
    std::error_code ignored;
    std::filesystem::remove(scratch_, ignored);
    return {boost::system::in_place_value, embedded_plot(text, width_px, height_of(panels), label, over)};
  }

  double axis_s(double time_s) const { return seconds(recording_.utc_at(time_s).time_since_epoch()); }

  plot::Panel time_panel() const {
    // One reading has no duration, and gnuplot cannot draw an axis of microseconds at times since 1970.
    const double margin_s = recording_.duration_s() < 1.0 ? 1.0 : 0.0;
    plot::Panel panel;
    panel.is_x_time = true;
    panel.x_range = {{axis_s(recording_.begin_s) - margin_s, axis_s(recording_.end_s) + margin_s}};
    // Silences are drawn behind the curves.
    for (const auto& [from_s, to_s] : stretches(RecordedState::kStale, RecordedState::kStale)) {
      panel.spans.push_back({.from = from_s, .to = to_s, .color = "#dddddd"});
    }
    return panel;
  }

  /// The stretches of the axis where the most serious state of the bins is one of these.
  std::vector<std::pair<double, double>> stretches(RecordedState first, RecordedState last) const {
    std::vector<std::pair<double, double>> found;
    const double bin_s = recording_.duration_s() / static_cast<double>(kTimeBins);
    bool is_open = false;
    for (std::size_t i = 0; i < kTimeBins; ++i) {
      const bool is_one = sensor_.bins[i].gravest >= first && sensor_.bins[i].gravest <= last;
      const double from_s = axis_s(recording_.begin_s + bin_s * static_cast<double>(i));
      if (is_one && is_open) found.back().second = from_s + bin_s;
      if (is_one && !is_open) found.emplace_back(from_s, from_s + bin_s);
      is_open = is_one;
    }
    return found;
  }

  std::string event_titles(int height_px) const;
  plot::Panel speed_panel() const;
  plot::Panel direction_panel() const;
  plot::Panel state_panel() const;

  const RecordingNumbers& recording_;
  const SensorNumbers& sensor_;
  std::filesystem::path scratch_;
};

/// Invisible elements with a tooltip for each event.
std::string Figures::event_titles(int height_px) const {
  constexpr double kMinWidth_px = 3.0;
  const double axis_px = kWidth_px - plot::kTimeAxisLeft_px - plot::kTimeAxisRight_px;
  std::string titles;
  const auto [axis_begin_s, axis_end_s] = *time_panel().x_range;
  const double px_per_s = axis_px / (axis_end_s - axis_begin_s);
  for (const StateEvent& event : sensor_.events) {
    const double from_px = plot::kTimeAxisLeft_px + (axis_s(event.from_s) - axis_begin_s) * px_per_s;
    fmt::format_to(
        std::back_inserter(titles),
        "<rect x=\"{:.1f}\" y=\"0\" width=\"{:.1f}\" height=\"{}\" fill=\"transparent\"><title>{} for {}, from "
        "{}</title></rect>\n",
        from_px, std::max(event.length_s() * px_per_s, kMinWidth_px), height_px,
        kRecordedStateNames[static_cast<std::size_t>(event.state)], settings::duration_text(event.length_s()),
        utc_text(recording_.utc_at(event.from_s)));
  }
  return titles;
}

plot::Panel Figures::speed_panel() const {
  plot::Curve band{.title = "lowest to highest", .style = plot::Style::kBand, .x = {}, .y = {}, .color = kWindColor};
  plot::Curve mean{.title = "speed", .style = plot::Style::kLine, .x = {}, .y = {}, .color = kWindColor};
  plot::Curve gust{.title = sensor_.reported_gust_m_s ? "gust reported by the sensor" : "3 s gust",
                   .style = plot::Style::kLine,
                   .x = {},
                   .y = {},
                   .color = kGustColor};
  double highest_m_s = 1.0;
  bool has_band = false;
  const auto add = [](plot::Curve& curve, double x, double y, double y2) {
    curve.x.push_back(x);
    curve.y.push_back(y);
    curve.y2.push_back(y2);
  };
  for (const TimeBin& bin : sensor_.bins) {
    if (bin.count == 0) continue;
    const double x = axis_s(bin.time_s());
    if (bin.follows_silence) {
      for (plot::Curve* curve : {&band, &mean, &gust}) add(*curve, kNothing, kNothing, kNothing);
    }
    add(band, x, bin.min_m_s, bin.max_m_s);
    add(mean, x, bin.mean_m_s(), 0.0);
    if (bin.gust_m_s) add(gust, x, *bin.gust_m_s, 0.0);
    has_band = has_band || bin.max_m_s > bin.min_m_s;
    highest_m_s = std::max({highest_m_s, bin.max_m_s, bin.gust_m_s.value_or(0.0)});
  }
  // A line through few readings would be invisible.
  if (mean.x.size() < kFewReadings) mean.style = plot::Style::kPoints;

  plot::Panel panel = time_panel();
  panel.y_label = "speed, m/s";
  panel.y_range = {{0.0, 1.3 * highest_m_s}};
  panel.height_px = 360;
  if (has_band) {
    mean.title = "mean";
    panel.curves.push_back(std::move(band));
  }
  if (std::ranges::any_of(gust.y, [](double y) { return std::isfinite(y); })) panel.curves.push_back(std::move(gust));
  panel.curves.push_back(std::move(mean));
  return panel;
}

plot::Panel Figures::direction_panel() const {
  plot::Curve readings{.title = {}, .style = plot::Style::kDots, .x = {}, .y = {}, .color = kPaleColor};
  for (const DirectionPoint& point : sensor_.directions) {
    readings.x.push_back(axis_s(point.time_s));
    readings.y.push_back(point.direction_deg);
  }
  // Points, not lines: a wind passing through north would draw a line across the panel.
  plot::Curve mean{.title = {}, .style = plot::Style::kDots, .x = {}, .y = {}, .color = kWindColor};
  for (const TimeBin& bin : sensor_.bins) {
    const wind::Vector sum{bin.u_sum_m_s, bin.v_sum_m_s};
    if (bin.directed == 0 || speed_of(sum) == 0.0) continue;
    mean.x.push_back(axis_s(bin.time_s()));
    mean.y.push_back(wind::direction_from_deg(sum));
  }
  if (readings.x.size() < kFewReadings) mean.style = plot::Style::kPoints;

  plot::Panel panel = time_panel();
  panel.y_label = "from, degrees";
  panel.y_range = {{0.0, 360.0}};
  panel.y_step = 90.0;
  panel.height_px = 260;
  for (plot::Curve* curve : {&readings, &mean}) {
    if (!curve->x.empty()) panel.curves.push_back(std::move(*curve));
  }
  return panel;
}

plot::Panel Figures::state_panel() const {
  plot::Panel panel = time_panel();
  panel.spans = {{.from = panel.x_range->first,
                  .to = panel.x_range->second,
                  .color = std::string(kRecordedStateColors[static_cast<std::size_t>(RecordedState::kLive)])}};
  for (std::size_t i = 1; i < kRecordedStates; ++i) {
    const auto state = static_cast<RecordedState>(i);
    for (const auto& [from_s, to_s] : stretches(state, state)) {
      panel.spans.push_back({.from = from_s, .to = to_s, .color = std::string(kRecordedStateColors[i])});
    }
  }
  panel.x_label = "UTC";
  panel.y_label = "state";
  panel.y_range = {{0.0, 1.0}};
  panel.y_step = -1.0;
  panel.height_px = 120;
  return panel;
}

Result<std::string, Failure> Figures::distribution() {
  const SpeedDistribution& numbers = sensor_.distribution;
  if (numbers.share.empty()) return {};
  plot::Curve measured{.title = "readings", .style = plot::Style::kBars, .x = {}, .y = {}, .color = kWindColor};
  for (std::size_t i = 0; i < numbers.share.size(); ++i) {
    measured.x.push_back((static_cast<double>(i) + 0.5) * numbers.class_m_s);
    measured.y.push_back(100.0 * numbers.share[i]);
  }
  const double end_m_s = numbers.class_m_s * static_cast<double>(numbers.share.size() + 1);
  plot::Panel panel{.title = {}, .x_label = "speed, m/s", .y_label = "share of the readings, %", .curves = {measured}};
  if (numbers.weibull_shape) {
    const double k = *numbers.weibull_shape;
    const double c = *numbers.weibull_scale_m_s;
    plot::Curve fit{.title = fmt::format("Weibull, k = {:.2f}, c = {:.2f} m/s", k, c),
                    .style = plot::Style::kLine,
                    .x = {},
                    .y = {},
                    .color = kFitColor};
    constexpr int kPoints = 200;
    for (int i = 1; i <= kPoints; ++i) {
      const double speed_m_s = end_m_s * i / kPoints;
      const double part = speed_m_s / c;
      fit.x.push_back(speed_m_s);
      fit.y.push_back(100.0 * numbers.class_m_s * k / c * std::pow(part, k - 1.0) * std::exp(-std::pow(part, k)));
    }
    panel.curves.push_back(std::move(fit));
  }
  panel.x_range = {{0.0, end_m_s}};
  panel.y_range = {{0.0, 130.0 * *std::ranges::max_element(numbers.share)}};
  panel.height_px = 470;
  return draw(std::span(&panel, 1), "Distribution of the speed", 500);
}

Result<std::string, Failure> Figures::spectrum() {
  if (!sensor_.spectrum) return {};
  const SpectrumNumbers& numbers = *sensor_.spectrum;

  // Means over eighths of an octave: the same density of points at all frequencies.
  plot::Curve measured{.title = "measured", .style = plot::Style::kLine, .x = {}, .y = {}, .color = kWindColor};
  constexpr double kPerOctave = 8.0;
  // Without the line at the Nyquist frequency, which has half of the power.
  const std::size_t lines = numbers.density_m2_s2_hz.size() - 1;
  for (std::size_t k = 1; k < lines;) {
    const double place = std::floor(kPerOctave * std::log2(static_cast<double>(k)));
    double sum = 0.0;
    double log_sum = 0.0;
    std::size_t count = 0;
    for (; k < lines && std::floor(kPerOctave * std::log2(static_cast<double>(k))) == place; ++k, ++count) {
      sum += numbers.density_m2_s2_hz[k];
      log_sum += std::log(numbers.frequency_hz(k));
    }
    const double density = sum / static_cast<double>(count);
    if (!(density > 0.0)) continue;
    measured.x.push_back(std::exp(log_sum / static_cast<double>(count)));
    measured.y.push_back(density);
  }
  if (measured.x.empty()) return {};
  const auto [lowest, highest] = std::ranges::minmax(measured.y);
  const double from_hz = measured.x.front();
  const double to_hz = measured.x.back();

  plot::Panel panel{.title = {},
                    .x_label = "frequency, Hz",
                    .y_label = "S, m²/s²/Hz",
                    .is_x_log = true,
                    .is_y_log = true,
                    .curves = {measured}};
  if (numbers.von_karman) {
    const VonKarmanFit& fit = *numbers.von_karman;
    plot::Curve curve{.title = fmt::format("von Karman, U = {:.2f} m/s, TI = {:.2f}{}", fit.speed_m_s, fit.intensity,
                                           fit.length_m ? fmt::format(", L = {:.0f} m", *fit.length_m) : ""),
                      .style = plot::Style::kLine,
                      .x = {},
                      .y = {},
                      .color = kFitColor};
    constexpr int kPoints = 200;
    for (int i = 0; i <= kPoints; ++i) {
      const double f = from_hz * std::pow(to_hz / from_hz, static_cast<double>(i) / kPoints);
      curve.x.push_back(f);
      curve.y.push_back(fit.sigma_m_s() * fit.sigma_m_s() * fit.time_scale_s *
                        wind::turbulence::von_karman_density(f * fit.time_scale_s));
    }
    panel.curves.push_back(std::move(curve));
  }
  if (numbers.power_law) {
    // Drawn above the measured curve, so that both can be seen.
    const PowerLawFit& fit = *numbers.power_law;
    plot::Curve curve{.title = fmt::format("f to the power of {:.2f}, drawn twice as high", -fit.beta),
                      .style = plot::Style::kLine,
                      .x = {},
                      .y = {},
                      .color = kSlopeColor};
    for (const double f : {fit.from_hz, fit.to_hz}) {
      curve.x.push_back(f);
      curve.y.push_back(2.0 * std::exp(fit.log_level - fit.beta * std::log(f)));
    }
    panel.curves.push_back(std::move(curve));
  }
  panel.x_range = {{from_hz, to_hz}};
  panel.y_range = {{std::max(0.5 * lowest, 1e-7 * highest), 8.0 * highest}};
  panel.height_px = 560;
  return draw(std::span(&panel, 1), "Spectrum");
}

Result<std::string, Failure> Figures::diurnal() {
  if (!sensor_.diurnal) return {};
  plot::Curve band{.title = "8 of 10 readings", .style = plot::Style::kBand, .x = {}, .y = {}, .color = kWindColor};
  plot::Curve mean{.title = "mean", .style = plot::Style::kLine, .x = {}, .y = {}, .color = kWindColor};
  double highest_m_s = 1.0;
  for (std::size_t i = 0; i < sensor_.diurnal->size(); ++i) {
    const HourOfDay& hour = (*sensor_.diurnal)[i];
    const bool has_any = hour.count > 0;
    const double x = static_cast<double>(i) + 0.5;
    band.x.push_back(x);
    band.y.push_back(has_any ? hour.p10_m_s : kNothing);
    band.y2.push_back(has_any ? hour.p90_m_s : kNothing);
    mean.x.push_back(x);
    mean.y.push_back(has_any ? hour.mean_m_s : kNothing);
    highest_m_s = std::max({highest_m_s, hour.p90_m_s, hour.mean_m_s});
  }
  plot::Panel panel{
      .title = {}, .x_label = "hour of the day, local time", .y_label = "speed, m/s", .curves = {band, mean}};
  panel.x_range = {{0.0, 24.0}};
  panel.x_step = 3.0;
  panel.y_range = {{0.0, 1.25 * highest_m_s}};
  panel.height_px = 360;
  return draw(std::span(&panel, 1), "Speed by the hour of the day");
}

/// RFC 4648, section 4.
std::string base64(std::string_view bytes) {
  constexpr std::string_view kSigns = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = i; k < i + 3; ++k) {
      three = (three << 8U) | (k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0U);
    }
    for (unsigned k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kSigns[(three >> (18U - 6U * k)) & 63U] : '=';
  }
  return text;
}

}  // namespace

std::string embedded_plot(std::string_view svg, int width_px, int height_px, std::string_view label,
                          std::string_view over) {
  return fmt::format(
      "<svg viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"{2}\" class=\"plot\">\n<image width=\"{0}\" "
      "height=\"{1}\" href=\"data:image/svg+xml;base64,{3}\"/>\n{4}</svg>\n",
      width_px, height_px, label, base64(svg), over);
}

Result<SensorFigures, Failure> draw_figures(const RecordingNumbers& recording, const SensorNumbers& sensor,
                                            const std::filesystem::path& scratch) {
  Figures figures(recording, sensor, scratch);
  SensorFigures drawn;
  if (sensor.rose.count > 0) drawn.rose = draw_wind_rose(sensor.rose);
  for (const auto& [svg, draw] :
       {std::pair(&drawn.series, &Figures::series), std::pair(&drawn.distribution, &Figures::distribution),
        std::pair(&drawn.spectrum, &Figures::spectrum), std::pair(&drawn.diurnal, &Figures::diurnal)}) {
    auto figure = (figures.*draw)();
    if (!figure) return figure.error();
    *svg = std::move(*figure);
  }
  return drawn;
}

}  // namespace yuragi::daemon::tools::report
