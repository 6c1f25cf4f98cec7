#include "simulators/usb/umockdev_testbed.hpp"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <umockdev.h>
#include <unistd.h>

namespace yuragi::simulators::usb {
namespace {

void throw_if(GError* error, const std::string& what) {
  if (error == nullptr) return;
  const std::string why = error->message;
  g_error_free(error);
  throw std::runtime_error(what + ": " + why);
}

}  // namespace

bool is_in_umockdev() noexcept {
  const char* const preloaded = std::getenv("LD_PRELOAD");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return preloaded != nullptr && std::string_view(preloaded).find("libumockdev-preload") != std::string_view::npos;
}

void restart_in_umockdev() {
  // The arguments in /proc/self/cmdline are separated by zero bytes.
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::vector<std::string> words = {"umockdev-wrapper", std::filesystem::read_symlink("/proc/self/exe").string()};
  for (std::size_t begin = bytes.find('\0') + 1; begin != 0 && begin < bytes.size();) {
    const std::size_t end = bytes.find('\0', begin);
    words.push_back(bytes.substr(begin, end - begin));
    begin = end + 1;
  }
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  throw std::runtime_error(fmt::format("cannot start umockdev-wrapper ({}): install the package umockdev",
                                       std::generic_category().message(errno)));
}

UmockdevTestbed::UmockdevTestbed() {
  if (!is_in_umockdev()) throw std::runtime_error("not started by umockdev-wrapper; use --umockdev");
  testbed_ = {umockdev_testbed_new(), [](UMockdevTestbed* held) { g_object_unref(held); }};
}

UmockdevTestbed::~UmockdevTestbed() = default;

std::string UmockdevTestbed::real_path(const std::string& path) const {
  gchar* const root = umockdev_testbed_get_root_dir(testbed_.get());
  std::string real = root + path;
  g_free(root);
  return real;
}

void UmockdevTestbed::add(const std::string& description) {
  GError* error = nullptr;
  umockdev_testbed_add_from_string(testbed_.get(), description.c_str(), &error);
  throw_if(error, "cannot add a simulated device");
}

void UmockdevTestbed::remove(const std::string& sysfs_path) {
  umockdev_testbed_remove_device(testbed_.get(), sysfs_path.c_str());
}

void UmockdevTestbed::send_uevent(const std::string& sysfs_path, const std::string& action) {
  umockdev_testbed_uevent(testbed_.get(), sysfs_path.c_str(), action.c_str());
}

void UmockdevTestbed::attach(const std::string& node, const ProgramCallQueue& calls) {
  UMockdevIoctlBase* const handler = calls.make_handler();
  GError* error = nullptr;
  umockdev_testbed_attach_ioctl(testbed_.get(), node.c_str(), handler, &error);
  g_object_unref(handler);
  throw_if(error, "cannot attach to " + node);
}

void UmockdevTestbed::detach(const std::string& node) {
  GError* error = nullptr;
  umockdev_testbed_detach_ioctl(testbed_.get(), node.c_str(), &error);
  if (error != nullptr) g_error_free(error);
}

}  // namespace yuragi::simulators::usb
