#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

#include "engine/base/part.hpp"

namespace yuragi::workers {

/// Threads that share work with the caller, for scenes that are too large for one core in a tick.
///
/// A piece of work has as many parts as there are threads; whichever thread is free takes the next part. So the caller
/// does the parts that no other thread has begun, and all of them if another program uses the other cores: it waits
/// only for parts in progress. Between two pieces of work a thread polls kSpins times, some hundreds of microseconds,
/// and then sleeps: in a loop of work without pauses no thread sleeps, and at 60 Hz none keeps a core busy (waking the
/// threads then costs some 50 us per tick). Thread-safe: no, one caller. Realtime-safe: run() neither allocates nor
/// locks; it waits for the slowest part that another thread has begun.
class Pool {
 public:
  static constexpr std::size_t kMaxThreads = 255;

  /// `threads`: number of threads that share the work, including the caller; 0 counts as 1, and the maximum is
  /// kMaxThreads.
  explicit Pool(std::size_t threads);
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  std::size_t size() const noexcept { return size_; }

  /// Calls work(Part) once for each part, and returns when all are done. `work` must not throw: an exception of it ends
  /// the program (std::terminate).
  template <class Work>
  void run(const Work& work) noexcept {
    run_task([](const void* task, Part part) { (*static_cast<const Work*>(task))(part); }, &work);
  }

 private:
  using Task = void (*)(const void* work, Part part);

  void run_task(Task task, const void* work) noexcept;
  bool do_next_part() noexcept;
  void serve() noexcept;

  const std::size_t size_;
  // The present work. Read by a thread that has taken a part: it does not change until that is done.
  Task task_ = nullptr;
  const void* work_ = nullptr;
  /// The number of the present work, and in the last eight bits the next free part.
  std::atomic<std::uint32_t> next_part_;
  std::atomic<std::size_t> parts_to_do_{0};
  std::atomic<bool> is_ending_{false};
  std::vector<std::thread> workers_;
};

}  // namespace yuragi::workers
