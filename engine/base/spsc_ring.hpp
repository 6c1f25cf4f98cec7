#pragma once

#include <cstddef>

#include <boost/lockfree/spsc_queue.hpp>

namespace yuragi {

/// A bounded queue from one thread to one other, for streams in which every value matters: push() returns false when it
/// is full, and the caller counts the lost values.
///
/// Thread-safe: for one producer and one consumer. Realtime-safe after construction: yes.
template <class T>
class SpscRing {
 public:
  explicit SpscRing(std::size_t capacity) : queue_(capacity) {}

  bool push(const T& value) { return queue_.push(value); }
  bool pop(T& value) { return queue_.pop(value); }

  /// Passes each waiting value to `use`, oldest first; returns their number.
  template <class Use>
  std::size_t drain(Use&& use) {
    return queue_.consume_all(use);
  }

 private:
  boost::lockfree::spsc_queue<T> queue_;
};

}  // namespace yuragi
