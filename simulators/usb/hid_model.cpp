// What USB and the HID class require of a device (USB 2.0 specification, 9.6; HID 1.11 specification, 6.2 and 7.2).
#include "simulators/usb/hid_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace yuragi::simulators::usb {
namespace {

constexpr double kKeptFor_s = 5.0;  // longer than a slow virtual machine takes to fetch a report
constexpr std::size_t kMaxQueue = 256;
constexpr std::uint8_t kTheEndpoint = 1;

// bmRequestType and bRequest of the HID class (7.2).
constexpr std::uint8_t kClassToHost = 0xA1;
constexpr std::uint8_t kClassToDevice = 0x21;
constexpr std::uint8_t kGetReportRequest = 0x01;
constexpr std::uint8_t kSetReportRequest = 0x09;
constexpr std::uint8_t kSetIdleRequest = 0x0A;
constexpr unsigned kInputType = 1;  // high byte of wValue
constexpr unsigned kOutputType = 2;

std::uint8_t low_byte(std::size_t number) {
  return static_cast<std::uint8_t>(number & 0xFFU);
}
std::uint8_t high_byte(std::size_t number) {
  return static_cast<std::uint8_t>((number >> 8U) & 0xFFU);
}

Bytes device_descriptor(const HidIdentity& identity) {
  return {18,
          0x01,
          0x10,
          0x01,  // USB 1.1
          0,
          0,
          0,                                                           // class: given by the interface
          static_cast<std::uint8_t>(identity.is_full_speed ? 64 : 8),  // packet of end point 0
          low_byte(identity.vendor),
          high_byte(identity.vendor),
          low_byte(identity.product),
          high_byte(identity.product),
          0x00,
          0x01,  // release 1.00
          1,
          2,
          0,  // manufacturer, product, no serial number
          1};
}

Bytes endpoint_descriptor(std::uint8_t address, const HidIdentity& identity) {
  return {7, 0x05, address, 0x03, identity.report_size, 0, identity.interval_ms};
}

Bytes configuration_descriptor(const HidIdentity& identity) {
  const std::size_t report_size = identity.report_descriptor.size();
  const std::uint8_t endpoints = identity.has_out_endpoint ? 2 : 1;
  Bytes bytes = {9, 0x02, 0, 0, 1, 1, 0, 0x80, 50};                   // bus powered, 100 mA
  const Bytes interface = {9, 0x04, 0, 0, endpoints, 0x03, 0, 0, 0};  // HID, no boot protocol
  const Bytes hid = {9, 0x21, 0x10, 0x01, 0, 1, 0x22, low_byte(report_size), high_byte(report_size)};
  const auto append = [&bytes](const Bytes& more) { bytes.insert(bytes.end(), more.begin(), more.end()); };
  append(interface);
  append(hid);
  append(endpoint_descriptor(0x80U | kTheEndpoint, identity));
  if (identity.has_out_endpoint) append(endpoint_descriptor(kTheEndpoint, identity));
  bytes[2] = low_byte(bytes.size());
  bytes[3] = high_byte(bytes.size());
  return bytes;
}

}  // namespace

Descriptors hid_descriptors(const HidIdentity& identity) {
  return {.device = device_descriptor(identity),
          .configuration = configuration_descriptor(identity),
          .hid_report = identity.report_descriptor,
          .strings = {identity.manufacturer, identity.product_name}};
}

Bytes plain_report_descriptor(std::uint8_t size) {
  return {0x06, 0xA0, 0xFF,  // usage page: the vendor's own
          0x09, 0x01,        // usage 1
          0xA1, 0x01,        // collection: application
          0x09, 0x02,        //   usage 2
          0x15, 0x00,        //   from 0
          0x26, 0xFF, 0x00,  //   to 255
          0x75, 0x08,        //   8 bits
          0x95, size,        //   each of so many
          0x81, 0x02,        //   input
          0x09, 0x03,        //   usage 3
          0x91, 0x02,        //   output, alike
          0xC0};
}

unsigned compass_point(double direction_deg) {
  return static_cast<unsigned>(std::lround(direction_deg / 22.5)) % 16U;
}

HidModel::HidModel(const HidIdentity& identity, std::span<const core::FaultKind> known_faults,
                   const HidModelOptions& options)
    : descriptors_(hid_descriptors(identity)),
      known_faults_(known_faults),
      options_(options),
      has_out_endpoint_(identity.has_out_endpoint),
      random_(options.seed) {}

void HidModel::advance(double time_s, const core::PlayedMoment& wind, std::optional<core::FaultKind> fault) {
  now_s_ = std::max(now_s_, time_s);
  wind_ = wind;
  fault_ = fault;
  play();
}

std::optional<Bytes> HidModel::control(const SetupPacket& setup, std::span<const std::uint8_t> data) {
  const unsigned type = setup.value >> 8U;
  if (setup.request_type == kClassToDevice && setup.request == kSetIdleRequest) return Bytes{};
  if (setup.request_type == kClassToDevice && setup.request == kSetReportRequest && type == kOutputType) {
    return take_output(data) ? std::optional(Bytes{}) : std::nullopt;
  }
  if (setup.request_type == kClassToHost && setup.request == kGetReportRequest && type == kInputType) {
    auto report = input_report(low_byte(setup.value));
    if (report && report->size() > setup.length) report->resize(setup.length);
    return report;
  }
  return std::nullopt;
}

std::optional<Bytes> HidModel::input_report(std::uint8_t) {
  return std::nullopt;
}

std::optional<Bytes> HidModel::in(std::uint8_t endpoint, std::size_t max_size) {
  if (endpoint != kTheEndpoint) return std::nullopt;
  while (!waiting_.empty() && waiting_.front().from_s + kKeptFor_s < now_s_) waiting_.pop_front();
  if (waiting_.empty() || waiting_.front().from_s > now_s_) return std::nullopt;
  Bytes report = std::move(waiting_.front().report);
  waiting_.pop_front();
  if (report.size() > max_size) report.resize(max_size);
  return report;
}

bool HidModel::out(std::uint8_t endpoint, std::span<const std::uint8_t> data) {
  return has_out_endpoint_ && endpoint == kTheEndpoint && take_output(data);
}

void HidModel::queue_report(Bytes report, double delay_s) {
  if (waiting_.size() == kMaxQueue) waiting_.pop_front();
  waiting_.push_back({now_s_ + delay_s, std::move(report)});
}

Bytes HidModel::random_bytes(std::size_t size) {
  Bytes bytes(size);
  std::ranges::generate(bytes, [this] { return static_cast<std::uint8_t>(random_()); });
  return bytes;
}

}  // namespace yuragi::simulators::usb
