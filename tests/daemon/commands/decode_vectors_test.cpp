// `yuragi decode` over every vector of ../shared/data that a format covers.
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/decode/hex_text.hpp"
#include "tests/daemon/commands/decode_run.hpp"
#include "tests/support/byte_vectors.hpp"
#include "tests/support/decoded_text.hpp"
#include "tests/support/places.hpp"

namespace yuragi::daemon::commands {
namespace {

using Arguments = std::vector<std::string>;
using nlohmann::json;

TEST_F(DecodeCommand, DecodesEverySharedSentence) {
  const auto vectors = shared_json("vectors/nmea_vectors.json");
  if (vectors.is_null()) GTEST_SKIP() << "../shared/data/vectors/nmea_vectors.json is not here";
  for (const auto& vector : vectors) {
    const std::string sentence_text = vector["sentence"];
    SCOPED_TRACE(sentence_text);
    const auto& expect = vector["expect"];
    json decoded = one(sentence_text + "\n", {"nmea", "--refused", "--status", "accept"});
    if (!vector["checksum_ok"]) {
      EXPECT_EQ(decoded["refused"], "bad checksum");
    } else if (expect.contains("drop")) {
      EXPECT_EQ(decoded["refused"], "invalid");
    } else {
      EXPECT_FALSE(decoded.contains("refused")) << decoded;
      if (expect.contains("speed_ms")) {
        EXPECT_TRUE(is_value(decoded["speed_m_s"], expect["speed_ms"].get<double>()));
      }
      const char* direction = expect.contains("angle") ? "angle" : expect.contains("dir_true") ? "dir_true" : "dir_mag";
      if (expect.contains(direction)) {
        EXPECT_TRUE(is_value(decoded["direction_deg"], expect[direction].get<double>()));
      }
      if (expect.contains("ref")) {
        EXPECT_EQ(decoded["reference"], expect["ref"] == "R" ? "relative" : "true");
      }
    }
  }
}

TEST_F(DecodeCommand, DecodesEverySharedGillFrame) {
  const auto vectors = shared_json("vectors/gill_vectors.json");
  if (vectors.is_null()) GTEST_SKIP() << "../shared/data/vectors/gill_vectors.json is not here";
  for (const auto& vector : vectors) {
    const std::string body = vector["body"];
    SCOPED_TRACE(body);
    json decoded = one(vector["frame_hex"].get<std::string>() + "\n", {"gill", "--hex", "--refused"});
    const drivers::decode::TextFields fields = drivers::decode::split_fields(body, ',');
    if (body.find(",04,") != std::string::npos) {
      EXPECT_EQ(decoded["refused"], "invalid");
      continue;
    }
    EXPECT_TRUE(is_value(decoded["speed_m_s"], std::stod(std::string(fields[2])), 1e-9));
    const bool has_direction = !fields[1].empty() && decoded["speed_m_s"].get<double>() >= 0.05;
    EXPECT_TRUE(is_value(decoded["direction_deg"],
                         has_direction ? std::optional(std::stod(std::string(fields[1]))) : std::nullopt));

    // With the checksum that the manual prints it is read only where that is right.
    const auto printed = run("\x02" + body + "\x03" + vector["printed"].get<std::string>() + "\r\n", {"gill"});
    EXPECT_EQ(printed.objects.size(), vector["printed_is_right"].get<bool>() ? 1U : 0U);
  }
}

TEST_F(DecodeCommand, DecodesEverySharedStationReport) {
  const auto vectors = test::load_byte_vectors("hid_vectors.json", "");
  if (vectors.empty()) GTEST_SKIP() << "../shared/data/vectors/hid_vectors.json is not here";
  const std::map<std::string, std::string> formats = {
      {"WMR100", "wmr100"}, {"WMR300", "wmr300"}, {"AcuRite", "acurite"}, {"Fine Offset", "fineoffset"}};
  std::map<std::string, int> covered;
  for (const auto& vector : vectors) {
    const std::string device = vector["device"];
    const std::string layer = vector.value("layer", "");
    const auto format = std::ranges::find_if(formats, [&](const auto& each) { return device.starts_with(each.first); });
    if (format == formats.end() || !vector.contains("bytes") || !vector.contains("expect")) continue;
    if (layer.find("report") != std::string::npos && layer.starts_with("8-byte")) continue;  // one report of a frame
    if (layer.starts_with("fixed block")) continue;                                          // no wind in it
    SCOPED_TRACE(device + ": " + vector["bytes"].get<std::string>());
    const auto& expect = vector["expect"];
    const auto done = run(vector["bytes"].get<std::string>() + "\n", {format->second, "--hex", "--refused"});
    ASSERT_FALSE(done.objects.empty());
    json decoded = done.objects.front();
    ++covered[format->second];

    const bool has_wind = (expect.contains("avg_ms") && !expect["avg_ms"].is_null()) || expect.value("valid", false);
    if (!has_wind) {
      EXPECT_TRUE(decoded.contains("refused")) << decoded;
      continue;
    }
    const auto number = [&](std::initializer_list<const char*> names) -> std::optional<double> {
      for (const char* name : names) {
        if (expect.contains(name) && !expect[name].is_null()) return expect[name].get<double>();
      }
      return std::nullopt;
    };
    EXPECT_TRUE(is_value(decoded["speed_m_s"], number({"avg_ms", "speed_ms"}), 1e-4));
    EXPECT_TRUE(is_value(decoded["direction_deg"], number({"avg_dir", "dir_deg"}), 1e-9));
    // The collection has a gust as it stands there; one below the average is left out.
    auto gust_m_s = number({"gust_ms"});
    if (gust_m_s < number({"avg_ms"})) gust_m_s.reset();
    EXPECT_TRUE(is_value(decoded["gust_m_s"], gust_m_s, 1e-9));
  }
  EXPECT_EQ(covered["wmr300"], 1);
  EXPECT_EQ(covered["fineoffset"], 2);
  EXPECT_GE(covered["acurite"], 9);
  EXPECT_GE(covered["wmr100"], 4);
}

TEST_F(DecodeCommand, DecodesEverySharedCounterReply) {
  const auto vectors = test::load_byte_vectors("usb_vectors.json", "");
  if (vectors.empty()) GTEST_SKIP() << "../shared/data/vectors/usb_vectors.json is not here";
  int covered = 0;
  for (const auto& vector : vectors) {
    if (!vector.contains("reply") || !vector.contains("expect")) continue;
    const std::string device = vector["device"];
    const bool is_labjack = device.starts_with("LabJack");
    json decoded = one(vector["reply"].get<std::string>() + "\n", {is_labjack ? "labjack" : "mcc1208", "--hex"});
    EXPECT_EQ(decoded["count"], vector["expect"][is_labjack ? "counter" : "count"]);
    if (is_labjack) {
      EXPECT_TRUE(is_value(decoded["volts"], vector["expect"]["ain_raw"].get<double>() * 3.7231e-5, 1e-9));
    }
    ++covered;
  }
  EXPECT_EQ(covered, 2);
}

TEST_F(DecodeCommand, DecodesEverySharedModbusExchange) {
  const auto vectors = test::load_byte_vectors("modbus_vectors.json", "");
  if (vectors.empty()) GTEST_SKIP() << "../shared/data/vectors/modbus_vectors.json is not here";

  struct Case {
    Arguments arguments;
    std::string expects_speed;
    std::string expects_direction;
    std::string expects_gust = {};
  };
  // The vane alone is asked as slave 1; beside the cup it is slave 2.
  const std::map<std::string, Case> cases = {
      {"Renke RS-FSJT-N01", {{"modbus:renke-rs-fsjt-n01"}, "wind_speed_ms", ""}},
      {"Renke, answer with a leading", {{"modbus:renke-rs-fsjt-n01"}, "wind_speed_ms", ""}},
      {"DFRobot SEN048", {{"modbus:dfrobot-sen0483"}, "wind_speed_ms", ""}},
      {"Renke RS-FXJT-N01",
       {{"modbus:renke-rs-fsjt-rs-fxjt-n01", "--speed-slave", "9", "--direction-slave", "1"}, "", "wind_dir_deg"}},
      {"SenseCAP ONE", {{"modbus:seeed-sensecap-one"}, "ws_avg", "dir_avg", "ws_max"}},
      {"Lufft WS-UMB", {{"modbus:lufft-umb"}, "fast", "", "max"}},
      {"Xunchip", {{"modbus:xunchip-xm8589"}, "wind_speed_raw", ""}},
  };
  int covered = 0;
  for (const auto& vector : vectors) {
    const std::string device = vector["device"];
    SCOPED_TRACE(device);
    const std::string line =
        vector["request"].get<std::string>() + " | " + vector["response"].get<std::string>() + "\n";
    ++covered;
    if (vector["kind"] == "exception") {
      json decoded = one(line, {"modbus:renke-rs-fsjt-n01", "--hex", "--refused"});
      EXPECT_EQ(decoded["refused"], "exception");
      EXPECT_EQ(decoded["detail"], "2, illegal data address");
      continue;
    }
    if (vector["expect"].contains("error")) {
      EXPECT_EQ(one(line, {"modbus:renke-rs-fsjt-n01", "--hex", "--refused"})["refused"], "not mine");
      continue;
    }
    if (device == "Vaisala WM80") {
      // Made before it was known that its less significant words come first: 5.5 m/s is next to nothing in that order.
      EXPECT_LT(one(line, {"modbus:vaisala-wm80", "--hex"})["speed_m_s"].get<double>(), 1e-30);
      continue;
    }
    const auto found = std::ranges::find_if(cases, [&](const auto& each) { return device.starts_with(each.first); });
    ASSERT_NE(found, cases.end());
    auto [arguments, speed, direction, gust] = found->second;
    arguments.emplace_back("--hex");
    json decoded = one(line, arguments);
    const auto expected = [&](const std::string& name) {
      const double unit = name == "wind_speed_raw" ? 0.1 : 1.0;
      const bool is_there = !name.empty() && !vector["expect"][name].is_null();
      return is_there ? std::optional(unit * vector["expect"][name].get<double>()) : std::nullopt;
    };
    EXPECT_TRUE(is_value(decoded["speed_m_s"], expected(speed), 1e-9));
    EXPECT_TRUE(is_value(decoded["direction_deg"], expected(direction), 1e-9));
    EXPECT_TRUE(is_value(decoded["gust_m_s"], expected(gust), 1e-9));
  }
  EXPECT_EQ(covered, 10);
}

TEST_F(DecodeCommand, ReadsEveryWindSentenceOfARealVoyageAsGpsdDoes) {
  const std::string log = test::source_path("../shared/data/nmea/gpsd_bundg_zeus_9.log");
  std::ifstream in(log);
  if (!in) GTEST_SKIP() << log << " is not here";
  int sentences = 0;
  for (std::string line; std::getline(in, line);) sentences += line.find("MW") == 3 ? 1 : 0;
  EXPECT_EQ(sentences, 450);

  const auto done = run_file(log, {"nmea"});
  EXPECT_EQ(done.code, 0);
  ASSERT_EQ(done.objects.size(), 450U);

  // gpsd reports the newest once a second, so that its values are among ours, in the same order.
  std::map<std::string, std::vector<json>> by_reference;
  for (const json& reading : done.objects) by_reference[reading["reference"]].push_back(reading);
  std::map<std::string, std::size_t> at;
  const auto follows = [&](const std::string& reference, double speed_m_s, double direction_deg) {
    const auto& readings = by_reference[reference];
    for (std::size_t& i = at[reference]; i < readings.size(); ++i) {
      if (is_value(readings[i]["speed_m_s"], speed_m_s, 0.06) &&
          is_value(readings[i]["direction_deg"], direction_deg, 0.06))
        return true;
    }
    return false;
  };
  std::ifstream gpsd(test::source_path("../shared/data/nmea/gpsd_bundg_zeus_9.tpv_wind.json"));
  int compared = 0;
  for (std::string line; std::getline(gpsd, line);) {
    const json report = json::parse(line);
    if (report.contains("wspeedr")) {
      EXPECT_TRUE(follows("relative", report["wspeedr"], report["wangler"])) << line;
      ++compared;
    }
    if (report.contains("wspeedt")) {
      EXPECT_TRUE(follows("north", report["wspeedt"], report["wanglet"])) << line;
      ++compared;
    }
  }
  EXPECT_GT(compared, 200);
}

TEST_F(DecodeCommand, ReadsALogWithoutStatusFieldsByPolicy) {
  const std::string log = test::source_path("../shared/data/nmea/signalk_n2kd-183-merrimac.log");
  if (!std::ifstream(log)) GTEST_SKIP() << log << " is not here";
  EXPECT_TRUE(run_file(log, {"nmea", "--status", "refuse"}).objects.empty());
  const auto done = run_file(log, {"nmea"});
  ASSERT_EQ(done.objects.size(), 147U);
  EXPECT_TRUE(is_value(done.objects[0]["speed_m_s"], 1.89 * 1852.0 / 3600.0, 1e-9));
  EXPECT_TRUE(is_value(done.objects[0]["direction_deg"], 327.6, 1e-9));
  for (const json& reading : done.objects) EXPECT_EQ(reading["status"], "uncertain");
}

}  // namespace
}  // namespace yuragi::daemon::commands
