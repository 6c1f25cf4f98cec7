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
/// The caller does a part itself. Between two pieces of work a thread polls kSpins times, some tens of microseconds,
/// and then sleeps: in a loop of work without pauses no thread sleeps, and at 60 Hz none burns a core (waking the
/// threads then costs some 50 us per tick). Thread-safe: no, one caller. Realtime-safe: run() neither allocates nor
/// locks; it waits for the slowest part.
class WorkerPool {
 public:
  /// `threads`: how many share the work, the caller among them; 0 counts as 1.
  explicit WorkerPool(std::size_t threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

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
  void serve(std::size_t index) noexcept;

  const std::size_t size_;
  Task task_ = nullptr;
  const void* work_ = nullptr;
  std::atomic<std::uint32_t> works_begun_{0};
  std::atomic<std::size_t> parts_to_do_{0};
  std::atomic<bool> is_ending_{false};
  std::vector<std::thread> workers_;
};

}  // namespace yuragi::workers
