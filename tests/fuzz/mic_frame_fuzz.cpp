// Any bytes as what a microphone's worker says, in pieces of any size: what is read stays bounded and sane, and so does
// the wind that is made of it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "drivers/decode/microphone/mic_estimator.hpp"
#include "drivers/decode/microphone/mic_frame.hpp"
#include "engine/wind/wind_reading.hpp"

namespace {

using namespace yuragi;
using namespace yuragi::drivers;

void require_mic(bool holds) {
  if (!holds) std::abort();
}

/// FNV-1a over the payload, written into a header: so that the fuzzer gets past the checksum.
void mend_checksum(std::vector<std::uint8_t>& frame) {
  std::uint32_t hash = 2166136261U;
  for (const std::uint8_t byte : std::span(frame).subspan(16)) hash = (hash ^ byte) * 16777619U;
  for (std::size_t i = 0; i < 4; ++i) frame[12 + i] = static_cast<std::uint8_t>(hash >> (8U * i));
}

void use_block(std::optional<decode::microphone::MicEstimator>& estimator, const decode::microphone::MicBlock& block) {
  require_mic(block.segments > 0);
  if (!estimator) return;
  const auto estimate = estimator->add(block);
  if (!estimate || !*estimate) return;
  const decode::microphone::MicEstimate& wind = **estimate;
  require_mic(wind.speed_m_s >= 0.0 && wind.speed_m_s <= wind::kMaxPlausibleSpeed_m_s);
  require_mic(!wind.gust_m_s || (*wind.gust_m_s >= 0.0 && *wind.gust_m_s <= wind::kMaxPlausibleSpeed_m_s));
  require_mic(!wind.direction_deg || (*wind.direction_deg >= 0.0 && *wind.direction_deg < 360.0));
  require_mic(std::isfinite(wind.level_db));
}

void read_frames(std::span<const std::uint8_t> bytes, std::size_t piece_size) {
  decode::microphone::MicFrameReader reader;
  std::optional<decode::microphone::MicEstimator> estimator;
  while (!bytes.empty()) {
    const auto piece = bytes.first(std::min(piece_size, bytes.size()));
    bytes = bytes.subspan(piece.size());
    reader.push(piece);
    while (const auto item = reader.next()) {
      if (!item->frame) continue;
      if (const auto* hello = std::get_if<decode::microphone::MicHello>(&*item->frame)) {
        require_mic(hello->channels >= 1 && hello->channels <= decode::microphone::kMicMaxChannels);
        require_mic(hello->bands >= 1 && hello->bands <= decode::microphone::kMicMaxBands);
        decode::microphone::MicEstimatorOptions options;
        if (hello->channels == 3) options.faces_deg = {0.0, 120.0, 240.0};
        estimator.emplace(options, *hello);
      } else if (const auto* block = std::get_if<decode::microphone::MicBlock>(&*item->frame)) {
        use_block(estimator, *block);
      }
    }
    require_mic(reader.waiting_bytes() <= decode::microphone::kMicMaxPayload + 16);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
  if (size < 3) return 0;
  const std::size_t piece_size = 1U + data[0];
  const std::uint8_t channels = data[1];
  const std::uint8_t bands = data[2];
  const std::span<const std::uint8_t> rest(data + 3, size - 3);
  read_frames(rest, piece_size);

  // The same as the payload of a block, after a hello of that shape: all the numbers are the fuzzer's.
  decode::microphone::MicHello hello;
  hello.rate_hz = 48000.0;
  hello.channels = static_cast<std::uint8_t>(1 + channels % decode::microphone::kMicMaxChannels);
  hello.bands = static_cast<std::uint8_t>(1 + bands % decode::microphone::kMicMaxBands);
  hello.bins.fill(2);
  hello.high_bins = bands % 2 == 0 ? 100 : 0;
  std::vector<std::uint8_t> bytes = decode::microphone::encode_mic_frame(hello);
  for (std::size_t at = 0; at < rest.size();) {
    std::vector<std::uint8_t> frame =
        decode::microphone::encode_mic_frame(decode::microphone::MicBlock{.segments = 1}, hello);
    // Past the header and the counts, which end with the shape.
    for (std::size_t i = 16 + 28; i < frame.size() && at < rest.size(); ++i, ++at) frame[i] = rest[at];
    mend_checksum(frame);
    bytes.insert(bytes.end(), frame.begin(), frame.end());
  }
  read_frames(bytes, piece_size);
  return 0;
}
