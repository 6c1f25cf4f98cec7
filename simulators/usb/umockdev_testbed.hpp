#pragma once

#include <memory>
#include <string>

#include "simulators/usb/umockdev_calls.hpp"

struct _UMockdevTestbed;  // NOLINT(bugprone-reserved-identifier): the name is GObject's

namespace yuragi::sim {

/// True: this program runs with umockdev's library before the C library's, as a testbed and those who use it must.
bool is_in_umockdev() noexcept;

/// Starts this program anew, with the same arguments, under umockdev-wrapper (Debian: umockdev). Returns only by
/// throwing std::runtime_error, saying what to install.
[[noreturn]] void restart_in_umockdev();

/// A /sys and a /dev of our own, for this program and those that it starts, for as long as this lives. One at a time.
/// Thread-safe: no.
class UmockdevTestbed {
 public:
  /// Throws std::runtime_error where is_in_umockdev() is false.
  UmockdevTestbed();
  ~UmockdevTestbed();
  UmockdevTestbed(const UmockdevTestbed&) = delete;
  UmockdevTestbed& operator=(const UmockdevTestbed&) = delete;

  /// Where "/dev/..." of the testbed is in truth.
  std::string real_path(const std::string& path) const;

  /// Adds devices that are described as `umockdev-record` writes them. Throws std::runtime_error.
  void add(const std::string& description);
  /// Removes one, and its node.
  void remove(const std::string& sysfs_path);
  /// Tells those who listen to the kernel, through udev: `action` is "add" or "remove".
  void tell(const std::string& sysfs_path, const std::string& action);

  /// From now on calls on that node ("/dev/...") come into the queue. Throws std::runtime_error.
  void attach(const std::string& node, const ProgramCallQueue& calls);
  /// The node takes no new ones; who has it open goes on.
  void detach(const std::string& node);

 private:
  std::shared_ptr<_UMockdevTestbed> testbed_;
};

}  // namespace yuragi::sim
