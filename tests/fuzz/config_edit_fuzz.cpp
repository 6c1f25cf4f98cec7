// Any bytes as a configuration, with a calibration to write into it: the edit is refused, or made, and made again it
// changes nothing.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/config_edit.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace yuragi;
  if (size == 0) return 0;
  std::vector<daemon::settings::ConfigChange> changes = {{"calibration", "gain", 1.043}};
  if ((data[0] & 1) != 0) changes.push_back({"calibration", "curve", std::string("0:0 5:5.2")});
  if ((data[0] & 2) != 0) changes.push_back({"", "exponent", 1.6});

  // Half of the inputs begin with a sensor, so that the edits are reached.
  std::string text = (data[0] & 4) != 0 ? "[[sensor]]\nname = \"roof\"\n" : "";
  text += (data[0] & 8) != 0 ? "calibration = { gain = 2 " : "";
  for (std::size_t i = 1; i < size; ++i) text += static_cast<char>(data[i]);

  const auto edited = daemon::settings::edit_sensor(text, "roof", changes);
  if (!edited) return 0;
  const auto again = daemon::settings::edit_sensor(*edited, "roof", changes);
  if (!again || *again != *edited) std::abort();
  return 0;
}
