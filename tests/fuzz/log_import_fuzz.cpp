// Any bytes as a log of messages: the import ends with plausible readings in order, or with a failure.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "daemon/tools/logs/log_import.hpp"
#include "drivers/windlog/windlog_writer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace yuragi;
  if (size == 0) return 0;
  daemon::tools::logs::Options options;
  if ((data[0] & 1) != 0) {
    options.start = UtcTime(std::chrono::seconds(1'687'730'400));
    options.interval = std::chrono::milliseconds(250);
  }
  if ((data[0] & 2) != 0) options.table.time_format = daemon::tools::csv::TimeFormat::kDayFirst;

  // Half of the inputs begin with a clock and a wind, so that those that follow are reached.
  std::string text = (data[0] & 4) != 0 ? "" : "$GPRMC,220000,A,,,,,,,250623,,\n$WIMWV,10,R,5.0,M,A\n";
  for (std::size_t i = 1; i < size; ++i) text += static_cast<char>(data[i]);

  std::istringstream in(text);
  daemon::tools::csv::Input input(in);
  MonoTime last{};
  const auto report = daemon::tools::logs::import_log(
      input, "fuzz", options, {.reading = [&](std::string_view, const wind::Reading& reading) {
        if (!drivers::windlog::is_recordable(reading) || reading.time.mono < last) std::abort();
        last = reading.time.mono;
      }});
  if (report && report->taken > report->rows) std::abort();
  return 0;
}
