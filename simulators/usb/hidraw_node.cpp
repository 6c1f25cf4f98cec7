#include "simulators/usb/hidraw_node.hpp"

#include <algorithm>
#include <cerrno>
#include <memory>
#include <utility>

#include <linux/hidraw.h>
#include <linux/input.h>
#include <sys/ioctl.h>

namespace yuragi::simulators::usb {
namespace {

// Of HID's requests (Device Class Definition for HID 1.11, 7.2).
constexpr std::uint8_t kClassIn = 0xA1;
constexpr std::uint8_t kClassOut = 0x21;
constexpr std::uint8_t kHidrawGetReport = 1;
constexpr std::uint8_t kHidrawSetReport = 9;
constexpr std::uint16_t kHidrawInputReport = 1;
constexpr std::uint16_t kHidrawOutputReport = 2;
constexpr std::uint16_t kHidrawFeatureReport = 3;

constexpr std::uint8_t kInterruptEndpoint = 3;
constexpr std::size_t kMaxReports = 64;    // HIDRAW_BUFFER_SIZE
constexpr std::size_t kMaxReport = 16384;  // HID_MAX_BUFFER_SIZE
constexpr double kTimeout_s = 5.0;         // USB_CTRL_GET_TIMEOUT

/// An ioctl's number without the size that is part of it.
constexpr unsigned long without_size(unsigned long request) {
  return request & ~(static_cast<unsigned long>(_IOC_SIZEMASK) << _IOC_SIZESHIFT);
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.c_str()), text.size() + 1};
}

}  // namespace

HidrawNode::HidrawNode(Host& host, const std::string& path)
    : host_(&host), readiness_(path, ReadinessNode::Direction::kReadable) {
  for (const Endpoint& endpoint : host.port().summary().endpoints) {
    if (endpoint.type != kInterruptEndpoint) continue;
    const auto number = static_cast<std::uint8_t>(endpoint.address & 0x0FU);
    if ((endpoint.address & 0x80U) == 0) {
      if (out_endpoint_ == 0) out_endpoint_ = number;
    } else if (in_endpoint_ == 0) {
      in_endpoint_ = number;
      report_size_ = endpoint.max_packet_size;
    }
  }
}

void HidrawNode::serve(double time_s) {
  time_s_ = time_s;
  give_up_late_ones();
  while (auto call = calls_.take()) obey(std::move(*call));
  read_reports();
  hand_out_reports();
}

void HidrawNode::unplug() {
  host_ = nullptr;
  reading_.reset();
  reports_.clear();
  for (ProgramCall& reader : readers_) reader.fail(EIO);
  readers_.clear();
  pending_.clear();
  readiness_.set_ready(true);  // wakes a program that waits in poll()
}

void HidrawNode::read_reports() {
  if (host_ == nullptr || in_endpoint_ == 0) return;
  if (!is_open()) {
    if (reading_) host_->cancel(*std::exchange(reading_, std::nullopt));
    reports_.clear();
    return;
  }
  if (reading_) return;
  Transfer transfer;
  transfer.endpoint = in_endpoint_;
  transfer.is_to_host = true;
  transfer.max_size = report_size_;
  reading_ = host_->submit(std::move(transfer), [this](const Outcome& outcome) {
    reading_.reset();
    if (outcome.is_refused) return;
    if (reports_.size() < kMaxReports) reports_.push_back(outcome.data);
    read_reports();
  });
}

void HidrawNode::hand_out_reports() {
  while (!reports_.empty() && !readers_.empty()) {
    ProgramCall reader = std::move(readers_.front());
    readers_.pop_front();
    const Bytes report = std::move(reports_.front());
    reports_.pop_front();
    // Before the reply: the program may call poll() at once, and would read again if more reports seemed to be
    // available.
    readiness_.set_ready(!reports_.empty());
    const ProgramMemory buffer = reader.argument();
    buffer.write(0, report);
    reader.reply(static_cast<long>(std::min(buffer.bytes().size(), report.size())));
  }
  readiness_.set_ready(host_ == nullptr || !reports_.empty());
}

void HidrawNode::obey(ProgramCall call) {
  switch (call.kind()) {
    case ProgramCallKind::kIoctl:
      if (host_ == nullptr) return call.fail(ENODEV);
      return obey_ioctl(std::move(call));
    case ProgramCallKind::kRead:
      if (host_ == nullptr) return call.fail(EIO);
      readers_.push_back(std::move(call));
      return hand_out_reports();
    case ProgramCallKind::kWrite: {
      if (host_ == nullptr) return call.fail(ENODEV);
      const ProgramMemory report = call.argument();
      return set_report(std::move(call), report.bytes(), kHidrawOutputReport);
    }
  }
}

void HidrawNode::obey_ioctl(ProgramCall call) {
  const unsigned long request = call.request();
  const std::size_t size = _IOC_SIZE(request);
  const ProgramMemory memory = call.argument().pointed_to(0, size);
  const Summary& summary = host_->port().summary();
  const Bytes& descriptor = host_->port().descriptors().hid_report;
  if (!memory) return call.fail(EFAULT);

  switch (without_size(request)) {
    case without_size(HIDIOCGRDESCSIZE):
      memory.write_value(static_cast<int>(descriptor.size()));
      return call.reply(0);
    case without_size(HIDIOCGRDESC): {
      hidraw_report_descriptor reply{};
      reply.size = static_cast<std::uint32_t>(std::min<std::size_t>(descriptor.size(), sizeof reply.value));
      std::copy_n(descriptor.begin(), reply.size, reply.value);
      memory.write_value(reply);
      return call.reply(0);
    }
    case without_size(HIDIOCGRAWINFO):
      memory.write_value(hidraw_devinfo{.bustype = BUS_USB,
                                        .vendor = static_cast<std::int16_t>(summary.vendor_id),
                                        .product = static_cast<std::int16_t>(summary.product_id)});
      return call.reply(0);
    case without_size(HIDIOCGRAWNAME(0)): {
      const std::string name = summary.manufacturer + " " + summary.product;
      memory.write(0, bytes_of(name));
      return call.reply(static_cast<long>(std::min(size, name.size() + 1)));
    }
    case without_size(HIDIOCGRAWUNIQ(0)):
      memory.write(0, bytes_of(summary.serial));
      return call.reply(static_cast<long>(std::min(size, summary.serial.size() + 1)));
    case without_size(HIDIOCGFEATURE(0)):
      return get_report(std::move(call), memory, kHidrawFeatureReport);
    case without_size(HIDIOCGINPUT(0)):
      return get_report(std::move(call), memory, kHidrawInputReport);
    case without_size(HIDIOCSFEATURE(0)):
      return set_report(std::move(call), memory.bytes(), kHidrawFeatureReport);
    case without_size(HIDIOCSOUTPUT(0)):
      return set_report(std::move(call), memory.bytes(), kHidrawOutputReport);
    default:
      return call.fail(ENOTTY);
  }
}

// The first byte of a buffer is the report's number. Reports without numbers have 0 there, which does not go over the
// wire.

void HidrawNode::get_report(ProgramCall call, const ProgramMemory& buffer, std::uint16_t type) {
  if (buffer.bytes().size() < 2 || buffer.bytes().size() > kMaxReport) return call.fail(EINVAL);
  const std::uint8_t number = buffer.bytes()[0];
  const std::size_t skipped = number == 0 ? 1 : 0;
  Transfer transfer;
  transfer.is_to_host = true;
  transfer.max_size = buffer.bytes().size() - skipped;
  transfer.setup = {kClassIn, kHidrawGetReport, static_cast<std::uint16_t>((type << 8U) | number), 0,
                    static_cast<std::uint16_t>(transfer.max_size)};
  const auto kept = std::make_shared<ProgramCall>(std::move(call));
  submit(kept, std::move(transfer), [kept, buffer, skipped](const Outcome& outcome) {
    if (outcome.is_refused) return kept->fail(EPIPE);
    buffer.write(skipped, outcome.data);
    kept->reply(static_cast<long>(outcome.size + skipped));
  });
}

void HidrawNode::set_report(ProgramCall call, std::span<const std::uint8_t> report, std::uint16_t type) {
  if (report.size() < 2 || report.size() > kMaxReport) return call.fail(EINVAL);
  const std::uint8_t number = report[0];
  const std::size_t whole = report.size();
  if (number == 0) report = report.subspan(1);
  Transfer transfer;
  transfer.data.assign(report.begin(), report.end());
  if (type == kHidrawOutputReport && out_endpoint_ != 0) {
    transfer.endpoint = out_endpoint_;
  } else {
    transfer.setup = {kClassOut, kHidrawSetReport, static_cast<std::uint16_t>((type << 8U) | number), 0,
                      static_cast<std::uint16_t>(report.size())};
  }
  const auto kept = std::make_shared<ProgramCall>(std::move(call));
  submit(kept, std::move(transfer), [kept, whole](const Outcome& outcome) {
    if (outcome.is_refused) return kept->fail(EPIPE);
    kept->reply(static_cast<long>(whole));
  });
}

void HidrawNode::submit(const std::shared_ptr<ProgramCall>& call, Transfer transfer, Host::Then then) {
  const std::uint64_t number = host_->submit(std::move(transfer), std::move(then));
  pending_.push_back({number, time_s_ + kTimeout_s, call});
}

void HidrawNode::give_up_late_ones() {
  std::erase_if(pending_, [this](const Pending& pending) {
    const auto call = pending.call.lock();
    if (call && time_s_ >= pending.deadline_s) {
      host_->cancel(pending.transfer);
      call->fail(ETIMEDOUT);
      return true;
    }
    return !call;
  });
}

}  // namespace yuragi::simulators::usb
