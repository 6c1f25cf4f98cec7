// Every driver: two sensors that read the same values are refused, and what they may share stays allowed.
#include "daemon/settings/same_device.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "daemon/settings/config.hpp"
#include "drivers/sensor/driver.hpp"

namespace yuragi::daemon::settings {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

struct SensorPair {
  std::string name;    ///< of the case
  std::string driver;  ///< of both sensors, where their entries name none
  std::string first;   ///< the keys of two sensors
  std::string second;
  std::string shared = {};  ///< what the message names; empty: they are allowed together
};

// /dev/yuragi-... is on no machine, so that nothing of what is plugged in here is named.
const std::vector<SensorPair>& sensor_pairs() {
  static const std::vector<SensorPair> kPairs = {
      {"DavisConsole", "davis", "device = '/dev/yuragi-a'", "device = '/dev/yuragi-a'",
       "read serial port /dev/yuragi-a: "},
      {"DavisServer", "davis", "transport = 'tcp'\nhost = 'Logger'", "transport = 'tcp'\nhost = 'logger'",
       "read logger:22222: "},
      {"DavisTwoConsoles", "davis", "transport = 'tcp'\nhost = 'a'", "transport = 'tcp'\nhost = 'b'", ""},

      {"WeatherLinkTransmitter", "weatherlink", "host = 'wll'\ntransmitter = 2", "host = 'wll'\ntransmitter = 2",
       "read WeatherLink Live wll:80 (transmitter: 2): "},
      // "0" reads the first station that has a wind, which may be the other sensor's.
      {"WeatherLinkAnyTransmitter", "weatherlink", "host = 'wll'", "host = 'wll'\ntransmitter = 2",
       "(transmitter: any and 2)"},
      {"WeatherLinkTransmitters", "weatherlink", "host = 'wll'\ntransmitter = 1", "host = 'wll'\ntransmitter = 2", ""},
      {"TwoWeatherLinks", "weatherlink", "host = 'a'", "host = 'b'", ""},

      {"AnyWeatherStation", "hid", "", "", "read USB weather station: "},
      // Without a place the only station that is plugged in is read: the other sensor's.
      {"WeatherStationByPathAndAny", "hid", "", "path = '1-1'", "(path: any and 1-1)"},
      {"WeatherStationBySerial", "hid", "serial = 'A1'", "serial = 'A1'\nstation = 'wmr300'", "serial: A1"},
      {"WeatherStationByLink", "hid", "path = '/dev/null'", "path = '/dev/../dev/null'", "path: /dev/null"},
      {"WeatherStationsByPath", "hid", "path = '1-1'", "path = '1-2'", ""},
      {"WeatherStationsBySerial", "hid", "serial = 'A1'", "serial = 'A2'", ""},
      {"WeatherStationsByPathAndSerial", "hid", "path = '1-1'", "serial = 'A2'", ""},
      {"WeatherStationsOfTwoKinds", "hid", "station = 'wmr100'", "station = 'te923'", ""},

      {"UmbId", "umb", "transport = 'tcp'\nhost = 'a'\nid = 2", "transport = 'tcp'\nhost = 'a'\nid = 2",
       "read a:9750 (class: 7; id: 2): "},
      {"UmbIdsBehindOneServer", "umb", "transport = 'tcp'\nhost = 'a'", "transport = 'tcp'\nhost = 'a'\nid = 2", ""},
      {"UmbClassesBehindOneServer", "umb", "transport = 'tcp'\nhost = 'a'", "transport = 'tcp'\nhost = 'a'\nclass = 8",
       ""},
      // The driver opens a serial port for one device.
      {"UmbIdsOnOnePort", "umb", "device = '/dev/yuragi-a'", "device = '/dev/yuragi-a'\nid = 2",
       "need serial port /dev/yuragi-a, "},

      {"DefaultMicrophone", "microphone", "", "channels = 2", "read the default sound input: "},
      // Channels are counted from the first one on.
      {"MicrophoneChannel", "microphone", "device = 'UMC404HD'", "device = 'umc404hd'\nchannels = 4",
       "read sound input (device: umc404hd): "},
      // A part of a name selects the first input that has it.
      {"MicrophoneByPartOfAName", "microphone", "device = 'UMC'", "device = 'UMC404HD'", "(device: umc and umc404hd)"},
      {"MicrophonesOfOneCard", "microphone", "device = 'UMC404HD 192k: USB Audio (hw:1,0)'",
       "device = 'UMC404HD 192k: USB Audio (hw:1,1)'", ""},
      {"MicrophonesOfTwoSystems", "microphone", "device = 'UMC'\nhost_api = 'ALSA'",
       "device = 'UMC'\nhost_api = 'JACK'", ""},

      {"ModbusId", "modbus", "host = 'a'\nspeed_slave = 3", "host = 'A'\nspeed_slave = 3",
       "read Modbus line a:502 (speed_slave: 3; profile: function 3, register 0): "},
      {"ModbusIdOnALine", "modbus", "transport = 'rtu'\ndevice = '/dev/yuragi-a'",
       "transport = 'rtu'\ndevice = '/dev/yuragi-a'", "read serial port /dev/yuragi-a (speed_slave: 1; "},
      {"ModbusIdsOnALine", "modbus", "transport = 'rtu'\ndevice = '/dev/yuragi-a'",
       "transport = 'rtu'\ndevice = '/dev/yuragi-a'\nspeed_slave = 7", ""},
      {"ModbusIdsBehindAGateway", "modbus", "host = 'a'", "host = 'a'\nspeed_slave = 7", ""},
      {"ModbusOneVane", "modbus", "host = 'a'\ndirection_slave = 9", "host = 'a'\nspeed_slave = 7\ndirection_slave = 9",
       ""},

      {"MqttTopic", "mqtt", "topic = 'wind'", "topic = 'wind'\nhost = 'localhost'",
       "read MQTT broker 127.0.0.1:1883 (topic: wind; "},
      {"MqttKey", "mqtt", "topic = 'wind'\nspeed_path = '/a'", "topic = 'wind'\nspeed_path = '/a'", "speed_path: /a"},
      {"MqttPresetsKey", "mqtt", "topic = 't'\npreset = 'rtl_433'",
       "topic = 't'\npreset = 'rtl_433'\nspeed_path = '/wind_avg_km_h'", "speed_path: "},
      // A filter takes all topics that match it.
      {"MqttFilter", "mqtt", "topic = 'garden/+/wind'", "topic = 'garden/roof/wind'", "topic: garden/+/wind and "},
      {"MqttTwoFilters", "mqtt", "topic = 'garden/+/wind'", "topic = 'garden/#'", "topic: garden/+/wind and "},
      {"MqttChannel", "mqtt", "topic = 't'\npreset = 'rtl_433'\nchannel = 'A'",
       "topic = 't'\npreset = 'rtl_433'\nchannel = 'A'", "channel: A"},
      // The first station that is heard is read, which may be the other sensor's.
      {"MqttAnyStation", "mqtt", "topic = 't'\npreset = 'rtl_433'", "topic = 't'\npreset = 'rtl_433'\nid = '115'",
       "id: any and 115"},
      {"MqttKeysOfOneTopic", "mqtt", "topic = 'wind'\nspeed_path = '/a'", "topic = 'wind'\nspeed_path = '/b'", ""},
      {"MqttChannelsOfOneTopic", "mqtt", "topic = 't'\npreset = 'rtl_433'\nchannel = 'A'",
       "topic = 't'\npreset = 'rtl_433'\nchannel = 'B'", ""},
      {"MqttTopicsOfOneBroker", "mqtt", "topic = 'a'", "topic = 'b'", ""},
      {"MqttTwoBrokers", "mqtt", "topic = 'a'", "topic = 'a'\nhost = 'b'", ""},

      {"EcowittGateway", "ecowitt", "host = 'gw'", "host = 'gw'", "read gateway gw:45000: "},
      {"TwoEcowittGateways", "ecowitt", "host = '192.168.1.30'", "host = '192.168.1.31'", ""},

      {"JsonUrl", "json", "url = 'http://a/b?c=d'\nspeed = '/s'", "url = 'http://a:80/b?c=d'\nspeed = '/s'",
       "read server a:80 (url: #"},
      {"JsonQueriesOfOneServer", "json", "url = 'http://a/b?c=1'\nspeed = '/s'", "url = 'http://a/b?c=2'\nspeed = '/s'",
       ""},
      {"JsonValuesOfOneAnswer", "json", "url = 'http://a/b'\nspeed = '/s'", "url = 'http://a/b'\nspeed = '/t'", ""},

      {"EcowittPushPort", "ecowitt-push", "", "path = '/b'", "read pushes to TCP port 8090: "},
      {"EcowittPushPorts", "ecowitt-push", "", "port = 8091", ""},

      {"TempestStation", "tempest", "serial_number = 'ST-1'", "serial_number = 'ST-1'",
       "read UDP port 50222 (serial_number: ST-1): "},
      {"TempestAnyStation", "tempest", "", "serial_number = 'ST-1'", "(serial_number: any and ST-1)"},
      {"TempestStations", "tempest", "serial_number = 'ST-1'", "serial_number = 'ST-2'", ""},
      {"TempestHubs", "tempest", "from = '192.168.1.20'", "from = '192.168.1.21'", ""},
      {"TempestHubInANet", "tempest", "from = '192.168.1.0/24'", "from = '192.168.1.21'", "from: 192.168.1.0/24 and "},

      {"OscAddress", "osc", "", "", "read UDP port 9000 (address: /wind; "},
      // One port of this machine is opened by one sensor; a multicast group by any number.
      {"OscAddressesOfOnePort", "osc", "", "address = '/b'", "need UDP port 9000, "},
      {"OscPattern", "osc", "host = '239.1.2.3'\nfrom = '0.0.0.0/0'\naddress = '/*/wind'",
       "host = '239.1.2.3'\nfrom = '0.0.0.0/0'\naddress = '/roof/wind'", "address: /*/wind and /roof/wind"},
      {"OscAddressesOfOneGroup", "osc", "host = '239.1.2.3'\nfrom = '0.0.0.0/0'\naddress = '/a'",
       "host = '239.1.2.3'\nfrom = '0.0.0.0/0'\naddress = '/b'", ""},
      {"OscPorts", "osc", "", "port = 9001", ""},

      {"NmeaServer", "nmea", "transport = 'tcp'\nhost = '127.0.0.1'", "transport = 'tcp'\nhost = 'localhost'",
       "read 127.0.0.1:10110 "},
      {"NmeaTalker", "nmea", "transport = 'tcp'\nhost = 'a'\ntalker = 'WI'\nsender = '10.0.0.1'",
       "transport = 'tcp'\nhost = 'a'\ntalker = 'WI'\nsender = '10.0.0.2'", "(talker: WI; "},
      // Any talker that is heard first is read.
      {"NmeaAnyTalker", "nmea", "transport = 'tcp'\nhost = 'a'", "transport = 'tcp'\nhost = 'a'\ntalker = 'WI'",
       "(talker: any and WI; "},
      {"NmeaSentence", "nmea", "transport = 'tcp'\nhost = 'a'\nsentences = 'MWD,MWV'",
       "transport = 'tcp'\nhost = 'a'\nsentences = 'MWV'", "sentences: MWD,MWV and MWV"},
      {"NmeaFile", "nmea", "transport = 'file'\nfile = '/tmp/../dev/null'",
       "transport = 'file'\nfile = '/dev/null'\nplay_rate = 1", "read file /dev/null "},
      {"NmeaGroup", "nmea", "transport = 'udp'\nhost = '239.1.2.3'", "transport = 'udp'\nhost = '239.1.2.3'",
       "read UDP 239.1.2.3:10110 "},
      {"NmeaTalkers", "nmea", "transport = 'tcp'\nhost = 'a'\ntalker = 'WI'",
       "transport = 'tcp'\nhost = 'a'\ntalker = 'II'", ""},
      {"NmeaApparentAndTrue", "nmea", "transport = 'tcp'\nhost = 'a'\nreference = 'relative'",
       "transport = 'tcp'\nhost = 'a'\nreference = 'true'", ""},
      {"NmeaDevicesInXdr", "nmea", "transport = 'tcp'\nhost = 'a'", "transport = 'tcp'\nhost = 'a'\nxdr_id = 1", ""},
      {"NmeaPolledAddress", "nmea", "transport = 'tcp'\nhost = 'a'\nformat = 'umb'",
       "transport = 'tcp'\nhost = 'a'\nformat = 'umb'\naddress = '01'", "request: 01TR4?"},
      {"NmeaPolledAddresses", "nmea", "transport = 'tcp'\nhost = 'a'\nformat = 'umb'",
       "transport = 'tcp'\nhost = 'a'\nformat = 'umb'\naddress = '02'", ""},
      {"NmeaSendersOfOneGroup", "nmea", "transport = 'udp'\nhost = '239.1.2.3'\nsender = '10.0.0.1'",
       "transport = 'udp'\nhost = '239.1.2.3'\nsender = '10.0.0.2'", ""},
      {"NmeaTwoPorts", "nmea", "device = '/dev/yuragi-a'", "device = '/dev/yuragi-b'", ""},

      {"CanInterface", "nmea2000", "transport = 'can'", "transport = 'can'\ninterface = 'can0'",
       "read CAN interface can0: "},
      {"CanAddress", "nmea2000", "transport = 'can'\naddress = 5", "transport = 'can'\naddress = 5", "(address: 5)"},
      {"CanAnyAddress", "nmea2000", "transport = 'can'", "transport = 'can'\naddress = 5", "(address: any and 5)"},
      {"CanAddresses", "nmea2000", "transport = 'can'\naddress = 5", "transport = 'can'\naddress = 6", ""},
      {"CanInterfaces", "nmea2000", "transport = 'can'", "transport = 'can'\ninterface = 'can1'", ""},

      {"SignalKServer", "signalk", "host = 'a'", "host = 'a'\nport = 8375", "read a:8375 "},
      {"SignalKSource", "signalk", "transport = 'websocket'\nhost = 'a'\nsource = 'n2k.1'",
       "transport = 'websocket'\nhost = 'a'\nsource = 'n2k.1'", "source: n2k.1"},
      {"SignalKAnySource", "signalk", "host = 'a'", "host = 'a'\nsource = 'n2k.1'", "source: any and n2k.1"},
      {"SignalKSources", "signalk", "host = 'a'\nsource = 'n2k.1'", "host = 'a'\nsource = 'n2k.2'", ""},
      {"SignalKPaths", "signalk", "transport = 'websocket'\nhost = 'a'\npath = '/a'",
       "transport = 'websocket'\nhost = 'a'\npath = '/b'", ""},
      {"SignalKApparentAndTrue", "signalk", "host = 'a'\nreference = 'relative'", "host = 'a'\nreference = 'true'", ""},
      {"SignalKVessels", "signalk", "host = 'a'", "host = 'a'\ncontext = 'vessels.b'", ""},

      {"LineColumn", "line", "transport = 'tcp'\nhost = 'a'\nformat = 'columns'", "transport = 'tcp'\nhost = 'a'",
       "read a:10110 (speed_column: 1; "},
      {"LineKey", "line", "transport = 'tcp'\nhost = 'a'\nformat = 'json'",
       "transport = 'tcp'\nhost = 'a'\nformat = 'json'\nspeed_column = 3", "(speed_key: speed)"},
      {"LineSerialPort", "line", "device = '/dev/yuragi-a'\nspeed_column = 3", "device = '/dev/yuragi-a'",
       "need serial port /dev/yuragi-a, "},
      {"LineColumns", "line", "transport = 'tcp'\nhost = 'a'", "transport = 'tcp'\nhost = 'a'\nspeed_column = 3", ""},
      {"LineKeys", "line", "transport = 'tcp'\nhost = 'a'\nformat = 'keys'",
       "transport = 'tcp'\nhost = 'a'\nformat = 'keys'\nspeed_key = 'b'", ""},
      {"LineRequests", "line", "transport = 'tcp'\nhost = 'a'\npoll_interval = 1\nrequest = 'A'",
       "transport = 'tcp'\nhost = 'a'\npoll_interval = 1\nrequest = 'B'", ""},

      {"TwoSynthetic", "synthetic", "", "", ""},

      {"AnyUsbDevice", "usb", "", "", "read USB device: "},
      // The first device that is plugged in is taken, which may be the other sensor's.
      {"UsbBySerialAndAny", "usb", "", "serial = '7'", "(serial: any and 7)"},
      {"UsbSerial", "usb", "serial = '7'", "serial = '7'\ncounter = 1\ndevice = 'labjack-u3'", "serial: 7"},
      {"UsbSerials", "usb", "serial = '7'", "serial = '8'", ""},
      {"UsbPorts", "usb", "port = '1-1'", "port = '1-2'", ""},

      {"RecordingFile", "windlog", "file = '/tmp/yuragi-a'", "file = '/tmp/../tmp/yuragi-a'\nrate = 2",
       "read recording /tmp/yuragi-a "},
      {"RecordedSensor", "windlog", "file = '/tmp/yuragi-a'\nsensor = 'mast'", "file = '/tmp/yuragi-a'\nsensor = '*'",
       "sensor: mast and any"},
      {"RecordedSensors", "windlog", "file = '/tmp/yuragi-a'\nsensor = 'mast'",
       "file = '/tmp/yuragi-a'\nsensor = 'roof'", ""},
      {"RecordedDays", "windlog", "file = '/tmp/yuragi-a'", "file = '/tmp/yuragi-a'\nstart = '3600'", ""},

      {"OneSerialPort", "", "driver = 'nmea'\ndevice = '/dev/yuragi-a'", "driver = 'line'\ndevice = '/dev/yuragi-a'",
       "need serial port /dev/yuragi-a, "},
      {"OneSerialPortByTwoNames", "", "driver = 'nmea'\ndevice = '/dev/null'",
       "driver = 'line'\ndevice = '/dev/../dev/null'", "need serial port /dev/null, "},
      {"OneUdpPort", "", "driver = 'nmea'\ntransport = 'udp'\nport = 9000", "driver = 'osc'", "need UDP port 9000, "},
      {"BroadcastsAndText", "", "driver = 'weatherlink'\nhost = 'a'",
       "driver = 'nmea'\ntransport = 'udp'\nport = 22222", "need UDP port 22222, "},
      {"AModbusLineAndText", "", "driver = 'modbus'\ntransport = 'rtu'\ndevice = '/dev/yuragi-a'",
       "driver = 'nmea'\ndevice = '/dev/yuragi-a'", "need serial port /dev/yuragi-a, "},
  };
  return kPairs;
}

Config config_of(const SensorPair& pair) {
  const std::string driver = pair.driver.empty() ? "" : "driver = '" + pair.driver + "'\n";
  return parse_config("[[sensor]]\nname = 'roof'\n" + driver + pair.first + "\n\n[[sensor]]\nname = 'mast'\n" + driver +
                          pair.second + "\n",
                      "wall.toml");
}

class SensorPairs : public testing::TestWithParam<SensorPair> {};

TEST_P(SensorPairs, AreRefusedWhereTheyReadTheSame) {
  const SensorPair& pair = GetParam();
  Config config = config_of(pair);
  for (int turn = 0; turn < 2; ++turn) {  // whichever of the two comes first
    if (pair.shared.empty()) {
      EXPECT_NO_THROW(refuse_same_device(config.sensors));
    } else if (turn == 0) {
      EXPECT_THAT(
          [&] { refuse_same_device(config.sensors); },
          ThrowsMessage<ConfigError>(AllOf(StartsWith("wall.toml:"),
                                           HasSubstr("sensors \"roof\" and \"mast\" both " +
                                                     (pair.shared.starts_with("need ") ? pair.shared : "read ")),
                                           HasSubstr(pair.shared), HasSubstr(": remove one of "))));
    } else {
      EXPECT_THROW(refuse_same_device(config.sensors), ConfigError);
    }
    std::ranges::reverse(config.sensors);
  }
}

INSTANTIATE_TEST_SUITE_P(SameDevice, SensorPairs, testing::ValuesIn(sensor_pairs()),
                         [](const auto& pair) { return pair.param.name; });

TEST(SameDevice, IsTriedWithEveryDriver) {
  for (const drivers::sensor::DriverDescription* driver : drivers::sensor::driver_table()) {
    const auto is_tried = [driver](bool is_refused) {
      return std::ranges::any_of(sensor_pairs(), [=](const SensorPair& pair) {
        return pair.driver == driver->name && pair.shared.empty() != is_refused;
      });
    };
    EXPECT_TRUE(is_tried(false)) << driver->name << " has no pair that is allowed";
    EXPECT_EQ(is_tried(true), driver->name != "synthetic") << driver->name << " has no pair that is refused";
  }
}

TEST(SameDevice, IsSharedByWhatPlaysARecordingInItsPlace) {
  Config config = config_of({.name = "", .driver = "ecowitt", .first = "host = 'gw'", .second = "host = 'gw'"});
  for (SensorConfig& sensor : config.sensors) sensor.stand_in = StandIn{};
  EXPECT_NO_THROW(refuse_same_device(config.sensors));
}

TEST(SameDevice, IsNotFoundForASensorWhoseProfileIsLost) {
  const std::string keys = "host = 'a'\nprofile = '/nowhere.toml'";
  EXPECT_NO_THROW(
      refuse_same_device(config_of({.name = "", .driver = "modbus", .first = keys, .second = keys}).sensors));
}

}  // namespace
}  // namespace yuragi::daemon::settings
