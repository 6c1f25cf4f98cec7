#include "daemon/web/routes.hpp"

#include <set>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/web/openapi.hpp"

namespace yuragi::daemon::web {
namespace {

using nlohmann::json;
using testing::HasSubstr;

wire::Sensors one_sensor(wind::judging::SensorState state) {
  wire::Sensors sensors;
  wire::SensorStatus& sensor = sensors.sensors.emplace_back();
  sensor.name = "roof \"east\"\n";
  sensor.driver = "modbus";
  sensor.state = state;
  sensor.state_reason = "its plug is out";
  sensor.readings = 12;
  sensor.speed_m_s = 3.25;
  sensor.refused = {{"checksum", 2}};
  sensors.late_ticks = 7;
  return sensors;
}

class RoutesTest : public testing::Test {
 protected:
  http::Response get(const std::string& path) { return said(answer_to({.method = "GET", .path = path}, facts_)); }
  static http::Response said(const Answer& answer) {
    EXPECT_TRUE(std::holds_alternative<http::Response>(answer)) << "a question to the daemon";
    return std::holds_alternative<http::Response>(answer) ? std::get<http::Response>(answer) : http::Response{};
  }

  wire::Sensors sensors_ = one_sensor(wind::judging::SensorState::kLive);
  Facts facts_{.software = "yuragi 0.0.0", .sensors = &sensors_, .age_s = 0.3};
};

TEST_F(RoutesTest, Health_WellOrWhatNeedsAttention) {
  EXPECT_EQ(get("/healthz").status, 200U);
  sensors_ = one_sensor(wind::judging::SensorState::kDisconnected);
  EXPECT_EQ(get("/healthz").status, 503U);
  EXPECT_THAT(get("/healthz").body, HasSubstr("its plug is out"));
}
TEST_F(RoutesTest, OldNewsAreNone) {
  facts_.age_s = 9.0;
  EXPECT_EQ(get("/healthz").status, 503U);
  EXPECT_THAT(get("/healthz").body, HasSubstr("no news from the daemon for 9 s"));
  for (const char* path : {"/metrics", "/api/v1/status"}) {
    EXPECT_EQ(get(path).status, 503U);
    EXPECT_EQ(get(path).content_type, "application/problem+json");
  }
  facts_.sensors = nullptr;
  EXPECT_THAT(get("/healthz").body, HasSubstr("just begun"));
}
TEST_F(RoutesTest, Metrics_NamesUnitsAndEscapedLabels) {
  const std::string text = get("/metrics").body;
  EXPECT_THAT(text,
              HasSubstr(R"(yuragi_sensor_speed_meters_per_second{sensor="roof \"east\"\n",driver="modbus"} 3.25)"));
  EXPECT_THAT(text, HasSubstr(R"(driver="modbus",reason="checksum"} 2)"));
  EXPECT_THAT(text, HasSubstr(R"(driver="modbus",state="live"} 1)"));
  EXPECT_THAT(text, HasSubstr(R"(driver="modbus",state="stale"} 0)"));
  EXPECT_THAT(text, HasSubstr("# TYPE yuragi_ticks_skipped_total counter\nyuragi_ticks_skipped_total 7\n"));
}
TEST_F(RoutesTest, Metrics_FaultsByKind) {
  EXPECT_THAT(get("/metrics").body, HasSubstr("# TYPE yuragi_faults_total counter\n"));
  facts_.faults = [] { return FaultCounts{{"a stream connection", 3}, {"an \"HTTP\" request", 1}}; };
  const std::string text = get("/metrics").body;
  EXPECT_THAT(text, HasSubstr("yuragi_faults_total{kind=\"a stream connection\"} 3\n"));
  EXPECT_THAT(text, HasSubstr(R"(yuragi_faults_total{kind="an \"HTTP\" request"} 1)"));
}
TEST_F(RoutesTest, Status_IsJsonWhateverANameHolds) {
  sensors_.sensors[0].detail = "\xff\xfe";
  const json status = json::parse(get("/api/v1/status").body);
  EXPECT_EQ(status["verdict"], "well");
  EXPECT_EQ(status["sensors"][0]["name"], "roof \"east\"\n");
}
TEST_F(RoutesTest, WhatIsNotThere_OrNotTaken) {
  EXPECT_EQ(get("/").status, 404U);
  EXPECT_EQ(get("/healthz/").status, 404U);
  const http::Response refusal = said(answer_to({.method = "POST", .path = "/healthz"}, facts_));
  EXPECT_EQ(refusal.status, 405U);
  EXPECT_EQ(refusal.fields, (std::vector<std::pair<std::string, std::string>>{{"Allow", "GET"}}));
  EXPECT_EQ(said(answer_to({.method = "HEAD", .path = "/healthz"}, facts_)).status, 200U);
}
TEST_F(RoutesTest, AScene_IsAskedOfTheDaemon) {
  const Answer answer =
      answer_to({.method = "POST", .path = "/api/v1/scenes", .body = R"({"scene":"meadow","shown":false})"}, facts_);
  ASSERT_TRUE(std::holds_alternative<Question>(answer));
  const auto& question = std::get<Question>(answer);
  EXPECT_EQ(question.control.scene, "meadow");
  const http::Response done =
      question.answer({.done = true, .message = "hidden", .scenes = {{"meadow", "grass", false}}});
  EXPECT_EQ(done.status, 200U);
  EXPECT_EQ(json::parse(done.body)["scenes"][0]["is_shown"], false);
  const http::Response refused = question.answer({.done = false, .message = "no scene 'meadow'", .scenes = {}});
  EXPECT_EQ(refused.status, 409U);
  EXPECT_EQ(json::parse(refused.body)["detail"], "no scene 'meadow'");
}
TEST_F(RoutesTest, ValuesAndAReload_AreAskedOfTheDaemon) {
  const Answer set =
      answer_to({.method = "POST",
                 .path = "/api/v1/parameters",
                 .body = R"({"scene":"elm","set":{"gain":1.5,"shown":true,"color":"#112233"},"reset":["x"]})"},
                facts_);
  ASSERT_TRUE(std::holds_alternative<Question>(set));
  const auto command = std::get<Question>(set).control.parameters;
  ASSERT_TRUE(command);
  EXPECT_EQ(command->scene, "elm");
  ASSERT_EQ(command->edits.size(), 4U);
  EXPECT_EQ(command->edits[0].value, "#112233");
  EXPECT_EQ(command->edits[1].value, "1.5");
  EXPECT_EQ(command->edits[2].value, "true");
  EXPECT_EQ(command->edits[3].value, std::nullopt);
  EXPECT_EQ(std::get<Question>(set).answer({.done = false, .message = "no", .scenes = {}}).status, 409U);

  const Answer list = answer_to({.method = "GET", .path = "/api/v1/parameters"}, facts_);
  const wire::ParameterReport report{.groups = {{"", "", {{.name = "clouds", .value = "0.5"}}}}};
  const json listed = json::parse(
      std::get<Question>(list).answer({.done = true, .message = "", .scenes = {}, .parameters = report}).body);
  EXPECT_EQ(listed["parameters"][0]["parameters"][0]["value"], 0.5);

  const Answer reload = answer_to({.method = "POST", .path = "/api/v1/reload", .body = "{}"}, facts_);
  ASSERT_TRUE(std::get<Question>(reload).control.reload);
  const wire::ReloadReport done{.applied = {"[look] clouds: 0 -> 1"}};
  EXPECT_EQ(json::parse(std::get<Question>(reload)
                            .answer({.done = true, .message = "done", .scenes = {}, .reload = done})
                            .body)["applied"][0],
            "[look] clouds: 0 -> 1");
}
TEST_F(RoutesTest, WhatIsSetByHand_IsAskedOfTheDaemonAndInStatusAndMetrics) {
  const Answer answer = answer_to(
      {.method = "POST", .path = "/api/v1/hand", .body = R"({"speed_m_s":8,"direction_deg":270,"for_s":30})"}, facts_);
  ASSERT_TRUE(std::holds_alternative<Question>(answer));
  const auto& question = std::get<Question>(answer);
  ASSERT_TRUE(question.control.hand);
  EXPECT_EQ(question.control.hand->for_s, 30.0);
  const wire::ByHand by_hand{.wind = wire::HeldWind{8.0, 270.0, 30.0}, .blackout = wire::Hold{}};
  const json done = json::parse(question.answer({.done = true, .message = "", .scenes = {}, .by_hand = by_hand}).body);
  EXPECT_EQ(done["by_hand"]["wind"]["left_s"], 30.0);
  EXPECT_EQ(done["by_hand"]["blackout"]["left_s"], nullptr);
  EXPECT_EQ(done["by_hand"]["camera"], nullptr);

  sensors_.by_hand = by_hand;
  sensors_.cameras.push_back({.name = "gate"});
  const json status = json::parse(get("/api/v1/status").body);
  EXPECT_EQ(status["by_hand"]["wind"]["speed_m_s"], 8.0);
  EXPECT_EQ(status["cameras"], json::array({"gate"}));
  EXPECT_EQ(status["camera"], "gate");
  EXPECT_THAT(status["attention"][0].get<std::string>(), HasSubstr("dark by hand until somebody ends it"));
  const std::string text = get("/metrics").body;
  EXPECT_THAT(text, HasSubstr("yuragi_by_hand{part=\"wind\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("yuragi_by_hand{part=\"camera\"} 0\n"));
}
TEST_F(RoutesTest, PlayersOfADaemonThatPlaysNothing_AreNone) {
  const Answer answer = answer_to({.method = "GET", .path = "/api/v1/player"}, facts_);
  ASSERT_TRUE(std::holds_alternative<Question>(answer));
  const http::Response none = std::get<Question>(answer).answer({.done = false, .message = "none plays", .scenes = {}});
  EXPECT_EQ(none.status, 200U);
  EXPECT_EQ(json::parse(none.body)["players"], json::array());
}

TEST_F(RoutesTest, ANameIsOnePartOfAPath) {
  const auto request = [this](const std::string& method, const std::string& path) {
    return answer_to({.method = method, .path = path, .body = "{}"}, facts_);
  };
  const Answer verify = request("POST", "/api/v1/recordings/wall%20of.windlog/verify");
  ASSERT_TRUE(std::holds_alternative<ArchiveRequest>(verify));
  EXPECT_EQ(std::get<ArchiveRequest>(verify).what, ArchiveRequest::What::kVerify);
  EXPECT_EQ(std::get<ArchiveRequest>(verify).name, "wall of.windlog");
  EXPECT_EQ(std::get<ArchiveRequest>(request("GET", "/api/v1/recordings")).name, "");
  EXPECT_EQ(std::get<ArchiveRequest>(request("GET", "/api/v1/jobs/12/file")).name, "12");
  for (const char* path :
       {"/api/v1/recordings/", "/api/v1/recordings//verify", "/api/v1/recordings/a/b/verify", "/api/v1/jobs/1/file/"})
    EXPECT_EQ(said(request("GET", path)).status, 404U) << path;
  EXPECT_EQ(said(request("GET", "/api/v1/recordings/a/verify")).status, 405U);
  EXPECT_EQ(
      said(answer_to({.method = "POST", .path = "/api/v1/support-bundle", .body = R"({"out":"x"})"}, facts_)).status,
      400U);
}
TEST_F(RoutesTest, WhatShowsWhenPeopleAreThereIsPrivate) {
  for (const char* path : {"/api/v1/log", "/api/v1/sessions", "/api/v1/recordings", "/api/v1/recordings/wall.windlog",
                           "/api/v1/jobs/1", "/api/v1/jobs/1/file", "/api/v1/configuration"})
    EXPECT_TRUE(is_private(path)) << path;
  for (const char* path : {"/", "/healthz", "/api/v1/status", "/api/v1/history", "/ws"})
    EXPECT_FALSE(is_private(path)) << path;
}

TEST_F(RoutesTest, Sessions_AreListedWhileTheyAreValid) {
  EXPECT_EQ(json::parse(get("/api/v1/sessions").body)["sessions"], json::array());
  Pairings pairings;
  pairings.add("0123456789", "192.168.1.30", 1.8e9);
  facts_.pairings = &pairings;
  facts_.utc_s = 1.8e9;
  EXPECT_EQ(json::parse(get("/api/v1/sessions").body)["sessions"][0], json({{"id", "0123456789"},
                                                                            {"since_s", 1'800'000'000},
                                                                            {"last_use_s", 1'800'000'000},
                                                                            {"address", "192.168.1.30"}}));
  facts_.utc_s = 1.9e9;
  EXPECT_EQ(json::parse(get("/api/v1/sessions").body)["sessions"], json::array());
}

TEST_F(RoutesTest, TheFleetIsTheLeadersList) {
  EXPECT_EQ(json::parse(get("/api/v1/fleet").body)["nodes"], json::array()) << "this daemon does not lead";
  const std::string nodes = R"({"nodes": [{"node": "foyer"}]})";
  facts_.fleet = &nodes;
  EXPECT_EQ(get("/api/v1/fleet").body, nodes);
  facts_.age_s = 2.0 * facts_.patience_s;
  EXPECT_EQ(get("/api/v1/fleet").status, 503U) << "nothing old is shown as if it were of now";
}

TEST_F(RoutesTest, TheWindOfTheLastMinutesHasAgesAndNoTimesSoThatNoClockMatters) {
  EXPECT_EQ(json::parse(get("/api/v1/wind").body)["age_s"], json::array());
  WindMemory memory;
  wire::Sensors sensors = one_sensor(wind::judging::SensorState::kLive);
  sensors.wind.live_weight = 0.75;
  memory.add(100.0, sensors);
  sensors.sensors[0].state = wind::judging::SensorState::kStale;
  memory.add(101.0, sensors);
  facts_.wind = &memory;
  facts_.mono_s = 103.5;
  const json wind = json::parse(get("/api/v1/wind").body);
  EXPECT_EQ(wind["age_s"], json({3.5, 2.5}));
  EXPECT_EQ(wind["measured_m_s"], json({3.25, nullptr}));
  EXPECT_EQ(wind["blended_m_s"].size(), 2U);
  EXPECT_EQ(wind["noise_share"], json({0.25, 0.25}));
}

TEST(OpenApi, DescribesEachRoute_AndNothingElse) {
  std::set<std::pair<std::string, std::string>> served, described;
  for (const Route& route : routes()) {
    std::string method(route.method);
    std::ranges::transform(method, method.begin(), [](char c) { return static_cast<char>(c - 'A' + 'a'); });
    served.emplace(method, route.path);
  }
  const json api = json::parse(openapi_json());
  for (const auto& [path, methods] : api["paths"].items()) {
    for (const auto& method : methods.items()) described.emplace(method.key(), path);
  }
  EXPECT_EQ(served, described);
}

/// Each key that the description names is taken by the server, and no other (request_body.hpp).
TEST(OpenApi, BodiesAreThoseThatAreTaken) {
  const json api = json::parse(openapi_json());
  const auto keys = [&api](const char* path) {
    const json& schema = api["paths"][path]["post"]["requestBody"]["content"]["application/json"]["schema"];
    EXPECT_EQ(schema["additionalProperties"], false);
    json body = json::object();
    if (schema["properties"].empty()) return body.dump();
    for (const auto& [key, property] : schema["properties"].items())
      body[key] = property.contains("default") ? property["default"]
                  : property.contains("enum")  ? property["enum"][0]
                                               : json("meadow");
    return body.dump();
  };
  for (const char* path :
       {"/api/v1/scenes", "/api/v1/player", "/api/v1/pair", "/api/v1/sessions", "/api/v1/parameters", "/api/v1/reload",
        "/api/v1/hand", "/api/v1/blackout", "/api/v1/camera", "/api/v1/sensors", "/api/v1/sensors/find",
        "/api/v1/sensors/try", "/api/v1/sensors/undo", "/api/v1/kept", "/api/v1/kept/undo"}) {
    const Answer answer = answer_to({.method = "POST", .path = path, .body = keys(path)}, {});
    const auto* const refusal = std::get_if<http::Response>(&answer);
    EXPECT_EQ(refusal, nullptr) << refusal->body;
  }
}

}  // namespace
}  // namespace yuragi::daemon::web
