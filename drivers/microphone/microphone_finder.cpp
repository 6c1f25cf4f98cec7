// The microphones of `yuragi sensors list`: listed by the worker, in a process of its own, since a sound library may
// hang while it enumerates devices.
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <unistd.h>

#include "drivers/bus/process_port.hpp"
#include "drivers/microphone/microphone_sensor.hpp"

namespace yuragi::drivers::microphone {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kProgram = "yuragi";
constexpr auto kListTimeout = std::chrono::seconds(10);
constexpr std::size_t kMaxText = 1U << 16U;

/// The output of a program until it ends, or until it takes too long.
std::string output_of(bus::BytePort& port) {
  std::string text;
  if (!port.open()) return text;
  std::array<std::uint8_t, 4096> buffer{};
  while (text.size() < kMaxText) {
    const bus::ByteArrival arrival = port.read(buffer, kListTimeout);
    if (arrival.status != bus::ByteStatus::kBytes) break;
    text.append(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(arrival.size));
  }
  port.close();
  return text;
}

/// The words of a line up to its end, with tabs between.
template <std::size_t kCount>
std::optional<std::array<std::string_view, kCount>> fields_of(std::string_view line) {
  std::array<std::string_view, kCount> fields;
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::size_t tab = i + 1 < kCount ? line.find('\t') : line.size();
    if (tab == std::string_view::npos) return std::nullopt;
    fields[i] = line.substr(0, tab);
    line.remove_prefix(std::min(line.size(), tab + 1));
  }
  return fields;
}

/// A text as a TOML string.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

/// Inputs that the system has and this user may not open: PortAudio omits them silently.
void add_forbidden(std::vector<sensor::FoundDevice>& found) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator("/dev/snd", none)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("pcm") || !name.ends_with("c")) continue;
    if (access(entry.path().c_str(), R_OK | W_OK) == 0) continue;
    found.push_back({.what = "sound input " + entry.path().string(),
                     .settings = "",
                     .trouble = "no permission to open it",
                     .remedy = "add the daemon's user to the group audio: usermod -aG audio USER"});
  }
}

}  // namespace

std::string microphone_worker_program() {
  std::error_code failure;
  const fs::path own = fs::read_symlink("/proc/self/exe", failure);
  // The link still leads to this program after an update has put another in its place.
  if (own.filename() == kProgram || own.filename() == fmt::format("{} (deleted)", kProgram)) return "/proc/self/exe";
  const fs::path beside = own.parent_path() / kProgram;
  if (access(beside.c_str(), X_OK) == 0) return beside;
  for (const char* folder : {"/usr/local/bin", "/usr/bin"}) {
    const fs::path installed = fs::path(folder) / kProgram;
    if (access(installed.c_str(), X_OK) == 0) return installed;
  }
  return beside;
}

std::vector<sensor::FoundDevice> find_microphones(const std::string& worker) {
  std::vector<sensor::FoundDevice> found;
  const auto port = bus::make_process_port({worker, "mic-worker", "--list"});
  const std::string text = output_of(*port);
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    if (const auto fields = fields_of<5>(rest.substr(0, end))) {
      const auto [host_api, channels, rate_hz, is_default, name] = *fields;
      int count = 0;
      std::from_chars(channels.data(), channels.data() + channels.size(), count);
      found.push_back({.what = fmt::format("microphone {} ({}), {} channel{}, {} Hz{}", name, host_api, channels,
                                           count == 1 ? "" : "s", rate_hz, is_default == "default" ? ", default" : ""),
                       .settings = fmt::format("device = {}\nchannels = {}", quoted(name), std::clamp(count, 1, 4)),
                       .trouble = "",
                       .remedy = ""});
    }
    rest.remove_prefix(std::min(rest.size(), end + 1));
  }
  add_forbidden(found);
  return found;
}

}  // namespace yuragi::drivers::microphone
