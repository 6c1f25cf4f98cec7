#include "simulators/usb/umockdev_simulator.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "simulators/usb/hidraw_node.hpp"
#include "simulators/usb/umockdev_testbed.hpp"
#include "simulators/usb/usb_host.hpp"
#include "simulators/usb/usbfs_node.hpp"
#include "simulators/usb/usbip_server.hpp"

namespace yuragi::simulators::usb {
namespace {

constexpr const char* kRootHub = "/devices/pci0000:00/0000:00:14.0/usb1";
constexpr std::uint8_t kHidClass = 3;
constexpr unsigned kUsbMajor = 189;
constexpr unsigned kHidrawMajor = 241;
constexpr unsigned kMaxDeviceNumbers = 127;

std::string hex(std::span<const std::uint8_t> bytes) {
  return fmt::format("{:02X}", fmt::join(bytes, ""));
}

}  // namespace

/// A device in the testbed: its description in sysfs, and its nodes.
struct PluggedDevice {
  std::vector<std::string> paths;  // of all its parts, without /sys, the deepest first
  std::vector<std::string> node_names;
  std::vector<std::unique_ptr<EmulatedNode>> nodes;
};

struct UmockdevSimulator::State {
  struct Socket {
    explicit Socket(std::unique_ptr<Port> device) : port(std::move(device)), host(*port) {}
    std::unique_ptr<Port> port;
    Host host;
    std::optional<PluggedDevice> plugged;
  };

  explicit State(std::vector<std::unique_ptr<Port>> ports) : known_faults(faults_of(ports)) {
    for (auto& port : ports) sockets.push_back(std::make_unique<Socket>(std::move(port)));
    for (std::size_t i = 0; i < sockets.size(); ++i) plug_in(i);
  }

  /// Makes the device appear. The host's kernel gives it the next number each time, as a real one does.
  void plug_in(std::size_t index) {
    Socket& socket = *sockets[index];
    const Summary& summary = socket.port->summary();
    const bool is_hid = !summary.interfaces.empty() && summary.interfaces[0].device_class == kHidClass;
    device_number = device_number % kMaxDeviceNumbers + 1;
    PluggedDevice device;
    const std::string usb_path = fmt::format("{}/1-{}", kRootHub, index + 1);
    const std::string usb_node = fmt::format("bus/usb/001/{:03}", device_number);
    const std::string hidraw_node = fmt::format("hidraw{}", index);

    // The nodes first: a program that sees the device in sysfs can open it immediately.
    add_node<UsbfsNode>(socket, device, usb_node);
    if (is_hid) add_node<HidrawNode>(socket, device, hidraw_node);

    const auto add = [&](const std::string& path, const std::string& description) {
      testbed.add(description);
      device.paths.insert(device.paths.begin(), path);
    };
    add(usb_path, usb_description(socket, usb_path, usb_node));
    for (const Interface& interface : summary.interfaces) {
      const std::string path = fmt::format("{}/1-{}:1.{}", usb_path, index + 1, interface.number);
      add(path, interface_description(path, interface, is_hid && interface.number == 0));
    }
    if (is_hid) {
      const std::string hid_path = fmt::format("{}/1-{}:1.0/0003:{:04X}:{:04X}.{:04X}", usb_path, index + 1,
                                               summary.vendor_id, summary.product_id, ++hid_number);
      add(hid_path, hid_description(socket, hid_path, index));
      add(hid_path + "/hidraw/" + hidraw_node, hidraw_description(hid_path, hidraw_node, index));
    }
    for (auto path = device.paths.rbegin(); path != device.paths.rend(); ++path)
      testbed.send_uevent("/sys" + *path, "add");
    socket.plugged = std::move(device);
  }

  template <class Node>
  void add_node(Socket& socket, PluggedDevice& device, const std::string& name) {
    auto node = std::make_unique<Node>(socket.host, testbed.real_path("/dev/" + name));
    testbed.attach("/dev/" + name, node->calls());
    device.nodes.push_back(std::move(node));
    device.node_names.push_back(name);
  }

  /// Removes it. Its nodes stay for the programs that have them open, whose calls now fail.
  void unplug(Socket& socket) {
    PluggedDevice device = std::move(*std::exchange(socket.plugged, std::nullopt));
    socket.host.cancel_all();
    for (auto& node : device.nodes) {
      node->unplug();
      gone.push_back(std::move(node));
    }
    for (const std::string& path : device.paths) {
      testbed.send_uevent("/sys" + path, "remove");
      testbed.remove("/sys" + path);
    }
    for (const std::string& name : device.node_names) {
      std::error_code is_gone_already;
      std::filesystem::remove(testbed.real_path("/dev/" + name), is_gone_already);
      testbed.detach("/dev/" + name);
    }
  }

  std::string usb_description(const Socket& socket, const std::string& path, const std::string& node) const {
    const Summary& summary = socket.port->summary();
    const Descriptors& descriptors = socket.port->descriptors();
    std::string text = fmt::format(
        "P: {}\nE: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM={:03}\n"
        "E: MAJOR={}\nE: MINOR={}\nE: DEVNAME=/dev/{}\nE: PRODUCT={:x}/{:x}/{:x}\n",
        path, device_number, kUsbMajor, device_number - 1, node, summary.vendor_id, summary.product_id,
        summary.release);
    const auto attribute = [&text](const char* name, const std::string& value) {
      if (!value.empty()) text += fmt::format("A: {}={}\\n\n", name, value);
    };
    attribute("busnum", "1");
    attribute("devnum", std::to_string(device_number));
    text += fmt::format("A: dev={}:{}\n", kUsbMajor, device_number - 1);  // with its line end it would not be removed
    attribute("devpath", path.substr(path.rfind('-') + 1));
    attribute("speed", "12");
    attribute("idVendor", fmt::format("{:04x}", summary.vendor_id));
    attribute("idProduct", fmt::format("{:04x}", summary.product_id));
    attribute("bcdDevice", fmt::format("{:04x}", summary.release));
    attribute("bConfigurationValue", std::to_string(summary.configuration_value));
    attribute("bNumConfigurations", std::to_string(summary.configurations));
    attribute("manufacturer", summary.manufacturer);
    attribute("product", summary.product);
    attribute("serial", summary.serial);
    text += fmt::format("H: descriptors={}{}\n\n", hex(descriptors.device), hex(descriptors.configuration));
    return text;
  }

  static std::string interface_description(const std::string& path, const Interface& interface, bool is_hid) {
    return fmt::format(
        "P: {}\nE: DEVTYPE=usb_interface\nE: SUBSYSTEM=usb\n{}A: bInterfaceNumber={:02x}\\n\n"
        "A: bInterfaceClass={:02x}\\n\n\n",
        path, is_hid ? "E: DRIVER=usbhid\n" : "", interface.number, interface.device_class);
  }

  static std::string hid_description(const Socket& socket, const std::string& path, std::size_t index) {
    const Summary& summary = socket.port->summary();
    const std::string id = fmt::format("0003:{:08X}:{:08X}", summary.vendor_id, summary.product_id);
    const std::string name = summary.manufacturer + " " + summary.product;
    const std::string phys = fmt::format("usb-0000:00:14.0-{}/input0", index + 1);
    return fmt::format(
        "P: {0}\nE: SUBSYSTEM=hid\nE: DRIVER=hid-generic\nE: HID_ID={1}\nE: HID_NAME={2}\nE: HID_PHYS={3}\n"
        "E: HID_UNIQ={4}\n"
        "A: uevent=DRIVER=hid-generic\\nHID_ID={1}\\nHID_NAME={2}\\nHID_PHYS={3}\\nHID_UNIQ={4}\\n\n"
        "H: report_descriptor={5}\n\n",
        path, id, name, phys, summary.serial, hex(socket.port->descriptors().hid_report));
  }

  static std::string hidraw_description(const std::string& hid_path, const std::string& node, std::size_t index) {
    return fmt::format(
        "P: {0}/hidraw/{1}\nE: SUBSYSTEM=hidraw\nE: MAJOR={2}\nE: MINOR={3}\nE: DEVNAME=/dev/{1}\n"
        "A: dev={2}:{3}\nL: device=../../../{4}\n\n",
        hid_path, node, kHidrawMajor, index, hid_path.substr(hid_path.rfind('/') + 1));
  }

  UmockdevTestbed testbed;
  std::vector<core::FaultKind> known_faults;
  std::vector<std::unique_ptr<Socket>> sockets;
  std::vector<std::unique_ptr<EmulatedNode>> gone;  // nodes of unplugged devices that a program still has open
  unsigned device_number = 1;                       // the root hub's
  unsigned hid_number = 0;
  std::optional<core::FaultKind> fault;
};

UmockdevSimulator::UmockdevSimulator(std::vector<std::unique_ptr<Port>> ports)
    : state_(std::make_unique<State>(std::move(ports))) {}

UmockdevSimulator::~UmockdevSimulator() = default;

std::span<const core::FaultKind> UmockdevSimulator::known_faults() const {
  return state_->known_faults;
}

std::vector<int> UmockdevSimulator::descriptors() const {
  std::vector<int> all;
  for (const auto& socket : state_->sockets) {
    if (!socket->plugged) continue;
    for (const auto& node : socket->plugged->nodes) all.push_back(node->descriptor());
  }
  for (const auto& node : state_->gone) all.push_back(node->descriptor());
  return all;
}

void UmockdevSimulator::serve(std::span<const int> /*ready*/, double time_s, std::optional<core::FaultKind> fault) {
  State& state = *state_;
  state.fault = fault;
  for (std::size_t i = 0; i < state.sockets.size(); ++i) {
    State::Socket& socket = *state.sockets[i];
    socket.port->advance(time_s, fault);
    if (socket.plugged && !socket.port->is_plugged_in()) state.unplug(socket);
    if (!socket.plugged && socket.port->is_plugged_in()) state.plug_in(i);
    if (!socket.plugged) continue;

    // Calls of programs, the device's outcomes, and the calls that these complete.
    for (const auto& node : socket.plugged->nodes) node->serve(time_s);
    socket.host.serve();
    for (const auto& node : socket.plugged->nodes) node->serve(time_s);
  }
  for (const auto& node : state.gone) node->serve(time_s);
  std::erase_if(state.gone, [](const auto& node) { return !node->is_open(); });
}

std::string UmockdevSimulator::status() const {
  const State& state = *state_;
  const core::PlayedMoment moment =
      state.sockets.empty() ? core::PlayedMoment{} : state.sockets.front()->port->moment();
  std::size_t open = 0;
  for (const auto& socket : state.sockets) {
    if (socket->plugged) open += std::ranges::any_of(socket->plugged->nodes, &EmulatedNode::is_open) ? 1U : 0U;
  }
  return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {} of {} open{}{}", moment.speed_m_s, moment.direction_deg,
                     open, state.sockets.size(), state.fault ? ", fault: " : "",
                     state.fault ? name_of(*state.fault) : "");
}

}  // namespace yuragi::simulators::usb
