#include "drivers/bus/host_lookup.hpp"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

#include <boost/asio/io_context.hpp>

#include "engine/base/contain.hpp"

namespace yuragi::drivers::bus {
namespace {

using Endpoints = std::vector<boost::asio::ip::tcp::endpoint>;
using LookupResult = Result<Endpoints, Failure>;

Failure cannot_look_up(const std::string& host, const std::exception& error) {
  return {"cannot look up \"" + host + "\" (" + error.what() + ")"};
}

/// The system's look-up. Blocks. Never throws: it is the whole work of its thread.
LookupResult resolve_host(const std::string& host, std::uint16_t port) try {
  boost::asio::io_context context;
  boost::asio::ip::tcp::resolver resolver(context);
  boost::system::error_code error;
  Endpoints endpoints;
  for (const auto& entry : resolver.resolve(host, std::to_string(port), error)) endpoints.push_back(entry.endpoint());
  if (!endpoints.empty()) return endpoints;
  return Failure{"cannot find the host \"" + host + "\" (" + error.message() +
                 "): check its name and this machine's name server, or use an IP address"};
} catch (const std::exception& error) {  // for example, no descriptor for the context
  return cannot_look_up(host, error);
}

}  // namespace

/// Shared with the thread, which may outlive the caller.
struct HostLookup::State {
  std::string host;
  std::uint16_t port = 0;

  std::mutex mutex;
  std::condition_variable changed;
  bool is_under_way = false;
  bool is_interrupted = false;
  std::optional<LookupResult> result;
};

HostLookup::HostLookup(std::string host, std::uint16_t port) : state_(std::make_shared<State>()) {
  state_->host = std::move(host);
  state_->port = port;
}

LookupResult HostLookup::find(Nanoseconds timeout) {
  // An address needs no name server.
  boost::system::error_code no_address;
  const auto address = boost::asio::ip::make_address(state_->host, no_address);
  if (!no_address) return Endpoints{{address, state_->port}};

  std::unique_lock lock(state_->mutex);
  if (state_->is_interrupted) return Failure{"interrupted"};
  if (!state_->is_under_way && !state_->result) {
    try {
      std::thread([state = state_] {
        LookupResult result = Failure{"looking up " + state->host + " failed"};
        contain("looking up a host name", [&] { result = resolve_host(state->host, state->port); });
        const std::lock_guard guard(state->mutex);
        state->result = std::move(result);
        state->is_under_way = false;
        state->changed.notify_all();
      }).detach();
      state_->is_under_way = true;
    } catch (const std::system_error& error) {
      return cannot_look_up(state_->host, error);
    }
  }

  state_->changed.wait_for(lock, timeout, [this] { return state_->result || state_->is_interrupted; });
  if (state_->is_interrupted) return Failure{"interrupted"};
  if (!state_->result) {
    return Failure{"no name server has returned an address for \"" + state_->host +
                   "\": check the network, or use an IP address"};
  }
  LookupResult result = std::move(*state_->result);
  state_->result.reset();
  return result;
}

bool HostLookup::is_under_way() const {
  const std::lock_guard lock(state_->mutex);
  return state_->is_under_way;
}

void HostLookup::interrupt() noexcept {
  const std::lock_guard lock(state_->mutex);
  state_->is_interrupted = true;
  state_->changed.notify_all();
}

}  // namespace yuragi::drivers::bus
