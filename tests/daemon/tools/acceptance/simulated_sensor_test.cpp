#include "daemon/tools/acceptance/simulated_sensor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/settings/config.hpp"

namespace yuragi::daemon::tools::acceptance {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The sensor of a configuration with this entry.
settings::SensorConfig sensor_of(const std::string& entry) {
  return settings::parse_config("[[sensor]]\nname = \"roof\"\n" + entry + "\n[[scene]]\nkind = \"grass\"\n", "test")
      .sensors.front();
}

SimulationPlan plan_of_entry(const std::string& entry) {
  return plan_simulation(sensor_of(entry)).value();
}

std::string why_not(const std::string& entry) {
  const auto plan = plan_simulation(sensor_of(entry));
  return plan ? "it is simulated" : plan.error().message;
}

TEST(SimulationPlan, PlaysAModbusDeviceOverTcp) {
  const SimulationPlan plan = plan_of_entry(
      "driver = \"modbus\"\nprofile = \"renke-rs-fsjt-n01\"\ntransport = \"rtu\"\ndevice = \"/dev/ttyUSB7\"\n"
      "poll_interval = 0.5");
  EXPECT_THAT(plan.arguments, ElementsAre("modbus", "--tcp", "127.0.0.1:0", "--profile", "renke-rs-fsjt-n01", "--speed",
                                          "8", "--direction", "225", "--turbulence", "0"));
  const settings::SensorConfig sensor = at_port(plan, 4321);
  EXPECT_EQ(sensor.values.text("transport"), "tcp");
  EXPECT_EQ(sensor.values.text("host"), "127.0.0.1");
  EXPECT_EQ(sensor.values.text("device"), "");
  EXPECT_EQ(sensor.values.integer("port"), 4321);
  EXPECT_EQ(sensor.values.number("poll_interval"), 0.5) << "as configured";
}

TEST(SimulationPlan, PlaysTheSlaveIdsOfTheEntry) {
  EXPECT_THAT(plan_of_entry("driver = \"modbus\"\nspeed_slave = 5\ndirection_slave = 6").arguments,
              Contains("renke-rs-fsjt-rs-fxjt-n01@5"));
  EXPECT_THAT(plan_of_entry("driver = \"modbus\"\nprofile = \"calypso-ulp\"\nspeed_slave = 9").arguments,
              Contains("calypso-ulp@9"));
  EXPECT_THAT(why_not("driver = \"modbus\"\nspeed_slave = 5\ndirection_slave = 9"), HasSubstr("or is the next id"));
  EXPECT_THAT(why_not("driver = \"modbus\"\ndirection_slave = 9"), HasSubstr("direction_slave"));
}

TEST(SimulationPlan, PlaysTheTextThatASensorTakes) {
  const auto formats = [](const std::string& keys) {
    return plan_of_entry("driver = \"nmea\"\ndevice = \"/dev/ttyUSB7\"\n" + keys).arguments.at(4);
  };
  EXPECT_EQ(formats(""), "mwv");
  EXPECT_EQ(formats("format = \"umb\""), "umb");
  EXPECT_EQ(formats("sentences = \"MWD, XDR\""), "mwd,xdr");
  EXPECT_EQ(formats("reference = \"north\""), "mwd");
  EXPECT_EQ(formats("reference = \"true\""), "vwt");
  EXPECT_THAT(plan_of_entry("driver = \"line\"\ndevice = \"/dev/ttyACM0\"").arguments, Contains("csv"));
  EXPECT_THAT(plan_of_entry("driver = \"line\"\ndevice = \"/dev/ttyACM0\"\nformat = \"keys\"").arguments,
              Contains("key-value"));
  EXPECT_THAT(why_not("driver = \"line\"\ndevice = \"/dev/ttyACM0\"\nspeed_column = 3"), HasSubstr("4.2,270"));
}

TEST(SimulationPlan, PlaysADavisConsoleOverTcp) {
  const SimulationPlan plan = plan_of_entry("driver = \"davis\"\ndevice = \"/dev/ttyUSB7\"");
  EXPECT_THAT(plan.arguments,
              ElementsAre("davis", "--tcp", "127.0.0.1:0", "--speed", "8", "--direction", "225", "--turbulence", "0"));
  EXPECT_EQ(plan.sensor.values.text("transport"), "tcp");
  EXPECT_NEAR(plan.expected.speed_tolerance_m_s, 0.447, 0.001) << "it says whole miles per hour";
}

TEST(SimulationPlan, PlaysABusInTheLinesThatASensorTakes) {
  const auto arguments_of = [](const std::string& keys) {
    const auto all = plan_of_entry("driver = \"nmea2000\"\n" + keys).arguments;
    return all.at(4) + " " + all.at(6);
  };
  const std::string serial = "device = \"/dev/ttyACM0\"\n";
  EXPECT_EQ(arguments_of(serial), "yacht-devices apparent");
  EXPECT_EQ(arguments_of(serial + "format = \"canboat\""), "canboat apparent");
  EXPECT_EQ(arguments_of(serial + "format = \"canboat\"\nangle_unit = \"rad\""), "canboat-si apparent");
  EXPECT_EQ(arguments_of(serial + "reference = \"true\""), "yacht-devices boat");
  EXPECT_EQ(arguments_of("transport = \"can\"\nreference = \"north\""), "candump north");

  const SimulationPlan plan =
      plan_of_entry("driver = \"nmea2000\"\ntransport = \"can\"\naddress = 7\nnorth_offset = 10");
  EXPECT_EQ(plan.sensor.values.text("transport"), "tcp");
  EXPECT_EQ(plan.sensor.values.integer("address"), -1) << "the simulator's own is another";
  EXPECT_DOUBLE_EQ(plan.expected.direction_deg, 235.0);
  EXPECT_DOUBLE_EQ(plan_of_entry("driver = \"nmea2000\"\ntransport = \"can\"\nreference = \"north\"\nnorth_offset = 10")
                       .expected.direction_deg,
                   225.0);
}

TEST(SimulationPlan, PlaysASignalKServer) {
  const SimulationPlan plan = plan_of_entry(
      "driver = \"signalk\"\nhost = \"boat\"\nsource = \"n2k.105\"\ncontext = \"vessels.x\"\nnorth_offset = 10");
  EXPECT_THAT(plan.arguments, ElementsAre("signalk", "--tcp", "127.0.0.1:0", "--speed", "8", "--direction", "225",
                                          "--turbulence", "0"));
  EXPECT_EQ(plan.sensor.values.text("source"), "");
  EXPECT_EQ(plan.sensor.values.text("context"), "");
  EXPECT_DOUBLE_EQ(plan.expected.direction_deg, 235.0);
  EXPECT_THAT(why_not("driver = \"signalk\"\nhost = \"boat\"\nreference = \"north\""),
              HasSubstr("only the apparent wind"));
}

TEST(SimulationPlan, PlaysWhatSendsToTheSensor) {
  const SimulationPlan tempest = plan_of_entry("driver = \"tempest\"\nserial_number = \"ST-1\"\nport = 4000");
  EXPECT_THAT(tempest.arguments, ElementsAre("tempest", "--udp", "127.0.0.1:4000", "--interval", "1", "--station",
                                             "ST-1", "--speed", "8", "--direction", "225", "--turbulence", "0"));
  EXPECT_EQ(tempest.sensor.values.text("host"), "127.0.0.1");
  EXPECT_EQ(tempest.sensor.values.text("from"), "127.0.0.1") << "real hubs are not heard";
  EXPECT_EQ(at_port(tempest, simulator_port("sending to 127.0.0.1:4000\n").value()).values.integer("port"), 4000);

  const SimulationPlan push = plan_of_entry(
      "driver = \"ecowitt-push\"\nhost = \"0.0.0.0\"\nfrom = \"192.168.1.0/24\"\npath = \"/roof\"\nstation_key = "
      "\"KEY\"");
  EXPECT_THAT(push.arguments, ElementsAre("ecowitt-push", "--to", "127.0.0.1:8090", "--interval", "1", "--path",
                                          "/roof", "--speed", "8", "--direction", "225", "--turbulence", "0"));
  EXPECT_EQ(push.sensor.values.text("host"), "127.0.0.1");
  EXPECT_EQ(push.sensor.values.text("from"), "127.0.0.1");
  EXPECT_TRUE(push.sensor.values.secret("station_key").is_empty()) << "no key on a command line";
}

TEST(SimulationPlan, PlaysAProgramThatSendsMessages) {
  const SimulationPlan plan = plan_of_entry("driver = \"osc\"\nport = 9100\naddress = \"/roof\"\nspeed_argument = 2");
  EXPECT_THAT(plan.arguments,
              ElementsAre("osc", "--to", "127.0.0.1:9100", "--address", "/roof", "--speed-argument", "2",
                          "--direction-argument", "1", "--speed", "8", "--direction", "225", "--turbulence", "0"));
  EXPECT_THAT(why_not("driver = \"osc\"\naddress = \"/*\""), HasSubstr("is a pattern"));
}

TEST(SimulationPlan, PlaysWhatIsAskedInTheNetwork) {
  const SimulationPlan ecowitt = plan_of_entry("driver = \"ecowitt\"\nhost = \"192.168.1.30\"");
  EXPECT_THAT(ecowitt.arguments, ElementsAre("ecowitt", "--tcp", "127.0.0.1:0", "--interval", "1", "--speed", "8",
                                             "--direction", "225", "--turbulence", "0"));
  EXPECT_EQ(ecowitt.sensor.values.text("host"), "127.0.0.1");

  const SimulationPlan json = plan_of_entry(
      "driver = \"json\"\nurl = \"https://lan/?key=hunter2\"\nspeed = \"/a/0/v\"\ntime = \"/t\"\nspeed_unit = \"kn\"");
  EXPECT_THAT(json.arguments,
              ElementsAre("json", "--tcp", "127.0.0.1:0", "--interval", "1", "--unit", "kn", "--speed-at", "/a/0/v",
                          "--time-at", "/t", "--speed", "8", "--direction", "225", "--turbulence", "0"));
  EXPECT_EQ(at_port(json, 4321).values.secret("url"), Secret("http://127.0.0.1/wind.json"));
  EXPECT_THAT(why_not("driver = \"json\"\nurl = \"http://lan\"\nspeed = \"/a\"\ngust = \"/a/b\""),
              HasSubstr("each of speed, direction, gust and time at a place of its own"));

  const SimulationPlan live = plan_of_entry("driver = \"weatherlink\"\nhost = \"192.168.1.40\"\ntransmitter = 3");
  EXPECT_THAT(live.arguments,
              ElementsAre("weatherlink-live", "--tcp", "127.0.0.1:0", "--udp", "127.0.0.1:22222", "--interval", "1",
                          "--speed", "8", "--direction", "225", "--turbulence", "0"));
  const settings::SensorConfig sensor = at_port(live, 4321);
  EXPECT_EQ(sensor.values.integer("http_port"), 4321);
  EXPECT_EQ(sensor.values.integer("port"), 22222);
  EXPECT_EQ(sensor.values.text("host"), "127.0.0.1");
}

TEST(SimulationPlan, PlaysALufftOfTheConfiguredAddressOverTcp) {
  const SimulationPlan plan = plan_of_entry("driver = \"umb\"\ndevice = \"/dev/ttyUSB7\"\nclass = 8\nid = 3");
  EXPECT_THAT(plan.arguments, ElementsAre("umb", "--tcp", "127.0.0.1:0", "--class", "8", "--id", "3", "--speed", "8",
                                          "--direction", "225", "--turbulence", "0"));
  EXPECT_EQ(plan.sensor.values.text("transport"), "tcp");
}

TEST(SimulationPlan, ExpectsTheCalibratedWind) {
  const SimulationPlan plain = plan_of_entry("driver = \"modbus\"");
  EXPECT_DOUBLE_EQ(plain.expected.speed_m_s, 8.0);
  EXPECT_DOUBLE_EQ(plain.expected.direction_deg, 225.0);
  EXPECT_NEAR(plain.expected.speed_tolerance_m_s, 0.1, 1e-9);
  const SimulationPlan calibrated =
      plan_of_entry("driver = \"modbus\"\n[sensor.calibration]\ngain = 2\noffset = 0.5\nnorth_offset = 150");
  EXPECT_DOUBLE_EQ(calibrated.expected.speed_m_s, 16.5);
  EXPECT_NEAR(calibrated.expected.speed_tolerance_m_s, 0.2, 1e-9);
  EXPECT_NEAR(calibrated.expected.direction_deg, 15.0, 1e-9);
  const std::string nmea = "driver = \"nmea\"\ndevice = \"/dev/ttyUSB7\"\nnorth_offset = 10\n";
  EXPECT_DOUBLE_EQ(plan_of_entry(nmea).expected.direction_deg, 235.0);
  EXPECT_DOUBLE_EQ(plan_of_entry(nmea + "reference = \"north\"").expected.direction_deg, 225.0)
      << "what is from north needs no mark";
}

TEST(SimulationPlan, SaysWhatIsNotSimulated) {
  EXPECT_THAT(why_not("driver = \"usb\""), HasSubstr("a simulated usb cannot be started here"));
  EXPECT_THAT(why_not("driver = \"synthetic\""), HasSubstr("the driver synthetic has no simulated device"));
}

TEST(SimulatorPort, IsThatOfAWholeFirstLine) {
  EXPECT_EQ(simulator_port("listening on Modbus TCP 127.0.0.1:4001\nmore: 2\n"), 4001);
  EXPECT_EQ(simulator_port("listening on 127.0.0.1:40"), std::nullopt) << "more may come";
  EXPECT_EQ(simulator_port("serving\n"), std::nullopt);
  EXPECT_EQ(simulator_port("at 1.1.1.1:70000\n"), std::nullopt);
}

SensorMeasured measured(double speed_m_s, double direction_deg) {
  SensorMeasured sensor;
  sensor.status.state = wind::judging::SensorState::kLive;
  sensor.status.readings = 50;
  sensor.status.direction_deg = direction_deg;
  sensor.first_reading_s = 0.4;
  sensor.least_speed_m_s = sensor.mean_speed_m_s = sensor.largest_speed_m_s = speed_m_s;
  sensor.median_delay_s = 0.02;
  sensor.frames = sensor.moved_frames = 100;
  sensor.largest_live_weight = 1.0;
  return sensor;
}

TEST(JudgeSimulated, ComparesWithWhatWasSimulated) {
  const ExpectedWind expected{8.0, 0.1, 359.5, 1.0};
  EXPECT_THAT(judge_simulated(measured(8.05, 0.4), expected).remarks, IsEmpty()) << "a constant wind is no remark";
  EXPECT_EQ(judge_simulated(measured(8.05, 0.4), expected).outcome, Outcome::kPassed);
  EXPECT_THAT(judge_simulated(measured(16.0, 0.0), expected).remarks, ElementsAre(HasSubstr("it should be 8.00 m/s")));
  EXPECT_THAT(judge_simulated(measured(8.0, 180.0), expected).remarks,
              ElementsAre(HasSubstr("it should be 360 degrees")));
  EXPECT_EQ(judge_simulated(measured(8.0, 180.0), expected).outcome, Outcome::kFailed);
  SensorMeasured silent = measured(8.0, 0.0);
  silent.first_reading_s.reset();
  EXPECT_EQ(judge_simulated(silent, expected).outcome, Outcome::kFailed);
  SensorMeasured cup = measured(8.0, 0.0);
  cup.status.direction_deg.reset();
  EXPECT_EQ(judge_simulated(cup, expected).outcome, Outcome::kPassed) << "it has no vane";
}

}  // namespace
}  // namespace yuragi::daemon::tools::acceptance
