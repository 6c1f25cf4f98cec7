#pragma once

#include <cstdint>
#include <memory>

#include "engine/platform/descriptor.hpp"

namespace yuragi::daemon::http {

/// The beginning of an open file as the body of an answer, which may be of any size and on a disk that is slow or
/// hangs: a thread of its own moves it into a pipe. Thread-safe: yes.
class FileBody {
 public:
  /// `file`: a regular file, whose place is neither used nor moved. A file that gets shorter ends the connection.
  FileBody(std::shared_ptr<const platform::Descriptor> file, std::uint64_t bytes);

  std::uint64_t bytes() const { return bytes_; }

  /// Begins to read, and returns the end of the pipe that has the bytes; the caller closes it, at any time. Throws
  /// std::system_error.
  int begin() const;

 private:
  std::shared_ptr<const platform::Descriptor> file_;
  std::uint64_t bytes_;
};

}  // namespace yuragi::daemon::http
