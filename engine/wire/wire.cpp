#include "engine/wire/wire.hpp"

#include "engine/pose/pose_arrays.hpp"

namespace yuragi::wire {

std::string_view name_of(Error error) {
  switch (error) {
    case Error::kTooLong:
      return "too long";
    case Error::kNotVerified:
      return "not a Yuragi message";
    case Error::kUnknown:
      return "of an unknown kind";
    case Error::kInconsistent:
      return "contradicts itself";
  }
  return "?";
}

std::optional<std::string> protocol_mismatch(const Hello& hello) {
  if (hello.protocol == kProtocol) return std::nullopt;
  const std::string speaks =
      "speaks protocol " + std::to_string(hello.protocol) + ", this program protocol " + std::to_string(kProtocol);
  return speaks + (hello.protocol > kProtocol ? ": update this program" : ": update the daemon");
}

Result<std::size_t, Error> read_size_prefix(std::span<const std::uint8_t, kSizePrefixBytes> prefix, std::size_t limit) {
  std::size_t length = 0;
  for (std::size_t i = 0; i < kSizePrefixBytes; ++i) length |= std::size_t{prefix[i]} << (8 * i);
  if (length == 0 || length > limit) return Error::kTooLong;
  return length;
}

bool fits(const Frame& frame, const Scenes& scenes) {
  const std::size_t count = scenes.scenes.size();
  if (frame.poses.size() != count || frame.opacities.size() != count) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const auto* strands = std::get_if<pose::StrandPose>(&frame.poses[i]);
    const bool is_left_out = frame.opacities[i] <= 0.0F && strands != nullptr && strands->bend_east_rad.empty();
    if (!is_left_out && !pose::fits(frame.poses[i], scenes.scenes[i].skeleton)) return false;
  }
  return true;
}

}  // namespace yuragi::wire
