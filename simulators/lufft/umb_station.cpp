#include "simulators/lufft/umb_station.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

namespace yuragi::simulators::lufft {
namespace {

constexpr char kQueryOne = 0x23;
constexpr char kQuerySeveral = 0x2F;
constexpr char kProtocolVersion = 0x10;
constexpr std::size_t kHeader = 8;
constexpr std::size_t kTail = 4;
constexpr std::size_t kUmbGarbage = 60;
constexpr std::size_t kUmbPieces = 4;
constexpr double kUmbPieceGap_s = 0.05;
/// The delay of a late reply: longer than a client should wait.
constexpr double kUmbLate_s = 1.2;
constexpr char kStatusUnknownChannel = 0x24;
constexpr char kStatusInvalidParameter = 0x11;
constexpr char kStatusUnknownCommand = 0x10;

unsigned byte_of(char c) {
  return static_cast<unsigned char>(c);
}

unsigned word_at(std::string_view bytes, std::size_t at) {
  return byte_of(bytes[at]) + 256 * byte_of(bytes[at + 1]);
}

std::string word(unsigned value) {
  return {static_cast<char>(value % 256), static_cast<char>(value / 256)};
}

unsigned mirrored(unsigned value, int bits) {
  unsigned other_way = 0;
  for (int i = 0; i < bits; ++i) other_way = (other_way << 1U) | ((value >> static_cast<unsigned>(i)) & 1U);
  return other_way;
}

/// CRC-CCITT in its textbook form, highest bit first, of bytes whose bits are in the order of the line.
unsigned umb_crc(std::string_view bytes) {
  unsigned crc = 0xFFFF;
  for (const char c : bytes) {
    crc ^= mirrored(byte_of(c), 8) << 8U;
    for (int i = 0; i < 8; ++i) crc = ((crc << 1U) ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U)) & 0xFFFFU;
  }
  return mirrored(crc, 16);
}

}  // namespace

UmbStation::UmbStation(std::unique_ptr<text::Wire> wire, const UmbStationOptions& options, core::MeasuredWind wind)
    : wire_(std::move(wire)),
      options_(options),
      wind_(std::move(wind)),
      random_(options.garbage_seed),
      known_faults_{core::FaultKind::kSilence,     core::FaultKind::kFreeze,  core::FaultKind::kSpike,
                    core::FaultKind::kGarbage,     core::FaultKind::kSplit,   core::FaultKind::kPartial,
                    core::FaultKind::kBadChecksum, core::FaultKind::kWrongId, core::FaultKind::kLate,
                    core::FaultKind::kException} {
  const auto more = wire_->known_faults();
  known_faults_.insert(known_faults_.end(), more.begin(), more.end());
}

void UmbStation::serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) {
  fault_ = fault;
  if (fault == core::FaultKind::kDisconnect || fault == core::FaultKind::kUnplug) {
    wire_->take_away();
    waiting_.clear();
    received_.clear();
    return;
  }
  wire_->bring_back();
  moment_ = wind_.at(time_s, fault);
  const std::string bytes = wire_->read(ready);
  if (options_.echoes && !bytes.empty()) wire_->write(bytes);
  received_ += bytes;
  take_requests(time_s, fault);
  while (!waiting_.empty() && waiting_.front().time_s <= time_s) {
    wire_->write(waiting_.front().bytes);
    waiting_.pop_front();
  }
}

/// Replies to whole frames to this device and ignores everything else.
void UmbStation::take_requests(double time_s, std::optional<core::FaultKind> fault) {
  while (true) {
    received_.erase(0, std::min(received_.find('\x01'), received_.size()));
    if (received_.size() < kHeader) return;
    const std::size_t size = kHeader + byte_of(received_[6]) + kTail;
    if (received_[1] != kProtocolVersion || received_[7] != '\x02') {
      received_.erase(0, 1);
      continue;
    }
    if (received_.size() < size) return;
    const std::string request = received_.substr(0, size);
    const bool is_whole = request[size - 4] == '\x03' && request[size - 1] == '\x04' &&
                          umb_crc(request.substr(0, size - 3)) == word_at(request, size - 3);
    received_.erase(0, is_whole ? size : 1);
    if (!is_whole || word_at(request, 2) != options_.device_class * 4096 + options_.id) continue;
    const std::string reply = reply_to(std::string_view(request).substr(kHeader, size - kHeader - kTail), fault);
    send(frame(reply, request.substr(4, 2), fault), time_s, fault);
  }
}

/// Returns the content of a reply, between STX and ETX, for the content of a request.
std::string UmbStation::reply_to(std::string_view command, std::optional<core::FaultKind> fault) {
  const std::string head{command[0], kProtocolVersion};
  const std::string_view asked = command.substr(std::min<std::size_t>(command.size(), 2));
  const bool is_one = command[0] == kQueryOne && asked.size() == 2;
  const bool is_several =
      command[0] == kQuerySeveral && !asked.empty() && asked.size() == 1 + 2 * std::size_t{byte_of(asked[0])};
  if (!is_one && !is_several) return head + kStatusUnknownCommand;
  ++queries_;
  const bool is_too_long = options_.refuses_long_query && asked.size() > 5;
  if (fault == core::FaultKind::kException || is_too_long) return head + kStatusInvalidParameter;
  if (is_one) return head + channel(word_at(asked, 0));
  std::string reply = head + '\0' + asked[0];
  for (std::size_t at = 1; at < asked.size(); at += 2) {
    const std::string said = channel(word_at(asked, at));
    reply += static_cast<char>(said.size());
    reply += said;
  }
  return reply;
}

/// Status, number, type (float) and value.
std::string UmbStation::channel(unsigned number) const {
  const auto value = measured(number);
  if (!value) return kStatusUnknownChannel + word(number);
  const auto single = static_cast<float>(*value);
  std::string bytes(sizeof single, '\0');
  std::memcpy(bytes.data(), &single, sizeof single);
  return '\0' + word(number) + '\x16' + bytes;
}

/// WS manual, 6.1, 6.3, 6.4, 6.8, 6.9, 6.12, 6.14.
std::optional<double> UmbStation::measured(unsigned number) const {
  switch (number) {
    case 400:
    case 440:
    case 460:
      return moment_.speed_m_s;
    case 500:
      return moment_.direction_deg;
    case 401:
      if (options_.has_fast_channels) return moment_.speed_m_s;
      break;
    case 501:
      if (options_.has_fast_channels) return moment_.direction_deg;
      break;
    default:
      break;
  }
  if (!options_.measures_more) return {};
  switch (number) {
    case 100:
      return 14.5;
    case 200:
      return 65.0;
    case 300:
      return 1013.25;
    case 620:
      return 7.5;
    case 820:
      return 3.0;
    default:
      return {};
  }
}

std::string UmbStation::frame(std::string_view text, std::string_view receiver,
                              std::optional<core::FaultKind> fault) const {
  const unsigned id = options_.id + (fault == core::FaultKind::kWrongId ? 1 : 0);
  std::string bytes{'\x01', kProtocolVersion};
  bytes += receiver;
  bytes += word(options_.device_class * 4096 + id);
  bytes += static_cast<char>(text.size());
  bytes += '\x02';
  bytes += text;
  bytes += '\x03';
  return bytes + word(umb_crc(bytes)) + '\x04';
}

void UmbStation::send(std::string reply, double time_s, std::optional<core::FaultKind> fault) {
  if (fault == core::FaultKind::kSilence) return;
  if (fault == core::FaultKind::kBadChecksum) reply[reply.size() - 2] = static_cast<char>(~reply[reply.size() - 2]);
  if (fault == core::FaultKind::kPartial) reply.resize(reply.size() * 2 / 3);
  if (fault == core::FaultKind::kGarbage) {
    reply.resize(kUmbGarbage);
    std::ranges::generate(reply, [this] { return static_cast<char>(random_()); });
  }
  if (fault == core::FaultKind::kLate) return send_after(kUmbLate_s, reply, time_s);
  if (fault != core::FaultKind::kSplit) return send_after(0.0, reply, time_s);
  const std::size_t size = reply.size() / kUmbPieces + 1;
  for (std::size_t piece = 0; piece * size < reply.size(); ++piece) {
    send_after(static_cast<double>(piece) * kUmbPieceGap_s, reply.substr(piece * size, size), time_s);
  }
}

/// Bytes keep their order.
void UmbStation::send_after(double delay_s, const std::string& bytes, double time_s) {
  const double due_s = time_s + delay_s;
  waiting_.push_back({waiting_.empty() ? due_s : std::max(due_s, waiting_.back().time_s), bytes});
}

std::string UmbStation::status() const {
  return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {}, {} queries{}{}", moment_.speed_m_s, moment_.direction_deg,
                     wire_->place(), queries_, fault_ ? ", fault: " : "", fault_ ? name_of(*fault_) : "");
}

}  // namespace yuragi::simulators::lufft
