// Records numbered readings, and each second a numbered temperature, the next hundred when the last are on the disk,
// until it is killed; says on standard output how far it came. The recorder's tests kill it.
#include <chrono>
#include <cstdint>
#include <cstdio>

#include "daemon/recording/recorder.hpp"

int main(int argc, char** argv) {
  using namespace yuragi;
  if (argc != 2) return 64;
  daemon::recording::Recorder recorder(
      argv[1], {.started = {}, .software = "yuragi test", .configuration = "", .sensors = {{"mast", "", ""}}});

  for (std::int64_t i = 0;; ++i) {
    wind::Reading reading;
    reading.time.mono += std::chrono::milliseconds(5 * i);
    reading.speed_m_s = 0.001 * static_cast<double>(i % 100'000);
    if (i % 200 == 0) {
      wind::StationQuantities said;
      said.time = reading.time;
      said.air_temperature_c = static_cast<double>(i / 200 % 50);
      recorder.push(0, said);
    }
    recorder.push(0, reading);
    if (i % 100 != 0) continue;
    const auto pushed = static_cast<std::uint64_t>(i + 1);
    const auto is_written = [pushed](const daemon::recording::RecorderStatus& status) {
      return status.written == pushed;
    };
    if (!recorder.wait_until(is_written, std::chrono::seconds(60))) return 1;
    std::printf("%llu\n", static_cast<unsigned long long>(pushed));
    std::fflush(stdout);
  }
}
