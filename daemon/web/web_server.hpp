#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/stream/client_admission.hpp"
#include "daemon/stream/transport.hpp"
#include "daemon/values/moment.hpp"
#include "daemon/web/archive.hpp"
#include "daemon/web/fault_counts.hpp"
#include "daemon/web/log_line.hpp"
#include "daemon/web/sockets.hpp"
#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"
#include "engine/base/time.hpp"

namespace yuragi::daemon::web {

struct Settings {
  std::string listen = {};  ///< "HOST:PORT"; port 0 takes any free one
  std::vector<std::string> hosts =
      {};                    ///< names by which clients may call this machine, besides its own (is_known_host())
  bool takes_token = false;  ///< only who shows the token changes something; false: only this machine does
  Secret token = {};         ///< empty: there is none, or it cannot be read
  /// Where pairings outlive the daemon (PairingsFile); empty: browsers have to be paired again after a restart.
  std::filesystem::path pairings_file = {};
  bool reading_takes_token = false;       ///< nobody reads without it, either; but this machine reads kHealthPath
  std::vector<std::string> proxies = {};  ///< addresses whose X-Forwarded-For is believed, for the log and limits
  std::vector<std::string> origins = {};  ///< "https://editor.p5js.org": whose pages may read, too
  std::filesystem::path folder = {};      ///< served at /site/ (Site); empty: none
  ArchiveSettings archive = {};           ///< the daemon's files, for those who may change something (Archive)
  stream::AdmissionLimits clients = {};
  SocketLimits sockets = {};
  std::filesystem::path certificate = {}, key = {};  ///< by TLS (http::CertificateFiles); empty: in the clear
  /// The folders of the guide as HTML and of the viewer as WebAssembly, read by the constructor.
  std::filesystem::path guide = {}, viewer = {};
  wire::Hello hello = {};  ///< software and rate; the first of the stream's messages by WebSocket
  /// Carries out a client's request and calls `reply` once, on any thread. Called on the web server's own; must not
  /// wait. `is_local`: the client is of this machine, or trusted as if it were. Empty: every request is refused.
  std::function<void(const wire::Control& control, bool is_local, std::function<void(wire::ControlReply)> reply)> ask =
      {};
  /// Reads the wind of the last hours as JSON and calls `reply` once, on any thread. Called on the web server's own;
  /// must not wait. Fails with kNoInput if there is none, with kUnavailable if it is to be asked again. Empty:
  /// nothing is recorded.
  std::function<void(unsigned hours, std::function<void(Result<std::string, Failure>)> reply)> history = {};
  /// The last lines of the log, oldest first. Called on the web server's own thread; must not wait. Empty: there is
  /// none.
  LogTail log = {};
  /// How many exceptions were contained. Called on the web server's own thread; must not wait. Empty: not counted.
  FaultCounter faults = {};
  /// After this time without news from the daemon the page shows that it hangs, and a request is given up.
  Nanoseconds patience = std::chrono::seconds(5);
};

/// The state of the daemon by HTTP, for people, scripts and Prometheus: /healthz, /metrics, /api/v1 (routes.cpp), and
/// wind, state and poses by WebSocket: /ws (Sockets).
///
/// A thread of its own answers, from what was published last; the caller of publish() hands over a pointer and goes on.
/// Thread-safe: everything but construction, close() and destruction.
class Server final : public stream::Transport {
 public:
  /// Listens and begins to answer. Throws FailureError (kUnavailable) if that is not possible, or if the certificate
  /// cannot be used.
  explicit Server(Settings settings);
  ~Server() override;

  /// Where it listens: "127.0.0.1:7480".
  std::string local_endpoint() const;
  /// "https://127.0.0.1:7480"
  std::string address() const;

  /// Begins to read the certificate's files again, as it does by itself every hour.
  void renew_certificate();
  /// What is wrong with them, for a person; nullopt: nothing.
  std::optional<std::string> certificate_trouble() const;

  /// Trusts clients with this token from now on.
  void set_token(const Secret& token);

  std::string name() const override { return "http " + local_endpoint(); }
  void publish(stream::SharedBytes frame) override;
  void publish_scenes(stream::SharedBytes scenes) override;
  /// The values of a tick of the wind. Does nothing while no WebSocket wants them.
  void publish_moment(std::shared_ptr<const values::Moment> moment);
  void publish_sensors(stream::SharedBytes here, stream::SharedBytes elsewhere) override;
  /// The nodes in one wind, as JSON for /api/v1/fleet; null: this daemon does not lead.
  void publish_fleet(std::shared_ptr<const std::string> nodes);
  std::size_t client_count() const override;
  /// Clients on other machines get less, and can ask at any time.
  bool has_untrusted_clients() const override;
  void close() override;

 private:
  class Thread;
  std::unique_ptr<Thread> thread_;
};

}  // namespace yuragi::daemon::web
