#include "engine/platform/clock_offset.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sys/timerfd.h>
#include <sys/timex.h>
#include <unistd.h>

#include "engine/platform/child_process.hpp"
#include "engine/platform/descriptor.hpp"

namespace yuragi::platform {
namespace {

constexpr time_t kPatience_s = 2;
constexpr int kEndTakes_ms = 500;  // of a program that has closed its output
constexpr std::size_t kMaxOutput_bytes = 4096;
constexpr double kMaxAge_s = 7200.0;  // of a measurement
constexpr double kMaxOffset_s = 1e9;  // more is not a time
constexpr std::size_t kTrackingWords = 14;
constexpr std::string_view kMessageType = "(uuuuittayttttbtt)";
constexpr std::size_t kMessageWords = 16;  // without the bytes of its reference
constexpr std::size_t kMaxReference_bytes = 16;
constexpr int kUnsynchronised = 3;  // leap indicator of NTP

std::vector<std::string_view> words_of(std::string_view text, char between) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.remove_suffix(1);
  std::vector<std::string_view> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(between), text.size());
    words.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

template <class Number>
std::optional<Number> number_in(std::string_view word) {
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return number;
}

/// What chronyc prints of a clock that is synchronised.
bool is_leap_status(std::string_view word) {
  return word == "Normal" || word == "Insert second" || word == "Delete second";
}

bool is_fresh(double measured_s, UtcTime now) {
  return std::abs(seconds(now.time_since_epoch()) - measured_s) <= kMaxAge_s;
}

/// A descriptor that is readable after kPatience_s.
int make_timer() {
  const int timer = ::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC);
  const itimerspec once{.it_interval = {}, .it_value = {.tv_sec = kPatience_s, .tv_nsec = 0}};
  ::timerfd_settime(timer, 0, &once, nullptr);
  return timer;
}

/// The output of a program that ends well within kPatience_s; nullopt if there is none, or it fails.
std::optional<std::string> output_of(const std::vector<std::string>& command, int interruption) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
  const Descriptor from(ends[0]);
  Descriptor to(ends[1]);
  const Descriptor nowhere(::open("/dev/null", O_WRONLY | O_CLOEXEC));
  const Descriptor timer(make_timer());
  if (timer.get() < 0 || nowhere.get() < 0) return std::nullopt;
  try {
    ChildProcess child({.command = command, .output = to.get(), .error = nowhere.get()});
    to.reset();
    std::string text;
    while (text.size() < kMaxOutput_bytes) {
      std::array<pollfd, 3> waiting{{{from.get(), POLLIN, 0}, {timer.get(), POLLIN, 0}, {interruption, POLLIN, 0}}};
      if (::poll(waiting.data(), waiting.size(), -1) < 0 && errno == EINTR) continue;
      if (waiting[1].revents != 0 || waiting[2].revents != 0 || waiting[0].revents == 0) return std::nullopt;
      std::array<char, 1024> block{};
      const ssize_t count = ::read(from.get(), block.data(), block.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) {
        const auto end = child.end(kEndTakes_ms);
        return end && end->is_good() ? std::optional(text) : std::nullopt;
      }
      text.append(block.data(), static_cast<std::size_t>(count));
    }
  } catch (const std::system_error&) {
    // It is not installed.
  }
  return std::nullopt;
}

/// The kernel's estimate, which what sets the clock has left there.
ClockOffset kernel_offset() {
  timex state{};
  const int clock = ::adjtimex(&state);
  if (clock < 0 || clock == TIME_ERROR || (state.status & STA_UNSYNC) != 0)
    return {.offset_s = std::nullopt, .source = "no time service replies"};
  if (state.esterror <= 0) return {.offset_s = std::nullopt, .source = "the time service does not report it"};
  return {.offset_s = 1e-6 * static_cast<double>(state.esterror), .source = "the kernel's estimate"};
}

}  // namespace

std::optional<double> chrony_offset_s(std::string_view line, UtcTime now) {
  const auto words = words_of(line, ',');
  if (words.size() < kTrackingWords || !is_leap_status(words[13])) return std::nullopt;
  const auto measured_s = number_in<double>(words[3]);
  const auto behind_s = number_in<double>(words[4]);
  if (!measured_s || !behind_s || !is_fresh(*measured_s, now) || !(std::abs(*behind_s) < kMaxOffset_s))
    return std::nullopt;
  return -*behind_s;
}

std::optional<double> timesyncd_offset_s(std::string_view text, UtcTime now) {
  const auto words = words_of(text, ' ');
  if (words.size() < kMessageWords || words[0] != kMessageType) return std::nullopt;
  const auto leap = number_in<int>(words[1]);
  const auto reference_bytes = number_in<std::size_t>(words[8]);
  if (!leap || *leap == kUnsynchronised || !reference_bytes || *reference_bytes > kMaxReference_bytes ||
      words.size() != kMessageWords + *reference_bytes) {
    return std::nullopt;
  }
  // Sent by us, received and sent by the server, received by us (RFC 5905), in microseconds.
  std::array<double, 4> times_s{};
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const auto time_us = number_in<std::uint64_t>(words[9 + *reference_bytes + i]);
    if (!time_us) return std::nullopt;
    times_s.at(i) = 1e-6 * static_cast<double>(*time_us);
  }
  const double offset_s = 0.5 * ((times_s[0] - times_s[1]) + (times_s[3] - times_s[2]));
  if (!is_fresh(times_s[3], now) || !(std::abs(offset_s) < kMaxOffset_s)) return std::nullopt;
  return offset_s;
}

ClockOffset read_clock_offset(UtcTime now, const ClockPrograms& programs, int interruption) {
  if (const auto line = output_of(programs.chrony, interruption)) {
    const auto offset_s = chrony_offset_s(*line, now);
    return {.offset_s = offset_s, .source = offset_s ? "chrony" : "chrony has no time from a server"};
  }
  if (const auto text = output_of(programs.timesyncd, interruption)) {
    if (const auto offset_s = timesyncd_offset_s(*text, now))
      return {.offset_s = offset_s, .source = "systemd-timesyncd, at its last measurement"};
  }
  return kernel_offset();
}

std::string text_of(const ClockOffset& offset) {
  if (!offset.offset_s) return "clock's offset unknown (" + offset.source + ")";
  const double offset_ms = 1e3 * *offset.offset_s;
  const double size_ms = std::abs(offset_ms);
  std::array<char, 32> number{};
  const auto end = std::to_chars(number.data(), number.data() + number.size(), size_ms, std::chars_format::fixed,
                                 size_ms < 10.0 ? 2 : 0);
  return "clock " + std::string(number.data(), end.ptr) + " ms " + (offset_ms < 0.0 ? "behind" : "ahead of") +
         " UTC (" + offset.source + ")";
}

}  // namespace yuragi::platform
