#include "engine/base/snapshot.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <boost/crc.hpp>

namespace yuragi {
namespace {

constexpr std::array<std::uint8_t, 4> kSnapshotMark = {'Y', 'u', 'S', 'n'};

struct SnapshotHead {
  std::uint32_t version = kMotionVersion;
  std::uint64_t made_of = 0;

  void list_state(StatePass& pass) { pass(version, made_of); }
};
constexpr std::size_t kHead_bytes = kSnapshotMark.size() + 12;
constexpr std::size_t kSum_bytes = 4;

std::uint32_t checksum(std::span<const std::uint8_t> bytes) {
  boost::crc_32_type sum;
  sum.process_bytes(bytes.data(), bytes.size());
  return sum.checksum();
}

Failure bad_snapshot(std::string message) {
  return {.message = std::move(message), .kind = FailureKind::kBadData};
}

}  // namespace

Result<std::span<const std::uint8_t>, Failure> opened_snapshot(std::span<const std::uint8_t> snapshot,
                                                               std::uint64_t made_of) {
  if (snapshot.size() < kSnapshotMark.size() ||
      !std::ranges::equal(snapshot.first(kSnapshotMark.size()), kSnapshotMark)) {
    return bad_snapshot("is not a snapshot");
  }
  if (snapshot.size() < kHead_bytes + kSum_bytes) return bad_snapshot("is damaged: it is too short");
  const auto summed = snapshot.first(snapshot.size() - kSum_bytes);
  std::uint32_t sum = 0;
  StatePass::loading(snapshot.last(kSum_bytes))(sum);
  if (sum != checksum(summed)) return bad_snapshot("is damaged: its checksum is wrong");

  SnapshotHead head;
  StatePass::loading(summed.subspan(kSnapshotMark.size()).first(kHead_bytes - kSnapshotMark.size()))(head);
  if (head.version != kMotionVersion) {
    return bad_snapshot("is of version " + std::to_string(head.version) + " of the motion; this program has version " +
                        std::to_string(kMotionVersion));
  }
  if (head.made_of != made_of) return bad_snapshot("is of another configuration");
  return summed.subspan(kHead_bytes);
}

std::vector<std::uint8_t> closed_snapshot(std::span<const std::uint8_t> state, std::uint64_t made_of,
                                          std::uint32_t version) {
  std::vector<std::uint8_t> snapshot(kSnapshotMark.begin(), kSnapshotMark.end());
  SnapshotHead head{.version = version, .made_of = made_of};
  StatePass::saving(snapshot)(head);
  snapshot.insert(snapshot.end(), state.begin(), state.end());
  std::uint32_t sum = checksum(snapshot);
  StatePass::saving(snapshot)(sum);
  return snapshot;
}

Failure state_failure(StatePass::Problem problem) {
  return bad_snapshot(problem == StatePass::Problem::kLengthDiffers ? "is damaged: its length is wrong"
                                                                    : "is damaged: a number is out of its range");
}

}  // namespace yuragi
