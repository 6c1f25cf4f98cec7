// main of tests whose devices stand in a testbed of umockdev's: they run under its library, and start themselves anew
// where they do not.
#include <gtest/gtest.h>

#include "simulators/usb/umockdev_testbed.hpp"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (!testing::GTEST_FLAG(list_tests) && !yuragi::simulators::usb::is_in_umockdev())
    yuragi::simulators::usb::restart_in_umockdev();
  return RUN_ALL_TESTS();
}
