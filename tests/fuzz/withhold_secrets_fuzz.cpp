// Any bytes as a text of a recording: it is no TOML, or its secrets are withheld, and then there are none left.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "daemon/settings/withhold_secrets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace yuragi::daemon;
  if (size == 0) return 0;
  // Most inputs begin with what leads to a secret.
  std::string text = (data[0] & 1) != 0 ? "[[sensor]]\ndriver = 'mqtt'\n" : "";
  text += (data[0] & 2) != 0 ? "password = " : "";
  for (std::size_t i = 1; i < size; ++i) text += static_cast<char>(data[i]);

  const auto withheld = settings::withhold_in_configuration(text);
  if (withheld) {
    if (withheld->secrets == 0 && withheld->text != text) std::abort();
    const auto again = settings::withhold_in_configuration(withheld->text);
    if (!again || again->secrets != 0 || again->text != withheld->text) std::abort();
  }
  const auto options = settings::withhold_in_options(text, (data[0] & 4) != 0 ? "mqtt" : "unknown");
  if (!options) return 0;
  const auto again = settings::withhold_in_options(options->text, "unknown");
  if (!again || again->secrets != 0) std::abort();
  return 0;
}
