#include "simulators/microphone/microphone_simulator.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "engine/base/count_text.hpp"

namespace yuragi::simulators::microphone {
namespace {

constexpr double kMaxAtOnce_s = 1.0;  // a halted machine does not make up for more
// Limit for sound that a client has not yet read. Exceeding it loses sound, which is heard as a click: a client on a
// busy machine is late by seconds, one that hangs for longer.
constexpr double kMaxWaiting_s = 20.0;
// Not a whole number of samples; large enough that the socket, which holds a few hundred pieces of any size, holds the
// sound of many turns.
constexpr std::size_t kSplitBytes = 1021;

/// One client, or the reader of the pipe.
struct Client {
  int descriptor = -1;
  std::vector<std::uint8_t> waiting;  ///< bytes not yet taken; begins anywhere, ends with a frame
};

void close_microphone_socket(int& descriptor) {
  if (descriptor >= 0) close(std::exchange(descriptor, -1));
}

int listen_on(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    errno = ENAMETOOLONG;
    return -1;
  }
  std::memcpy(address.sun_path, path.c_str(), path.size());
  unlink(path.c_str());
  int listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (listener < 0) return -1;
  if (bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 || listen(listener, 8) != 0) {
    const int error = errno;
    close_microphone_socket(listener);
    errno = error;
  }
  return listener;
}

}  // namespace

struct Simulator::State {
  Options options;
  Outputs outputs;
  Sound sound;
  core::MeasuredWind wind;
  core::PlayedMoment moment;
  std::optional<core::FaultKind> fault;
  int listener = -1;
  std::vector<Client> clients;
  Client pipe;
  double rendered_s = 0.0;
  std::vector<float> samples;

  State(const Options& chosen, Outputs where, core::MeasuredWind measured)
      : options(chosen), outputs(std::move(where)), sound(chosen), wind(std::move(measured)) {}
  ~State() { drop(true); }

  void drop(bool unplugged) {
    for (Client& client : clients) close_microphone_socket(client.descriptor);
    clients.clear();
    close_microphone_socket(pipe.descriptor);
    pipe.waiting.clear();
    close_microphone_socket(listener);
    if (unplugged && !outputs.socket.empty()) unlink(outputs.socket.c_str());
  }

  void plug_in() {
    if (!outputs.socket.empty() && listener < 0) listener = listen_on(outputs.socket);
    // It can be opened only while another program reads it.
    if (!outputs.pipe.empty() && pipe.descriptor < 0) {
      pipe.descriptor = open(outputs.pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    }
  }

  /// Returns false if the reader has disconnected.
  bool give(Client& client) const {
    const auto bytes = std::as_bytes(std::span(samples));
    const auto most = static_cast<std::size_t>(kMaxWaiting_s * options.rate_hz) * options.channels * sizeof(float);
    if (client.waiting.size() + bytes.size() <= most) {
      const auto* const begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
      client.waiting.insert(client.waiting.end(), begin, begin + bytes.size());
    }
    std::size_t taken = 0;
    while (taken < client.waiting.size()) {
      const std::size_t piece = std::min(client.waiting.size() - taken,
                                         fault == core::FaultKind::kSplit ? kSplitBytes : client.waiting.size());
      const ssize_t size = write(client.descriptor, client.waiting.data() + taken, piece);
      if (size < 0 && errno != EAGAIN && errno != EINTR) return false;
      if (size <= 0) break;
      taken += static_cast<std::size_t>(size);
    }
    client.waiting.erase(client.waiting.begin(), client.waiting.begin() + static_cast<std::ptrdiff_t>(taken));
    return true;
  }
};

Simulator::Simulator(const Options& options, Outputs outputs, core::MeasuredWind wind)
    : state_(std::make_unique<State>(options, std::move(outputs), std::move(wind))) {
  std::signal(SIGPIPE, SIG_IGN);  // a client that closes its socket must not end the program
  state_->plug_in();
  if (!state_->outputs.socket.empty() && state_->listener < 0) {
    throw std::runtime_error(fmt::format("cannot listen on {} ({}): choose another path", state_->outputs.socket,
                                         std::generic_category().message(errno)));
  }
}

Simulator::~Simulator() = default;

std::span<const core::FaultKind> microphone_faults() {
  static constexpr std::array kKnown = {
      core::FaultKind::kSilence, core::FaultKind::kFreeze,     core::FaultKind::kSpike, core::FaultKind::kGarbage,
      core::FaultKind::kSplit,   core::FaultKind::kDisconnect, core::FaultKind::kUnplug};
  return kKnown;
}

std::span<const core::FaultKind> Simulator::known_faults() const {
  return microphone_faults();
}

std::vector<int> Simulator::descriptors() const {
  return state_->listener >= 0 ? std::vector{state_->listener} : std::vector<int>();
}

void Simulator::serve(std::span<const int> ready, double time_s, std::optional<core::FaultKind> fault) {
  State& state = *state_;
  state.fault = fault;
  state.moment = state.wind.at(time_s, fault);

  // A disconnected device refuses new clients; an unplugged one has no name.
  if (fault == core::FaultKind::kDisconnect || fault == core::FaultKind::kUnplug) {
    state.drop(fault == core::FaultKind::kUnplug);
    state.rendered_s = time_s;
    return;
  }
  state.plug_in();
  for (const int descriptor : ready) {
    if (descriptor != state.listener) continue;
    const int client = accept4(state.listener, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (client >= 0) state.clients.push_back({client, {}});
  }

  // The sound up to now.
  state.rendered_s = std::max(state.rendered_s, time_s - kMaxAtOnce_s);
  const auto frames = static_cast<std::size_t>(std::max(0.0, (time_s - state.rendered_s) * state.options.rate_hz));
  state.rendered_s += static_cast<double>(frames) / state.options.rate_hz;
  state.samples.clear();
  if (fault != core::FaultKind::kSilence) state.sound.render(state.moment, frames, fault, state.samples);

  std::erase_if(state.clients, [&](Client& client) {
    if (state.give(client)) return false;
    close_microphone_socket(client.descriptor);
    return true;
  });
  if (state.pipe.descriptor >= 0 && !state.give(state.pipe)) close_microphone_socket(state.pipe.descriptor);
}

std::string Simulator::status() const {
  const State& state = *state_;
  return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {}{}{}", state.moment.speed_m_s, state.moment.direction_deg,
                     count_text(state.clients.size() + (state.pipe.descriptor >= 0 ? 1U : 0U), "listener"),
                     state.fault ? ", fault: " : "", state.fault ? name_of(*state.fault) : "");
}

}  // namespace yuragi::simulators::microphone
