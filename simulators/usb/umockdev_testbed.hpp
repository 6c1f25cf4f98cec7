#pragma once

#include <memory>
#include <string>

#include "simulators/usb/umockdev_calls.hpp"

struct _UMockdevTestbed;  // NOLINT(bugprone-reserved-identifier): the name is GObject's

namespace yuragi::simulators::usb {

/// Returns true if this program runs with umockdev's library before the C library's, as a testbed and the programs that
/// use it must.
bool is_in_umockdev() noexcept;

/// Starts this program anew, with the same arguments, under umockdev-wrapper (Debian: umockdev). Returns only by
/// throwing std::runtime_error, which names the package to install.
[[noreturn]] void restart_in_umockdev();

/// A separate /sys and /dev for this program and those that it starts, for the lifetime of this object. One at a time.
/// Thread-safe: no.
class UmockdevTestbed {
 public:
  /// Throws std::runtime_error if is_in_umockdev() is false.
  UmockdevTestbed();
  ~UmockdevTestbed();
  UmockdevTestbed(const UmockdevTestbed&) = delete;
  UmockdevTestbed& operator=(const UmockdevTestbed&) = delete;

  /// The real path of "/dev/..." in the testbed.
  std::string real_path(const std::string& path) const;

  /// Adds devices that are described as `umockdev-record` writes them. Throws std::runtime_error.
  void add(const std::string& description);
  /// Removes one, and its node.
  void remove(const std::string& sysfs_path);
  /// Sends a uevent to udev's listeners: `action` is "add" or "remove".
  void send_uevent(const std::string& sysfs_path, const std::string& action);

  /// From now on calls on that node ("/dev/...") are put into the queue. Throws std::runtime_error.
  void attach(const std::string& node, const ProgramCallQueue& calls);
  /// Programs that open the node from now on are not served; those that have it open continue.
  void detach(const std::string& node);

 private:
  std::shared_ptr<_UMockdevTestbed> testbed_;
};

}  // namespace yuragi::simulators::usb
