#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/tools/doctor/doctor.hpp"
#include "daemon/tools/doctor/finding.hpp"
#include "daemon/tools/doctor/program_output.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::tools::support {

/// Runs a program of the system: doctor::program_output(), or a test's.
using RunProgram = std::function<std::optional<doctor::ProgramOutput>(std::vector<std::string>)>;
std::optional<doctor::ProgramOutput> run_program(std::vector<std::string> command);

struct BundleRequest {
  doctor::Examination examination;
  std::vector<doctor::Finding> findings;
  UtcTime now{};
  bool with_host_name = false;
  bool with_readings = false;  ///< of the last hour
  RunProgram run = run_program;
};

/// The files of a bundle: texts by name. Every secret of the configuration is taken out of all of them (Redaction).
/// Reads the configuration, the recording and the output of the system's programs; a program that is not installed
/// gives no file.
std::map<std::string, std::string> bundle_files(const BundleRequest& request);

/// Packs texts as a folder into a new .tar.gz at `archive`, readable by its owner and group (0640), which must not be
/// there yet. By tar(1).
Result<void, Failure> pack(const std::map<std::string, std::string>& files, const std::string& folder,
                           const std::filesystem::path& archive);

}  // namespace yuragi::daemon::tools::support
