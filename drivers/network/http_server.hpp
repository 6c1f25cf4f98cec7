#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "engine/base/address.hpp"
#include "engine/base/result.hpp"
#include "engine/base/time.hpp"

namespace yuragi::drivers::network {

/// A whole request. The views hold during HttpService::answer() only.
struct HttpRequest {
  boost::asio::ip::address sender = {};
  std::string_view method = {};  ///< "GET", "POST"
  std::string_view target = {};  ///< the path and the query, after the method
  std::string_view host = {};    ///< the field "Host"; empty: none
  bool is_of_browser = false;    ///< it has fields that only browsers send (Origin, Referer, Sec-Fetch-...)
  std::string_view body = {};
};

struct HttpAnswer {
  unsigned status = 200;
  std::string text = {};  ///< one line
};

/// Why a connection brought no request.
enum class HttpFailure : std::uint8_t {
  kMalformed,  ///< not HTTP; answered with 400
  kTooLong,    ///< a header or a body beyond its limit; answered with 431 or 413
  kCutOff,     ///< it was closed within the request
  kTooSlow,    ///< the request was not whole in time
  kTooMany,    ///< it was the oldest of too many connections, and was closed for a new one
};

/// Handles a server's requests. Called only by HttpServer::serve(), on its thread.
class HttpService {
 public:
  virtual ~HttpService() = default;
  /// Returns true if this address can connect. If not, its connection is closed at once.
  virtual bool admits(const boost::asio::ip::address& sender) = 0;
  virtual HttpAnswer answer(const HttpRequest& request) = 0;
  virtual void failed(HttpFailure why, const boost::asio::ip::address& sender) = 0;
};

/// The limits of a server to which anybody in the network can connect.
struct HttpLimits {
  std::uint32_t header_bytes = 16 * 1024;
  std::uint64_t body_bytes = 16UL * 1024;
  std::size_t connections = 16;
  /// Maximum duration of a connection, even if it is busy.
  Nanoseconds time = std::chrono::seconds(10);
};

/// A small server of HTTP/1.0 and 1.1, one request for each connection. It does its work within serve() alone, on the
/// caller's thread, and holds at most HttpLimits of memory and time for its clients: if more connect than it takes, the
/// oldest connection gives way to the new one, so that silent ones cannot keep others out.
///
/// Thread-safe: interrupt() alone; everything else belongs to one thread.
class HttpServer {
 public:
  /// `address`: numeric, a port of 0 takes a free one.
  explicit HttpServer(const Address& address, const HttpLimits& limits = {});
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Listens. The failure's text: why not, and what to do.
  Result<void, Failure> open();
  /// Closes all connections, too, without a call of the service.
  void close() noexcept;

  /// While it is open: the port at which it listens.
  std::uint16_t port() const noexcept { return port_; }

  /// Serves received requests, waiting for at most `timeout`. Fails if it cannot accept any more.
  Result<void, Failure> serve(Nanoseconds timeout, HttpService& service);

  /// Ends a serve() that waits, and makes all later ones end at once.
  void interrupt() noexcept;

 private:
  class Connection;

  void accept();
  void take(boost::asio::ip::tcp::socket socket);

  Address address_;
  HttpLimits limits_;
  std::atomic<bool> is_interrupted_ = false;
  boost::asio::io_context context_;
  boost::asio::ip::tcp::acceptor acceptor_{context_};
  boost::asio::ip::tcp::endpoint sender_;  ///< of the connection that is accepted next
  std::uint16_t port_ = 0;
  std::vector<std::weak_ptr<Connection>> connections_;  ///< the oldest first
  HttpService* service_ = nullptr;                      ///< during serve()
  std::optional<Failure> failure_;                      ///< of accepting
};

}  // namespace yuragi::drivers::network
