// A recording of which any bytes were changed, and any part cut off: the reader gives plausible readings, or a failure;
// a player that is told anything gives plausible readings whose time does not go back, or a failure.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

#include <unistd.h>

#include "drivers/windlog/verify_recording.hpp"
#include "drivers/windlog/windlog_player.hpp"
#include "drivers/windlog/windlog_reader.hpp"
#include "drivers/windlog/windlog_writer.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::drivers;

const std::filesystem::path& scratch_file() {
  static const std::filesystem::path kFile =
      std::filesystem::temp_directory_path() / ("yuragi-fuzz-" + std::to_string(getpid()) + ".windlog");
  return kFile;
}

std::string make_recording() {
  std::filesystem::remove(scratch_file());
  {
    auto writer = windlog::Writer::open(scratch_file());
    if (!writer) std::abort();
    for (int session = 0; session < 2; ++session) {
      if (!writer->begin_session({{}, "fuzz", ""})) std::abort();
      const auto sensor = writer->add_sensor("mast", "fuzz", "");
      for (int i = 0; i < 150; ++i) {
        wind::Reading reading;
        reading.time.mono += std::chrono::milliseconds(100 * i);
        reading.direction_deg = i;
        if (!writer->append(*sensor, reading)) std::abort();
        wind::StationQuantities quantities;
        quantities.time = reading.time;
        quantities.air_temperature_c = 20.0;
        if (!writer->append(*sensor, quantities)) std::abort();
      }
    }
  }
  std::ifstream in(scratch_file(), std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Plays the scratch file; each byte is an order, and the last ones are a place to seek to as well.
void play_anything(std::span<const std::uint8_t> orders) {
  Instant now{MonoTime(std::chrono::hours(1)), UtcTime(std::chrono::hours(500'000))};
  MonoTime last = now.mono;
  const auto use = [&](const wind::Reading& reading) {
    if (!wind::is_plausible(reading) || reading.time.mono < last) std::abort();
    last = reading.time.mono;
  };
  const std::string place(orders.begin(), orders.begin() + static_cast<std::ptrdiff_t>(orders.size() % 12));
  static_cast<void>(windlog::parse_utc_offset(place));
  auto opened = windlog::Player::open(
      scratch_file(),
      {.playback = {.loop = orders.size() % 2 == 0, .sensor = "*"}, .at_time_of_day = orders.size() % 3 == 0}, now);
  if (!opened) return;
  windlog::Player& player = *opened;
  for (const std::uint8_t order : orders.first(std::min<std::size_t>(orders.size(), 64))) {
    switch (order % 8) {
      case 0:
        player.pause(now);
        break;
      case 1:
        player.resume(now);
        break;
      case 2:
        static_cast<void>(player.step(now, 1 + order / 8));
        break;
      case 3:
        static_cast<void>(player.seek(now, std::to_string(order / 8)));
        break;
      case 4:
        static_cast<void>(player.seek(now, place));
        break;
      case 5:
        player.set_rate(now, 0.25 * (1 + order / 8));
        break;
      default:
        break;
    }
    static_cast<void>(player.play(now, use));
    now.mono += std::chrono::milliseconds(10 * order);
    now.utc += std::chrono::milliseconds(10 * order);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string kWhole = make_recording();
  std::string bytes = kWhole;

  // Two bytes cut the file, if they are small enough; then each four are an offset and what to write there.
  if (size >= 2) {
    const std::size_t length = (static_cast<std::size_t>(data[0]) << 8 | data[1]) * 2;
    if (length < bytes.size()) bytes.resize(length);
  }
  for (std::size_t i = 2; i + 4 <= size && !bytes.empty(); i += 4) {
    const std::size_t offset =
        static_cast<std::size_t>(data[i]) << 16 | static_cast<std::size_t>(data[i + 1]) << 8 | data[i + 2];
    bytes[offset % bytes.size()] = static_cast<char>(data[i + 3]);
  }
  std::ofstream(scratch_file(), std::ios::binary | std::ios::trunc) << bytes;

  play_anything(std::span(data, size));
  static_cast<void>(windlog::verify_recording(scratch_file(), std::chrono::seconds(1)));

  auto reader = windlog::Reader::open(scratch_file());
  if (!reader) return 0;
  const auto use_quantities = [&](const windlog::LoggedQuantities& logged) {
    if (!wind::plausible_part(logged.quantities) || logged.sensor >= reader->sensors().size()) std::abort();
  };
  static_cast<void>(reader->each_quantities(std::chrono::seconds(size % 20), Nanoseconds::max(), use_quantities));
  reader->seek(std::chrono::seconds(size % 40));
  static_cast<void>(reader->log_time_of(UtcTime{}));
  for (;;) {
    const auto logged = reader->next();
    if (!logged || !*logged) return 0;
    if (!wind::is_plausible((*logged)->reading) || (*logged)->sensor >= reader->sensors().size()) std::abort();
  }
}
