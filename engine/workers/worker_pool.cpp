#include "engine/workers/worker_pool.hpp"

#include <algorithm>

namespace yuragi::workers {
namespace {

/// Number of polls of a value before a thread sleeps: some hundreds of microseconds, depending on the processor's
/// pause.
constexpr int kSpins = 20'000;

/// Pool::next_part_: the bits of the part, and one more work.
constexpr std::uint32_t kPartMask = 0xFF;
constexpr std::uint32_t kOneWork = kPartMask + 1;
static_assert(Pool::kMaxThreads <= kPartMask);

/// Waits until `value` is no longer `old`, spinning first.
template <class Value>
void wait_for_change(const std::atomic<Value>& value, Value old) noexcept {
  for (int spin = 0; spin < kSpins; ++spin) {
    if (value.load(std::memory_order_acquire) != old) return;
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

Pool::Pool(std::size_t threads)
    : size_(std::clamp<std::size_t>(threads, 1, kMaxThreads)), next_part_(static_cast<std::uint32_t>(size_)) {
  workers_.reserve(size_ - 1);
  for (std::size_t index = 1; index < size_; ++index) workers_.emplace_back([this] { serve(); });
}

Pool::~Pool() {
  is_ending_.store(true, std::memory_order_relaxed);
  next_part_.fetch_add(kOneWork, std::memory_order_release);  // a work whose parts are all taken
  next_part_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void Pool::run_task(Task task, const void* work) noexcept {
  if (workers_.empty()) return task(work, {});
  task_ = task;
  work_ = work;
  parts_to_do_.store(size_, std::memory_order_relaxed);
  const std::uint32_t last = next_part_.load(std::memory_order_relaxed);
  next_part_.store((last & ~kPartMask) + kOneWork, std::memory_order_release);
  next_part_.notify_all();
  while (do_next_part()) {
  }
  for (std::size_t left = parts_to_do_.load(std::memory_order_acquire); left != 0;
       left = parts_to_do_.load(std::memory_order_acquire)) {
    wait_for_change(parts_to_do_, left);
  }
}

/// Returns false if all parts are taken.
bool Pool::do_next_part() noexcept {
  std::uint32_t next = next_part_.load(std::memory_order_acquire);
  do {
    if ((next & kPartMask) >= size_) return false;
  } while (!next_part_.compare_exchange_weak(next, next + 1, std::memory_order_acq_rel, std::memory_order_acquire));
  task_(work_, {.index = next & kPartMask, .count = size_});
  if (parts_to_do_.fetch_sub(1, std::memory_order_acq_rel) == 1) parts_to_do_.notify_one();
  return true;
}

void Pool::serve() noexcept {
  while (true) {
    const std::uint32_t seen = next_part_.load(std::memory_order_acquire);
    if (is_ending_.load(std::memory_order_relaxed)) return;
    if ((seen & kPartMask) < size_) {
      do_next_part();
    } else {
      wait_for_change(next_part_, seen);
    }
  }
}

}  // namespace yuragi::workers
