#include "drivers/driver.hpp"
namespace yuragi {
extern const DriverDescription kSyntheticDriver;
const DriverDescription kSyntheticDriver{"synthetic", "", {}, nullptr};
}  // namespace yuragi
