// Standard descriptors and requests: USB 2.0 specification, chapter 9; those of HID: Device Class Definition for
// HID 1.11, 7.1. All numbers are little-endian.
#include "simulators/usb/usb_standard.hpp"

#include <algorithm>

namespace yuragi::simulators::usb {
namespace {

// bRequest.
constexpr std::uint8_t kGetStatus = 0;
constexpr std::uint8_t kClearFeature = 1;
constexpr std::uint8_t kSetFeature = 3;
constexpr std::uint8_t kSetAddress = 5;
constexpr std::uint8_t kGetDescriptor = 6;
constexpr std::uint8_t kGetConfiguration = 8;
constexpr std::uint8_t kSetConfiguration = 9;
constexpr std::uint8_t kGetInterface = 10;
constexpr std::uint8_t kSetInterface = 11;

// bDescriptorType.
constexpr std::uint8_t kDeviceDescriptor = 1;
constexpr std::uint8_t kConfigurationDescriptor = 2;
constexpr std::uint8_t kStringDescriptor = 3;
constexpr std::uint8_t kInterfaceDescriptor = 4;
constexpr std::uint8_t kEndpointDescriptor = 5;
constexpr std::uint8_t kHidDescriptor = 0x21;
constexpr std::uint8_t kHidReportDescriptor = 0x22;

constexpr std::uint16_t kLanguageEnglish = 0x0409;
constexpr std::size_t kMaxString = 126;  // bLength is one byte, a character is two

std::uint8_t byte_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return at < bytes.size() ? bytes[at] : std::uint8_t{0};
}

std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(byte_at(bytes, at) | (byte_at(bytes, at + 1) << 8U));
}

/// Calls `use(type, bytes)` for each descriptor in a configuration, up to the first with an invalid length.
template <class Use>
void each_descriptor(std::span<const std::uint8_t> configuration, Use&& use) {
  while (configuration.size() >= 2 && configuration[0] >= 2 && configuration[0] <= configuration.size()) {
    use(configuration[1], configuration.first(configuration[0]));
    configuration = configuration.subspan(configuration[0]);
  }
}

Bytes string_descriptor(const std::string& text) {
  const std::size_t length = std::min(text.size(), kMaxString);
  Bytes bytes = {static_cast<std::uint8_t>(2 + 2 * length), kStringDescriptor};
  for (const char c : text.substr(0, length)) {
    bytes.push_back(static_cast<std::uint8_t>(c));
    bytes.push_back(0);
  }
  return bytes;
}

}  // namespace

const Endpoint* Summary::endpoint(std::uint8_t address) const {
  const auto found = std::ranges::find(endpoints, address, &Endpoint::address);
  return found == endpoints.end() ? nullptr : &*found;
}

Summary summary_of(const Descriptors& descriptors) {
  const std::span<const std::uint8_t> device = descriptors.device;
  const auto string_at = [&](std::size_t at) {
    const std::size_t number = byte_at(device, at);
    return number >= 1 && number <= descriptors.strings.size() ? descriptors.strings[number - 1] : std::string();
  };
  Summary summary;
  summary.vendor_id = word_at(device, 8);
  summary.product_id = word_at(device, 10);
  summary.release = word_at(device, 12);
  summary.device_class = byte_at(device, 4);
  summary.subclass = byte_at(device, 5);
  summary.protocol = byte_at(device, 6);
  summary.configurations = byte_at(device, 17);
  summary.configuration_value = byte_at(descriptors.configuration, 5);
  summary.manufacturer = string_at(14);
  summary.product = string_at(15);
  summary.serial = string_at(16);

  each_descriptor(descriptors.configuration, [&](std::uint8_t type, std::span<const std::uint8_t> bytes) {
    const bool is_first_setting = byte_at(bytes, 3) == 0;
    if (type == kInterfaceDescriptor && is_first_setting) {
      summary.interfaces.push_back({byte_at(bytes, 2), byte_at(bytes, 5), byte_at(bytes, 6), byte_at(bytes, 7)});
    } else if (type == kEndpointDescriptor) {
      summary.endpoints.push_back(
          {byte_at(bytes, 2), static_cast<std::uint8_t>(byte_at(bytes, 3) & 3U), word_at(bytes, 4)});
    }
  });
  return summary;
}

SetupPacket usb_setup_of(std::span<const std::uint8_t, 8> bytes) {
  return {bytes[0], bytes[1], word_at(bytes, 2), word_at(bytes, 4), word_at(bytes, 6)};
}

ControlPipe::ControlPipe(Device& device)
    : device_(device), configuration_value_(summary_of(device.descriptors()).configuration_value) {}

std::optional<Bytes> ControlPipe::control(const SetupPacket& setup, std::span<const std::uint8_t> data) {
  std::optional<Bytes> reply = is_standard(setup) ? standard(setup) : device_.control(setup, data);
  if (reply) reply->resize(setup.is_to_host() ? std::min<std::size_t>(reply->size(), setup.length) : 0);
  return reply;
}

std::optional<Bytes> ControlPipe::standard(const SetupPacket& setup) {
  // Requests to read and to write have different numbers: one in the wrong direction is refused.
  if (setup.is_to_host()) {
    switch (setup.request) {
      case kGetStatus:
        return Bytes{0, 0};
      case kGetDescriptor:
        return descriptor(setup);
      case kGetConfiguration:
        return Bytes{configuration_};
      case kGetInterface:
        return Bytes{0};
      default:
        return std::nullopt;
    }
  }
  switch (setup.request) {
    case kClearFeature:
    case kSetFeature:
    case kSetAddress:
      return Bytes{};
    case kSetConfiguration:
      if (setup.value != 0 && setup.value != configuration_value_) return std::nullopt;
      configuration_ = static_cast<std::uint8_t>(setup.value);
      return Bytes{};
    case kSetInterface:
      return setup.value == 0 ? std::optional(Bytes{}) : std::nullopt;
    default:
      return std::nullopt;
  }
}

std::optional<Bytes> ControlPipe::descriptor(const SetupPacket& setup) const {
  const Descriptors& own = device_.descriptors();
  const auto type = static_cast<std::uint8_t>(setup.value >> 8U);
  const std::size_t number = setup.value & 0xFFU;
  switch (type) {
    case kDeviceDescriptor:
      return own.device;
    case kConfigurationDescriptor:
      return number == 0 ? std::optional(own.configuration) : std::nullopt;
    case kStringDescriptor:
      if (number == 0) {
        return Bytes{4, kStringDescriptor, kLanguageEnglish & 0xFFU, kLanguageEnglish >> 8U};
      }
      return number <= own.strings.size() ? std::optional(string_descriptor(own.strings[number - 1])) : std::nullopt;
    case kHidReportDescriptor:
      if (own.hid_report.empty() || setup.index != 0) return std::nullopt;
      return own.hid_report;
    case kHidDescriptor: {
      std::optional<Bytes> found;
      each_descriptor(own.configuration, [&](std::uint8_t inner_type, std::span<const std::uint8_t> bytes) {
        if (inner_type == kHidDescriptor && !found) found.emplace(bytes.begin(), bytes.end());
      });
      return found;
    }
    default:
      return std::nullopt;
  }
}

}  // namespace yuragi::simulators::usb
