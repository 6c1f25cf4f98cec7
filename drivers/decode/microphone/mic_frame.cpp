#include "drivers/decode/microphone/mic_frame.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <utility>

namespace yuragi::drivers::decode::microphone {
namespace {

constexpr std::array<std::uint8_t, 4> kMark = {'Y', 'M', 'I', 'C'};
constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kHeader = 16;
constexpr std::uint8_t kHelloKind = 1;
constexpr std::uint8_t kBlockKind = 2;
constexpr std::uint8_t kTroubleKind = 3;
constexpr std::size_t kMaxText = 1024;
constexpr double kMaxRate_hz = 1e6;

/// Fowler, Noll and Vo's FNV-1a.
std::uint32_t mic_checksum(std::span<const std::uint8_t> bytes) noexcept {
  std::uint32_t hash = 2166136261U;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 16777619U;
  return hash;
}

class PayloadWriter {
 public:
  template <std::unsigned_integral T>
  void put(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8U * i)));
  }
  void put(float value) { put(std::bit_cast<std::uint32_t>(value)); }
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  void put(const std::string& text) {
    bytes_.insert(bytes_.end(), text.begin(),
                  text.begin() + static_cast<std::ptrdiff_t>(std::min(text.size(), kMaxText)));
  }

  /// The payload with its header.
  std::vector<std::uint8_t> frame(std::uint8_t kind) const {
    PayloadWriter whole;
    whole.bytes_.assign(kMark.begin(), kMark.end());
    whole.put(kVersion);
    whole.put(kind);
    whole.put(std::uint16_t{0});
    whole.put(static_cast<std::uint32_t>(bytes_.size()));
    whole.put(mic_checksum(bytes_));
    whole.bytes_.insert(whole.bytes_.end(), bytes_.begin(), bytes_.end());
    return std::move(whole.bytes_);
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// Reads the payload; returns 0 beyond the end, and remembers that.
class PayloadReader {
 public:
  explicit PayloadReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <std::unsigned_integral T>
  T take() {
    if (bytes_.size() < sizeof(T)) {
      is_short_ = true;
      bytes_ = {};
      return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) value |= static_cast<std::uint64_t>(bytes_[i]) << (8U * i);
    bytes_ = bytes_.subspan(sizeof(T));
    return static_cast<T>(value);
  }
  float take_float() { return std::bit_cast<float>(take<std::uint32_t>()); }
  double take_double() { return std::bit_cast<double>(take<std::uint64_t>()); }
  std::string take_text() {
    std::string text(bytes_.begin(), bytes_.end());
    bytes_ = {};
    for (char& c : text) {
      if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';  // it goes to logs and terminals
    }
    return text;
  }

  bool is_short() const { return is_short_; }
  bool is_at_end() const { return bytes_.empty(); }

 private:
  std::span<const std::uint8_t> bytes_;
  bool is_short_ = false;
};

bool is_shape(std::uint8_t channels, std::uint8_t bands) noexcept {
  return channels >= 1 && channels <= kMicMaxChannels && bands >= 1 && bands <= kMicMaxBands;
}

Result<MicFrame, Refusal> decode_hello(PayloadReader payload) {
  MicHello hello;
  hello.rate_hz = payload.take_double();
  hello.channels = payload.take<std::uint8_t>();
  hello.bands = payload.take<std::uint8_t>();
  hello.high_bins = payload.take<std::uint16_t>();
  if (payload.is_short()) return Refusal::kTooShort;
  if (!is_shape(hello.channels, hello.bands)) return Refusal::kInvalid;
  if (!(hello.rate_hz > 0.0 && hello.rate_hz <= kMaxRate_hz)) return Refusal::kInvalid;
  for (std::size_t band = 0; band < hello.bands; ++band) hello.bins[band] = payload.take<std::uint16_t>();
  if (payload.is_short()) return Refusal::kTooShort;
  if (std::count(hello.bins.begin(), hello.bins.begin() + hello.bands, 0) != 0) return Refusal::kInvalid;
  hello.device = payload.take_text();
  return MicFrame(std::move(hello));
}

/// Every number of a block that is a power or a part of something.
bool is_sane(const MicChannel& channel) noexcept {
  const auto is_power = [](float value) { return std::isfinite(value) && value >= 0.0F; };
  return std::ranges::all_of(channel.power, is_power) && is_power(channel.high_power) &&
         is_power(channel.total_power) && is_power(channel.peak) && is_power(channel.clipped) &&
         channel.clipped <= 1.0F;
}

Result<MicFrame, Refusal> decode_block(PayloadReader payload, const MicHello& hello) {
  MicBlock block;
  block.end_sample = payload.take<std::uint64_t>();
  block.end_mono_ns = static_cast<std::int64_t>(payload.take<std::uint64_t>());
  block.lost_samples = payload.take<std::uint32_t>();
  block.invalid_samples = payload.take<std::uint32_t>();
  block.segments = payload.take<std::uint16_t>();
  const auto channels = payload.take<std::uint8_t>();
  const auto bands = payload.take<std::uint8_t>();
  if (payload.is_short()) return Refusal::kTooShort;
  if (channels != hello.channels || bands != hello.bands) return Refusal::kNotMine;

  for (std::size_t i = 0; i < channels; ++i) {
    MicChannel& channel = block.channels[i];
    channel.high_power = payload.take_float();
    channel.total_power = payload.take_float();
    channel.clipped = payload.take_float();
    channel.peak = payload.take_float();
    for (std::size_t band = 0; band < bands; ++band) channel.power[band] = payload.take_float();
  }
  bool is_finite = true;
  for (std::size_t pair = 0; pair < mic_pair_count(channels); ++pair) {
    for (std::size_t band = 0; band < bands; ++band) {
      const float real = payload.take_float();
      const float imaginary = payload.take_float();
      is_finite = is_finite && std::isfinite(real) && std::isfinite(imaginary);
      block.cross[pair][band] = {real, imaginary};
    }
  }
  if (payload.is_short()) return Refusal::kTooShort;
  if (!payload.is_at_end()) return Refusal::kMalformed;
  if (!is_finite || block.segments == 0 || !std::ranges::all_of(block.channels, is_sane)) return Refusal::kInvalid;
  return MicFrame(block);
}

}  // namespace

std::vector<std::uint8_t> encode_mic_frame(const MicHello& hello) {
  PayloadWriter payload;
  payload.put(hello.rate_hz);
  payload.put(hello.channels);
  payload.put(hello.bands);
  payload.put(hello.high_bins);
  for (std::size_t band = 0; band < hello.bands; ++band) payload.put(hello.bins[band]);
  payload.put(hello.device);
  return payload.frame(kHelloKind);
}

std::vector<std::uint8_t> encode_mic_frame(const MicBlock& block, const MicHello& hello) {
  PayloadWriter payload;
  payload.put(block.end_sample);
  payload.put(static_cast<std::uint64_t>(block.end_mono_ns));
  payload.put(block.lost_samples);
  payload.put(block.invalid_samples);
  payload.put(block.segments);
  payload.put(hello.channels);
  payload.put(hello.bands);
  for (std::size_t i = 0; i < hello.channels; ++i) {
    const MicChannel& channel = block.channels[i];
    payload.put(channel.high_power);
    payload.put(channel.total_power);
    payload.put(channel.clipped);
    payload.put(channel.peak);
    for (std::size_t band = 0; band < hello.bands; ++band) payload.put(channel.power[band]);
  }
  for (std::size_t pair = 0; pair < mic_pair_count(hello.channels); ++pair) {
    for (std::size_t band = 0; band < hello.bands; ++band) {
      payload.put(block.cross[pair][band].real());
      payload.put(block.cross[pair][band].imag());
    }
  }
  return payload.frame(kBlockKind);
}

std::vector<std::uint8_t> encode_mic_frame(const MicTrouble& trouble) {
  PayloadWriter payload;
  payload.put(trouble.message);
  return payload.frame(kTroubleKind);
}

void MicFrameReader::push(std::span<const std::uint8_t> bytes) {
  waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
}

void MicFrameReader::clear() {
  waiting_.clear();
  hello_.reset();
}

std::optional<MicFrameReader::Item> MicFrameReader::next() {
  // Bytes that are not the mark, or its beginning, are skipped up to the next mark.
  const auto begins_a_mark = [this](const std::deque<std::uint8_t>::iterator& at) {
    const auto rest = std::min<std::ptrdiff_t>(waiting_.end() - at, kMark.size());
    return std::equal(at, at + rest, kMark.begin());
  };
  auto mark = waiting_.begin();
  while (mark != waiting_.end() && !begins_a_mark(mark)) ++mark;
  if (mark != waiting_.begin()) {
    waiting_.erase(waiting_.begin(), mark);
    return Item{Refusal::kMalformed, {}};
  }
  if (waiting_.size() < kHeader) return std::nullopt;

  std::array<std::uint8_t, kHeader> header{};
  std::copy_n(waiting_.begin(), kHeader, header.begin());
  const std::span<const std::uint8_t> header_bytes(header);
  PayloadReader fields(header_bytes.subspan(kMark.size()));
  const auto version = fields.take<std::uint8_t>();
  const auto kind = fields.take<std::uint8_t>();
  fields.take<std::uint16_t>();
  const auto size = fields.take<std::uint32_t>();
  const auto checksum = fields.take<std::uint32_t>();
  if (version != kVersion || kind < kHelloKind || kind > kTroubleKind || size > kMicMaxPayload) {
    waiting_.pop_front();  // not a header after all: search for the mark after this one
    return Item{Refusal::kMalformed, {}};
  }
  if (waiting_.size() < kHeader + size) return std::nullopt;

  const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(kHeader + size);
  std::vector<std::uint8_t> bytes(waiting_.begin(), end);
  const std::span<const std::uint8_t> payload = std::span(bytes).subspan(kHeader);
  if (mic_checksum(payload) != checksum) {
    waiting_.pop_front();  // the size can be wrong, and a frame can begin within it
    return Item{Refusal::kBadChecksum, std::move(bytes)};
  }
  waiting_.erase(waiting_.begin(), end);
  auto frame = decode(kind, payload);
  return Item{std::move(frame), std::move(bytes)};
}

Result<MicFrame, Refusal> MicFrameReader::decode(std::uint8_t kind, std::span<const std::uint8_t> payload) {
  if (kind == kTroubleKind) return MicFrame(MicTrouble{PayloadReader(payload).take_text()});
  if (kind == kHelloKind) {
    auto frame = decode_hello(PayloadReader(payload));
    if (frame) hello_ = std::get<MicHello>(*frame);
    return frame;
  }
  if (!hello_) return Refusal::kNotMine;
  return decode_block(PayloadReader(payload), *hello_);
}

}  // namespace yuragi::drivers::decode::microphone
