#pragma once

#include <stdexcept>
#include <string>

#include <boost/system/result.hpp>

namespace yuragi {

/// What a function at a border returns when it can fail as a matter of course: the value, or why there is none.
/// E is an enum where the caller decides by it, or Failure where a person reads it.
template <class T, class E>
using Result = boost::system::result<T, E>;

/// A failure for a person to read: what is wrong, where, and what to do about it.
struct Failure {
  std::string message;
};

[[noreturn]] inline void throw_exception_from_error(const Failure& failure, const boost::source_location&) {
  throw std::runtime_error(failure.message);
}

}  // namespace yuragi
