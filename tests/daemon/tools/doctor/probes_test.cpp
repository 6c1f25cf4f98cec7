// What the probes see of this machine: real sockets, folders and programs.
#include <algorithm>
#include <chrono>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/tools/doctor/doctor.hpp"
#include "daemon/tools/doctor/local_port.hpp"
#include "daemon/tools/doctor/machine_probe.hpp"
#include "daemon/tools/doctor/program_output.hpp"
#include "daemon/tools/doctor/sensor_probe.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::tools::doctor {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

settings::Config config_of(const std::string& toml) {
  return settings::parse_config(toml, "test.toml");
}

std::vector<std::pair<std::optional<EndpointKind>, std::string>> names_in(const std::string& lines) {
  std::vector<std::pair<std::optional<EndpointKind>, std::string>> names;
  for (const DeviceFacts& device : named_devices(config_of("[[sensor]]\nname = \"roof\"\n" + lines).sensors[0]))
    names.emplace_back(device.kind, device.name);
  return names;
}

TEST(NamedDevices, AreWhatTheConfigurationSays) {
  using Named = std::pair<std::optional<EndpointKind>, std::string>;
  EXPECT_THAT(names_in("driver = \"modbus\"\nhost = \"10.0.0.5\"\nport = 1502"),
              ElementsAre(Named(EndpointKind::kServer, "10.0.0.5:1502")));
  EXPECT_THAT(names_in("driver = \"modbus\"\ntransport = \"rtu\"\ndevice = \"/dev/a\"\ndirection_device = \"/dev/b\""),
              ElementsAre(Named(EndpointKind::kSerialPort, "/dev/a"), Named(EndpointKind::kSerialPort, "/dev/b")));
  EXPECT_THAT(names_in("driver = \"nmea\"\ndevice = \"/dev/ttyS0\""),
              ElementsAre(Named(EndpointKind::kSerialPort, "/dev/ttyS0")));
  EXPECT_THAT(names_in("driver = \"nmea\"\ntransport = \"tcp\"\nhost = \"mast\""),
              ElementsAre(Named(EndpointKind::kServer, "mast:10110")));
  EXPECT_THAT(names_in("driver = \"nmea\"\ntransport = \"udp\"\nport = 5000"),
              ElementsAre(Named(EndpointKind::kUdpPort, ":5000")));
  EXPECT_THAT(names_in("driver = \"line\"\ntransport = \"file\"\nfile = \"/tmp/x\""),
              ElementsAre(Named(EndpointKind::kFile, "/tmp/x")));
  EXPECT_THAT(names_in("driver = \"mqtt\"\ntopic = \"a\""),
              ElementsAre(Named(EndpointKind::kBroker, "127.0.0.1:1883")));
  EXPECT_THAT(names_in("driver = \"mqtt\"\ntopic = \"a\"\nhost = \"lan\"\ntls = true"),
              ElementsAre(Named(EndpointKind::kBroker, "lan:8883")));
  EXPECT_THAT(names_in("driver = \"tempest\""), ElementsAre(Named(EndpointKind::kUdpPort, ":50222")));
  EXPECT_THAT(names_in("driver = \"ecowitt\"\nhost = \"gw\""), ElementsAre(Named(EndpointKind::kServer, "gw:45000")));
  EXPECT_THAT(names_in("driver = \"json\"\nurl = \"https://lan/a?key=b\"\nspeed = \"/a\""),
              ElementsAre(Named(EndpointKind::kServer, "lan:443")));
  EXPECT_THAT(names_in("driver = \"ecowitt-push\""), ElementsAre(Named(EndpointKind::kTcpPort, "127.0.0.1:8090")));
  EXPECT_THAT(names_in("driver = \"davis\"\ndevice = \"/dev/ttyUSB0\""),
              ElementsAre(Named(EndpointKind::kSerialPort, "/dev/ttyUSB0")));
  EXPECT_THAT(names_in("driver = \"weatherlink\"\nhost = \"wll\""),
              ElementsAre(Named(EndpointKind::kServer, "wll:80"), Named(EndpointKind::kUdpPort, ":22222")));
  EXPECT_THAT(names_in("driver = \"hid\"\nstation = \"wmr300\""),
              ElementsAre(Named(EndpointKind::kHid, "hid (station wmr300)")));
  EXPECT_THAT(names_in("driver = \"microphone\""), ElementsAre(Named(EndpointKind::kSoundCard, "microphone")));
  EXPECT_THAT(names_in("driver = \"windlog\"\nfile = \"a.windlog\""),
              ElementsAre(Named(EndpointKind::kFile, "a.windlog")));
  EXPECT_EQ(names_in("driver = \"synthetic\"").at(0).first, std::nullopt);
}

TEST(NamedDevices, OfEveryDriverAreKnown) {
  for (const drivers::sensor::DriverDescription* driver : drivers::sensor::driver_table()) {
    const auto sensor = settings::default_sensor("a", *driver, *settings::parse_values("", driver->parameters));
    for (const DeviceFacts& device : named_devices(sensor))
      EXPECT_EQ(device.kind == std::nullopt, driver->name == "synthetic") << driver->name;
  }
}

TEST(NeededGroups, AreThoseOfTheKindsOfDevices) {
  EXPECT_THAT(needed_groups(config_of("[[sensor]]\nname = \"a\"\ndriver = \"hid\"\n"
                                      "[[sensor]]\nname = \"b\"\ndriver = \"usb\"\n"
                                      "[[sensor]]\nname = \"c\"\ndriver = \"line\"\ndevice = \"/dev/ttyUSB0\"\n"
                                      "[[sensor]]\nname = \"d\"\ndriver = \"microphone\"\n")),
              ElementsAre("plugdev", "dialout", "audio"));
  EXPECT_THAT(needed_groups(settings::default_config()), IsEmpty());
}

TEST(ChosenDevice, IsComparedByWhatBothSay) {
  const auto finding = [](const settings::Config& config, const std::string& offered) {
    return sensors::DeviceFinding{config.sensors[0].driver, {"it", offered, "", ""}};
  };
  const settings::Config any = config_of("[[sensor]]\nname = \"a\"\ndriver = \"hid\"\n");
  EXPECT_TRUE(is_chosen(any.sensors[0], finding(any, "station = \"wmr100\"\npath = \"1-1\"")));
  const settings::Config one = config_of("[[sensor]]\nname = \"a\"\ndriver = \"hid\"\nstation = \"wmr300\"\n");
  EXPECT_TRUE(is_chosen(one.sensors[0], finding(one, "station = \"wmr300\"\npath = \"1-1\"")));
  EXPECT_FALSE(is_chosen(one.sensors[0], finding(one, "station = \"wmr100\"\npath = \"1-1\"")));
  const settings::Config card =
      config_of("[[sensor]]\nname = \"a\"\ndriver = \"microphone\"\ndevice = \"usb audio\"\n");
  EXPECT_TRUE(is_chosen(card.sensors[0], finding(card, "device = \"C-Media USB Audio: hw:1,0\"")));
  EXPECT_FALSE(is_chosen(card.sensors[0], finding(card, "device = \"HDA Intel\"")));
  EXPECT_FALSE(is_chosen(card.sensors[0], finding(any, "station = \"wmr100\""))) << "of another driver";
}

TEST(ProbeDevices, ReachesAHostOrSaysWhyNot) {
  const LoopbackPort server(SOCK_STREAM);
  ASSERT_EQ(listen(server.descriptor(), 8), 0);
  const std::string device = "[[sensor]]\nname = \"a\"\ndriver = \"modbus\"\nport = ";
  const auto open = probe_devices(config_of(device + std::to_string(server.port())), {}, std::nullopt, 10s);
  EXPECT_TRUE(open.at(0).is_there) << open.at(0).trouble;
  // Port 1 of this machine: nobody has it.
  const settings::Config closed = config_of(device + "1");
  EXPECT_THAT(probe_devices(closed, {}, std::nullopt, 10s).at(0).trouble, HasSubstr("Connection refused"));

  wire::Sensors running;
  running.sensors.resize(1);
  running.sensors[0].name = "a";
  running.sensors[0].state = wind::judging::SensorState::kLive;
  EXPECT_TRUE(probe_devices(closed, {}, running, 10s).at(0).is_used) << "and it was not asked";
  running.sensors[0].state = wind::judging::SensorState::kDisconnected;
  EXPECT_FALSE(probe_devices(closed, {}, running, 10s).at(0).is_used);
}

TEST(ProbeDevices, LooksForFilesPortsAndWhatIsPluggedIn) {
  const auto kinds = config_of(
      "[[sensor]]\nname = \"a\"\ndriver = \"windlog\"\nfile = \"/nonexistent.windlog\"\n"
      "[[sensor]]\nname = \"b\"\ndriver = \"line\"\ndevice = \"/dev/nonexistent\"\n"
      "[[sensor]]\nname = \"c\"\ndriver = \"line\"\ndevice = \"/dev/null\"\n"
      "[[sensor]]\nname = \"d\"\ndriver = \"hid\"\n");
  const std::vector<sensors::DeviceFinding> plugged = {
      {kinds.sensors[3].driver, {.what = "a station", .settings = "", .trouble = "closed", .remedy = "open it"}}};
  const auto found = probe_devices(kinds, plugged, std::nullopt, 1s);
  EXPECT_FALSE(found.at(0).is_there);
  EXPECT_FALSE(found.at(1).is_there);
  EXPECT_TRUE(found.at(2).is_there);
  EXPECT_EQ(found.at(2).trouble, "");
  EXPECT_EQ(found.at(3).name, "a station");
  EXPECT_EQ(found.at(3).remedy, "open it");
  EXPECT_FALSE(probe_devices(kinds, {}, std::nullopt, 1s).at(3).is_there);
}

TEST(LocalPort, IsFreeInUseOrOfAnotherMachine) {
  bool is_in_use = true;
  EXPECT_EQ(listen_trouble("127.0.0.1:0", is_in_use), "");
  EXPECT_FALSE(is_in_use);
  const LoopbackPort server(SOCK_STREAM);
  ASSERT_EQ(listen(server.descriptor(), 8), 0);
  EXPECT_THAT(listen_trouble(fmt::format("127.0.0.1:{}", server.port()), is_in_use), HasSubstr("in use"));
  EXPECT_TRUE(is_in_use);
  EXPECT_THAT(listen_trouble("192.0.2.1:7410", is_in_use), HasSubstr("Cannot assign"));  // RFC 5737: of nobody
  EXPECT_FALSE(is_in_use);
  EXPECT_NE(listen_trouble("no address", is_in_use), "");
  EXPECT_EQ(udp_trouble(":0"), "");
  EXPECT_NE(udp_trouble("192.0.2.1:9000"), "");
}

TEST(LocalPort, IsFreeForThoseThatShareIt) {
  const LoopbackPort other(SOCK_DGRAM);
  const std::string place = fmt::format("127.0.0.1:{}", other.port());
  EXPECT_THAT(udp_trouble(place), HasSubstr("in use"));
  EXPECT_THAT(udp_trouble(place, true), HasSubstr("in use")) << "the other one does not share it";
  const int yes = 1;
  ASSERT_EQ(setsockopt(other.descriptor(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes), 0);
  EXPECT_EQ(udp_trouble(place, true), "");
}

TEST(MachineProbe, SeesTheDiskOfAFolder) {
  const test::TemporaryFolder folder;
  settings::RecordingConfig recording;
  recording.file = folder / "wall.windlog";
  recording.least_free_bytes = 5;
  const DiskFacts disk = probe_disk(recording, 2.0);
  EXPECT_TRUE(disk.is_there);
  EXPECT_TRUE(disk.is_writable);
  ASSERT_TRUE(disk.free_bytes.has_value());
  const auto space = std::filesystem::space(folder.path());
  EXPECT_LE(*disk.free_bytes, static_cast<double>(space.capacity));
  EXPECT_EQ(disk.least_free_bytes, 5.0);
  EXPECT_EQ(disk.bytes_a_day, 2.0 * kBytesPerReading * 86400.0);
  EXPECT_FALSE(disk.is_bounded);
  recording.is_daily = true;
  recording.keep_days = 30;
  EXPECT_TRUE(probe_disk(recording, 2.0).is_bounded);
  recording.file = folder / "missing/wall.windlog";
  EXPECT_FALSE(probe_disk(recording, 2.0).is_there);
}

TEST(MachineProbe, SeesClockUserVersionsAndLimits) {
  EXPECT_LT(std::chrono::abs(probe_clock(settings::default_config()).now - std::chrono::system_clock::now()), 60s);
  EXPECT_FALSE(probe_groups({}).user.empty());
  const VersionFacts versions = probe_versions("", std::nullopt);
  EXPECT_THAT(versions.program, testing::StartsWith("yuragi "));
  EXPECT_THAT(versions.kernel, testing::StartsWith("Linux "));
  EXPECT_THAT(versions.libraries, testing::Contains(testing::StartsWith("libsqlite3.so")));
  const LimitFacts limits = probe_limits(settings::default_config());
  EXPECT_GT(limits.open_files, 0U);
  EXPECT_GT(limits.needed_open_files, 64U);
  EXPECT_GT(limits.available_memory_bytes.value_or(0), 1'000'000U);
}

TEST(ProgramOutput, IsAllThatAProgramSaysAndItsExitCode) {
  const auto said = program_output({"sh", "-c", "echo out; echo err >&2; exit 3"}, 60s);
  ASSERT_TRUE(said.has_value());
  EXPECT_EQ(said->text, "out\nerr\n");
  EXPECT_EQ(said->exit_code, 3);
  EXPECT_EQ(program_output({"printf", "%s", "$HOME; *"}, 60s)->text, "$HOME; *") << "no shell reads the arguments";
  EXPECT_FALSE(program_output({"yuragi-no-such-program"}, 60s).has_value());
}

TEST(ProgramOutput, IsBounded) {
  EXPECT_EQ(program_output({"sleep", "600"}, 50ms)->exit_code, -1);
  const auto endless = program_output({"yes"}, 60s, 10'000);
  EXPECT_EQ(endless->exit_code, -1);
  EXPECT_LT(endless->text.size(), 20'000U);
}

TEST(Doctor, FindsThisMachineAndTellsAWrongConfiguration) {
  const auto well = examine({.config_file = std::nullopt,
                             .config = config_of("[stream]\nlisten = \"127.0.0.1:0\"\n[[sensor]]\nname = \"a\"\n"
                                                 "driver = \"modbus\"\nport = 1\n"),
                             .config_error = "",
                             .daemon = std::nullopt});
  const auto of = [](const std::vector<Finding>& all, const std::string& area) {
    const auto found = std::ranges::find(all, area, &Finding::area);
    return found == all.end() ? Finding{Verdict::kOk, "none", "", ""} : *found;
  };
  EXPECT_EQ(of(well, "sensor").verdict, Verdict::kError);
  EXPECT_THAT(of(well, "sensor").text, HasSubstr("a: 127.0.0.1:1: cannot be reached: Connection refused"));
  EXPECT_EQ(of(well, "port").verdict, Verdict::kOk);
  for (const char* const area : {"configuration", "permissions", "clock", "graphics", "display", "version", "limits"})
    EXPECT_EQ(of(well, area).area, area);

  const auto ill = examine(
      {.config_file = "a.toml", .config = std::nullopt, .config_error = "a.toml:1:1: wrong", .daemon = std::nullopt});
  EXPECT_EQ(of(ill, "configuration").text, "a.toml:1:1: wrong");
  EXPECT_EQ(of(ill, "sensor").area, "none") << "what cannot be read names no devices";
}

}  // namespace
}  // namespace yuragi::daemon::tools::doctor
