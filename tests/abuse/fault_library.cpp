// A library that is preloaded into a program (LD_PRELOAD) and makes its disk and its clock faulty. The numbers that say
// how are in a file that both sides map, which the environment variable YURAGI_ABUSE_FAULTS names:
//
//   int64 clock_ahead_ns    what is added to the time of day (CLOCK_REALTIME)
//   int64 write_delay_ns    how long each write to a recording takes in addition; below 0: until this is changed
//   int64 write_error       the errno that each write to a recording fails with; 0: none
//
// Only files whose names contain ".windlog" are the recording.
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

namespace {

struct Orders {
  std::atomic<std::int64_t> clock_ahead_ns;
  std::atomic<std::int64_t> write_delay_ns;
  std::atomic<std::int64_t> write_error;
};
static_assert(sizeof(Orders) == 24);

const Orders* map_orders() {
  const char* const path = std::getenv("YURAGI_ABUSE_FAULTS");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  const int file = path == nullptr ? -1 : open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) std::abort();
  const void* const memory = mmap(nullptr, sizeof(Orders), PROT_READ, MAP_SHARED, file, 0);
  close(file);
  if (memory == MAP_FAILED) std::abort();
  return static_cast<const Orders*>(memory);
}

const Orders& orders() {
  static const Orders* const mapped = map_orders();
  return *mapped;
}

template <class Function>
Function* original(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

bool is_of_a_recording(int file) {
  char link[64];
  char path[4096];
  std::snprintf(link, sizeof(link), "/proc/self/fd/%d", file);
  const ssize_t size = readlink(link, path, sizeof(path) - 1);
  if (size < 0) return false;
  path[size] = '\0';
  return std::strstr(path, ".windlog") != nullptr;
}

/// What is to happen before a write; false where it is to fail, with errno set.
bool may_write(int file) {
  if (orders().write_delay_ns == 0 && orders().write_error == 0) return true;
  if (!is_of_a_recording(file)) return true;
  constexpr long kLook_ns = 10'000'000;
  for (std::int64_t waited_ns = 0;; waited_ns += kLook_ns) {
    const std::int64_t delay_ns = orders().write_delay_ns;
    if (delay_ns >= 0 && waited_ns >= delay_ns) break;
    const timespec look{0, kLook_ns};
    nanosleep(&look, nullptr);
  }
  const std::int64_t error = orders().write_error;
  if (error != 0) errno = static_cast<int>(error);
  return error == 0;
}

/// As clock_gettime(), of the clock that is ahead.
int read_clock(clockid_t clock, timespec* time) {
  static auto* const real = original<int(clockid_t, timespec*)>("clock_gettime");
  const int result = real(clock, time);
  if (result != 0 || (clock != CLOCK_REALTIME && clock != CLOCK_REALTIME_COARSE)) return result;
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t ahead_ns = orders().clock_ahead_ns;
  const std::int64_t now_ns = std::int64_t{time->tv_sec} * kSecond_ns + time->tv_nsec + ahead_ns;
  time->tv_sec = now_ns / kSecond_ns;
  time->tv_nsec = now_ns % kSecond_ns;
  return 0;
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  return read_clock(clock, time);
}

int gettimeofday(timeval* time, void*) noexcept {
  timespec now{};
  read_clock(CLOCK_REALTIME, &now);
  *time = {now.tv_sec, now.tv_nsec / 1000};
  return 0;
}

time_t time(time_t* result) noexcept {
  timespec now{};
  read_clock(CLOCK_REALTIME, &now);
  if (result != nullptr) *result = now.tv_sec;
  return now.tv_sec;
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t offset) {
  static auto* const real = original<ssize_t(int, const void*, size_t, off64_t)>("pwrite64");
  return may_write(file) ? real(file, bytes, size, offset) : -1;
}

ssize_t pwrite(int file, const void* bytes, size_t size, off_t offset) {
  return pwrite64(file, bytes, size, offset);
}

ssize_t write(int file, const void* bytes, size_t size) {
  static auto* const real = original<ssize_t(int, const void*, size_t)>("write");
  return may_write(file) ? real(file, bytes, size) : -1;
}

int fsync(int file) {
  static auto* const real = original<int(int)>("fsync");
  return may_write(file) ? real(file) : -1;
}

int fdatasync(int file) {
  static auto* const real = original<int(int)>("fdatasync");
  return may_write(file) ? real(file) : -1;
}

int ftruncate64(int file, off64_t size) noexcept {
  static auto* const real = original<int(int, off64_t)>("ftruncate64");
  return may_write(file) ? real(file, size) : -1;
}

}  // extern "C"
