// The real hidapi, with simulated stations in umockdev's testbed: found by id and place, opened, read, refused, lost;
// and the driver as the daemon opens it.
#include "drivers/bus/hid_device.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulators/usb/hid_stations.hpp"
#include "simulators/usb/umockdev_simulator.hpp"
#include "tests/simulators/usb/steady_wind.hpp"
#include "tests/support/driver_named.hpp"
#include "tests/support/live_sensor.hpp"
#include "tests/support/simulator_thread.hpp"

namespace yuragi::drivers::hid {
namespace {

using namespace std::chrono_literals;
using simulators::core::FaultKind;
using testing::HasSubstr;

constexpr std::array kIds = {bus::HidId{0x0FDE, 0xCA01}, bus::HidId{0x24C0, 0x0003}};
constexpr Nanoseconds kPatience = 60s;  // only a hang takes so long
constexpr double kPace = 20.0;

/// The stations in the sockets 1-1, 1-2 ... of a bus. "echo" is a device that is none.
std::unique_ptr<SimulatorThread> plug_in(std::initializer_list<std::string_view> names) {
  std::vector<std::unique_ptr<simulators::usb::Port>> ports;
  for (const std::string_view name : names) {
    ports.push_back(name == "echo"
                        ? simulators::usb::echo_port()
                        : std::make_unique<simulators::usb::Port>(simulators::usb::make_hid_station(name, kPace),
                                                                  simulators::usb::steady_wind(8.6, 225.0)));
  }
  return std::make_unique<SimulatorThread>(std::make_unique<simulators::usb::UmockdevSimulator>(std::move(ports)));
}

/// Takes the node away, so that nobody can open it, whoever it is.
void take_node_away(const std::string& node) {
  const char* const root = std::getenv("UMOCKDEV_DIR");  // NOLINT(concurrency-mt-unsafe): set before any thread
  ASSERT_NE(root, nullptr);
  std::filesystem::remove(root + node);
}

class HidDeviceTest : public testing::Test {
 protected:
  std::unique_ptr<bus::HidDevice> device_ = bus::make_hid_device();
  std::array<std::uint8_t, 64> buffer_{};

  std::string failure_of(const bus::HidPlace& place, std::span<const bus::HidId> ids = kIds) {
    const auto opened = device_->open(ids, place);
    return opened ? "" : opened.error().message;
  }
};

TEST_F(HidDeviceTest, SaysWhatIsMissing) {
  const auto bus = plug_in({"echo"});
  EXPECT_THAT(failure_of({}), HasSubstr("no device 0fde:ca01 or 24c0:0003 on USB: plug it in"));
  EXPECT_TRUE(bus::list_hid_devices(kIds).empty());
}

TEST_F(HidDeviceTest, ListsWhatIsPluggedInByPort) {
  const auto bus = plug_in({"acurite", "echo", "wmr100"});
  const auto listings = bus::list_hid_devices(kIds);
  ASSERT_EQ(listings.size(), 2U);
  EXPECT_EQ(listings[0].info.port, "1-1");
  EXPECT_EQ(listings[0].info.node, "/dev/hidraw0");
  EXPECT_EQ(listings[0].info.id, kIds[1]);
  EXPECT_EQ(listings[0].info.serial, "");
  EXPECT_EQ(listings[0].trouble, "");
  EXPECT_EQ(listings[1].info.port, "1-3");
  EXPECT_EQ(listings[1].info.id, kIds[0]);
}

TEST_F(HidDeviceTest, TellsTwoAlikeApartByPortOrNode) {
  const auto bus = plug_in({"wmr100", "wmr100"});
  const std::string failure = failure_of({});
  EXPECT_THAT(failure, HasSubstr("2 devices match"));
  EXPECT_THAT(failure, HasSubstr("1-1 (/dev/hidraw0), 1-2 (/dev/hidraw1)"));
  for (const std::string path : {"1-2", "/dev/hidraw1"}) {
    const auto opened = device_->open(kIds, {.serial = "", .path = path});
    ASSERT_TRUE(opened.has_value()) << opened.error().message;
    EXPECT_EQ(opened->node, "/dev/hidraw1");
    EXPECT_EQ(bus::where_is(*opened), "USB port 1-2");
  }
  EXPECT_THAT(failure_of({.serial = "", .path = "1-9"}), HasSubstr("at 1-9 on USB: plug it in"));
  EXPECT_THAT(failure_of({.serial = "", .path = "/dev/null"}), HasSubstr("at /dev/null"));
}

TEST_F(HidDeviceTest, TellsThemApartBySerialNumber) {
  const auto bus = plug_in({"echo"});
  constexpr std::array kEcho = {
      bus::HidId{simulators::usb::EchoDevice::kVendor, simulators::usb::EchoDevice::kProduct}};
  EXPECT_EQ(failure_of({.serial = "E0001", .path = ""}, kEcho), "");
  EXPECT_THAT(failure_of({.serial = "E0002", .path = ""}, kEcho), HasSubstr("serial number E0002"));
}

TEST_F(HidDeviceTest, SaysWhatToDoAboutANodeThatItMayNotOpen) {
  const auto bus = plug_in({"wmr100"});
  take_node_away("/dev/hidraw0");
  EXPECT_THAT(failure_of({}), HasSubstr("70-yuragi.rules"));
  const auto listings = bus::list_hid_devices(kIds);
  ASSERT_EQ(listings.size(), 1U);
  EXPECT_NE(listings[0].trouble, "");
}

TEST_F(HidDeviceTest, SendsAndReadsReportsAndIsSilentWithoutThem) {
  const auto bus = plug_in({"wmr100"});
  ASSERT_EQ(failure_of({}), "");
  EXPECT_EQ(device_->read(buffer_, 0ms).status, bus::HidStatus::kSilence);
  EXPECT_EQ(device_->read(buffer_, 120ms).status, bus::HidStatus::kSilence) << "it was not told to start";
  EXPECT_TRUE(device_->write(std::array<std::uint8_t, 9>{0, 0x20, 0x00, 0x08, 0x01, 0, 0, 0, 0}));
  const bus::HidArrival arrival = device_->read(buffer_, kPatience);
  ASSERT_EQ(arrival.status, bus::HidStatus::kReport);
  EXPECT_EQ(arrival.size, 8U);
}

TEST_F(HidDeviceTest, GetsAnInputReportOrARefusal) {
  const auto bus = plug_in({"acurite"});
  ASSERT_EQ(failure_of({}), "");
  const bus::HidArrival arrival = device_->get_input_report(1, std::span(buffer_).first(10));
  ASSERT_EQ(arrival.status, bus::HidStatus::kReport);
  EXPECT_EQ(arrival.size, 10U);
  EXPECT_EQ(buffer_[0], 1);
  EXPECT_EQ(device_->get_input_report(9, std::span(buffer_).first(10)).status, bus::HidStatus::kSilence);
}

TEST_F(HidDeviceTest, SeesADeviceThatIsGone) {
  const auto bus = plug_in({"acurite"});
  ASSERT_EQ(failure_of({}), "");
  bus->set_fault(FaultKind::kUnplug);
  EXPECT_EQ(device_->read(buffer_, kPatience).status, bus::HidStatus::kLost);
  EXPECT_EQ(device_->get_input_report(1, buffer_).status, bus::HidStatus::kLost);
  EXPECT_FALSE(device_->write(std::array<std::uint8_t, 9>{0, 1}));
  device_->close();
  EXPECT_EQ(device_->read(buffer_, kPatience).status, bus::HidStatus::kLost);
  bus->set_fault(std::nullopt);
  EXPECT_EQ(failure_of({}), "");
}

TEST_F(HidDeviceTest, EndsAReadThatIsInterruptedFromAnotherThread) {
  const auto bus = plug_in({"acurite"});
  ASSERT_EQ(failure_of({}), "");
  std::atomic<bool> is_reading = false;
  bus::HidArrival arrival;
  std::thread reader([&] {
    is_reading = true;
    arrival = device_->read(buffer_, 60s);
  });
  while (!is_reading) std::this_thread::yield();
  device_->interrupt();
  reader.join();
  EXPECT_EQ(arrival.status, bus::HidStatus::kInterrupted);
  EXPECT_EQ(device_->read(buffer_, 60s).status, bus::HidStatus::kInterrupted) << "and all later ones";
}

// --- the driver

TEST(HidDriverTest, FindsAStationAndHowToWriteItDown) {
  const auto bus = plug_in({"fineoffset", "te923"});
  take_node_away("/dev/hidraw1");
  const auto found = driver_named("hid").find();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].what, "Fine Offset WH1080 or WH3080 (1941:8021) at USB port 1-1");
  EXPECT_EQ(found[0].settings, "station = \"fineoffset\"\npath = \"1-1\"");
  EXPECT_EQ(found[0].trouble, "");
  EXPECT_EQ(found[0].remedy, "");
  EXPECT_THAT(found[1].trouble, HasSubstr("cannot open /dev/hidraw1"));
  EXPECT_THAT(found[1].remedy, HasSubstr("70-yuragi.rules"));
}

TEST(HidDriverTest, WaitsForAStationThatIsNotThere) {
  const auto bus = plug_in({"wmr300"});
  test::LiveSensor sensor(driver_named("hid").open(values_for("hid", {{"station", std::string("wmr100")}})));
  ASSERT_TRUE(sensor.wait_until([&] { return !sensor.sink.links.empty(); }));
  EXPECT_EQ(sensor.sink.last_state(), wind::LinkState::kConnecting);
  EXPECT_THAT(sensor.sink.last_detail(), HasSubstr("no device 0fde:ca01 on USB"));
}

TEST(HidDriverTest, RefusesAStationThatItDoesNotKnow) {
  const auto table = driver_named("hid").parameters;
  EXPECT_FALSE(ParameterValues::resolve(table, {{"station", std::string("wmr200")}}).has_value());
}

class HidDriverOfEveryStation : public testing::TestWithParam<std::string_view> {};

std::string suffix_of_station(const testing::TestParamInfo<std::string_view>& parameter) {
  std::string name(parameter.param);
  std::ranges::replace(name, '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Hid, HidDriverOfEveryStation, testing::ValuesIn(simulators::usb::hid_station_names()),
                         suffix_of_station);

TEST_P(HidDriverOfEveryStation, ReadsItsWindAndComesBackAfterThePlugWasPulled) {
  const auto bus = plug_in({"echo", GetParam()});
  test::LiveSensor sensor(driver_named("hid").open(values_for("hid", {{"pace", kPace}})));
  const RecordingSink& sink = sensor.sink;
  ASSERT_TRUE(sensor.wait_for_readings(2)) << sink.last_detail();
  EXPECT_NEAR(sink.readings.back().speed_m_s, 8.6, 0.12);
  EXPECT_THAT(sink.last_detail(), HasSubstr("at USB port 1-2"));

  bus->set_fault(FaultKind::kUnplug);
  EXPECT_TRUE(sensor.wait_until([&] { return sink.last_state() == wind::LinkState::kConnecting; }));
  bus->set_fault(std::nullopt);
  EXPECT_TRUE(sensor.wait_for_readings(1)) << sink.last_detail();
  EXPECT_EQ(sink.last_state(), wind::LinkState::kConnected);
  EXPECT_NEAR(sink.readings.back().speed_m_s, 8.6, 0.12);
}

}  // namespace
}  // namespace yuragi::drivers::hid
