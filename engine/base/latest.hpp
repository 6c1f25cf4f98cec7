#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

namespace yuragi {

/// A triple buffer: one writer hands the newest value to one reader; older values that were not read are dropped.
///
/// Ownership: holds three T. The writer fills writable() and calls publish(); the reader calls refresh() and reads
/// value(). Neither ever waits for the other. Thread-safe: for one writer thread and one reader thread. Realtime-safe:
/// yes; no allocation, no lock, no throw.
template <class T>
class Latest {
 public:
  Latest() = default;
  explicit Latest(const T& initial) : slots_{initial, initial, initial} {}

  /// Writer: the slot to fill. It contains an older value.
  T& writable() noexcept { return slots_[write_]; }

  /// Writer: makes the slot the newest one and takes another to write to.
  void publish() noexcept {
    const std::uint8_t previous =
        middle_.exchange(static_cast<std::uint8_t>(write_ | kFresh), std::memory_order_acq_rel);
    write_ = previous & kIndex;
  }

  void publish(const T& value) noexcept(noexcept(std::declval<T&>() = value)) {
    writable() = value;
    publish();
  }

  /// Reader: takes the newest value. Returns true if value() changed.
  bool refresh() noexcept {
    if ((middle_.load(std::memory_order_acquire) & kFresh) == 0) return false;
    read_ = middle_.exchange(read_, std::memory_order_acq_rel) & kIndex;
    return true;
  }

  /// Reader: the value taken by the last refresh() that returned true, or the initial one.
  const T& value() const noexcept { return slots_[read_]; }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;

  std::array<T, 3> slots_{};
  alignas(64) std::uint8_t write_ = 0;
  alignas(64) std::atomic<std::uint8_t> middle_{1};
  alignas(64) std::uint8_t read_ = 2;
};

}  // namespace yuragi
