// Any bytes from a USB/IP host: read as messages, and obeyed by a simulated device behind its port.
#include <cstdint>
#include <cstdlib>
#include <memory>

#include "simulators/usb/usb_port.hpp"
#include "simulators/usb/usbip_protocol.hpp"
#include "tests/simulators/usb/steady_wind.hpp"

namespace {

using namespace yuragi;

void require(bool holds) {
  if (!holds) std::abort();
}

void obey(simulators::usb::Port& port, const simulators::usb::UsbipMessage& message, double time_s) {
  port.advance(time_s, std::nullopt);
  if (const auto* submit = std::get_if<simulators::usb::UsbipSubmit>(&message)) {
    require(submit->length <= simulators::usb::kUsbipLongestTransfer && submit->endpoint < 16);
    port.submit({.id = submit->number,
                 .endpoint = submit->endpoint,
                 .is_to_host = submit->is_to_host,
                 .setup = submit->setup,
                 .data = submit->data,
                 .max_size = submit->length});
  } else if (const auto* unlink = std::get_if<simulators::usb::UsbipUnlink>(&message)) {
    port.cancel(unlink->unlinked);
  }
  for (const simulators::usb::Outcome& outcome : port.take_outcomes()) {
    require(simulators::usb::usbip_submit_reply(static_cast<std::uint32_t>(outcome.id), simulators::usb::kUsbipDone,
                                                outcome.size, outcome.data)
                .size() >= 48);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {  // NOLINT(readability-identifier-naming)
  for (const simulators::usb::UsbipPhase phase :
       {simulators::usb::UsbipPhase::kRequests, simulators::usb::UsbipPhase::kTransfers}) {
    const std::unique_ptr<simulators::usb::Port> port = simulators::usb::echo_port();
    std::span bytes(data, size);
    for (double time_s = 0.0;; time_s += 0.02) {
      const auto taken = simulators::usb::take_usbip_message(phase, bytes);
      if (!taken || !taken->message) break;
      require(taken->size > 0 && taken->size <= bytes.size());
      obey(*port, *taken->message, time_s);
      bytes = bytes.subspan(taken->size);
    }
  }
  return 0;
}
