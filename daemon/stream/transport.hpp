#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "engine/wire/wire.hpp"

namespace yuragi {

/// A finished message, shared by all clients that it is on the way to. Never changed once it is handed over.
using SharedBytes = std::shared_ptr<const wire::Bytes>;

/// A way out of the daemon for what it computes: one file each, beside this one.
///
/// All calls come from the thread that runs the I/O context. None of them waits for a client.
class Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// For the log: what it speaks, and where.
  virtual std::string name() const = 0;

  /// The newest frame (an encoded wire::Frame). Clients that are slow miss some, never the last one.
  virtual void publish(SharedBytes frame) = 0;

  /// The newest state of the sensors (an encoded wire::Sensors).
  virtual void publish_sensors(SharedBytes sensors) = 0;

  /// Clients connected now.
  virtual std::size_t client_count() const = 0;

  /// Ends all connections and takes no more. A second call does nothing.
  virtual void close() = 0;
};

}  // namespace yuragi
