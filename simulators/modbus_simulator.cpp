// Simulated Modbus devices. Their registers stand here, and nowhere else in the simulators; the drivers have their own
// (as profiles), so that a mistake on either side shows.
//
//   slave  register  type  meaning
//     1     0x0000   u16   RS-FSJT-N01: wind speed, 0.1 m/s
//     2     0x0000   u16   RS-FXJT-N01: direction as one of eight points, 0 = north, 1 = north-east ... 7 = north-west
//     2     0x0001   u16   RS-FXJT-N01: direction, degrees, 0 to 360
//
// Both know function 3 and no other (Renke RS-FX-N01 manual, p. 9).
#include "simulators/modbus_simulator.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <random>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <modbus/modbus.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace yuragi::sim {
namespace {

constexpr int kBacklog = 8;
constexpr std::uint32_t kClientPatience_us = 200'000;  // for the rest of a request

// Offsets in a request over TCP.
constexpr std::size_t kTransactionLow = 1;
constexpr std::size_t kUnit = 6;
constexpr std::size_t kFunction = 7;
constexpr std::size_t kCountLow = 11;

struct FreeContext {
  void operator()(modbus_t* context) const noexcept { modbus_free(context); }
};
struct FreeMapping {
  void operator()(modbus_mapping_t* mapping) const noexcept { modbus_mapping_free(mapping); }
};
using Context = std::unique_ptr<modbus_t, FreeContext>;
using Mapping = std::unique_ptr<modbus_mapping_t, FreeMapping>;
using Request = std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH>;

/// One device on the simulated line.
struct Slave {
  std::uint8_t id;
  int registers;
  void (*measure)(const PlayedMoment& moment, std::uint16_t* registers);
};

constexpr Slave kCup = {1, 1, [](const PlayedMoment& moment, std::uint16_t* registers) {
                          registers[0] = static_cast<std::uint16_t>(std::lround(10.0 * moment.speed_m_s));
                        }};
constexpr Slave kVane = {2, 2, [](const PlayedMoment& moment, std::uint16_t* registers) {
                           registers[0] = static_cast<std::uint16_t>(std::lround(moment.direction_deg / 45.0) % 8);
                           registers[1] = static_cast<std::uint16_t>(std::lround(moment.direction_deg));
                         }};
constexpr std::array kCupAndVane = {kCup, kVane};
constexpr std::array kCupOnly = {kCup};

struct Device {
  std::string_view name;
  std::span<const Slave> slaves;
};
constexpr std::array<Device, 2> kDevices = {
    {{"renke-rs-fsjt-rs-fxjt-n01", kCupAndVane}, {"renke-rs-fsjt-n01", kCupOnly}}};

const Device& device_named(std::string_view name) {
  const auto found = std::ranges::find(kDevices, name, &Device::name);
  if (found == kDevices.end()) {
    throw std::runtime_error(
        fmt::format("no simulated Modbus device \"{}\"; known: {}", name, fmt::join(modbus_device_names(), ", ")));
  }
  return *found;
}

std::uint16_t port_of(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  // The port stands at the same place in both families' addresses.
  return ntohs(reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

}  // namespace

struct ModbusSimulator::State {
  struct Line {
    Slave slave;
    Mapping registers;
  };

  std::string host;
  std::uint16_t port = 0;
  Context context;
  int listener = -1;
  std::vector<int> clients;
  std::vector<Line> lines;
  MeasuredWind wind;
  PlayedMoment moment;
  std::mt19937_64 random;
  std::uint64_t answered = 0;
  std::optional<FaultKind> fault;

  explicit State(MeasuredWind measured) : wind(std::move(measured)) {}
  ~State() { drop(); }

  bool listen() {
    context.reset(modbus_new_tcp_pi(host.c_str(), std::to_string(port).c_str()));
    if (!context) return false;
    modbus_set_indication_timeout(context.get(), 0, kClientPatience_us);
    modbus_set_byte_timeout(context.get(), 0, kClientPatience_us);
    modbus_set_response_timeout(context.get(), 0, 1000);  // libmodbus sleeps for so long before some exceptions
    listener = modbus_tcp_pi_listen(context.get(), kBacklog);
    if (listener < 0) return false;
    fcntl(listener, F_SETFL, O_NONBLOCK);
    port = port_of(listener);
    return true;
  }

  /// Closes every connection and the listener.
  void drop() {
    for (const int client : clients) close(client);
    clients.clear();
    if (listener >= 0) close(listener);
    listener = -1;
  }

  void accept_client() {
    const int client = accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
    if (client >= 0) clients.push_back(client);
  }

  /// Reads one request of a client and answers it. False: the client is gone.
  bool answer_client(int client) {
    Request request{};
    modbus_set_socket(context.get(), client);
    const int size = modbus_receive(context.get(), request.data());
    if (size < 0) return false;
    if (size <= static_cast<int>(kFunction)) return true;
    return answer(client, request, size);
  }

  bool answer(int client, Request& request, int size) {
    // A gateway says so when no device of that id answers; a device knows function 3 alone.
    const auto line = std::ranges::find(lines, request[kUnit], [](const Line& one) { return one.slave.id; });
    modbus_t* const line_context = context.get();
    if (fault == FaultKind::kSilence) return true;
    if (fault == FaultKind::kGarbage) return send_garbage(client);
    if (fault == FaultKind::kPartial) return send_partial(client, request);
    ++answered;
    if (line == lines.end()) {
      return modbus_reply_exception(line_context, request.data(), MODBUS_EXCEPTION_GATEWAY_TARGET) >= 0;
    }
    if (fault == FaultKind::kException) {
      return modbus_reply_exception(line_context, request.data(), MODBUS_EXCEPTION_SLAVE_OR_SERVER_FAILURE) >= 0;
    }
    if (request[kFunction] != MODBUS_FC_READ_HOLDING_REGISTERS) {
      return modbus_reply_exception(line_context, request.data(), MODBUS_EXCEPTION_ILLEGAL_FUNCTION) >= 0;
    }

    // libmodbus answers with the ids of the request, which makes two of the faults.
    if (fault == FaultKind::kWrongTransaction) --request[kTransactionLow];
    if (fault == FaultKind::kWrongId) ++request[kUnit];
    return modbus_reply(line_context, request.data(), size, line->registers.get()) >= 0;
  }

  bool send_bytes(int client, std::span<const std::uint8_t> bytes) const {
    return send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }

  bool send_garbage(int client) {
    std::array<std::uint8_t, 24> bytes{};
    std::ranges::generate(bytes, [this] { return static_cast<std::uint8_t>(random()); });
    return send_bytes(client, bytes);
  }

  /// The answer to a request for registers without its last byte.
  bool send_partial(int client, const Request& request) const {
    const auto data = static_cast<std::uint8_t>(2U * std::min<unsigned>(request[kCountLow], MODBUS_MAX_READ_REGISTERS));
    std::vector<std::uint8_t> bytes(request.begin(), request.begin() + kFunction + 1);
    bytes[4] = 0;
    bytes[5] = static_cast<std::uint8_t>(3 + data);
    bytes.push_back(data);
    bytes.resize(bytes.size() + data - (data > 0 ? 1U : 0U));
    return send_bytes(client, bytes);
  }
};

std::vector<std::string> modbus_device_names() {
  std::vector<std::string> names;
  names.reserve(kDevices.size());
  for (const Device& device : kDevices) names.emplace_back(device.name);
  return names;
}

ModbusSimulator::ModbusSimulator(std::string_view device, const std::string& host, std::uint16_t port,
                                 std::uint64_t seed, MeasuredWind wind)
    : state_(std::make_unique<State>(std::move(wind))) {
  state_->host = host;
  state_->port = port;
  state_->random.seed(seed);
  for (const Slave& slave : device_named(device).slaves) {
    Mapping registers(modbus_mapping_new(0, 0, slave.registers, 0));
    if (!registers) throw std::bad_alloc();
    state_->lines.push_back({slave, std::move(registers)});
  }
  if (!state_->listen()) {
    throw std::runtime_error(fmt::format("cannot listen on {}:{} ({}): choose another port, or 0 for a free one", host,
                                         port, modbus_strerror(errno)));
  }
}

ModbusSimulator::~ModbusSimulator() = default;

std::uint16_t ModbusSimulator::port() const {
  return state_->port;
}

std::span<const FaultKind> ModbusSimulator::known_faults() const {
  static constexpr std::array kKnown = {FaultKind::kSilence,          FaultKind::kFreeze,    FaultKind::kSpike,
                                        FaultKind::kGarbage,          FaultKind::kPartial,   FaultKind::kWrongId,
                                        FaultKind::kWrongTransaction, FaultKind::kException, FaultKind::kDisconnect};
  return kKnown;
}

std::vector<int> ModbusSimulator::descriptors() const {
  std::vector<int> all = state_->clients;
  if (state_->listener >= 0) all.push_back(state_->listener);
  return all;
}

void ModbusSimulator::serve(std::span<const int> ready, double time_s, std::optional<FaultKind> fault) {
  // The devices measure on, whoever asks.
  State& state = *state_;
  state.moment = state.wind.at(time_s, fault);
  for (State::Line& line : state.lines) line.slave.measure(state.moment, line.registers->tab_registers);

  // Dropped: nobody is served until the listener is back.
  state.fault = fault;
  if (fault == FaultKind::kDisconnect) return state.drop();
  if (state.listener < 0) {
    state.listen();
    return;
  }

  for (const int descriptor : ready) {
    if (descriptor == state.listener) {
      state.accept_client();
    } else if (std::ranges::count(state.clients, descriptor) != 0 && !state.answer_client(descriptor)) {
      close(descriptor);
      std::erase(state.clients, descriptor);
    }
  }
}

std::string ModbusSimulator::status() const {
  const State& state = *state_;
  return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {} clients, {} answers{}{}", state.moment.speed_m_s,
                     state.moment.direction_deg, state.clients.size(), state.answered, state.fault ? ", fault: " : "",
                     state.fault ? name_of(*state.fault) : "");
}

}  // namespace yuragi::sim
