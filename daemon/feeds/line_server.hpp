#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/time.hpp"

namespace yuragi::daemon::feeds {

/// Listens for programs that read lines by TCP. Never waits: it accepts and writes when it is called. A client that
/// does not keep up loses whole messages, and is disconnected when it has taken nothing for 30 s. What clients send is
/// discarded. Thread-safe: no.
class LineServer {
 public:
  static constexpr std::size_t kMaxClients = 16;

  /// `feed`: stands before what is logged. `address`: HOST:PORT, an IP address, which was checked.
  LineServer(std::string feed, const std::string& address);
  ~LineServer();

  /// To all clients. Further ones than kMaxClients are disconnected at once.
  void send(std::string_view message, MonoTime now);

  /// Where it listens; port 0 until then.
  std::string address() const;
  std::size_t clients() const noexcept;
  std::uint64_t messages() const noexcept { return messages_; }
  std::uint64_t bytes() const noexcept { return bytes_; }
  std::optional<MonoTime> last_sent() const noexcept { return last_sent_; }
  /// Why it cannot listen at present, and what to do; empty: it can.
  const std::string& trouble() const noexcept { return trouble_; }

 private:
  struct Sockets;
  void open(MonoTime now);
  void accept();

  std::string feed_, address_;
  std::unique_ptr<Sockets> sockets_;
  std::uint64_t messages_ = 0, bytes_ = 0;
  std::optional<MonoTime> last_sent_, tried_;
  std::string trouble_;
};

}  // namespace yuragi::daemon::feeds
