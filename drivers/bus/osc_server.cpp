// liblo 0.31 takes datagrams apart. They are read here, so that a trace can show what liblo refuses, and so that
// interrupt() can end the wait. Bundles are handed out at once: those that wait for their time would let a stranger
// fill the memory.
#include "drivers/bus/osc_server.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <span>
#include <type_traits>

#include <fmt/format.h>
#include <lo/lo.h>
#include <poll.h>
#include <sys/socket.h>

#include "drivers/bus/wake_event.hpp"

namespace yuragi {
namespace {

constexpr std::size_t kLargestDatagram = 65'536;
/// liblo goes down into bundles within bundles, each time on the stack.
constexpr std::size_t kMostBundles = 64;

struct FreeOscServer {
  void operator()(lo_server server) const noexcept { lo_server_free(server); }
};

void ignore_osc_error(int /*number*/, const char* /*message*/, const char* /*where*/) {}

std::optional<double> osc_number(char type, const lo_arg& argument) {
  double number = 0.0;
  switch (type) {
    case LO_INT32:
      number = argument.i;
      break;
    case LO_INT64:
      number = static_cast<double>(argument.h);
      break;
    case LO_FLOAT:
      number = static_cast<double>(argument.f);
      break;
    case LO_DOUBLE:
      number = argument.d;
      break;
    default:
      return std::nullopt;
  }
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

/// How many bundles begin in these bytes; more than there are, perhaps, but never fewer.
std::size_t bundles_in(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint8_t, 8> kBundle = {'#', 'b', 'u', 'n', 'd', 'l', 'e', 0};
  std::size_t count = 0;
  for (auto at = bytes.begin();; ++at, ++count) {
    at = std::search(at, bytes.end(), kBundle.begin(), kBundle.end());
    if (at == bytes.end()) return count;
  }
}

class LibloServer final : public OscServer {
 public:
  explicit LibloServer(std::uint16_t port) : port_(port) {}

  Result<void, Failure> open() override {
    server_.reset(lo_server_new_with_proto(std::to_string(port_).c_str(), LO_UDP, &ignore_osc_error));
    if (!server_) {
      return Failure{
          fmt::format("cannot listen at UDP port {}: another program may have it (`ss -lunp`); end that, or choose "
                      "another port here and where the messages come from",
                      port_)};
    }
    lo_server_enable_queue(server_.get(), 0, 1);
    lo_server_add_method(server_.get(), nullptr, nullptr, &note_message, this);
    return {};
  }

  void close() noexcept override { server_.reset(); }

  OscStatus receive(OscDatagram& datagram, Nanoseconds timeout) override {
    datagram = {};
    if (!server_) return OscStatus::kLost;
    std::array<pollfd, 2> waits = {
        {{lo_server_get_socket_fd(server_.get()), POLLIN, 0}, {wake_.descriptor(), POLLIN, 0}}};
    const int ready = poll(waits.data(), waits.size(), static_cast<int>(timeout / std::chrono::milliseconds(1)));
    if (wake_.is_set()) return OscStatus::kInterrupted;
    if (ready < 0 && errno != EINTR) return OscStatus::kLost;
    if (waits[0].revents == 0) return OscStatus::kSilence;

    const ssize_t size = recv(waits[0].fd, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (size < 0) return errno == EAGAIN || errno == EINTR ? OscStatus::kSilence : OscStatus::kLost;
    datagram.bytes.assign(buffer_.begin(), buffer_.begin() + size);
    take_apart(datagram);
    return OscStatus::kDatagram;
  }

  void interrupt() noexcept override { wake_.set(); }

 private:
  void take_apart(OscDatagram& datagram) {
    const auto size = datagram.bytes.size();
    if (size == 0 || size % 4 != 0 || bundles_in(datagram.bytes) > kMostBundles) return;
    into_ = &datagram;
    datagram.is_well_formed = lo_server_dispatch_data(server_.get(), buffer_.data(), size) >= 0;
    into_ = nullptr;
    if (!datagram.is_well_formed) datagram.messages.clear();
  }

  static int note_message(const char* path, const char* types, lo_arg** arguments, int count, lo_message /*message*/,
                          void* self) {
    OscMessage message{.address = path, .numbers = {}};
    for (int i = 0; i < count; ++i) message.numbers.push_back(osc_number(types[i], *arguments[i]));
    static_cast<LibloServer*>(self)->into_->messages.push_back(std::move(message));
    return 0;
  }

  std::uint16_t port_;
  WakeEvent wake_;
  std::unique_ptr<std::remove_pointer_t<lo_server>, FreeOscServer> server_;
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(kLargestDatagram);
  OscDatagram* into_ = nullptr;  // while liblo takes one apart
};

}  // namespace

std::unique_ptr<OscServer> make_osc_server(std::uint16_t port) {
  return std::make_unique<LibloServer>(port);
}

bool osc_address_matches(const std::string& address, const std::string& pattern) {
  return lo_pattern_match(address.c_str(), pattern.c_str()) != 0;
}

}  // namespace yuragi
