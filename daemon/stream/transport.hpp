#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi::daemon::stream {

/// An encoded message, shared by all clients that it is sent to; immutable.
using SharedBytes = std::shared_ptr<const wire::Bytes>;

/// An output of the daemon for frames and sensors.
///
/// All calls come from the thread that runs the I/O context. None of them waits for a client.
class Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// For the log: protocol and address.
  virtual std::string name() const = 0;

  /// The newest frame (an encoded wire::Frame). Slow clients miss some, but never the last one.
  virtual void publish(SharedBytes frame) = 0;

  /// The scenes have changed (an encoded wire::Scenes): all frames published from now on are of these. A client that
  /// has not announced that it takes new scenes is disconnected with that reason.
  virtual void publish_scenes(SharedBytes scenes) = 0;

  /// The newest state of the sensors (an encoded wire::Sensors): one message for clients of this machine, and one for
  /// those of others, which get less. `elsewhere` can be null while has_untrusted_clients() is false; a client that
  /// would need it waits for the next one.
  virtual void publish_sensors(SharedBytes here, SharedBytes elsewhere) = 0;

  /// Returns the number of clients that are connected.
  virtual std::size_t client_count() const = 0;
  /// Returns true if any client does not have the rights of this machine: it is on another one, or sends no token if
  /// one is required.
  virtual bool has_untrusted_clients() const = 0;

  /// Closes all connections and accepts no more. A second call does nothing.
  virtual void close() = 0;
};

}  // namespace yuragi::daemon::stream
