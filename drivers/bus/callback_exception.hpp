#pragma once

#include <exception>
#include <utility>

namespace yuragi::drivers::bus {

/// An exception of ours in a callback of a C library, through whose code it may not pass: it is kept, and thrown once
/// the library has returned.
///
/// Thread-safe: no; the library calls back on the thread that called it.
class CallbackException {
 public:
  /// Runs the callback's work. Of several exceptions the first is kept.
  template <class Work>
  void keep_from(Work&& work) noexcept {
    try {
      work();
    } catch (...) {
      if (!kept_) kept_ = std::current_exception();
    }
  }

  /// Throws the kept exception, once.
  void rethrow() {
    if (kept_) std::rethrow_exception(std::exchange(kept_, nullptr));
  }

 private:
  std::exception_ptr kept_;
};

}  // namespace yuragi::drivers::bus
