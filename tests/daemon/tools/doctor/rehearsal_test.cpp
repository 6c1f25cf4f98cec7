// The rehearsal of the next boot: what the user of a unit would meet, whoever asks.
#include "daemon/tools/doctor/rehearsal.hpp"

#include <fstream>
#include <functional>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "daemon/tools/doctor/service_judgements.hpp"
#include "tests/support/free_port.hpp"
#include "tests/support/places.hpp"
#include "tests/support/temporary_folder.hpp"

namespace yuragi::daemon::tools::doctor {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::uint32_t kUser = 901;
constexpr std::uint32_t kGroup = 902;
constexpr std::uint32_t kDialout = 20;

/// The packaged unit, with ids as a machine might have them.
ServiceUnit packaged() {
  std::ifstream in(test::source_path("config/systemd/yuragi.service"));
  ServiceUnit unit = parse_unit("yuragi.service", std::string{std::istreambuf_iterator<char>(in), {}});
  unit.user_id = kUser;
  unit.group_ids = {kGroup, kDialout};
  return unit;
}

Node root_folder(const std::string& path) {
  return {.path = path, .is_there = true, .mode = 0755};
}

/// A file that the service may use, below folders that everybody may enter.
PathFacts well(PathUse use, const std::string& path) {
  return {.what = "it",
          .use = use,
          .folders = {root_folder("/etc"), root_folder("/etc/yuragi")},
          .node = {.path = path, .is_there = true, .mode = 0660, .group = kGroup, .group_name = "yuragi"}};
}

TEST(ServiceUnit, IsReadFromThePackagedFile) {
  const ServiceUnit unit = packaged();
  EXPECT_EQ(unit.user, "yuragi");
  EXPECT_THAT(unit.groups, ElementsAre("audio", "dialout", "plugdev"));
  EXPECT_THAT(unit.folders, ElementsAre("/var/lib/yuragi"));
  EXPECT_EQ(unit.working_folder, "/var/lib/yuragi");
  EXPECT_EQ(unit.command.at(0), "/usr/bin/yuragi");
  EXPECT_TRUE(unit.hides_home);
  EXPECT_TRUE(unit.has_own_tmp);
  EXPECT_EQ(unit.protects_system, "strict");
  EXPECT_TRUE(unit.has_closed_devices);
  EXPECT_THAT(unit.devices, Contains("char-ttyUSB"));
  EXPECT_FALSE(unit.may_use_low_ports);
}

TEST(ServiceUnit, IsChangedByDropIns) {
  const ServiceUnit unit = parse_unit("a.service",
                                      "[Service]\nUser=a\nSupplementaryGroups=x y\nProtectHome=yes\n[Install]\nUser=z\n"
                                      "[Service]\nSupplementaryGroups=\nSupplementaryGroups=\\\n w\nProtectHome=no\n"
                                      "AmbientCapabilities=CAP_NET_BIND_SERVICE\n# User=b\n");
  EXPECT_EQ(unit.user, "a");
  EXPECT_THAT(unit.groups, ElementsAre("w"));
  EXPECT_FALSE(unit.hides_home);
  EXPECT_TRUE(unit.may_use_low_ports);
}

TEST(ServiceUnit, HasToHaveAUser) {
  ServiceUnit unit = packaged();
  EXPECT_THAT(judge(unit), IsEmpty());
  unit.user_id.reset();
  EXPECT_THAT(judge(unit).at(0).text, HasSubstr("no user yuragi"));
  EXPECT_THAT(judge(unit).at(0).remedy, HasSubstr("systemd-sysusers"));
}

/// A fault of a path: what is changed of one that is well, and what is found.
struct PathFault {
  const char* name;
  PathUse use;
  const char* path;
  std::function<void(PathFacts&)> spoil;
  const char* text;
  const char* remedy;
};

TEST(Rehearsal, FindsEachFaultOfAPathAndNothingElse) {
  const std::vector<PathFault> faults = {
      {"token missing", PathUse::kReadSecret, "/etc/yuragi/token", [](PathFacts& p) { p.node.is_there = false; },
       "is missing", "yuragi token"},
      {"token of another group", PathUse::kReadSecret, "/etc/yuragi/token", [](PathFacts& p) { p.node.group = 0; },
       "may not read it (mode 660", "sudo chgrp yuragi /etc/yuragi/token; sudo chmod 640"},
      {"folder closed", PathUse::kRead, "/etc/yuragi/a.png", [](PathFacts& p) { p.folders[1].mode = 0700; },
       "may not enter /etc/yuragi (mode 700)", "sudo chgrp yuragi /etc/yuragi"},
      {"recording's folder missing", PathUse::kWriteFolder, "/var/lib/yuragi/deep",
       [](PathFacts& p) { p.node.is_there = false; }, "is missing", "sudo install -d -o yuragi -g yuragi"},
      {"recording's folder of another", PathUse::kWriteFolder, "/var/lib/yuragi/deep",
       [](PathFacts& p) { p.node.mode = 0755; }, "may not write it", "sudo chown yuragi:yuragi /var/lib/yuragi/deep"},
      {"outside of what may be written", PathUse::kWriteFolder, "/srv/wind", [](PathFacts&) {},
       "may not write there (ProtectSystem=strict)", "ReadWritePaths=/srv/wind"},
      {"picture at home", PathUse::kRead, "/home/anna/a.png", [](PathFacts&) {}, "cannot see /home and /root",
       "sudo cp /home/anna/a.png /var/lib/yuragi/"},
      {"a link to a home", PathUse::kRead, "/etc/yuragi/a.png",
       [](PathFacts& p) { p.folders.push_back(root_folder("/home/anna")); }, "cannot see /home and /root", "sudo cp"},
      {"recording in /tmp", PathUse::kWriteFolder, "/tmp/wind", [](PathFacts&) {}, "PrivateTmp=", "/var/lib/yuragi"},
      {"picture of its owner alone", PathUse::kRead, "/etc/yuragi/a.png", [](PathFacts& p) { p.node.mode = 0600; },
       "may not read it (mode 600", "chmod g+r"},
      {"serial port of another group", PathUse::kDevice, "/dev/ttyUSB0",
       [](PathFacts& p) {
         p.node.group = 46;
         p.node.group_name = "plugdev2";
       },
       "may not open it", "SupplementaryGroups=plugdev2"},
      {"device without a rule", PathUse::kDevice, "/dev/hidraw0",
       [](PathFacts& p) {
         p.node.mode = 0600;
         p.node.group = 0;
       },
       "may not open it", "70-yuragi.rules"},
      {"device of a kind that the unit does not allow", PathUse::kDevice, "/dev/ttyAMA0",
       [](PathFacts& p) {
         p.node.device_classes = {"char-tty", "char-ttyAMA"};
       },
       "DeviceAllow=", "DeviceAllow=char-ttyAMA rw"},
      {"device unplugged", PathUse::kDevice, "/dev/ttyUSB0", [](PathFacts& p) { p.node.is_there = false; },
       "not plugged in", "sensors list"},
      {"profiles missing", PathUse::kList, "/usr/share/yuragi/profiles", [](PathFacts& p) { p.node.is_there = false; },
       "is missing", "ls -l /usr/share/yuragi/profiles"},
  };
  for (const PathFault& fault : faults) {
    SCOPED_TRACE(fault.name);
    PathFacts path = well(fault.use, fault.path);
    if (fault.use == PathUse::kWriteFolder || fault.use == PathUse::kList) path.node.mode = 0770;
    if (!std::string(fault.path).starts_with("/home") && !std::string(fault.path).starts_with("/tmp") &&
        !std::string(fault.path).starts_with("/srv")) {
      EXPECT_THAT(judge(path, packaged()), IsEmpty());
    }
    fault.spoil(path);
    const auto findings = judge(path, packaged());
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_NE(findings[0].verdict, Verdict::kOk);
    EXPECT_THAT(findings[0].text, HasSubstr(fault.text));
    EXPECT_THAT(findings[0].remedy, HasSubstr(fault.remedy));
  }
}

TEST(Rehearsal, TakesWhatSystemdMakesForTheUserAsHis) {
  PathFacts state = well(PathUse::kWriteFolder, "/var/lib/yuragi");
  state.node.is_there = false;
  EXPECT_THAT(judge(state, packaged()), IsEmpty()) << "it is made when the service starts";
  state.node = root_folder("/var/lib/yuragi");
  EXPECT_THAT(judge(state, packaged()), IsEmpty()) << "it is given to the user then";
}

TEST(Rehearsal, JudgesPortsForTheUserOfTheUnit) {
  const ServiceUnit unit = packaged();
  ListenFacts listen{.what = "[http] listen", .address = "127.0.0.1:7480", .port = 7480};
  EXPECT_THAT(judge(listen, unit), IsEmpty());
  listen.trouble = "Address already in use";
  listen.listener = 33;
  EXPECT_THAT(judge(listen, unit).at(0).text, HasSubstr("[http] listen: 127.0.0.1:7480: cannot listen here"));
  EXPECT_THAT(judge(listen, unit).at(0).remedy, HasSubstr("sport = :7480"));
  listen.listener = kUser;
  EXPECT_THAT(judge(listen, unit), IsEmpty()) << "the running service has it";
  listen = {.what = "[http] listen", .address = "0.0.0.0:80", .port = 80};
  EXPECT_THAT(judge(listen, unit).at(0).text, HasSubstr("may not listen on ports below 1024"));
  EXPECT_THAT(judge(listen, unit).at(0).remedy, HasSubstr("CAP_NET_BIND_SERVICE"));
  listen.first_unprivileged_port = 80;
  EXPECT_THAT(judge(listen, unit), IsEmpty());
}

TEST(Rehearsal, JudgesProgramsAndMonitors) {
  const ServiceUnit unit = packaged();
  ProgramFacts program{.path = "/usr/bin/xinit"};
  EXPECT_THAT(judge(program, unit).at(0).text, HasSubstr("/usr/bin/xinit, which is not installed"));
  program.is_there = true;
  EXPECT_THAT(judge(program, unit), IsEmpty());
  program.exit_code = 127;
  program.text = "yuragi: error while loading shared libraries: libmodbus.so.5: cannot open\n";
  EXPECT_THAT(judge(program, unit).at(0).text, HasSubstr("libmodbus.so.5"));

  MonitorFacts monitor{.output = "wall", .monitor = "HDMI-1"};
  EXPECT_THAT(judge(monitor).at(0).text, HasSubstr("no display can be reached"));
  EXPECT_EQ(judge(monitor).at(0).verdict, Verdict::kOk);
  monitor.present = {{"DP-1"}};
  EXPECT_THAT(judge(monitor).at(0).text, HasSubstr("monitor HDMI-1 is not connected; there is: DP-1"));
  monitor.monitor = "0";
  EXPECT_THAT(judge(monitor), IsEmpty());
}

TEST(Rehearsal, BeginsRelativePathsWhereTheServiceDoes) {
  const settings::Config config = settings::parse_config(
      "[recording]\nfile = \"wind.windlog\"\n[http]\ntoken_file = \"deep/../token\"\n", "a.toml");
  std::vector<std::string> paths;
  for (const PathFacts& path : named_paths({.config = config, .config_file = "/etc/yuragi/a.toml", .unit = packaged()}))
    paths.push_back(path.node.path);
  EXPECT_THAT(paths, ElementsAre("/etc/yuragi/a.toml", "/var/lib/yuragi/token", "/var/lib/yuragi",
                                 "/var/lib/yuragi/wind.windlog"));
}

/// Real files, and a user who is not who asks.
TEST(Rehearsal, LooksAtRealFilesAndPorts) {
  const test::TemporaryFolder folder;
  const LoopbackPort page(SOCK_STREAM);
  ASSERT_EQ(listen(page.descriptor(), 8), 0);
  std::ofstream(folder / "token") << "0123456789abcdef0123456789";
  chmod((folder / "token").c_str(), 0600);
  chmod(folder.path().c_str(), 0755);
  const settings::Config config = settings::parse_config(
      fmt::format("[stream]\nlisten = \"127.0.0.1:0\"\n[http]\nlisten = \"127.0.0.1:{}\"\ntoken_file = \"{}\"\n"
                  "[recording]\nfile = \"{}\"\n",
                  page.port(), (folder / "token").string(), (folder / "none/a.windlog").string()),
      "a.toml");
  ServiceUnit unit;
  unit.name = "yuragi.service";
  unit.user_id = 4'000'000;  // nobody's
  const auto texts = [&](const Rehearsal& rehearsal) {
    std::vector<std::string> all;
    for (const Finding& finding : rehearse_configuration(rehearsal)) all.push_back(finding.text);
    return all;
  };
  EXPECT_THAT(texts({.config = config, .unit = unit}),
              ElementsAre(HasSubstr("token: the user root of yuragi.service may not read it (mode 600"),
                          HasSubstr("none: is missing"), HasSubstr("cannot listen here")));
  EXPECT_THAT(
      texts({.config = config, .unit = this_process(), .own_addresses = {fmt::format("127.0.0.1:{}", page.port())}}),
      ElementsAre(HasSubstr("none: is missing")))
      << "who asks may read his own file";
}

}  // namespace
}  // namespace yuragi::daemon::tools::doctor
