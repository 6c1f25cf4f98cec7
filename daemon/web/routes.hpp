#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "daemon/http/server.hpp"
#include "daemon/web/archive.hpp"
#include "daemon/web/fault_counts.hpp"
#include "daemon/web/log_line.hpp"
#include "daemon/web/pairings.hpp"
#include "daemon/web/request_body.hpp"
#include "daemon/web/web_counts.hpp"
#include "daemon/web/wind_memory.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::web {

/// What an answer is made of.
struct Facts {
  std::string software = {};
  std::string address = {};  ///< where the server listens
  double tick_rate_hz = 0.0;
  const wire::Sensors* sensors = nullptr;  ///< the daemon's last news; null: there was none yet
  double age_s = 0.0;                      ///< of them
  double patience_s = 5.0;                 ///< news that are older are no news
  LogTail log = {};
  FaultCounter faults = {};
  Counts counts = {};
  const Pairings* pairings = nullptr;  ///< null: no browser is paired
  const std::string* fleet = nullptr;  ///< JSON of the nodes in one wind; null: this daemon does not lead
  const WindMemory* wind = nullptr;    ///< null: nothing is known of the last minutes
  double mono_s = 0.0;                 ///< now, of the memory's clock
  double utc_s = 0.0;                  ///< now
};

/// A request that the daemon has to carry out, and the answer that its reply becomes.
struct Question {
  wire::Control control;
  std::function<http::Response(const wire::ControlReply& reply)> answer;
  bool takes_long = false;  ///< scenes are made for it, and fade
};

/// A request for the recorded wind.
struct HistoryQuestion {
  unsigned hours = 0;
};

/// A request for a WebSocket, for who may read.
struct SocketOpening {};

using Answer =
    std::variant<http::Response, Question, Pairing, Revocation, HistoryQuestion, SocketOpening, ArchiveRequest>;

/// What those may do, too, who are let in nowhere else yet.
inline constexpr std::string_view kPairPath = "/api/v1/pair";

/// The browsers that were paired.
inline constexpr std::string_view kSessionsPath = "/api/v1/sessions";

/// What this machine can always read: service managers and monitors ask it.
inline constexpr std::string_view kHealthPath = "/healthz";

/// One thing that can be asked for. A part of its path in braces stands for any name.
struct Route {
  std::string_view method, path;
  Answer (*answer)(const http::Request& request, const Facts& facts);
  bool is_private = false;  ///< reading it takes the right to change something, too
};

/// All of them; openapi.json, which is served at /api/v1/openapi.json, describes each.
std::span<const Route> routes();

/// Returns true for a path that only those who may change something can read: the log names files and addresses,
/// recordings show when people are there. Pure.
bool is_private(std::string_view path);

/// Returns the refusal (405) of a method that a path does not take, or nullopt. HEAD counts as GET. Pure.
std::optional<http::Response> method_refusal(const http::Request& request);

/// The state of /api/v1/status as the message of a WebSocket: {"status": {...}}; nullopt: nothing is known. Pure.
std::optional<std::string> status_message(const Facts& facts);

/// Answers a request that is_known_host() and, if it changes something, is_own_origin() has let through. Pure.
Answer answer_to(const http::Request& request, const Facts& facts);

}  // namespace yuragi::daemon::web
