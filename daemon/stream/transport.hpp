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

  /// The newest state of the sensors (an encoded wire::Sensors).
  virtual void publish_sensors(SharedBytes sensors) = 0;

  /// Clients connected now.
  virtual std::size_t client_count() const = 0;

  /// Closes all connections and accepts no more. A second call does nothing.
  virtual void close() = 0;
};

}  // namespace yuragi::daemon::stream
