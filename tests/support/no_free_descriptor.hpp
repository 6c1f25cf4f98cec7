#pragma once

#include <stdexcept>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace yuragi::test {

/// As long as it lives this process can open no file and no socket: EMFILE.
class NoFreeDescriptor {
 public:
  NoFreeDescriptor() {
    const int lowest_free = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (lowest_free < 0 || getrlimit(RLIMIT_NOFILE, &before_) != 0) throw std::runtime_error("no limit to set");
    close(lowest_free);
    rlimit none = before_;
    none.rlim_cur = static_cast<rlim_t>(lowest_free);
    if (setrlimit(RLIMIT_NOFILE, &none) != 0) throw std::runtime_error("the limit cannot be set");
  }
  ~NoFreeDescriptor() { setrlimit(RLIMIT_NOFILE, &before_); }
  NoFreeDescriptor(const NoFreeDescriptor&) = delete;
  NoFreeDescriptor& operator=(const NoFreeDescriptor&) = delete;

 private:
  rlimit before_{};
};

}  // namespace yuragi::test
