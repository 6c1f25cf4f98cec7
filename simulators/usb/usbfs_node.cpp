#include "simulators/usb/usbfs_node.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

namespace yuragi::simulators::usb {
namespace {

constexpr std::uint32_t kCapabilities =
    USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
constexpr std::size_t kSetupSize = 8;
constexpr int kMaxBuffer = 64 * 1024;

}  // namespace

UsbfsNode::UsbfsNode(Host& host, const std::string& path)
    : host_(&host), readiness_(path, ReadinessNode::Direction::kWritable) {}

void UsbfsNode::serve(double /*time_s*/) {
  while (auto call = calls_.take()) obey(std::move(*call));

  // A program that has closed the node waits for no transfer.
  if (!is_open()) {
    for (const auto& [address, urb] : under_way_) {
      if (host_ != nullptr) host_->cancel(urb.transfer);
    }
    under_way_.clear();
    done_.clear();
  }
  readiness_.set_ready(host_ == nullptr || !done_.empty());
}

void UsbfsNode::unplug() {
  host_ = nullptr;
  while (!under_way_.empty()) finish(under_way_.begin()->first, -ESHUTDOWN, 0);
  readiness_.set_ready(true);
}

void UsbfsNode::obey(ProgramCall call) {
  if (call.kind() != ProgramCallKind::kIoctl) return call.fail(EINVAL);
  const unsigned long request = call.request();
  if (request == USBDEVFS_REAPURB || request == USBDEVFS_REAPURBNDELAY) return reap(std::move(call));
  if (host_ == nullptr) return call.fail(ENODEV);
  switch (request) {
    case USBDEVFS_SUBMITURB:
      return submit(std::move(call));
    case USBDEVFS_DISCARDURB:
      return discard(std::move(call));
    case USBDEVFS_GET_CAPABILITIES:
      call.argument().pointed_to(0, sizeof kCapabilities).write_value(kCapabilities);
      return call.reply(0);
    case USBDEVFS_GETDRIVER:
      return call.fail(ENODATA);  // no kernel driver holds an interface
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_RELEASEINTERFACE:
    case USBDEVFS_SETCONFIGURATION:
    case USBDEVFS_SETINTERFACE:
    case USBDEVFS_CLEAR_HALT:
    case USBDEVFS_RESET:
    case USBDEVFS_IOCTL:
    case USBDEVFS_DISCONNECT_CLAIM:
      return call.reply(0);
    default:
      return call.fail(ENOTTY);
  }
}

void UsbfsNode::submit(ProgramCall call) {
  // The URB and its buffer, in the program.
  Urb urb;
  urb.memory = call.argument().pointed_to(0, sizeof(usbdevfs_urb));
  if (urb.memory.bytes().size() < sizeof(usbdevfs_urb)) return call.fail(EFAULT);
  usbdevfs_urb head;  // its last member has no size: it cannot be initialised in standard C++
  std::memcpy(&head, urb.memory.bytes().data(), sizeof head);
  if (head.buffer_length < 0 || head.buffer_length > kMaxBuffer) return call.fail(EINVAL);
  const auto length = static_cast<std::size_t>(head.buffer_length);
  urb.buffer = urb.memory.pointed_to(offsetof(usbdevfs_urb, buffer), length);
  std::span<const std::uint8_t> bytes = urb.buffer.bytes();
  if (bytes.size() != length) return call.fail(EFAULT);

  // As a transfer.
  Transfer transfer;
  transfer.endpoint = head.endpoint & 0x0FU;
  transfer.is_to_host = (head.endpoint & 0x80U) != 0;
  switch (head.type) {
    case USBDEVFS_URB_TYPE_CONTROL:
      if (length < kSetupSize) return call.fail(EINVAL);
      transfer.setup = usb_setup_of(bytes.first<kSetupSize>());
      transfer.is_to_host = transfer.setup.is_to_host();
      urb.header_size = kSetupSize;
      break;
    case USBDEVFS_URB_TYPE_BULK:
    case USBDEVFS_URB_TYPE_INTERRUPT:
      if (host_->port().summary().endpoint(head.endpoint) == nullptr) return call.fail(ENOENT);
      break;
    default:
      return call.fail(EINVAL);
  }
  bytes = bytes.subspan(urb.header_size);
  transfer.max_size = bytes.size();
  if (!transfer.is_to_host) transfer.data.assign(bytes.begin(), bytes.end());

  const std::uintptr_t address = urb.memory.address();
  urb.transfer =
      host_->submit(std::move(transfer), [this, address](const Outcome& outcome) { finish(address, outcome); });
  under_way_.insert_or_assign(address, std::move(urb));
  call.reply(0);
}

void UsbfsNode::discard(ProgramCall call) {
  // The argument is the URB's address itself.
  std::uintptr_t address = 0;
  const ProgramMemory argument = call.argument();
  std::memcpy(&address, argument.bytes().data(), std::min(sizeof address, argument.bytes().size()));
  const auto found = under_way_.find(address);
  if (found == under_way_.end()) return call.fail(EINVAL);
  host_->cancel(found->second.transfer);
  finish(address, -ENOENT, 0);
  call.reply(0);
}

void UsbfsNode::reap(ProgramCall call) {
  if (done_.empty()) return call.fail(host_ == nullptr ? ENODEV : EAGAIN);
  call.argument().pointed_to(0, sizeof(void*)).point_to(0, done_.front().memory);
  call.reply(0);
  done_.pop_front();
  readiness_.set_ready(host_ == nullptr || !done_.empty());
}

void UsbfsNode::finish(std::uintptr_t address, const Outcome& outcome) {
  if (const auto found = under_way_.find(address); found != under_way_.end()) {
    found->second.buffer.write(found->second.header_size, outcome.data);
  }
  finish(address, outcome.is_refused ? -EPIPE : 0, outcome.size);
}

void UsbfsNode::finish(std::uintptr_t address, int status, std::size_t size) {
  auto found = under_way_.extract(address);
  if (!found) return;
  const auto put = [&](std::size_t offset, int value) {
    std::array<std::uint8_t, sizeof value> bytes{};
    std::memcpy(bytes.data(), &value, sizeof value);
    found.mapped().memory.write(offset, bytes);
  };
  put(offsetof(usbdevfs_urb, status), status);
  put(offsetof(usbdevfs_urb, actual_length), static_cast<int>(size));
  done_.push_back(std::move(found.mapped()));
  readiness_.set_ready(true);
}

}  // namespace yuragi::simulators::usb
