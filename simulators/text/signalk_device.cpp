// Signal K deltas, written here independently of the drivers' decoder: each value in a delta of its own, as
// signalk-server sends them (src/subscriptionmanager.ts), and first the values that it remembers. Sources: Signal K
// specification 1.x, streaming, subscription protocol, schemas/groups/environment.json.
#include "simulators/text/signalk_device.hpp"

#include <array>

#include <fmt/format.h>

#include "engine/base/units.hpp"

namespace yuragi::simulators::text {
namespace {

constexpr std::string_view kSelf = "vessels.urn:mrn:signalk:uuid:c0d79334-4e25-4245-8892-54e8ccc8021d";
constexpr double kRemembered_m_s = 33.0;
constexpr double kRememberedAngle_rad = 1.0;

std::string delta_of(std::string_view timestamp, std::string_view source, std::string_view path, double value) {
  return fmt::format(R"({{"context":"{}","updates":[{{"$source":"{}","timestamp":"{}","values":[)"
                     R"({{"path":"environment.wind.{}","value":{:.4f}}}]}}]}})"
                     "\r\n",
                     kSelf, source, timestamp, path, value);
}

class SignalKDevice final : public Device {
 public:
  explicit SignalKDevice(bool is_asked) : is_asked_(is_asked), is_subscribed_(!is_asked) {}

  std::span<const core::FaultKind> known_faults() const override {
    static constexpr std::array kKnown = {core::FaultKind::kWrongId};
    return kKnown;
  }
  std::string greeting() const override {
    return fmt::format(R"({{"name":"signalk-server","version":"2.14.4","timestamp":"{}","self":"{}",)"
                       R"("roles":["master","main"]}})"
                       "\r\n",
                       "2026-06-21T00:00:00.000Z", kSelf);
  }
  bool waits_for_clients() const override { return is_asked_; }
  void hear(std::string_view line) override {
    const bool subscribes = line.find(R"("subscribe":)") != std::string_view::npos &&
                            line.find(R"("environment.wind.*")") != std::string_view::npos;
    if (!subscribes) return;
    is_subscribed_ = true;
    recalls_ = true;
  }
  std::vector<std::string> send_messages(const core::PlayedMoment& moment,
                                         std::optional<core::FaultKind> fault) override {
    if (!is_subscribed_) return {};
    const std::string_view source = fault == core::FaultKind::kWrongId ? "n2k.36" : "n2k.35";
    std::vector<std::string> messages;
    if (recalls_) {
      constexpr std::string_view kDayBefore = "2026-06-20T12:00:00.000Z";
      messages.push_back(delta_of(kDayBefore, source, "speedApparent", kRemembered_m_s));
      messages.push_back(delta_of(kDayBefore, source, "angleApparent", kRememberedAngle_rad));
      recalls_ = false;
    }
    ++number_;
    const std::string time =
        fmt::format("2026-06-21T{:02}:{:02}:{:02}.012Z", number_ / 3600 % 24, number_ / 60 % 60, number_ % 60);
    const double angle_deg = moment.direction_deg > 180.0 ? moment.direction_deg - 360.0 : moment.direction_deg;
    messages.push_back(delta_of(time, source, "speedApparent", moment.speed_m_s));
    messages.push_back(delta_of(time, source, "angleApparent", angle_deg * kRadPerDeg));
    return messages;
  }
  bool is_request(std::string_view /*line*/) const override { return false; }

 private:
  bool is_asked_;
  bool is_subscribed_;  ///< by any client; the wire knows which clients have not subscribed
  bool recalls_ = false;
  unsigned number_ = 0;
};

}  // namespace

std::unique_ptr<Device> make_signalk_device(bool is_asked) {
  return std::make_unique<SignalKDevice>(is_asked);
}

}  // namespace yuragi::simulators::text
