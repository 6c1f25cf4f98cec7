#include "drivers/decode/davis/vantage_assembler.hpp"

#include <algorithm>
#include <utility>

namespace yuragi::drivers::decode::davis {

std::optional<VantageAssembler::Packet> VantageAssembler::next(ByteSpan& bytes) noexcept {
  if (std::exchange(is_taken_, false)) size_ = 0;
  while (!bytes.empty()) {
    bytes_[size_++] = bytes.front();
    bytes = bytes.subspan(1);
    if (!begins_vantage_packet(ByteSpan(bytes_).first(size_))) {
      drop_front();
      if (!std::exchange(is_outside_, true)) return Refusal::kMalformed;
    } else if (size_ == kVantagePacket) {
      is_outside_ = false;
      const bool ends_well = bytes_[95] == '\n' && bytes_[96] == '\r';
      if (ends_well && vantage_checksum(bytes_) == 0) {
        is_taken_ = true;
        return ByteSpan(bytes_);
      }
      drop_front();
      is_outside_ = true;  // bytes up to the next beginning belong to this one
      return Refusal::kBadChecksum;
    }
  }
  return std::nullopt;
}

bool VantageAssembler::cut() noexcept {
  const bool is_taken = std::exchange(is_taken_, false);
  is_outside_ = false;
  return std::exchange(size_, 0) > 0 && !is_taken;
}

/// Keeps the bytes from the next beginning of a packet on, if any.
void VantageAssembler::drop_front() noexcept {
  do {
    std::copy(bytes_.begin() + 1, bytes_.begin() + static_cast<std::ptrdiff_t>(size_), bytes_.begin());
    --size_;
  } while (size_ > 0 && !begins_vantage_packet(ByteSpan(bytes_).first(size_)));
}

}  // namespace yuragi::drivers::decode::davis
