#pragma once

#include <exception>
#include <string_view>
#include <utility>

namespace yuragi {

/// Receives each exception that contain() has stopped: `kind` names the work, `what` the exception's text. Called on
/// the thread where it happened.
using FaultReporter = void (*)(std::string_view kind, const char* what) noexcept;

/// Sets who receives contained exceptions, for the whole process; null (the default): nobody. Thread-safe.
void report_faults_to(FaultReporter reporter) noexcept;

/// Reports an exception that was contained. Thread-safe.
void report_fault(std::string_view kind, const char* what) noexcept;

/// Calls `work`. An exception costs this one piece of work, never its thread: it is reported, and passed to `on_fault`
/// as its text, valid for the call only. Every thread, and every handler of a listener, does its work in here. `kind`
/// names the work for the log: a literal, because the log counts by kind. Returns true if nothing was thrown.
/// Thread-safe. Costs nothing unless there is an exception.
template <class Work, class OnFault>
bool contain(std::string_view kind, Work&& work, OnFault&& on_fault) noexcept {
  const auto handle = [&](const char* what) noexcept {
    report_fault(kind, what);
    try {
      on_fault(what);
    } catch (...) {
      report_fault(kind, "handling an exception threw another");
    }
  };
  try {
    std::forward<Work>(work)();
    return true;
  } catch (const std::exception& error) {
    handle(error.what());
  } catch (...) {
    handle("an exception of unknown type");
  }
  return false;
}

template <class Work>
bool contain(std::string_view kind, Work&& work) noexcept {
  return contain(kind, std::forward<Work>(work), [](const char*) {});
}

}  // namespace yuragi
