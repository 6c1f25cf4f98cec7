// yuragi-recording-bench: how long it takes to open a recording, to find a place in it and to begin to play it, by its
// number of readings; and how many bytes a reading takes.
//
//   yuragi-recording-bench [FOLDER [MOST]]     recordings of 10^5 readings and more, up to MOST (default 10^6), in
//   FOLDER
//
// Each recording has a sensor that speaks ten times a second, and one that was heard ten times on the first day only:
// whoever plays the second must not have to look through the first.
//
// Measured with FOLDER on a local disk and MOST = 100000000, on two cores that other work used meanwhile, to which
// single times of more than 5 ms are due (the next run had 0.32, 0.82 and 4.93 ms in the place of the first three):
//
//     readings    bytes   open, ms   seldom, ms     seek   moment  begin to play
//       100000     32.5       0.99        18.05     0.21     0.39          15.21
//      1000000     32.6       2.04         0.36     0.12     0.31           4.78
//     10000000     33.1       1.51         0.55     1.41     8.98           1.19
//    100000000     33.6       1.34         0.43     0.13     2.06           0.73
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>

#include <fmt/format.h>

#include "drivers/windlog/windlog_player.hpp"
#include "drivers/windlog/windlog_writer.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::drivers;

const Instant kStart{MonoTime(std::chrono::hours(1)), UtcTime(std::chrono::hours(490'000))};
constexpr Nanoseconds kInterval = std::chrono::milliseconds(100);

wind::Reading reading_at(std::int64_t number) {
  wind::Reading reading;
  reading.time = {kStart.mono + number * kInterval, kStart.utc + number * kInterval};
  reading.speed_m_s = 3.0 + 0.001 * static_cast<double>(number % 1000);
  reading.direction_deg = 0.3 * static_cast<double>(number % 1000);
  return reading;
}

void write_recording(const std::filesystem::path& file, std::int64_t count) {
  constexpr std::int64_t kReadingsPerCommit = 100'000;
  auto writer = windlog::Writer::open(file).value();
  writer.begin_session({kStart, "yuragi-recording-bench", ""}).value();
  const std::int64_t often = writer.add_sensor("often", "simulated", "").value();
  const std::int64_t seldom = writer.add_sensor("seldom", "simulated", "").value();
  for (std::int64_t number = 0; number < 10; ++number) writer.append(seldom, reading_at(1000 * number + 500)).value();
  for (std::int64_t number = 0; number < count; ++number) {
    writer.append(often, reading_at(number)).value();
    if (number % kReadingsPerCommit == 0) writer.commit().value();
  }
  writer.close().value();
}

double milliseconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

void measure(const std::filesystem::path& file, std::int64_t count) {
  const auto open = [&](const char* sensor) { return windlog::Cursor::open(file, sensor).value(); };
  const double often_ms = milliseconds_of([&] { open("often"); });
  const double seldom_ms = milliseconds_of([&] { open("seldom"); });
  auto cursor = open("often");
  const double seek_ms = milliseconds_of([&] {
    cursor.seek(kInterval * (count / 2));
    cursor.next().value();
  });
  const double moment_ms = milliseconds_of([&] { cursor.find(kStart.utc + kInterval * (count / 3)).value(); });
  const double play_ms = milliseconds_of([&] {
    const Instant now{MonoTime(std::chrono::hours(5)), kStart.utc + std::chrono::hours(24 * 400)};
    auto player =
        windlog::Player::open(file, {.playback = {.loop = true, .sensor = "seldom"}, .at_time_of_day = true}, now);
    player->play(now, [](const wind::Reading&) {}).value();
  });
  fmt::print("{:>12} {:>8.1f} {:>10.2f} {:>12.2f} {:>8.2f} {:>8.2f} {:>14.2f}\n", count,
             static_cast<double>(std::filesystem::file_size(file)) / static_cast<double>(count), often_ms, seldom_ms,
             seek_ms, moment_ms, play_ms);
}

/// With 100,000 readings, and ten times as many up to `most`.
void run(const std::filesystem::path& folder, std::int64_t most) {
  fmt::print("{:>12} {:>8} {:>10} {:>12} {:>8} {:>8} {:>14}\n", "readings", "bytes", "open, ms", "seldom, ms", "seek",
             "moment", "begin to play");
  for (std::int64_t count = 100'000; count <= most; count *= 10) {
    const std::filesystem::path file = folder / fmt::format("yuragi-bench-{}.windlog", count);
    std::filesystem::remove(file);
    write_recording(file, count);
    measure(file, count);
    std::filesystem::remove(file);
  }
}

}  // namespace

int main(int argument_count, char** arguments) {
  try {
    run(argument_count > 1 ? std::filesystem::path(arguments[1]) : std::filesystem::temp_directory_path(),
        argument_count > 2 ? std::atoll(arguments[2]) : 1'000'000);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "yuragi-recording-bench: %s\n", error.what());
    return 1;
  }
}
