// libmodbus 3.1.6 opens and closes, sets up serial ports, sends, and cuts what arrives into messages. What it does not
// do is done here or in the decoder: over TCP it never checks the unit id, and its raw requests all carry one
// transaction id; it reports a message of another slave without its length; and nothing can interrupt it.
#include "drivers/bus/modbus_connection.hpp"

#include <algorithm>
#include <array>
#include <cerrno>

#include <modbus/modbus.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <unistd.h>

#include "drivers/bus/tcp_connect.hpp"

namespace yuragi::drivers::bus {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// From the first byte of a message to its last. While libmodbus waits for the rest nothing can interrupt it, so that
/// this is also the maximum wait at shutdown. At 1200 bit/s there is time for 50 bytes.
constexpr Nanoseconds kMaxMessage = std::chrono::milliseconds(500);

struct FreeModbus {
  void operator()(modbus_t* context) const noexcept { modbus_free(context); }
};
using Context = std::unique_ptr<modbus_t, FreeModbus>;

timespec to_timespec(Nanoseconds duration) {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(duration);
  return {whole.count(), (duration - whole).count()};
}

/// The length of a message that libmodbus has read from a serial line and refused. It goes by the function code.
std::size_t refused_length(std::span<const std::uint8_t> message) {
  constexpr std::size_t kCrc = 2;
  switch (message[1]) {
    case MODBUS_FC_WRITE_SINGLE_COIL:
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
    case MODBUS_FC_WRITE_MULTIPLE_COILS:
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      return 2 + 4 + kCrc;
    case MODBUS_FC_MASK_WRITE_REGISTER:
      return 2 + 6 + kCrc;
    case MODBUS_FC_REPORT_SLAVE_ID:
    case MODBUS_FC_WRITE_AND_READ_REGISTERS:
      return 3U + message[2] + kCrc;
    default:
      return 3U + (message[1] <= MODBUS_FC_READ_INPUT_REGISTERS ? message[2] : 0U) + kCrc;
  }
}

class LibmodbusConnection final : public ModbusConnection {
 public:
  explicit LibmodbusConnection(const ModbusLine& line) : line_(line), host_(line.host, line.port) {}
  ~LibmodbusConnection() override { LibmodbusConnection::close(); }
  LibmodbusConnection(const LibmodbusConnection&) = delete;
  LibmodbusConnection& operator=(const LibmodbusConnection&) = delete;

  Result<void, Failure> open(const Interruption& interruption) override {
    close();
    if (interruption.is_set()) return Failure{"interrupted"};
    Context context(is_tcp() ? modbus_new_tcp_pi(line_.host.c_str(), std::to_string(line_.port).c_str())
                             : modbus_new_rtu(line_.device.c_str(), line_.baud, line_.parity, 8, line_.stop_bits));
    if (!context) return Failure{explain(modbus_strerror(errno))};
    // No byte time-out: a whole message has to be there within the response time-out, however slowly it arrives.
    modbus_set_byte_timeout(context.get(), 0, 0);

    if (is_tcp()) {
      const auto socket = connect_tcp(host_, line_.connect_timeout, interruption);
      if (!socket) return Failure{explain(socket.error().message)};
      modbus_set_socket(context.get(), *socket);
    } else {
      if (modbus_connect(context.get()) != 0) return Failure{explain(modbus_strerror(errno))};
      // Two programs on one line would receive each other's replies.
      if (flock(modbus_get_socket(context.get()), LOCK_EX | LOCK_NB) != 0) {
        modbus_close(context.get());
        return Failure{"cannot open " + describe(line_) + ": another program uses it; stop that program first"};
      }
    }
    context_ = std::move(context);
    return {};
  }

  bool is_open() const noexcept override { return context_ != nullptr; }

  void close() noexcept override {
    if (context_) modbus_close(context_.get());
    context_.reset();
  }

  std::size_t settle(std::span<std::uint8_t, decode::modbus::kModbusMaxMessage> buffer, const ModbusPatience& patience,
                     const Interruption& interruption) override {
    if (!context_ || is_tcp()) return 0;
    const Nanoseconds quiet = std::max(patience.byte_timeout, frame_gap(line_));
    return read_until_quiet(buffer, quiet, SteadyClock::now() + patience.response_timeout, interruption);
  }

  bool send(const decode::modbus::Request& request, const ModbusPatience& patience) override {
    if (!context_) return false;
    patience_ = patience;
    deadline_ = SteadyClock::now() + patience.response_timeout;
    if (is_tcp()) {
      const auto message = decode::modbus::encode_tcp(request);
      return ::send(modbus_get_socket(context_.get()), message.data(), message.size(), MSG_NOSIGNAL) ==
             static_cast<ssize_t>(message.size());
    }
    const auto message = decode::modbus::encode_rtu_without_crc(request);
    modbus_flush(context_.get());
    return modbus_set_slave(context_.get(), request.unit) == 0 &&
           modbus_send_raw_request(context_.get(), message.data(), static_cast<int>(message.size())) >= 0;
  }

  Message receive(std::span<std::uint8_t, decode::modbus::kModbusMaxMessage> buffer,
                  const Interruption& interruption) override {
    // Wait for the first byte here, where `interruption` can end it and where silence differs from a message cut off.
    if (!context_) return {Status::kLost};
    const Nanoseconds remaining = deadline_ - SteadyClock::now();
    const bool has_bytes = remaining > Nanoseconds::zero() && wait_for_bytes(remaining, interruption);
    if (interruption.is_set()) return {Status::kInterrupted};
    if (!has_bytes) return {Status::kSilence};

    // Then libmodbus cuts out one message.
    std::ranges::fill(buffer, std::uint8_t{0});
    set_response_timeout(context_.get(), std::min<Nanoseconds>(deadline_ - SteadyClock::now(), kMaxMessage));
    const int size = modbus_receive_confirmation(context_.get(), buffer.data());
    if (size > 0) return {Status::kMessage, static_cast<std::size_t>(size)};
    if (size == 0 || errno == EMBBADCRC) {
      // A whole message of another slave is passed on alone. A damaged one, perhaps with a stray byte in front, may be
      // cut at the wrong place: so the decoder gets all received bytes.
      const std::size_t framed = std::min(refused_length(buffer), buffer.size());
      const bool is_whole = decode::modbus::modbus_crc(buffer.first(framed)) == 0;
      const Nanoseconds quiet = std::max(patience_.byte_timeout, frame_gap(line_));
      const std::size_t more = is_whole ? 0 : read_until_quiet(buffer.subspan(framed), quiet, deadline_, interruption);
      return {Status::kMessage, framed + more};
    }
    if (errno == ETIMEDOUT) return {Status::kCutOff};
    if (errno == EMBBADDATA) return {Status::kGarbled};
    return {Status::kLost};
  }

 private:
  bool is_tcp() const { return line_.framing == decode::modbus::Framing::kTcp; }

  /// libmodbus takes no time-out of zero.
  static void set_response_timeout(modbus_t* context, Nanoseconds timeout) {
    const timespec time = to_timespec(std::max<Nanoseconds>(timeout, std::chrono::milliseconds(1)));
    modbus_set_response_timeout(context, static_cast<std::uint32_t>(time.tv_sec),
                                static_cast<std::uint32_t>(time.tv_nsec / 1000));
  }

  /// Returns true if there is something to read, or the line has ended, within `timeout`.
  bool wait_for_bytes(Nanoseconds timeout, const Interruption& interruption) const {
    return interruption.wait(modbus_get_socket(context_.get()), WaitFor::kReadable, timeout) == WaitEnd::kReady;
  }

  /// Reads until no byte arrives for `quiet`, or until `deadline`; returns the number of bytes in the buffer.
  std::size_t read_until_quiet(std::span<std::uint8_t> buffer, Nanoseconds quiet, SteadyClock::time_point deadline,
                               const Interruption& interruption) const {
    std::size_t size = 0;
    while (SteadyClock::now() < deadline && wait_for_bytes(quiet, interruption)) {
      std::array<std::uint8_t, decode::modbus::kModbusMaxMessage> bytes{};
      const ssize_t got = ::read(modbus_get_socket(context_.get()), bytes.data(), bytes.size());
      if (got <= 0) break;
      const std::size_t kept = std::min(static_cast<std::size_t>(got), buffer.size() - size);
      std::ranges::copy_n(bytes.begin(), static_cast<std::ptrdiff_t>(kept), buffer.subspan(size).begin());
      size += kept;
    }
    return size;
  }

  std::string explain(const std::string& reason) const {
    if (is_tcp()) {
      return "cannot connect to " + describe(line_) + " (" + reason +
             "): check the host and port, the network, and that the device or gateway is switched on";
    }
    return "cannot open " + describe(line_) + " (" + reason +
           "): check the name of the serial port, its cable, and that this user may open it (group dialout)";
  }

  ModbusLine line_;
  HostLookup host_;  // TCP
  ModbusPatience patience_;
  Context context_;
  SteadyClock::time_point deadline_{};
};

}  // namespace

std::string describe(const ModbusLine& line) {
  if (line.framing == decode::modbus::Framing::kRtu) return line.device;
  const bool is_ipv6 = line.host.find(':') != std::string::npos;
  return (is_ipv6 ? "[" + line.host + "]" : line.host) + ":" + std::to_string(line.port);
}

Nanoseconds frame_gap(const ModbusLine& line) noexcept {
  constexpr int kFastest = 19200;
  constexpr int kBits = 39;  // 3.5 characters of 11 bits
  if (line.framing == decode::modbus::Framing::kTcp) return Nanoseconds::zero();
  if (line.baud > kFastest) return std::chrono::microseconds(1750);
  return std::chrono::nanoseconds(std::chrono::seconds(1)) * kBits / line.baud;
}

std::unique_ptr<ModbusConnection> make_modbus_connection(const ModbusLine& line) {
  return std::make_unique<LibmodbusConnection>(line);
}

}  // namespace yuragi::drivers::bus
