#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/stream/client_admission.hpp"
#include "engine/base/time.hpp"

namespace boost::asio {
class io_context;
}

namespace yuragi::daemon::http {

/// A whole request. Header fields that it does not have are empty.
struct Request {
  std::string method = {};  ///< "GET"
  std::string path = {};    ///< as it was sent, without the query
  std::string query = {};   ///< what stands behind the question mark
  std::string host = {};
  std::string origin = {};
  std::string fetch_site = {};      ///< Sec-Fetch-Site: where the page stands for which a browser sends it
  std::string method_to_come = {};  ///< of a preflight: Access-Control-Request-Method
  std::string content_type = {};
  std::string authorization = {};
  std::string cookie = {};
  std::string if_none_match = {};
  std::string accept_encoding = {};
  std::string body = {};
  std::string forwarded_for = {};  ///< X-Forwarded-For: for whom a proxy sends it
  bool is_forwarded = false;       ///< a proxy states that it sends it for another client
  bool is_https = false;           ///< by TLS, or a proxy states that it received it by HTTPS
  bool is_websocket = false;       ///< it asks for a WebSocket
  stream::Peer client = {};
};

struct Upgrade;          // upgrade.hpp
class FileBody;          // file_body.hpp
class CertificateFiles;  // certificate_files.hpp

struct Response {
  unsigned status = 200;
  std::string content_type = "application/json";
  std::string body = {};
  std::vector<std::pair<std::string, std::string>> fields = {};  ///< further fields of the header
  /// The body, in place of `body`: sent piece by piece, each within Limits::time. Kept until it is sent.
  std::shared_ptr<const FileBody> file = {};
  /// Takes over the connection of a request for a WebSocket, in place of an answer. It then has no place of HTTP's.
  std::function<void(Upgrade& upgrade)> take_over = {};
};

/// Call it once, on the thread of the server's context, at once or later.
using Reply = std::function<void(Response)>;

struct Limits {
  stream::AdmissionLimits clients = {};  ///< whose first request has come, if it does not ask for a WebSocket
  /// Those whose first request has not come, and those who ask for a WebSocket and have not got it. So many pages that
  /// open at once take no places of `clients`.
  stream::AdmissionLimits newcomers = {.max_clients = 128, .max_clients_per_address = 16};
  std::uint32_t header_bytes = 16 * 1024;
  std::uint64_t body_bytes = 64UL * 1024;
  /// From the end of an answer to the end of the next request, and for writing an answer, or a piece of a file.
  Nanoseconds time = std::chrono::seconds(20);
};

/// A server of HTTP/1.1 (R. Fielding and others, RFC 9110 and 9112, 2022) with connections that stay open. What is not
/// HTTP, too long or too slow is refused or closed here; the handler gets whole requests only. If it throws, a
/// std::exception the client is answered with 500.
///
/// All work is done on the thread that runs `io`, which must outlive this object. Thread-safe: no.
class Server {
 public:
  using Handler = std::function<void(const Request& request, Reply reply)>;

  /// Listens on `listen` ("HOST:PORT"; port 0 takes any free one). `certificate`: connections are by TLS, whose
  /// handshake counts as the wait for the first request; null: in the clear. Throws FailureError (kUnavailable) if that
  /// is not possible.
  Server(boost::asio::io_context& io, std::string_view listen, const Limits& limits, Handler handler,
         std::shared_ptr<const CertificateFiles> certificate = nullptr);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Where it listens: "127.0.0.1:7480".
  std::string local_endpoint() const;
  std::size_t client_count() const;

  /// Closes all connections and accepts no more. A second call does nothing.
  void close();

 private:
  class Listener;  // keeps Beast, which is slow to compile, in one file
  std::shared_ptr<Listener> listener_;
};

}  // namespace yuragi::daemon::http
