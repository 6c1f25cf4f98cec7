#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/report/measure_recording.hpp"
#include "tests/drivers/windlog/windlog_samples.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::test {

/// Readings `interval_ms` apart, from 0 on, with the speed and direction that a function of the index gives.
template <class Make>
std::vector<wind::Reading> made_readings(std::size_t count, std::int64_t interval_ms, Make&& make) {
  std::vector<wind::Reading> readings;
  for (std::size_t i = 0; i < count; ++i) {
    wind::Reading reading = reading_at(interval_ms * static_cast<std::int64_t>(i), 0.0);
    make(i, reading);
    readings.push_back(reading);
  }
  return readings;
}

/// The numbers of a recording of one sensor.
inline daemon::tools::report::RecordingNumbers numbers_of(const std::vector<wind::Reading>& readings,
                                                          const daemon::tools::report::Settings& settings = {},
                                                          const std::string& driver = "synthetic",
                                                          const std::string& options = "speed = 5") {
  const TemporaryFolder folder;
  write_session(folder / "a.windlog", readings, "mast", driver, options);
  auto reader = drivers::windlog::Reader::open(folder / "a.windlog");
  EXPECT_TRUE(reader);
  const auto numbers = daemon::tools::report::measure_recording(*reader, settings);
  EXPECT_TRUE(numbers) << (numbers ? "" : numbers.error().message);
  return numbers ? *numbers : daemon::tools::report::RecordingNumbers{};
}

}  // namespace yuragi::test
