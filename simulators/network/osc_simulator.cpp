#include "simulators/network/osc_simulator.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <random>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <fmt/format.h>

#include "engine/base/count_text.hpp"
#include "simulators/core/socket_address.hpp"

namespace yuragi::simulators::network {
namespace {

using boost::asio::ip::udp;

/// A text of OSC: with a zero byte at its end, and more of them up to a multiple of 4.
void add_text(std::string& message, const std::string& text) {
  constexpr std::size_t kAlignment = 4;
  message += text;
  message.append(kAlignment - text.size() % kAlignment, '\0');
}

void add_number(std::string& message, double number) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(number));
  for (const unsigned shift : {24U, 16U, 8U, 0U}) message += static_cast<char>(bits >> shift & 0xFFU);
}

}  // namespace

class OscSimulator::State {
 public:
  State(const OscOptions& options, core::MeasuredWind wind)
      : options_(options),
        wind_(std::move(wind)),
        random_(options.seed),
        to_(core::socket_address(options.host), options.port),
        socket_(context_, to_.protocol()) {}

  void serve(double time_s, std::optional<core::FaultKind> fault) {
    fault_ = fault;
    moment_ = wind_.at(time_s, fault);
    if (time_s < next_s_ || fault == core::FaultKind::kSilence) return;
    while (next_s_ <= time_s) next_s_ += options_.interval_s;  // skips messages that were due between the calls
    std::string message = this->message();
    if (fault == core::FaultKind::kPartial) message.resize(message.size() / 2);
    if (fault == core::FaultKind::kGarbage)
      std::ranges::generate(message, [this] { return static_cast<char>(random_()); });
    // Without a listener the next send fails; that is ignored.
    boost::system::error_code ignored;
    socket_.send_to(boost::asio::buffer(message), to_, 0, ignored);
    ++sent_;
  }

  std::string status() const {
    return fmt::format("wind {:4.1f} m/s from {:3.0f} deg, {}{}{}", moment_.speed_m_s, moment_.direction_deg,
                       count_text(sent_, "message"), fault_ ? ", fault: " : "", fault_ ? name_of(*fault_) : "");
  }

 private:
  std::string message() const {
    std::vector<double> arguments(std::max(options_.speed_argument, options_.direction_argument) + 1, 0.0);
    arguments[options_.speed_argument] = moment_.speed_m_s;
    arguments[options_.direction_argument] = moment_.direction_deg;
    std::string message;
    add_text(message, fault_ == core::FaultKind::kWrongId ? "/elsewhere" : options_.address);
    add_text(message, "," + std::string(arguments.size(), 'f'));
    for (const double argument : arguments) add_number(message, argument);
    return message;
  }

  OscOptions options_;
  core::MeasuredWind wind_;
  std::mt19937_64 random_;
  boost::asio::io_context context_;
  udp::endpoint to_;
  udp::socket socket_;
  double next_s_ = 0.0;
  core::PlayedMoment moment_;
  std::optional<core::FaultKind> fault_;
  std::uint64_t sent_ = 0;
};

OscSimulator::OscSimulator(const OscOptions& options, core::MeasuredWind wind)
    : state_(std::make_unique<State>(options, std::move(wind))) {}

OscSimulator::~OscSimulator() = default;

std::span<const core::FaultKind> OscSimulator::known_faults() const {
  using enum core::FaultKind;
  static constexpr std::array kKnown = {kSilence, kFreeze, kSpike, kGarbage, kPartial, kWrongId};
  return kKnown;
}

void OscSimulator::serve(std::span<const int> /*ready*/, double time_s, std::optional<core::FaultKind> fault) {
  state_->serve(time_s, fault);
}

std::string OscSimulator::status() const {
  return state_->status();
}

}  // namespace yuragi::simulators::network
