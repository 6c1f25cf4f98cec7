#include "daemon/tools/report/report_page.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "daemon/tools/report/page_writer.hpp"
#include "daemon/tools/report/report_style.hpp"
#include "daemon/tools/report/report_text.hpp"
#include "daemon/tools/report/sensor_section.hpp"
#include "engine/base/version.hpp"
#include "engine/wind/wind_reading.hpp"

namespace yuragi::daemon::tools::report {
namespace {

void add_warnings(PageWriter& page, const RecordingNumbers& recording) {
  std::uint64_t simulated = 0;
  std::uint64_t readings = 0;
  for (const SensorNumbers& sensor : recording.sensors) {
    simulated += sensor.quality[static_cast<std::size_t>(wind::ReadingQuality::kSimulated)];
    readings += sensor.readings;
  }
  if (simulated > 0) {
    page.add(
        "<p class=\"warn\"><b>Simulated.</b> {} of the {} readings were simulated: this is not, or not only, real "
        "wind.</p>\n",
        simulated, readings);
  }
  if (recording.skipped > 0) {
    page.add("<p class=\"warn\">{} rows of the file cannot be readings and were skipped.</p>\n", recording.skipped);
  }
  if (recording.clock_sets > 0) {
    page.add(
        "<p class=\"warn\">The recorder's clock was set {} {} (at most by {:+.0f} s). Times on this page count from "
        "the first reading, as if the clock had not been set.</p>\n",
        recording.clock_sets, recording.clock_sets == 1 ? "time" : "times", recording.largest_clock_set_s);
  }
}

/// UTC, and local time if it differs.
std::string both_times(UtcTime moment) {
  if (local_offset(moment) == Nanoseconds{0}) return utc_text(moment) + " (local time is the same)";
  return fmt::format("{}<br>{}", utc_text(moment), local_text(moment));
}

void add_recording(PageWriter& page, const RecordingNumbers& recording, const std::string& source) {
  page.add("<table><tbody>\n");
  page.row("Recording", page_text(source));
  page.row("From", both_times(recording.first));
  page.row("To", both_times(recording.last));
  page.row("Length", settings::duration_text(recording.duration_s()));
  page.row("Readings", fmt::format("{} in {} {}", recording.readings, recording.sessions,
                                   recording.sessions == 1 ? "session" : "sessions"));
  page.add("</tbody></table>\n");

  page.add(
      "<table><thead><tr><th>Sensor</th><th>Driver</th><th class=\"n\">Readings</th><th class=\"n\">Interval</th>"
      "<th class=\"n\">Gaps</th><th>Quality</th></tr></thead><tbody>\n");
  for (const SensorNumbers& sensor : recording.sensors) {
    std::string quality;
    constexpr std::array<std::string_view, 3> kWords = {"good", "uncertain", "<b>simulated</b>"};
    for (std::size_t i = 0; i < kWords.size(); ++i) {
      if (sensor.quality[i] == 0) continue;
      if (!quality.empty()) quality += ", ";
      quality += sensor.quality[i] == sensor.readings ? std::string(kWords[i])
                                                      : fmt::format("{} {}", sensor.quality[i], kWords[i]);
    }
    page.add(
        "<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
        "class=\"n\">{}</td><td>{}</td></tr>\n",
        page_text(sensor.name), page_text(sensor.driver), sensor.readings,
        sensor.readings > 1 ? settings::duration_text(sensor.interval_s) : "–",
        sensor.states[static_cast<std::size_t>(RecordedState::kStale)].count, quality);
  }
  page.add("</tbody></table>\n");
}

}  // namespace

std::string report_page(const RecordingNumbers& recording, std::span<const SensorFigures> figures,
                        const std::string& source) {
  PageWriter page;
  page.add(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>Wind recording {}</title>\n<style>{}</style>\n</head>\n"
      "<body>\n<h1>Wind recording {}</h1>\n",
      page_text(source), kReportStyle, page_text(source));
  if (recording.readings == 0) {
    page.add("<p class=\"lead\">This recording, or the selected part of it, has no readings.</p>\n");
    add_warnings(page, recording);
  } else {
    for (const SensorNumbers& sensor : recording.sensors) {
      page.add("<p class=\"lead\">{}</p>\n", sentence_of(recording, sensor));
    }
    add_warnings(page, recording);
    add_recording(page, recording, source);
    for (std::size_t i = 0; i < recording.sensors.size(); ++i) {
      add_sensor_section(page, recording, recording.sensors[i], figures[i], i == 0);
    }
  }
  page.add(
      "<footer>Made by yuragi report, version {}. Directions are where the wind comes from, in degrees clockwise from "
      "north. Times in the figures are UTC.</footer>\n</body>\n</html>\n",
      kVersion);
  return page.take();
}

}  // namespace yuragi::daemon::tools::report
