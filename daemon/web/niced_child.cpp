#include "daemon/web/niced_child.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "engine/platform/descriptor.hpp"

namespace yuragi::daemon::web {
namespace {

using std::chrono::steady_clock;

constexpr int kAwaited_nice = 5;
constexpr int kLowest_nice = 19;
constexpr int kBetweenLooks_ms = 100;
// ioprio_set(2), which has no header of its own: of this thread, in the class that gets the disk when nobody else wants
// it.
constexpr int kOfThisThread = 1;
constexpr int kIdleClass = 3 << 13;

/// Children inherit it. What the system does not permit is left out.
void lower_priority(Niceness niceness) noexcept {
  const bool is_lowest = niceness == Niceness::kLowest;
  setpriority(PRIO_PROCESS, 0, is_lowest ? kLowest_nice : kAwaited_nice);  // of this thread alone, on Linux
  if (is_lowest) syscall(SYS_ioprio_set, kOfThisThread, 0, kIdleClass);
}

/// A file in memory that vanishes with its descriptor.
class MemoryFile {
 public:
  explicit MemoryFile(const char* name) : file_(memfd_create(name, MFD_CLOEXEC)) {
    if (file_.get() < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
  }
  int get() const { return file_.get(); }
  /// Writes a text, and goes back to its beginning. Throws std::system_error.
  void fill(std::string_view text) const {
    if (write(file_.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()) ||
        lseek(file_.get(), 0, SEEK_SET) != 0)
      throw std::system_error(errno, std::generic_category(), "memfd");
  }
  std::size_t size() const {
    struct stat about {};
    return fstat(file_.get(), &about) == 0 ? static_cast<std::size_t>(about.st_size) : 0;
  }
  /// Its last bytes, `most` of them at most.
  std::string tail(std::size_t most) const {
    const std::size_t whole = size();
    std::string text(std::min(whole, most), '\0');
    const ssize_t read = pread(file_.get(), text.data(), text.size(), static_cast<off_t>(whole - text.size()));
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(read, 0)));
    return text;
  }

 private:
  platform::Descriptor file_;
};

}  // namespace

ChildOutput run_niced(Niceness niceness, std::vector<std::string> command, Nanoseconds time,
                      const std::stop_token& stop, const std::string& input,
                      const std::function<void(const std::string&)>& look) {
  lower_priority(niceness);
  const auto deadline = steady_clock::now() + time;
  const MemoryFile printed("printed");
  const MemoryFile complaints("complaints");
  const MemoryFile given("given");
  given.fill(input);
  std::size_t seen = 0;
  ChildOutput output;
  {
    platform::ChildProcess child({.command = std::move(command),
                                  .input = given.get(),
                                  .output = printed.get(),
                                  .error = complaints.get(),
                                  .has_own_group = true});
    while (!(output.end = child.end(kBetweenLooks_ms)) && output.why.empty()) {
      if (look && printed.size() > seen) {
        seen = printed.size();
        look(printed.tail(kMaxPrinted_bytes));
      }
      if (stop.stop_requested()) {
        output.why = "it was cancelled";
      } else if (steady_clock::now() >= deadline) {
        output.why = "it has taken too long";
      } else if (std::max(printed.size(), complaints.size()) > kMaxPrinted_bytes) {
        output.why = "it prints too much";
      }
    }
  }
  output.printed = printed.tail(kMaxPrinted_bytes);
  output.complaints = complaints.tail(kMaxComplaints_bytes);
  return output;
}

std::string failure_of(const ChildOutput& output) {
  if (!output.end) return output.why;
  if (output.end->is_good()) return {};
  std::string text = output.complaints;
  while (text.ends_with('\n')) text.pop_back();
  return text.empty() || output.end->signal != 0 ? "it " + platform::text_of(*output.end) : text;
}

}  // namespace yuragi::daemon::web
