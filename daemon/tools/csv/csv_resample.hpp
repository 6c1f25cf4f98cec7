#pragma once

#include <cstddef>
#include <cstdio>
#include <functional>
#include <string_view>

#include "daemon/tools/csv/csv_export.hpp"
#include "drivers/windlog/windlog_reader.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::csv {

inline constexpr std::string_view kResampledHeader = "utc,time_s,sensor,speed_m_s,direction_deg,gust_m_s,count";

/// So many rows a table of means can have: a recording whose clock leapt by decades would fill a disk with empty ones.
inline constexpr std::size_t kMaxResampledRows = 10'000'000;

/// Writes the means of a recording over blocks of `interval` (above 0), for each block and each sensor a row:
///
/// - utc, time_s: the block's beginning. Blocks are equally long in log time, and begin at multiples of `interval` in
///   UTC (every ten minutes: at 14:00, 14:10), by the clock of the session in which the range begins, as it was at that
///   session's end, once a machine without a battery had learnt the time;
/// - speed_m_s: the arithmetic mean of the speeds;
/// - direction_deg: where the mean vector comes from, of the readings that have a direction; empty without a wind;
/// - gust_m_s: the largest gust or speed;
/// - count: the number of readings. If it is 0, the other values are empty; nothing is interpolated.
///
/// The means of speed and direction are those of WMO-No. 8, Guide to Instruments and Methods of Observation, Volume I,
/// chapter 5 (measurement of surface wind): scalar for the speed, vectorial for the direction. Its gust is the largest
/// mean of 3 s; here it is the gust that the device reports, or its largest reading, with the averaging time of the
/// device.
///
/// Memory does not depend on the recording's length. Fails as export_csv() does, and (kUsage) if there would be more
/// than kMaxResampledRows.
Result<ExportReport, Failure> resample_csv(drivers::windlog::Reader& reader, const ExportRange& range,
                                           Nanoseconds interval, std::FILE* out,
                                           const std::function<void(std::size_t)>& progress = {});

}  // namespace yuragi::daemon::tools::csv
