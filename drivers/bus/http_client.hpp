#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::bus {

/// The parts of a URL of HTTP or HTTPS.
struct UrlParts {
  bool is_https = false;
  std::string host{};            ///< without the brackets of an IPv6 address
  std::uint16_t port = 0;        ///< the scheme's usual one if the URL has none
  std::string path_and_query{};  ///< may hold a key: for comparisons, never for people
};

/// Returns the parts; the failure has the reason and nothing of the URL. Thread-safe: yes.
Result<UrlParts, Failure> url_parts(const std::string& url);

/// What is fetched, and from where.
struct HttpResource {
  Secret url{};                   ///< http or https: a key may stand in it
  std::uint16_t port = 0;         ///< 0: that of the URL
  std::vector<Secret> headers{};  ///< "Name: value", sent with each request
  std::string ca_file{};          ///< CA certificates (PEM) that alone are trusted; empty: those of the system
  Nanoseconds timeout = std::chrono::seconds(10);  ///< from the request to the end of the reply
  std::size_t max_body = 1024UL * 1024;
};

/// Why there is no reply.
enum class HttpTrouble : std::uint8_t {
  kInterrupted,
  kTimeout,      ///< not within the time, or not to its end
  kUnreachable,  ///< no address, no connection
  kCertificate,  ///< the server's certificate was refused
  kTooLong,      ///< a longer body or header than is taken
  kCut,          ///< the connection ended within the reply
  kNotHttp,      ///< something else than HTTP
};

/// `reason` is for people, and has nothing of the URL but its host.
struct HttpFailure {
  HttpTrouble trouble = HttpTrouble::kUnreachable;
  std::string reason{};
};

/// A whole reply, of any status.
struct HttpReply {
  int status = 0;
  std::string body{};
  std::string etag{};                        ///< visible ASCII; empty: none
  std::optional<Nanoseconds> retry_after{};  ///< at least 0; not bounded
  std::string redirect_host{};               ///< where a redirect leads, printable; empty: it is none, or none is named
};

/// Fetches one resource again and again. Redirects are not followed: a reply with one is returned as it is, so that
/// secret headers go to no other server. Certificates are always verified. Thread-safe: interrupt() is; all else is for
/// one thread.
class HttpClient {
 public:
  virtual ~HttpClient() = default;

  /// Sends a GET and waits for the whole reply. `known_etag`: of the reply that is known, which the server then need
  /// not repeat (status 304); empty: none. Throws std::bad_alloc only.
  virtual Result<HttpReply, HttpFailure> get(const std::string& known_etag) = 0;

  /// Ends a get() at once, and every later one.
  virtual void interrupt() noexcept = 0;
};

/// By libcurl, whose look-up of a name has a thread of its own, which is abandoned when it takes too long. Throws
/// std::bad_alloc if libcurl cannot be set up.
std::unique_ptr<HttpClient> make_http_client(HttpResource resource);

}  // namespace yuragi::drivers::bus
