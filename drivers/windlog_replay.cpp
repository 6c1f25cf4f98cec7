#include "drivers/driver.hpp"
namespace yuragi {
extern const DriverDescription kWindlogDriver;
const DriverDescription kWindlogDriver{"windlog", "", {}, nullptr};
}  // namespace yuragi
