// Any bytes as a CSV file, with any settings: the import ends with plausible readings in order, or with a failure.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "daemon/tools/csv/csv_import.hpp"
#include "drivers/windlog/windlog_writer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace yuragi;
  if (size == 0) return 0;
  daemon::tools::csv::ImportOptions options;
  options.direction_is_toward = (data[0] & 1) != 0;
  options.components_are_from = (data[0] & 2) != 0;
  options.direction_unit = static_cast<daemon::tools::csv::DirectionUnit>((data[0] >> 2) & 3);
  options.comment = (data[0] & 16) != 0 ? '#' : '\0';

  // Half of the inputs have a header that is understood, so that the rows are reached.
  std::string text = (data[0] & 32) != 0 ? "" : "time,speed,direction,gust\n";
  if ((data[0] & 64) != 0) text = "time;u_kn;v_kn;temp;w\n";
  if ((data[0] & 128) != 0) text = "# FF : speed (in 0.1 m/s)\n# STN,YYYYMMDD,HH,DD,FF\n";
  for (std::size_t i = 1; i < size; ++i) text += static_cast<char>(data[i]);

  std::istringstream in(text);
  MonoTime last{};
  const auto report = daemon::tools::csv::import_csv(
      in, "fuzz", options, {.reading = [&](std::string_view, const wind::Reading& reading) {
        if (!drivers::windlog::is_recordable(reading) || reading.time.mono < last) std::abort();
        last = reading.time.mono;
      }});
  if (report && report->taken > report->rows) std::abort();
  return 0;
}
