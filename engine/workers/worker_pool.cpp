#include "engine/workers/worker_pool.hpp"

#include <algorithm>

namespace yuragi::workers {
namespace {

/// Looks at a value before a thread sleeps: some tens of microseconds.
constexpr int kSpins = 20'000;

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

WorkerPool::WorkerPool(std::size_t threads) : size_(std::max<std::size_t>(threads, 1)) {
  workers_.reserve(size_ - 1);
  for (std::size_t index = 1; index < size_; ++index) workers_.emplace_back([this, index] { serve(index); });
}

WorkerPool::~WorkerPool() {
  is_ending_.store(true, std::memory_order_relaxed);
  works_begun_.fetch_add(1, std::memory_order_release);
  works_begun_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void WorkerPool::run_task(Task task, const void* work) noexcept {
  const Part mine{.index = 0, .count = size()};
  if (!workers_.empty()) {
    task_ = task;
    work_ = work;
    parts_to_do_.store(workers_.size(), std::memory_order_relaxed);
    works_begun_.fetch_add(1, std::memory_order_release);
    works_begun_.notify_all();
  }
  task(work, mine);

  // The others' parts.
  for (std::size_t left = parts_to_do_.load(std::memory_order_acquire); left != 0;
       left = parts_to_do_.load(std::memory_order_acquire)) {
    wait_for_change(parts_to_do_, left);
  }
}

void WorkerPool::serve(std::size_t index) noexcept {
  const Part mine{.index = index, .count = size()};
  std::uint32_t seen = 0;
  while (true) {
    wait_for_change(works_begun_, seen);
    seen = works_begun_.load(std::memory_order_acquire);
    if (is_ending_.load(std::memory_order_relaxed)) return;
    task_(work_, mine);
    if (parts_to_do_.fetch_sub(1, std::memory_order_acq_rel) == 1) parts_to_do_.notify_one();
  }
}

}  // namespace yuragi::workers
