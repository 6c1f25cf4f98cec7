#include "simulators/davis/vantage_console.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace yuragi::simulators::davis {
namespace {

constexpr char kAck = '\x06';
constexpr char kNak = '\x21';
constexpr const char* kAwake = "\n\r";
constexpr double kSleepsAfter_s = 120.0;
constexpr double kMphOfOneMetrePerSecond = 3600.0 / 1609.344;
constexpr std::size_t kMaxCommand = 64;
constexpr std::size_t kConsoleGarbage = 99;
constexpr std::size_t kConsolePieces = 4;
constexpr double kConsolePieceGap_s = 0.1;
/// The delay of a late reply: longer than a client should wait.
constexpr double kConsoleLate_s = 3.0;

/// The checksum of the manual's chapter XII, here by halves of bytes.
std::uint16_t crc_ccitt(std::string_view bytes) {
  std::uint16_t crc = 0;
  const auto add = [&crc](unsigned half) {
    const unsigned top = (crc >> 12U) ^ half;
    crc = static_cast<std::uint16_t>((static_cast<unsigned>(crc) << 4U) ^ (top * 0x1021U));
  };
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    add(byte >> 4U);
    add(byte & 0x0FU);
  }
  return crc;
}

std::string with_crc(std::string bytes) {
  const std::uint16_t crc = crc_ccitt(bytes);
  bytes += static_cast<char>(crc >> 8U);
  bytes += static_cast<char>(crc & 0xFFU);
  return bytes;
}

void put_word(std::string& packet, std::size_t at, long value) {
  packet[at] = static_cast<char>(value & 0xFF);
  packet[at + 1] = static_cast<char>((value >> 8) & 0xFF);
}

}  // namespace

VantageConsole::VantageConsole(std::unique_ptr<text::Wire> wire, const VantageConsoleOptions& options,
                               core::MeasuredWind wind)
    : wire_(std::move(wire)),
      options_(options),
      wind_(std::move(wind)),
      random_(options.garbage_seed),
      known_faults_{core::FaultKind::kSilence,     core::FaultKind::kFreeze, core::FaultKind::kSpike,
                    core::FaultKind::kGarbage,     core::FaultKind::kSplit,  core::FaultKind::kPartial,
                    core::FaultKind::kBadChecksum, core::FaultKind::kLate,   core::FaultKind::kException} {
  const auto more = wire_->known_faults();
  known_faults_.insert(known_faults_.end(), more.begin(), more.end());
}

void VantageConsole::serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) {
  fault_ = fault;
  if (fault == core::FaultKind::kDisconnect || fault == core::FaultKind::kUnplug) {
    wire_->take_away();
    waiting_.clear();
    command_.clear();
    packets_left_ = 0;
    is_awake_ = false;
    return;
  }
  wire_->bring_back();

  receive(wire_->read(ready), time_s, fault);
  for (; packets_left_ > 0 && next_packet_s_ <= time_s; next_packet_s_ += options_.interval_s) {
    send_packet(next_packet_s_, fault);
  }
  while (!waiting_.empty() && waiting_.front().time_s <= time_s) {
    wire_->write(waiting_.front().bytes);
    waiting_.pop_front();
  }
  if (packets_left_ == 0 && time_s - last_command_s_ >= kSleepsAfter_s) is_awake_ = false;
}

/// Bytes that wake it are lost; a command ends with LF or CR, and an empty one ends the packets.
void VantageConsole::receive(std::string_view bytes, double time_s, std::optional<core::FaultKind> fault) {
  for (const char c : bytes) {
    last_command_s_ = time_s;
    if (!std::exchange(is_awake_, true)) continue;
    if (c == '\n' || c == '\r') {
      obey(std::exchange(command_, ""), time_s, fault);
    } else if (command_.size() < kMaxCommand) {
      command_ += c;
    }
  }
}

void VantageConsole::obey(const std::string& command, double time_s, std::optional<core::FaultKind> fault) {
  packets_left_ = 0;
  if (command.empty()) return reply(kAwake, time_s, fault);
  if (fault == core::FaultKind::kException) return reply({kNak}, time_s, fault);
  if (command == "TEST") return reply(std::string(kAwake) + "TEST" + kAwake, time_s, fault);
  if (command == "EEBRD 2B 01") {
    return reply(kAck + with_crc({static_cast<char>(options_.setup_bits)}), time_s, fault);
  }
  if (!begin_packets(command, time_s)) return reply({kNak}, time_s, fault);
  reply({kAck}, time_s, fault);
}

bool VantageConsole::begin_packets(const std::string& command, double time_s) {
  unsigned kinds = 1;
  int count = 0;
  int size = 0;
  const bool is_loop = std::sscanf(command.c_str(), "LOOP %d%n", &count, &size) == 1;
  const bool is_lps =
      !is_loop && options_.knows_lps && std::sscanf(command.c_str(), "LPS %u %d%n", &kinds, &count, &size) == 2;
  if ((!is_loop && !is_lps) || static_cast<std::size_t>(size) != command.size()) return false;
  if (kinds < 1 || kinds > 3 || count < 1) return false;
  packets_left_ = count;
  packet_kinds_ = kinds;
  is_loop2_next_ = kinds == 2;
  next_packet_s_ = time_s;
  return true;
}

void VantageConsole::send_packet(double time_s, std::optional<core::FaultKind> fault) {
  --packets_left_;
  moment_ = wind_.at(time_s, fault);
  if (fault == core::FaultKind::kSilence) return;
  std::string bytes = packet(is_loop2_next_);
  if (packet_kinds_ == 3) is_loop2_next_ = !is_loop2_next_;
  ++sent_;
  if (fault == core::FaultKind::kBadChecksum) bytes.back() = static_cast<char>(~bytes.back());
  if (fault == core::FaultKind::kPartial) bytes.resize(bytes.size() * 2 / 3);
  if (fault == core::FaultKind::kGarbage) {
    bytes.resize(kConsoleGarbage);
    std::ranges::generate(bytes, [this] { return static_cast<char>(random_()); });
  }
  if (fault != core::FaultKind::kSplit) return send_after(0.0, bytes, time_s);
  const std::size_t size = bytes.size() / kConsolePieces + 1;
  for (std::size_t piece = 0; piece * size < bytes.size(); ++piece) {
    send_after(static_cast<double>(piece) * kConsolePieceGap_s, bytes.substr(piece * size, size), time_s);
  }
}

/// The manual's chapter X, sections 1 and 2.
std::string VantageConsole::packet(bool is_loop2) const {
  std::string bytes(95, '\xFF');
  bytes.replace(0, 5, std::string("LOO\0", 4) + (is_loop2 ? '\x01' : '\0'));
  const double speed_mph = moment_.speed_m_s * kMphOfOneMetrePerSecond;
  const long direction_deg = std::lround(moment_.direction_deg) % 360;
  put_word(bytes, 5, is_loop2 ? 0x7FFF : 1203);
  put_word(bytes, 7, 29921);  // inHg / 1000
  put_word(bytes, 9, 718);
  bytes[11] = 41;
  put_word(bytes, 12, 581);  // 0.1 degrees Fahrenheit
  bytes[14] = static_cast<char>(std::lround(std::min(speed_mph, 254.0)));
  put_word(bytes, 16, direction_deg == 0 ? 360 : direction_deg);
  bytes[33] = 65;
  put_word(bytes, 41, 15);  // tips an hour
  put_word(bytes, 50, 37);  // tips since midnight
  if (is_loop2) {
    put_word(bytes, 18, std::lround(10.0 * speed_mph));
    put_word(bytes, 20, std::lround(10.0 * speed_mph));
    put_word(bytes, 22, std::lround(std::ceil(speed_mph)));
    put_word(bytes, 24, direction_deg == 0 ? 360 : direction_deg);
  } else {
    bytes[15] = bytes[14];
  }
  return with_crc(bytes + kAwake);
}

void VantageConsole::reply(const std::string& bytes, double time_s, std::optional<core::FaultKind> fault) {
  if (fault == core::FaultKind::kSilence) return;
  send_after(fault == core::FaultKind::kLate ? kConsoleLate_s : 0.0, bytes, time_s);
}

/// Bytes keep their order.
void VantageConsole::send_after(double delay_s, const std::string& bytes, double time_s) {
  const double due_s = time_s + delay_s;
  waiting_.push_back({waiting_.empty() ? due_s : std::max(due_s, waiting_.back().time_s), bytes});
}

std::string VantageConsole::status() const {
  return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {}, {}, {} packets sent{}{}", moment_.speed_m_s,
                     moment_.direction_deg, wire_->place(),
                     packets_left_ > 0 ? "sending"
                     : is_awake_       ? "awake"
                                       : "asleep",
                     sent_, fault_ ? ", fault: " : "", fault_ ? name_of(*fault_) : "");
}

}  // namespace yuragi::simulators::davis
