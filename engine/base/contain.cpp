#include "engine/base/contain.hpp"

#include <atomic>

namespace yuragi {
namespace {

std::atomic<FaultReporter> fault_reporter = nullptr;

}  // namespace

void report_faults_to(FaultReporter reporter) noexcept {
  fault_reporter.store(reporter, std::memory_order_release);
}

void report_fault(std::string_view kind, const char* what) noexcept {
  if (FaultReporter const reporter = fault_reporter.load(std::memory_order_acquire)) reporter(kind, what);
}

}  // namespace yuragi
