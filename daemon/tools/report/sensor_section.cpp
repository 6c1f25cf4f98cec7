#include "daemon/tools/report/sensor_section.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "daemon/settings/site_octaves.hpp"
#include "daemon/tools/report/default_wind.hpp"
#include "daemon/tools/report/report_text.hpp"
#include "daemon/tools/report/wind_rose.hpp"
#include "engine/wind/turbulence/site_spectrum.hpp"

namespace yuragi::daemon::tools::report {
namespace {

std::string percent(double part) {
  // Rounding gives neither 0 % for something nor 100 % for less than all.
  if (part > 0.0 && part < 0.001) return "below 0.1 %";
  if (part < 1.0 && part > 0.999) return "above 99.9 %";
  return fmt::format("{:.3g} %", 100.0 * part);
}

std::string speed_text(double speed_m_s) {
  return fmt::format("{:.1f} m/s", speed_m_s);
}

double gust_of(const SensorNumbers& sensor) {
  return sensor.reported_gust_m_s.value_or(sensor.gust_3s_m_s.value_or(sensor.max_m_s));
}

void add_tiles(PageWriter& page, const SensorNumbers& sensor) {
  page.add("<div class=\"tiles\">\n");
  page.tile(speed_text(sensor.mean_m_s), "mean speed");
  page.tile(speed_text(gust_of(sensor)), sensor.reported_gust_m_s ? "highest gust, reported by the sensor"
                                         : sensor.gust_3s_m_s     ? "highest gust (mean of 3 s)"
                                                                  : "highest reading");
  if (sensor.direction_deg) {
    page.tile(fmt::format("{:.0f}°", *sensor.direction_deg),
              fmt::format("mean direction: from {}", compass_text(*sensor.direction_deg)));
  }
  if (sensor.mean_m_s > 0.0 && sensor.believed > 1)
    page.tile(fmt::format("{:.2f}", sensor.deviation_m_s / sensor.mean_m_s), "deviation over mean speed");
  if (sensor.spectrum && sensor.spectrum->von_karman && sensor.spectrum->von_karman->length_m) {
    page.tile(fmt::format("{:.0f} m", *sensor.spectrum->von_karman->length_m), "length of the gusts, L");
  }
  page.add("</div>\n");
}

void add_series(PageWriter& page, const SensorFigures& figures) {
  if (figures.series.empty()) return;
  std::string keys;
  for (std::size_t i = 0; i < kRecordedStates; ++i) {
    keys += fmt::format("<span class=\"item\"><span class=\"key\" style=\"background:{}\"></span>{}</span> ",
                        kRecordedStateColors[i], kRecordedStateNames[i]);
  }
  page.add("<h3>Speed, direction and state</h3>\n");
  page.figure(figures.series,
              fmt::format("<span class=\"keys\">{}</span><br>Each column of the picture shows the lowest, mean and "
                          "highest of its readings: no extreme is lost. Pale points: single directions; dark ones: "
                          "means. Grey behind the curves: the sensor was silent; a blank: its readings were rejected.",
                          keys));
}

void add_rose_and_distribution(PageWriter& page, const SensorNumbers& sensor, const SensorFigures& figures) {
  page.add("<div class=\"pair\">\n");
  if (!figures.rose.empty()) {
    page.add("<div><h3>Where the wind came from</h3>\n");
    std::string keys;
    for (std::size_t i = 0; i < kRoseColors.size(); ++i) {
      keys += fmt::format("<span class=\"item\"><span class=\"key\" style=\"background:{}\"></span>{}</span> ",
                          kRoseColors[i], rose_class_text(sensor.rose, i));
    }
    page.figure(figures.rose, fmt::format("<span class=\"keys\">{}</span><br>Share of {} readings; calm: {}.", keys,
                                          sensor.rose.count, percent(sensor.rose.calm_share)));
    page.add("</div>\n");
  }
  if (!figures.distribution.empty()) {
    const SpeedDistribution& numbers = sensor.distribution;
    page.add("<div><h3>How strong it was</h3>\n");
    page.figure(
        figures.distribution,
        fmt::format("One reading in ten is below {:.1f} m/s, half are below {:.1f}, nine in ten below {:.1f}, 99 "
                    "in a hundred below {:.1f}.{}",
                    numbers.p10_m_s, numbers.p50_m_s, numbers.p90_m_s, numbers.p99_m_s,
                    numbers.weibull_shape ? " Weibull by mean and deviation (Justus et al. 1978)." : ""));
    page.add("</div>\n");
  }
  page.add("</div>\n");
}

std::string frequency_text(double frequency_hz) {
  return fmt::format("{:.3g}", frequency_hz);
}

void add_octaves(PageWriter& page, const SpectrumNumbers& spectrum) {
  page.add(
      "<table><thead><tr><th class=\"n\">from, Hz</th><th class=\"n\">to, Hz</th><th class=\"n\">variance, m²/s²</th>"
      "<th class=\"n\">von Karman, m²/s²</th><th class=\"n\">difference, dB</th><th>in the "
      "fit</th></tr></thead><tbody>\n");
  for (const OctaveBand& band : spectrum.octaves) {
    const bool has_ratio = band.fitted_m2_s2 && *band.fitted_m2_s2 > 0.0 && band.variance_m2_s2 > 0.0;
    page.add(
        "<tr><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{:.4g}</td><td class=\"n\">{}</td><td "
        "class=\"n\">{}</td><td>{}</td></tr>\n",
        frequency_text(band.from_hz), frequency_text(band.to_hz), band.variance_m2_s2,
        band.fitted_m2_s2 ? fmt::format("{:.4g}", *band.fitted_m2_s2) : "–",
        has_ratio ? fmt::format("{:+.1f}", 10.0 * std::log10(band.variance_m2_s2 / *band.fitted_m2_s2)) : "–",
        band.is_in_fit ? "yes" : "no");
  }
  page.add("</tbody></table>\n");
}

/// Why a slope may be smaller than that of turbulence.
std::string_view slope_remark(const SpectrumNumbers& spectrum) {
  // At three times the bend von Karman's slope has reached 1.5.
  const bool is_bent = spectrum.von_karman && spectrum.power_law->beta < 1.5 &&
                       spectrum.power_law->from_hz < 3.0 * 0.146 / spectrum.von_karman->time_scale_s;
  return is_bent ? "; these frequencies are near the bend of the spectrum, where it is flatter" : "";
}

void add_turbulence(PageWriter& page, const SensorNumbers& sensor) {
  page.add("<table><tbody>\n");
  if (sensor.blocks.turbulence_intensity) {
    page.row("Turbulence intensity of 10 minutes",
             fmt::format("{:.2f} (mean of {} blocks)", *sensor.blocks.turbulence_intensity, sensor.blocks.blocks));
  }
  if (sensor.blocks.gust_factor) {
    page.row("Gust factor: 3 s over 10 minutes", fmt::format("{:.2f}", *sensor.blocks.gust_factor));
  }
  if (sensor.gust_3s_m_s && sensor.mean_m_s > 0.0) {
    page.row("Highest 3 s over the mean of the recording",
             fmt::format("{:.2f} ({:.2f} m/s)", *sensor.gust_3s_m_s / sensor.mean_m_s, *sensor.gust_3s_m_s));
  }
  if (sensor.integral_time_s) {
    page.row("Integral time of the speed",
             fmt::format("{:.3g} s (autocorrelation of up to 30 min, to its first zero)", *sensor.integral_time_s));
  }
  if (sensor.spectrum) {
    const SpectrumNumbers& spectrum = *sensor.spectrum;
    if (const auto& fit = spectrum.power_law) {
      page.row(
          "Slope of the spectrum",
          fmt::format("β = {:.2f} (f<sup>−β</sup>, least squares from {} to {} Hz; Kolmogorov’s is 1.67){}", fit->beta,
                      frequency_text(fit->from_hz), frequency_text(fit->to_hz), slope_remark(spectrum)));
    }
    if (const auto& fit = spectrum.von_karman) {
      page.row(
          "von Karman's spectrum",
          fmt::format("U = {:.2f} m/s, TI = {:.2f}, L = {} (least squares over octaves, {} to {} Hz; {:.1f} dB remain)",
                      fit->speed_m_s, fit->intensity,
                      fit->length_m ? fmt::format("{:.0f} m", *fit->length_m)
                                    : std::string("not determined: the bend of the spectrum is outside the octaves"),
                      frequency_text(fit->from_hz), frequency_text(fit->to_hz), fit->rms_db));
    }
  }
  page.add("</tbody></table>\n");
}

/// The recording's wind as the default wind of a configuration, if the recording is long enough.
void add_default_wind(PageWriter& page, const RecordingNumbers& recording, const SensorNumbers& sensor) {
  constexpr double kLeast_s = 600.0;
  const std::optional<DefaultWind> wind = default_wind(sensor);
  if (!wind || recording.duration_s() < kLeast_s) return;
  page.add(
      "<p>For such a wind while no sensor is live, put this into the configuration (a recording of weeks is more "
      "representative than one of minutes). Turbulence and length belong together: over 10 minutes the wind of both "
      "has the intensity that was measured over 10 minutes.</p>\n"
      "<pre>[wind]\n"
      "default_speed = {:.1f}\n",
      wind->speed_m_s);
  if (wind->direction_deg) page.add("default_direction = {:.0f}\n", *wind->direction_deg);
  page.add("default_turbulence = {:.2f}\ndefault_length = {:.0f}{}\n</pre>\n", wind->turbulence_intensity,
           wind->length_m, wind->is_length_measured ? "" : "  # assumed: the recording does not determine it");
}

/// The site_octaves for a slow sensor at this place, ready to be copied.
void add_site(PageWriter& page, const SensorNumbers& sensor) {
  if (!sensor.site) return;
  const SiteNumbers& site = *sensor.site;
  page.add("<h3>For a slow sensor at this place</h3>\n");
  page.add(
      "<p>A sensor with an interval of several seconds does not measure quicker gusts: they are filled in by a model "
      "of open land. The table shows by how much the gusts that “{}” measured were stronger (+) or weaker (−) than the "
      "model would have given for a sensor of 14 s at its place, over {}:</p>\n",
      page_text(sensor.name), settings::duration_text(site.known_s));
  page.add("<table><thead><tr><th>octave</th><th class=\"n\">dB</th></tr></thead><tbody>\n");
  for (std::size_t octave = 0; octave < site.octaves_db.size(); ++octave) {
    const double from_hz = std::ldexp(wind::turbulence::SiteSpectrum::kFrom_hz, static_cast<int>(octave));
    page.add("<tr><td>{:g} – {:g} Hz</td><td class=\"n\">{:+.1f}</td></tr>\n", from_hz, 2.0 * from_hz,
             site.octaves_db[octave]);
  }
  page.add(
      "</tbody></table>\n"
      "<p>To correct the gusts of slow sensors by it, put this into the configuration. It is valid for gusts of {:.0f} "
      "m, so the sensor’s calibration has to give the same height (a day is more representative than half an "
      "hour):</p>\n"
      "<pre>[wind]\n"
      "site_octaves = \"{}\"\n"
      "</pre>\n",
      site.length_m, settings::site_octaves_text(site.octaves_db));
}

void add_spectrum(PageWriter& page, const RecordingNumbers& recording, const SensorNumbers& sensor,
                  const SensorFigures& figures) {
  page.add("<h3>Gusts and turbulence</h3>\n");
  add_turbulence(page, sensor);
  if (!sensor.spectrum) {
    page.add("<p class=\"quiet\">No spectrum. {}</p>\n", page_text(sensor.why_no_spectrum));
    return;
  }
  const SpectrumNumbers& spectrum = *sensor.spectrum;
  page.figure(figures.spectrum,
              fmt::format("Spectrum of {}: Welch's method, {} segments of {} readings ({}), Hann, overlapping by half, "
                          "detrended. Drawn as means over eighths of an octave.",
                          spectrum.is_of_speed ? "the speed" : "the wind along its mean direction", spectrum.segments,
                          spectrum.segment_readings,
                          settings::duration_text(static_cast<double>(spectrum.segment_readings) * spectrum.step_s)));
  page.add("<h3>Octave by octave</h3>\n");
  add_octaves(page, spectrum);
  add_default_wind(page, recording, sensor);
  add_site(page, sensor);
}

/// The meaning of a state, for a technician.
std::string_view meaning_of(RecordedState state) {
  switch (state) {
    case RecordedState::kLive:
      return "received, and plausible";
    case RecordedState::kStale:
      return "silent, or not recorded: cable, power, radio?";
    case RecordedState::kSpike:
      return "a reading far from all others was rejected";
    case RecordedState::kImplausible:
      return "repeatedly far from all others: a loose contact, interference on the line?";
    case RecordedState::kFrozen:
      return "exactly the same value repeatedly: icing, a stuck logger?";
    case RecordedState::kSeized:
      return "no wind for hours on a windy day: a bearing, a bird, ice?";
  }
  return "";
}

/// A table of those events that `is_wanted`.
template <class Wanted>
void add_events(PageWriter& page, const RecordingNumbers& recording, const SensorNumbers& sensor,
                std::string_view title, const Wanted& is_wanted) {
  const auto listed = std::ranges::count_if(sensor.events, is_wanted);
  if (listed == 0) return;
  std::uint64_t all = 0;
  for (std::size_t i = 1; i < kRecordedStates; ++i) {
    if (is_wanted(StateEvent{.state = static_cast<RecordedState>(i)})) all += sensor.states[i].count;
  }
  page.add("<h3>{}</h3>\n", title);
  if (all > static_cast<std::uint64_t>(listed)) page.add("<p class=\"quiet\">The longest {} of {}.</p>\n", listed, all);
  page.add(
      "<table class=\"long\"><thead><tr><th>state</th><th>from</th><th>to</th><th class=\"n\">length</th></tr></thead>"
      "<tbody>\n");
  for (const StateEvent& event : sensor.events) {
    if (!is_wanted(event)) continue;
    const auto state = static_cast<std::size_t>(event.state);
    page.add(
        "<tr><td class=\"s\"><span class=\"key\" style=\"background:{}\"></span>{}</td><td>{}</td><td>{}</td>"
        "<td class=\"n\">{}</td></tr>\n",
        kRecordedStateColors[state], kRecordedStateNames[state], utc_text(recording.utc_at(event.from_s)),
        utc_text(recording.utc_at(event.to_s)), settings::duration_text(event.length_s()));
  }
  page.add("</tbody></table>\n");
}

void add_states(PageWriter& page, const RecordingNumbers& recording, const SensorNumbers& sensor) {
  page.add(
      "<h3>States of the sensor</h3>\n"
      "<table><thead><tr><th>state</th><th class=\"n\">times</th><th class=\"n\">in all</th><th "
      "class=\"n\">share</th><th class=\"n\">longest</th><th>meaning</th></tr></thead><tbody>\n");
  for (std::size_t i = 0; i < kRecordedStates; ++i) {
    const StateTotal& total = sensor.states[i];
    const bool has_any = total.count > 0;
    page.add(
        "<tr><td class=\"s\"><span class=\"key\" style=\"background:{}\"></span>{}</td><td class=\"n\">{}</td><td "
        "class=\"n\">{}</td>"
        "<td class=\"n\">{}</td><td class=\"n\">{}</td><td>{}</td></tr>\n",
        kRecordedStateColors[i], kRecordedStateNames[i], total.count,
        has_any ? settings::duration_text(total.time_s) : "–",
        has_any ? percent(total.time_s / std::max(recording.duration_s(), 1e-9)) : "–",
        has_any ? settings::duration_text(total.longest_s) : "–", meaning_of(static_cast<RecordedState>(i)));
  }
  page.add(
      "</tbody></table>\n"
      "<p class=\"quiet\">A sensor is stale when it has sent no reading for {:g} of its own intervals, and for at "
      "least 1 s. {} of {} readings were accepted; {} were spikes. The numbers on this page are of the accepted "
      "readings, as recorded, before calibration.</p>\n",
      recording.stale_intervals, sensor.believed, sensor.readings, sensor.spikes);
  if (sensor.unchanged_for_s > 0.0) {
    page.add(
        "<p class=\"quiet\">This sensor sends only changes (on_change): a silence of up to {} means that the wind "
        "wind "
        "is unchanged, and is not a gap.</p>\n",
        settings::duration_text(sensor.unchanged_for_s));
  }
  const auto is_gap = [](const StateEvent& event) { return event.state == RecordedState::kStale; };
  if (sensor.events.empty()) page.add("<p>No gap, and nothing else to report.</p>\n");
  add_events(page, recording, sensor, "Gaps", is_gap);
  add_events(page, recording, sensor, "Other faults", std::not_fn(is_gap));
}

}  // namespace

std::string sentence_of(const RecordingNumbers& recording, const SensorNumbers& sensor) {
  if (sensor.believed == 0) {
    return fmt::format("“{}” sent no plausible reading in {}.", page_text(sensor.name),
                       settings::duration_text(recording.duration_s()));
  }
  if (sensor.readings == 1) {
    return fmt::format("“{}” sent one reading: {}.", page_text(sensor.name), speed_text(sensor.mean_m_s));
  }
  std::string text =
      fmt::format("In {} “{}” measured a mean wind of {}", settings::duration_text(sensor.last_s - sensor.first_s),
                  page_text(sensor.name), speed_text(sensor.mean_m_s));
  if (sensor.direction_deg && sensor.steadiness.value_or(0.0) > 0.3) {
    text += fmt::format(" from the {}", compass_text(*sensor.direction_deg));
  }
  text += fmt::format(", with gusts of up to {}.", speed_text(gust_of(sensor)));
  const StateTotal& silence = sensor.states[static_cast<std::size_t>(RecordedState::kStale)];
  if (silence.count == 0) return text + " There was no gap.";
  return text + fmt::format(" It was silent {} {}, for {} in all.", silence.count,
                            silence.count == 1 ? "time" : "times", settings::duration_text(silence.time_s));
}

void add_sensor_section(PageWriter& page, const RecordingNumbers& recording, const SensorNumbers& sensor,
                        const SensorFigures& figures, bool is_first) {
  page.add("<section>\n<h2{}>{}</h2>\n", is_first ? "" : " class=\"next\"", page_text(sensor.name));
  if (sensor.believed > 0) {
    add_tiles(page, sensor);
    add_series(page, figures);
    add_rose_and_distribution(page, sensor, figures);
    if (!figures.diurnal.empty()) {
      page.add("<h3>The day</h3>\n");
      page.figure(figures.diurnal,
                  "Mean speed by the hour of the day, and between which speeds eight of ten readings are.");
    }
    add_spectrum(page, recording, sensor, figures);
  }
  add_states(page, recording, sensor);
  page.add("</section>\n");
}

}  // namespace yuragi::daemon::tools::report
