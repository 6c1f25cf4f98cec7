#include "drivers/bus/serial_ports.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/temporary_folder.hpp"

namespace yuragi::drivers::bus {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A machine's folders, made up.
class SerialPortsTest : public testing::Test {
 protected:
  SerialPortsTest() {
    fs::create_directories(places_.devices / "serial/by-id");
    fs::create_directories(places_.devices / "serial/by-path");
    fs::create_directories(places_.classes);
  }

  void add_node(const std::string& name) { std::ofstream(places_.devices / name) << ""; }
  void add_built_in(const std::string& name, int type) {
    add_node(name);
    fs::create_directories(places_.classes / name);
    std::ofstream(places_.classes / name / "type") << type << "\n";
  }
  void link(const std::string& folder, const std::string& name, const std::string& node) {
    fs::create_symlink("../../" + node, places_.devices / "serial" / folder / name);
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const SerialPortInfo& port : find_serial_ports(places_)) {
      names.push_back(fs::path(port.name).lexically_relative(places_.devices).string());
    }
    return names;
  }

  test::TemporaryFolder folder_;
  SerialPortPlaces places_{.devices = folder_ / "dev", .classes = folder_ / "class"};
};

TEST_F(SerialPortsTest, AreAdaptersAndThoseBuiltInPortsThatHaveAChip) {
  add_node("ttyUSB0");
  add_node("ttyACM3");
  add_node("tty1");
  add_node("ttyUSBx");
  add_node("ttyUSB");
  add_built_in("ttyS0", 4);
  add_built_in("ttyS1", 0);
  add_node("ttyS2");
  EXPECT_THAT(names(), testing::ElementsAre("ttyACM3", "ttyS0", "ttyUSB0"));
}

TEST_F(SerialPortsTest, GoByTheNameThatOutlastsARestart) {
  add_node("ttyUSB0");
  add_node("ttyUSB1");
  add_node("ttyUSB2");
  link("by-path", "pci-0000-usb-1", "ttyUSB0");
  link("by-id", "usb-FTDI_A1", "ttyUSB0");
  link("by-path", "pci-0000-usb-2", "ttyUSB1");
  link("by-id", "usb-that-is-gone", "ttyUSB9");
  EXPECT_THAT(names(), testing::ElementsAre("serial/by-id/usb-FTDI_A1", "serial/by-path/pci-0000-usb-2", "ttyUSB2"));
}

TEST_F(SerialPortsTest, AreNoneWhereThereIsNothingToLookAt) {
  EXPECT_TRUE(find_serial_ports({.devices = folder_ / "no", .classes = folder_ / "such"}).empty());
}

TEST_F(SerialPortsTest, ThatThisUserMayOpenHaveNoTrouble) {
  add_node("ttyUSB0");
  ASSERT_EQ(find_serial_ports(places_).size(), 1U);
  EXPECT_EQ(find_serial_ports(places_)[0].trouble, "");
}

TEST(SerialPortAccess, OfAFileThatIsGoneSaysSo) {
  EXPECT_THAT(access_trouble("/no/such/port").trouble, HasSubstr("No such file"));
}

TEST_F(SerialPortsTest, ThatBelongToAGroupNameItAndHowToJoin) {
  // Nobody in particular looks at it, from a process of his own: root may open everything.
  add_node("ttyUSB0");
  const fs::path node = places_.devices / "ttyUSB0";
  if (chown(node.c_str(), 0, 20) != 0) GTEST_SKIP() << "only root can give a file to the group dialout";
  chmod(node.c_str(), 0660);
  for (fs::path path = places_.devices; path != "/tmp" && path.has_relative_path(); path = path.parent_path()) {
    fs::permissions(path, fs::perms::others_exec | fs::perms::others_read, fs::perm_options::add);
  }
  const pid_t child = fork();
  if (child == 0) {
    if (setgid(65534) != 0 || setuid(65534) != 0) _exit(2);
    const auto ports = find_serial_ports(places_);
    _exit(ports.size() == 1 && ports[0].trouble.find("group dialout") != std::string::npos &&
                  ports[0].remedy.find("usermod -a -G dialout") != std::string::npos
              ? 0
              : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace yuragi::drivers::bus
