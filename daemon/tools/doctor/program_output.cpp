#include "daemon/tools/doctor/program_output.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <system_error>

#include <unistd.h>

#include "drivers/bus/process_port.hpp"

namespace yuragi::daemon::tools::doctor {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::optional<std::string> find_program(const std::string& name) {
  if (name.starts_with('/')) return access(name.c_str(), X_OK) == 0 ? std::optional(name) : std::nullopt;
  std::error_code ignored;
  const fs::path beside = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const fs::path& folder : {beside, fs::path("/usr/local/bin"), fs::path("/usr/bin"), fs::path("/bin"),
                                 fs::path("/usr/sbin"), fs::path("/sbin")}) {
    const fs::path program = folder / name;
    if (!folder.empty() && access(program.c_str(), X_OK) == 0) return program.string();
  }
  return std::nullopt;
}

std::optional<ProgramOutput> program_output(std::vector<std::string> command, Nanoseconds timeout,
                                            std::size_t most_bytes) {
  const auto program = find_program(command.front());
  if (!program) return std::nullopt;
  // The shell joins both outputs, and prints the exit code last.
  constexpr std::string_view kMark = "\nexit code ";
  std::vector<std::string> words = {"/bin/sh", "-c", "\"$@\" 2>&1; printf '\\nexit code %d' $?", "sh", *program};
  words.insert(words.end(), command.begin() + 1, command.end());
  const auto port = drivers::bus::make_process_port(std::move(words));
  ProgramOutput output;
  if (!port->open()) return std::nullopt;
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  std::array<std::uint8_t, 4096> buffer{};
  while (output.text.size() < most_bytes) {
    const Nanoseconds left = deadline - std::chrono::steady_clock::now();
    if (left <= Nanoseconds{0}) break;
    const auto arrival = port->read(buffer, left);
    if (arrival.status != drivers::bus::ByteStatus::kBytes) break;
    output.text.append(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(arrival.size));
  }
  port->close();
  const std::size_t mark = output.text.rfind(kMark);
  if (mark == std::string::npos) return output;
  const std::string digits = output.text.substr(mark + kMark.size());
  std::from_chars(digits.data(), digits.data() + digits.size(), output.exit_code);
  output.text.resize(mark);
  return output;
}

}  // namespace yuragi::daemon::tools::doctor
