#pragma once

#include <filesystem>
#include <utility>

#include "engine/base/result.hpp"

namespace yuragi::drivers::windlog {

/// The right to write a series (recording_parts.hpp): one holder at a time, of all processes of the machine. Whoever
/// writes, renames or rewrites a recording holds it; readers need none. It is an open file description lock (fcntl(2))
/// on FILE-lock, which holds the process's id and is removed by the destructor. The system releases it when the process
/// ends, however that happens. It is not on the database itself: closing that file would drop SQLite's locks on it.
///
/// Owns a descriptor, which child programs do not inherit. Thread-safe: no; two objects in one process exclude each
/// other as two processes do.
class SeriesLock {
 public:
  /// Takes the lock of the file that `recording` refers to, which need not exist; a link is followed. Never waits for
  /// another holder: fails with kUnavailable if there is one, and otherwise if FILE-lock cannot be created. On a file
  /// system without locks it succeeds, and is_effective() is false.
  static Result<SeriesLock, Failure> take(const std::filesystem::path& recording);

  SeriesLock(SeriesLock&& other) noexcept;
  SeriesLock& operator=(SeriesLock&& other) noexcept;
  ~SeriesLock();

  bool is_effective() const { return is_effective_; }

  /// Is this still the lock of `recording`? False if FILE-lock was removed or replaced, or the name refers to another
  /// file by now. True if that cannot be looked up.
  bool is_of(const std::filesystem::path& recording) const;

 private:
  SeriesLock(std::filesystem::path file, int descriptor, bool is_effective)
      : file_(std::move(file)), descriptor_(descriptor), is_effective_(is_effective) {}

  std::filesystem::path file_;
  int descriptor_;  ///< -1: moved from
  bool is_effective_;
};

}  // namespace yuragi::drivers::windlog
