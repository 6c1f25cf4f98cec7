#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include <boost/system/result.hpp>

namespace yuragi {

/// The result of a function at a border that can be expected to fail: the value, or the reason for the failure. E is an
/// enum if the caller decides by it, or Failure if a person reads it.
template <class T, class E>
using Result = boost::system::result<T, E>;

/// The kind of a failure, as far as programs distinguish it: a command has an exit code for each.
enum class FailureKind : std::uint8_t {
  kOther,         ///< anything else
  kUsage,         ///< the request cannot be carried out
  kBadData,       ///< an input with invalid content
  kNoInput,       ///< an input file that does not exist
  kUnavailable,   ///< a device, a daemon or an address that is not to be had
  kCannotCreate,  ///< an output that cannot be written
};

/// A failure for a person to read: what is wrong, where, and what to do about it.
struct Failure {
  std::string message;
  FailureKind kind = FailureKind::kOther;
};

/// A Failure as an exception: for set-up, if a constructor has no other way, and from Result::value().
class FailureError : public std::runtime_error {
 public:
  explicit FailureError(const Failure& failure) : std::runtime_error(failure.message), kind_(failure.kind) {}
  FailureKind kind() const noexcept { return kind_; }

 private:
  FailureKind kind_;
};

[[noreturn]] inline void throw_exception_from_error(const Failure& failure, const boost::source_location&) {
  throw FailureError(failure);
}

}  // namespace yuragi
