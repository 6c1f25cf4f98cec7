// Records numbered readings, 200 a second, until it is killed; says on standard output how far it came. The recorder's
// tests kill it.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <thread>

#include "daemon/recording/recorder.hpp"

int main(int argc, char** argv) {
  using namespace yuragi;
  if (argc != 2) return 64;
  Recorder recorder(argv[1],
                    {.started = {}, .software = "yuragi test", .configuration = "", .sensors = {{"mast", "", ""}}});

  std::uint64_t reported = 0;
  for (std::int64_t i = 0;; ++i) {
    WindReading reading;
    reading.time.mono += std::chrono::milliseconds(5 * i);
    reading.speed_m_s = 0.001 * static_cast<double>(i % 100'000);
    recorder.push(0, reading);
    const std::uint64_t written = recorder.status().written;
    if (written != reported) std::printf("%llu\n", static_cast<unsigned long long>(written));
    if (written != reported) std::fflush(stdout);
    reported = written;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}
