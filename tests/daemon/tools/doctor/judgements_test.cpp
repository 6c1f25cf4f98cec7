// Each judgement, for well and for ill.
#include "daemon/tools/doctor/judgements.hpp"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace yuragi::daemon::tools::doctor {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

testing::Matcher<Finding> is(Verdict verdict, const std::string& text, const std::string& remedy) {
  return testing::AllOf(testing::Field("verdict", &Finding::verdict, verdict),
                        testing::Field("text", &Finding::text, HasSubstr(text)),
                        testing::Field("remedy", &Finding::remedy,
                                       remedy.empty() ? testing::Matcher<std::string>(std::string())
                                                      : testing::Matcher<std::string>(HasSubstr(remedy))));
}

UtcTime in_year(int year) {
  return std::chrono::sys_days(
      std::chrono::year_month_day(std::chrono::year(year), std::chrono::month(6), std::chrono::day(1)));
}

DeviceFacts there(std::optional<EndpointKind> kind, const std::string& name) {
  return {.sensor = "roof", .kind = kind, .name = name, .is_there = true};
}

TEST(JudgeDevice, IsWellWhereItIsThereAndCanBeUsed) {
  EXPECT_THAT(judge(there(EndpointKind::kSerialPort, "/dev/ttyUSB0")),
              is(Verdict::kOk, "roof: serial port /dev/tty", ""));
  EXPECT_THAT(judge(there(std::nullopt, "synthetic needs no device")), is(Verdict::kOk, "needs no device", ""));
  DeviceFacts used = there(EndpointKind::kServer, "10.0.0.5:502");
  used.is_used = true;
  EXPECT_THAT(judge(used), is(Verdict::kOk, "the running daemon has readings", ""));
}

TEST(JudgeDevice, SaysOfEachKindHowToFindOneThatIsNotThere) {
  const auto absent = [](EndpointKind kind, const std::string& name) {
    return judge(DeviceFacts{.sensor = "roof", .kind = kind, .name = name});
  };
  EXPECT_THAT(absent(EndpointKind::kSerialPort, "/dev/ttyUSB0"),
              is(Verdict::kError, "/dev/ttyUSB0: was not found", "yuragi sensors list"));
  EXPECT_THAT(absent(EndpointKind::kUsb, "hid (station wmr300)"), is(Verdict::kError, "was not found", "lsusb"));
  EXPECT_THAT(absent(EndpointKind::kSoundCard, "microphone"), is(Verdict::kError, "was not found", "arecord -l"));
  EXPECT_THAT(absent(EndpointKind::kServer, "[fd00::5]:502"),
              is(Verdict::kError, "was not found", "ping -c 3 fd00::5;"));
  EXPECT_THAT(absent(EndpointKind::kBroker, "broker.lan:1883"),
              is(Verdict::kError, "MQTT broker", "ping -c 3 broker.lan;"));
  EXPECT_THAT(absent(EndpointKind::kUdpPort, ":9000"),
              is(Verdict::kError, "UDP port", "sudo ss -lunp 'sport = :9000'"));
  EXPECT_THAT(absent(EndpointKind::kTcpPort, "0.0.0.0:8090"),
              is(Verdict::kError, "TCP port", "sudo ss -ltnp 'sport = :8090'"));
  EXPECT_THAT(absent(EndpointKind::kFile, "day.windlog"), is(Verdict::kError, "file", "ls -l day.windlog"));
}

TEST(JudgeDevice, PassesOnWhatTheDriverSaysAboutOneThatCannotBeOpened) {
  DeviceFacts device = there(EndpointKind::kUsb, "WMR100 (0fde:ca01)");
  device.trouble = "cannot open /dev/hidraw0";
  device.remedy = "install the rule";
  EXPECT_THAT(judge(device), is(Verdict::kError, "cannot open /dev/hidraw0", "install the rule"));
}

TEST(JudgeGroups, AreThoseOfTheDevices) {
  GroupFacts groups{.user = "anna", .groups = {"anna", "dialout"}, .needed_groups = {"dialout"}};
  EXPECT_THAT(judge(groups), ElementsAre(is(Verdict::kOk, "anna", "")));
  groups.needed_groups = {"dialout", "plugdev", "audio"};
  EXPECT_THAT(judge(groups), ElementsAre(is(Verdict::kWarning, "group plugdev", "sudo adduser anna plugdev"),
                                         is(Verdict::kWarning, "group audio", "sudo adduser anna audio")));
  groups.is_root = true;
  EXPECT_THAT(judge(groups), ElementsAre(is(Verdict::kOk, "sudo -u yuragi", "")));
}

TEST(JudgeCompany, NeedsAServerThatRepliesAndPermits) {
  CompanyServerFacts server{.server = "nats://10.0.0.2:4222", .channel = "wind"};
  EXPECT_THAT(judge(server), is(Verdict::kError, "nats://10.0.0.2:4222: it does not reply", "ping -c 3 10.0.0.2;"));
  server.trouble = "connection refused";
  EXPECT_THAT(judge(server), is(Verdict::kError, "4222: connection refused", "systemctl status nats-server"));
  server.is_connected = true;
  server.trouble = "does not permit this user something";
  EXPECT_THAT(judge(server), is(Verdict::kError, "does not permit this user", "leader-and-followers.conf"));
}

TEST(JudgeCompany, NeedsALeaderWhereItFollows) {
  CompanyServerFacts server{.server = "nats://wind:4222", .channel = "wind", .is_connected = true};
  EXPECT_THAT(judge(server), is(Verdict::kOk, "nats://wind:4222: connected", ""));
  server.needs_leader = true;
  EXPECT_THAT(judge(server), is(Verdict::kWarning, "no leader is heard on the channel wind", "start the leader"));
  server.is_led = true;
  EXPECT_THAT(judge(server), is(Verdict::kOk, "a leader is heard on the channel wind", ""));
}

TEST(JudgeClock, HasToBeSetAndShouldBeKept) {
  EXPECT_THAT(judge(ClockFacts{in_year(2026), true}), is(Verdict::kOk, "2026-06-01T00:00:00Z, set by a time", ""));
  EXPECT_THAT(judge(ClockFacts{in_year(2026), std::nullopt}), is(Verdict::kOk, "2026-06-01", ""));
  EXPECT_THAT(judge(ClockFacts{in_year(2026), false}), is(Verdict::kWarning, "drift", "timedatectl set-ntp true"));
  for (const int year : {1970, 2023, 2100}) {
    EXPECT_THAT(judge(ClockFacts{in_year(year), true}),
                is(Verdict::kError, std::to_string(year) + "-06-01", "timedatectl set-time"));
  }
}

TEST(JudgeClock, HasToBeRightWhereScreensAreInStep) {
  ClockFacts clock{.now = in_year(2026), .is_synchronised = true, .offset = {.offset_s = -0.02, .source = "chrony"}};
  EXPECT_THAT(judge(clock), is(Verdict::kOk, "set by a time server; clock 20 ms behind UTC (chrony)", ""));
  clock.is_of_wall = true;
  EXPECT_THAT(judge(clock), is(Verdict::kWarning, "clock 20 ms behind UTC (chrony)", "apt install chrony"));
  clock.offset.offset_s = 0.0003;
  EXPECT_THAT(judge(clock), is(Verdict::kOk, "clock 0.30 ms ahead of UTC (chrony)", ""));
  clock.offset = {.offset_s = std::nullopt, .source = "no time service replies"};
  EXPECT_THAT(judge(clock), is(Verdict::kWarning, "offset unknown (no time service replies)", "chronyc tracking"));
}

DiskFacts roomy() {
  return {.folder = "/var/lib/yuragi",
          .is_there = true,
          .is_writable = true,
          .user = "yuragi",
          .free_bytes = 20e9,
          .least_free_bytes = 200e6,
          .bytes_a_day = 4e6};
}

TEST(JudgeDisk, NeedsTheFolderTheRightAndTheRoom) {
  EXPECT_THAT(judge(roomy()), is(Verdict::kOk, "20.0 GB free, about 4.0 MB a day", ""));
  DiskFacts disk = roomy();
  disk.is_there = false;
  EXPECT_THAT(judge(disk), is(Verdict::kError, "does not exist", "sudo install -d -o yuragi"));
  disk = roomy();
  disk.is_writable = false;
  EXPECT_THAT(judge(disk), is(Verdict::kError, "may not write", "sudo chown yuragi /var/lib/yuragi"));
  disk = roomy();
  disk.free_bytes.reset();
  EXPECT_THAT(judge(disk), is(Verdict::kWarning, "cannot be determined", "df -h"));
  disk = roomy();
  disk.free_bytes = 199e6;
  EXPECT_THAT(judge(disk), is(Verdict::kError, "less than the 200 MB", "du -xsh"));
}

TEST(JudgeDisk, ThatIsFullSoonIsTold) {
  DiskFacts disk = roomy();
  disk.free_bytes = 200e6 + 59 * 4e6;
  EXPECT_THAT(judge(disk), is(Verdict::kWarning, "full in 59 days", "keep_days"));
  disk.is_bounded = true;
  EXPECT_THAT(judge(disk), is(Verdict::kOk, "", ""));
  disk.is_bounded = false;
  disk.free_bytes = 200e6 + 61 * 4e6;
  EXPECT_THAT(judge(disk), is(Verdict::kOk, "", ""));
}

TEST(JudgePort, IsFreeOrADaemonOfOurs) {
  PortFacts port{.address = "127.0.0.1:7410", .port = 7410};
  EXPECT_THAT(judge(port), is(Verdict::kOk, "free", ""));
  port.trouble = "Address already in use";
  port.is_in_use = true;
  EXPECT_THAT(judge(port), is(Verdict::kError, "already in use", "sudo ss -ltnp 'sport = :7410'"));
  port.daemon = "yuragi 0.2.0";
  EXPECT_THAT(judge(port), is(Verdict::kOk, "yuragi 0.2.0 replies", ""));
  port = {.address = "10.9.9.9:7410", .trouble = "Cannot assign requested address", .port = 7410};
  EXPECT_THAT(judge(port), is(Verdict::kError, "Cannot assign", "ip address"));
}

TEST(JudgeConfig, TellsErrorsAndWhoCanReadSecrets) {
  EXPECT_THAT(judge(ConfigFacts{}), ElementsAre(is(Verdict::kOk, "built-in", "")));
  EXPECT_THAT(judge(ConfigFacts{.file = "a.toml"}), ElementsAre(is(Verdict::kOk, "a.toml: no errors", "")));
  EXPECT_THAT(judge(ConfigFacts{.file = "a.toml", .error = "a.toml:1:1: seed: is no number"}),
              ElementsAre(is(Verdict::kError, "a.toml:1:1: seed", "yuragi check-config a.toml")));
  EXPECT_THAT(
      judge(ConfigFacts{.file = "a.toml", .exposed = {"everybody on this machine can read a.toml; chmod 640 a.toml"}}),
      ElementsAre(Finding{Verdict::kWarning, "configuration", "everybody on this machine can read a.toml",
                          "chmod 640 a.toml"}));
}

TEST(JudgeDisplay, NeedsGraphicsAViewerAndAPlaceToDraw) {
  DisplayFacts display{.graphics = {"/dev/dri/card0"}, .has_display = true, .viewer = "yuragi-viewer 0.2.0"};
  EXPECT_THAT(judge(display), ElementsAre(is(Verdict::kOk, "/dev/dri/card0", ""), is(Verdict::kOk, "", "")));
  display.graphics_trouble = "belongs to the group video";
  display.graphics_remedy = "sudo adduser anna video";
  display.has_display = false;
  EXPECT_THAT(judge(display),
              ElementsAre(is(Verdict::kWarning, "group video", "sudo adduser anna video"),
                          is(Verdict::kWarning, "the viewer cannot draw", "systemctl enable --now yuragi-viewer")));
  EXPECT_THAT(judge(DisplayFacts{}), ElementsAre(is(Verdict::kWarning, "on the CPU", "lspci"),
                                                 is(Verdict::kWarning, "not installed", "apt install")));
}

TEST(JudgeVersions, AreToBeTheSame) {
  VersionFacts versions{.program = "yuragi 0.2.0",
                        .version = "0.2.0",
                        .viewer = "yuragi-viewer 0.2.0",
                        .daemon = "yuragi 0.2.0",
                        .libraries = {"libmodbus.so.5.1.0"}};
  EXPECT_THAT(judge(versions), ElementsAre(is(Verdict::kOk, "libmodbus.so.5.1.0", "")));
  versions.viewer = "yuragi-viewer 0.1.0";
  versions.daemon = "yuragi 0.1.0";
  EXPECT_THAT(judge(versions), ElementsAre(is(Verdict::kOk, "", ""), is(Verdict::kWarning, "different", "apt install"),
                                           is(Verdict::kWarning, "0.1.0 runs", "systemctl restart yuragi")));
  versions.viewer.reset();
  versions.daemon.clear();
  EXPECT_EQ(judge(versions).size(), 1U);
}

TEST(JudgeLimits, AreToAllowWhatIsNeeded) {
  LimitFacts limits{
      .open_files = 1024, .most_open_files = 4096, .needed_open_files = 104, .available_memory_bytes = 8'000'000'000};
  EXPECT_THAT(judge(limits), ElementsAre(is(Verdict::kOk, "1024", "")));
  limits.needed_open_files = 2000;
  EXPECT_THAT(judge(limits), ElementsAre(is(Verdict::kError, "may need 2000", "ulimit -n 2000")));
  limits.needed_open_files = 5000;
  EXPECT_THAT(judge(limits)[0].remedy, StartsWith("systemctl edit yuragi"));
  limits = {
      .open_files = 1024, .most_open_files = 1024, .needed_open_files = 104, .available_memory_bytes = 100'000'000};
  EXPECT_THAT(judge(limits),
              ElementsAre(is(Verdict::kOk, "", ""), is(Verdict::kWarning, "100 MB of memory", "ps -eo")));
}

TEST(Findings, ArePrintedWithTheirRemediesAndCounted) {
  const std::vector<Finding> findings = {{Verdict::kOk, "clock", "set", ""},
                                         {Verdict::kError, "disk", "full", "df -h"},
                                         {Verdict::kWarning, "limits", "few", "ulimit"}};
  EXPECT_EQ(gravest(findings), Verdict::kError);
  EXPECT_EQ(gravest({}), Verdict::kOk);
  const std::string text = findings_text(findings);
  EXPECT_THAT(text, HasSubstr("error    disk           full\n                        fix: df -h\n"));
  EXPECT_THAT(text, testing::EndsWith("1 error, 1 warning\n"));
  const auto json = nlohmann::ordered_json::parse(findings_json(findings).dump());
  EXPECT_EQ(json["verdict"], "error");
  EXPECT_TRUE(json["findings"][0]["remedy"].is_null());
  EXPECT_EQ(json["findings"][1]["remedy"], "df -h");
}

}  // namespace
}  // namespace yuragi::daemon::tools::doctor
