#include "drivers/usb/usb_daq.hpp"

#include <array>

#include <fmt/format.h>

namespace yuragi::drivers::usb {

std::span<const DaqModel* const> usb_daq_models() {
  static constexpr std::array kModels = {&kMcc1208Model, &kLabjackModel};
  return kModels;
}

std::string wrong_wiring(const DaqModel& model, const DaqWiring& wiring) {
  if (wiring.counter >= model.counters) {
    return fmt::format("counter: is {}; {} has counters 0 to {}", wiring.counter, model.what, model.counters - 1);
  }
  for (const auto& [name, channel] :
       {std::pair{"vane_channel", wiring.vane_channel}, {"reference_channel", wiring.reference_channel}}) {
    if (channel && *channel >= model.channels) {
      return fmt::format("{}: is {}; {} has inputs 0 to {}", name, *channel, model.what, model.channels - 1);
    }
  }
  return "";
}

DaqTrouble trouble_of(bus::UsbStatus status, sensor::Sink& sink) {
  switch (status) {
    case bus::UsbStatus::kTimeout:
      sink.refused(decode::Refusal::kTimeout);
      return {"does not reply: check its cable, and plug it in again if this lasts"};
    case bus::UsbStatus::kStalled:
      sink.refused(decode::Refusal::kException);
      return {"refuses the request: plug it in again, and check that it is the configured kind of device"};
    case bus::UsbStatus::kDone:  // but with the wrong number of bytes
    case bus::UsbStatus::kOverflow:
      sink.refused(decode::Refusal::kMalformed);
      return {"sends more than was requested: check its cable"};
    case bus::UsbStatus::kInterrupted:
      return {"was interrupted", true};
    case bus::UsbStatus::kGone:
      break;
  }
  return {"was unplugged: plug it in again", true};
}

DaqTrouble trouble_of(decode::Refusal why, sensor::Sink& sink) {
  sink.refused(why);
  return {fmt::format("sends an invalid reply ({}): check its cable, and that no other program uses it", name_of(why))};
}

}  // namespace yuragi::drivers::usb
