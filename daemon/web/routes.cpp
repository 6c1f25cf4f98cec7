// What can be asked for by HTTP, with its answer.
#include "daemon/web/routes.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/state/attention.hpp"
#include "daemon/state/parameter_json.hpp"
#include "daemon/state/sensor_json.hpp"
#include "daemon/web/metrics.hpp"
#include "daemon/web/openapi.hpp"
#include "daemon/web/problem.hpp"
#include "daemon/web/query.hpp"
#include "engine/base/json_text.hpp"

namespace yuragi::daemon::web {
namespace {

using nlohmann::ordered_json;

http::Response json_response(const ordered_json& content) {
  return {.body = json_text(content, 2) + "\n"};
}

/// Returns why the last state of the daemon is no longer valid; nullopt if it is.
std::optional<std::string> silence_of(const Facts& facts) {
  if (facts.sensors == nullptr) return "the daemon has only just begun";
  if (facts.age_s <= facts.patience_s) return std::nullopt;
  return fmt::format("no news from the daemon for {:.0f} s: it hangs, or its machine is overloaded", facts.age_s);
}

http::Response no_news(const std::string& why) {
  http::Response response = problem(503, "No news from the daemon", why);
  response.fields.push_back({"Retry-After", "1"});
  return response;
}

Answer health(const http::Request& /*request*/, const Facts& facts) {
  const auto text = [](unsigned status, const std::string& body) {
    return http::Response{.status = status, .content_type = "text/plain; charset=utf-8", .body = body};
  };
  if (const auto why = silence_of(facts)) return text(503, *why + "\n");
  std::string reasons;
  for (const std::string& reason : state::needs_attention(*facts.sensors)) reasons += reason + "\n";
  return reasons.empty() ? text(200, "all is well\n") : text(503, reasons);
}

Answer metrics(const http::Request& /*request*/, const Facts& facts) {
  if (const auto why = silence_of(facts)) return no_news(*why);
  return http::Response{.content_type = "text/plain; version=0.0.4; charset=utf-8",
                        .body = metrics_text(*facts.sensors, facts.software, facts.counts,
                                             facts.faults ? facts.faults() : FaultCounts{})};
}

ordered_json status_json(const Facts& facts) {
  const std::vector<std::string> attention = state::needs_attention(*facts.sensors);
  ordered_json content = {{"verdict", attention.empty() ? "well" : "attention"},
                          {"attention", attention},
                          {"age_s", facts.age_s},
                          {"address", facts.address},
                          {"software", facts.software},
                          {"tick_rate_hz", facts.tick_rate_hz}};
  content.update(state::sensors_json(*facts.sensors));
  return content;
}
Answer status(const http::Request& /*request*/, const Facts& facts) {
  if (const auto why = silence_of(facts)) return no_news(*why);
  return json_response(status_json(facts));
}

Answer socket(const http::Request& request, const Facts& /*facts*/) {
  if (request.is_websocket) return SocketOpening{};
  http::Response refusal = problem(426, "A WebSocket", "/ws is for WebSockets: new WebSocket(\"ws://HOST:PORT/ws\")");
  refusal.fields.push_back({"Upgrade", "websocket"});
  return refusal;
}

Answer openapi(const http::Request& /*request*/, const Facts& /*facts*/) {
  return http::Response{.body = std::string(openapi_json())};
}

/// A reply that refuses becomes a problem: of a request that names what is not there, or that is not allowed.
http::Response answer_with(const wire::ControlReply& reply, const char* key, const ordered_json& list) {
  if (!reply.done) return problem(409, "Not done", reply.message);
  return json_response({{"message", reply.message}, {key, list}});
}

Question scenes_question(wire::Control control) {
  return {.control = std::move(control), .answer = [](const wire::ControlReply& reply) {
            return answer_with(reply, "scenes", state::scenes_json(reply.scenes));
          }};
}

Answer scenes(const http::Request& /*request*/, const Facts& /*facts*/) {
  return scenes_question({});
}
Answer change_scene(const http::Request& request, const Facts& /*facts*/) {
  const auto control = scene_control_of(request.body);
  if (!control) return problem(400, "Not understood", control.error().message);
  return scenes_question(*control);
}
/// A daemon that plays nothing refuses the question; its list is empty.
Answer players(const http::Request& /*request*/, const Facts& /*facts*/) {
  return Question{.control = {.scene = {}, .player = wire::PlayerCommand{}},
                  .answer = [](const wire::ControlReply& reply) {
                    return json_response({{"message", reply.message}, {"players", state::players_json(reply.players)}});
                  }};
}
Answer change_player(const http::Request& request, const Facts& /*facts*/) {
  const auto command = player_command_of(request.body);
  if (!command) return problem(400, "Not understood", command.error().message);
  return Question{.control = {.scene = {}, .player = *command}, .answer = [](const wire::ControlReply& reply) {
                    return answer_with(reply, "players", state::players_json(reply.players));
                  }};
}

Answer parameters(const http::Request& /*request*/, const Facts& /*facts*/) {
  return Question{.control = {.scene = {}, .parameters = wire::ParameterCommand{.describe = true}},
                  .answer = [](const wire::ControlReply& reply) {
                    return answer_with(
                        reply, "parameters",
                        reply.parameters ? state::parameters_json(reply.parameters->groups) : ordered_json::array());
                  }};
}
Answer change_parameters(const http::Request& request, const Facts& /*facts*/) {
  auto command = parameter_command_of(request.body);
  if (!command) return problem(400, "Not understood", command.error().message);
  return Question{.control = {.scene = {}, .parameters = std::move(*command)},
                  .answer =
                      [](const wire::ControlReply& reply) {
                        if (!reply.done) return problem(409, "Not done", reply.message);
                        return json_response({{"message", reply.message}});
                      },
                  .takes_long = true};
}
// ---- what is set by hand ----

Answer by_hand(const Result<wire::HandCommand, Failure>& command) {
  if (!command) return problem(400, "Not understood", command.error().message);
  return Question{.control = {.scene = {}, .hand = *command}, .answer = [](const wire::ControlReply& reply) {
                    return answer_with(reply, "by_hand", state::by_hand_json(reply.by_hand.value_or(wire::ByHand{})));
                  }};
}
Answer hand(const http::Request& request, const Facts& /*facts*/) {
  return by_hand(wind_by_hand_of(request.body));
}
Answer blackout(const http::Request& request, const Facts& /*facts*/) {
  return by_hand(blackout_of(request.body));
}
Answer camera(const http::Request& request, const Facts& /*facts*/) {
  return by_hand(camera_of(request.body));
}

Answer reload(const http::Request& request, const Facts& /*facts*/) {
  auto command = reload_command_of(request.body);
  if (!command) return problem(400, "Not understood", command.error().message);
  return Question{
      .control = {.scene = {}, .reload = std::move(*command)},
      .answer =
          [](const wire::ControlReply& reply) {
            const wire::ReloadReport report = reply.reload.value_or(wire::ReloadReport{});
            if (!reply.done) return problem(409, "Not done", reply.message);
            return json_response(
                {{"message", reply.message}, {"applied", report.applied}, {"takes_restart", report.takes_restart}});
          },
      .takes_long = true};
}

Answer pair(const http::Request& request, const Facts& /*facts*/) {
  auto pairing = pairing_of(request.body);
  if (!pairing) return problem(400, "Not understood", pairing.error().message);
  return std::move(*pairing);
}

Answer sessions(const http::Request& /*request*/, const Facts& facts) {
  ordered_json sessions = ordered_json::array();
  if (facts.pairings != nullptr) {
    for (const PairedBrowser& browser : facts.pairings->browsers(facts.utc_s)) {
      sessions.push_back({{"id", browser.id},
                          {"since_s", browser.since_utc_s},
                          {"last_use_s", browser.last_use_utc_s},
                          {"address", browser.address}});
    }
  }
  return json_response({{"sessions", std::move(sessions)}});
}
Answer revoke_session(const http::Request& request, const Facts& /*facts*/) {
  auto revocation = revocation_of(request.body);
  if (!revocation) return problem(400, "Not understood", revocation.error().message);
  return std::move(*revocation);
}

Answer fleet(const http::Request& /*request*/, const Facts& facts) {
  if (const auto why = silence_of(facts)) return no_news(*why);
  if (facts.fleet == nullptr) return json_response({{"nodes", ordered_json::array()}});
  return http::Response{.body = *facts.fleet};
}

Answer recent_wind(const http::Request& /*request*/, const Facts& facts) {
  ordered_json age_s = ordered_json::array();
  ordered_json measured_m_s = ordered_json::array();
  ordered_json blended_m_s = ordered_json::array();
  ordered_json noise_share = ordered_json::array();
  if (facts.wind != nullptr) {
    for (const WindMoment& moment : facts.wind->moments()) {
      age_s.push_back(facts.mono_s - moment.mono_s);
      measured_m_s.push_back(moment.measured_m_s ? ordered_json(*moment.measured_m_s) : ordered_json(nullptr));
      blended_m_s.push_back(moment.blended_m_s);
      noise_share.push_back(moment.noise_share);
    }
  }
  return json_response({{"age_s", std::move(age_s)},
                        {"measured_m_s", std::move(measured_m_s)},
                        {"blended_m_s", std::move(blended_m_s)},
                        {"noise_share", std::move(noise_share)}});
}

Answer history(const http::Request& request, const Facts& /*facts*/) {
  const auto hours = number_in_query(request.query, {.name = "hours", .least = 1, .most = 366 * 24, .otherwise = 24});
  if (!hours) return problem(400, "Not understood", hours.error().message);
  return HistoryQuestion{*hours};
}

Answer log(const http::Request& request, const Facts& facts) {
  const auto count = number_in_query(request.query, {.name = "lines", .least = 1, .most = 500, .otherwise = 200});
  if (!count) return problem(400, "Not understood", count.error().message);
  ordered_json lines = ordered_json::array();
  if (facts.log) {
    for (const LogLine& line : facts.log(*count))
      lines.push_back({{"time_s", line.time_s}, {"level", line.level}, {"text", line.text}});
  }
  return json_response({{"lines", std::move(lines)}});
}

// ---- recordings, jobs about them, and the configuration ----

using What = ArchiveRequest::What;
constexpr std::string_view kRecordings = "/api/v1/recordings";
constexpr std::string_view kSensors = "/api/v1/sensors";
constexpr std::string_view kKept = "/api/v1/kept";

/// The name in /api/v1/recordings/NAME/verify; empty if the path has none, or a damaged one.
std::string name_in(std::string_view path) {
  constexpr std::size_t kPlace = 3;  // behind "", "api", "v1" and the kind
  for (std::size_t i = 0; i <= kPlace; ++i) {
    const std::size_t slash = path.find('/');
    if (slash == std::string_view::npos) return {};
    path.remove_prefix(slash + 1);
  }
  return path_decoded(path.substr(0, path.find('/'))).value_or("");
}

template <What kWhat>
Answer archived(const http::Request& request, const Facts& /*facts*/) {
  return ArchiveRequest{.what = kWhat, .name = name_in(request.path)};
}
template <What kWhat>
Answer job(const http::Request& request, const Facts& facts) {
  if (const auto body = empty_body(request.body); !body) return problem(400, "Not understood", body.error().message);
  return archived<kWhat>(request, facts);
}

Answer calibrate(const http::Request& request, const Facts& /*facts*/) {
  auto order = calibration_order_of(request.body);
  if (!order) return problem(400, "Not understood", order.error().message);
  return ArchiveRequest{.what = What::kCalibrate, .name = name_in(request.path), .calibration = std::move(*order)};
}
Answer keep_calibration(const http::Request& request, const Facts& /*facts*/) {
  auto found = found_calibration_of(request.body);
  if (!found) return problem(400, "Not understood", found.error().message);
  return ArchiveRequest{.what = What::kKeepCalibration, .name = name_in(request.path), .found = std::move(*found)};
}

Answer sensor_request(const http::Request& request, What what) {
  auto sensor = sensor_of(request.body, what == What::kAddSensor);
  if (!sensor) return problem(400, "Not understood", sensor.error().message);
  return ArchiveRequest{.what = what, .sensor = std::move(*sensor)};
}
Answer add_sensor(const http::Request& request, const Facts& /*facts*/) {
  return sensor_request(request, What::kAddSensor);
}
Answer try_sensor(const http::Request& request, const Facts& /*facts*/) {
  return sensor_request(request, What::kTrySensor);
}

Answer keep(const http::Request& request, const Facts& /*facts*/) {
  auto values = kept_values_of(request.body);
  if (!values) return problem(400, "Not understood", values.error().message);
  return ArchiveRequest{.what = What::kKeep, .values = std::move(*values)};
}

constexpr std::array kRoutes = {
    Route{"GET", "/healthz", health},
    Route{"GET", "/metrics", metrics},
    Route{"GET", "/api/v1/openapi.json", openapi},
    Route{"GET", "/api/v1/status", status},
    Route{"GET", "/ws", socket},
    Route{"GET", "/api/v1/scenes", scenes},
    Route{"POST", "/api/v1/scenes", change_scene},
    Route{"GET", "/api/v1/player", players},
    Route{"POST", "/api/v1/player", change_player},
    Route{"GET", "/api/v1/parameters", parameters},
    Route{"POST", "/api/v1/parameters", change_parameters},
    Route{"POST", "/api/v1/hand", hand},
    Route{"POST", "/api/v1/blackout", blackout},
    Route{"POST", "/api/v1/camera", camera},
    Route{"POST", "/api/v1/reload", reload},
    Route{"GET", "/api/v1/fleet", fleet},
    Route{"GET", "/api/v1/wind", recent_wind},
    Route{"GET", "/api/v1/history", history},
    Route{"GET", "/api/v1/log", log, true},
    Route{"POST", kPairPath, pair},
    Route{"GET", kSessionsPath, sessions, true},
    Route{"POST", kSessionsPath, revoke_session, true},

    Route{"GET", kRecordings, archived<What::kList>, true},
    Route{"GET", "/api/v1/recordings/{name}", archived<What::kDownload>, true},
    Route{"POST", "/api/v1/recordings/{name}/verify", job<What::kVerify>, true},
    Route{"POST", "/api/v1/recordings/{name}/report", job<What::kReport>, true},
    Route{"POST", "/api/v1/recordings/{name}/copy", job<What::kCopy>, true},
    Route{"POST", "/api/v1/support-bundle", job<What::kSupportBundle>, true},
    Route{"GET", "/api/v1/jobs/{id}", archived<What::kJob>, true},
    Route{"DELETE", "/api/v1/jobs/{id}", archived<What::kCancelJob>, true},
    Route{"GET", "/api/v1/jobs/{id}/file", archived<What::kJobFile>, true},
    Route{"GET", "/api/v1/configuration", archived<What::kConfiguration>, true},

    Route{"GET", "/api/v1/drivers", archived<What::kDrivers>, true},
    Route{"GET", kSensors, archived<What::kSensors>},
    Route{"POST", kSensors, add_sensor},
    Route{"POST", "/api/v1/sensors/find", job<What::kFindSensors>, true},
    Route{"POST", "/api/v1/sensors/try", try_sensor, true},
    Route{"POST", "/api/v1/sensors/undo", job<What::kUndoPage>, true},
    Route{"DELETE", "/api/v1/sensors/{name}", archived<What::kRemoveSensor>, true},

    Route{"GET", "/api/v1/calibrations", archived<What::kCalibrations>, true},
    Route{"POST", "/api/v1/sensors/{name}/calibrate", calibrate, true},
    Route{"POST", "/api/v1/sensors/{name}/calibration", keep_calibration, true},
    Route{"DELETE", "/api/v1/sensors/{name}/calibration", archived<What::kForgetCalibration>, true},

    Route{"GET", kKept, archived<What::kKept>, true},
    Route{"POST", kKept, keep, true},
    Route{"DELETE", kKept, archived<What::kForgetKept>, true},
    Route{"POST", "/api/v1/kept/undo", job<What::kUndoPage>, true},
};

/// Takes the first part of a path, up to the next slash, which goes, too.
std::string_view take_part(std::string_view& path) {
  const std::string_view part = path.substr(0, path.find('/'));
  path.remove_prefix(std::min(part.size() + 1, path.size()));
  return part;
}

/// Returns true if a path is one of a route's.
bool has_path(const Route& route, std::string_view path) {
  std::string_view pattern = route.path;
  if (std::ranges::count(pattern, '/') != std::ranges::count(path, '/')) return false;
  while (!pattern.empty() || !path.empty()) {
    const std::string_view wanted = take_part(pattern);
    const std::string_view part = take_part(path);
    if (wanted.starts_with('{') ? part.empty() : wanted != part) return false;
  }
  return true;
}

std::string_view method_of(const http::Request& request) {
  return request.method == "HEAD" ? std::string_view("GET") : request.method;
}

}  // namespace

std::span<const Route> routes() {
  return kRoutes;
}

bool is_private(std::string_view path) {
  return std::ranges::any_of(kRoutes, [path](const Route& route) { return route.is_private && has_path(route, path); });
}

std::optional<http::Response> method_refusal(const http::Request& request) {
  const std::string_view method = method_of(request);
  std::string allowed;
  for (const Route& route : kRoutes) {
    if (!has_path(route, request.path)) continue;
    if (route.method == method) return std::nullopt;
    allowed += (allowed.empty() ? "" : ", ") + std::string(route.method);
  }
  if (allowed.empty()) {  // of the page, or not known
    if (method == "GET") return std::nullopt;
    allowed = "GET";
  }
  http::Response refusal = problem(405, "Method not allowed", request.path + " takes " + allowed);
  refusal.fields.push_back({"Allow", allowed});
  return refusal;
}

std::optional<std::string> status_message(const Facts& facts) {
  if (silence_of(facts)) return std::nullopt;
  return json_text(ordered_json{{"status", status_json(facts)}});
}

Answer answer_to(const http::Request& request, const Facts& facts) {
  if (auto refusal = method_refusal(request)) return std::move(*refusal);
  const auto route = std::ranges::find_if(
      kRoutes, [&](const Route& each) { return has_path(each, request.path) && each.method == method_of(request); });
  if (route != kRoutes.end()) return route->answer(request, facts);
  return problem(404, "Not found", request.path + " is not known; /api/v1/openapi.json lists all paths");
}

}  // namespace yuragi::daemon::web
