#pragma once

#include <vector>

#include "daemon/tools/doctor/facts.hpp"
#include "daemon/tools/doctor/finding.hpp"

namespace yuragi::daemon::tools::doctor {

// From what was found to what it means and which command fixes it. Pure.

/// Below this year a clock has never been set: the first release is later.
inline constexpr int kFirstPlausibleYear = 2024;
inline constexpr int kLastPlausibleYear = 2099;
/// A disk that is full sooner is worth a warning.
inline constexpr double kSoonFull_days = 60.0;
/// The daemon needs about 100 MB with a wall of 100,000 nodes.
inline constexpr std::uint64_t kLittleMemory_bytes = 200'000'000;

Finding judge(const DeviceFacts& device);
std::vector<Finding> judge(const GroupFacts& groups);
Finding judge(const ClockFacts& clock);
Finding judge(const DiskFacts& disk);
Finding judge(const PortFacts& port);
Finding judge(const CompanyServerFacts& server);
std::vector<Finding> judge(const ConfigFacts& config);
std::vector<Finding> judge(const DisplayFacts& display);
std::vector<Finding> judge(const VersionFacts& versions);
std::vector<Finding> judge(const LimitFacts& limits);

}  // namespace yuragi::daemon::tools::doctor
