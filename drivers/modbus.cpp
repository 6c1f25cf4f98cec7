#include "drivers/driver.hpp"
namespace yuragi {
extern const DriverDescription kModbusDriver;
const DriverDescription kModbusDriver{"modbus", "", {}, nullptr};
}  // namespace yuragi
