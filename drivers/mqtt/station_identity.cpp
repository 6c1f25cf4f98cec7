#include "drivers/mqtt/station_identity.hpp"

#include <utility>

#include <fmt/format.h>

#include "engine/base/printable_text.hpp"

namespace yuragi::drivers::mqtt {

bool StationIdentity::covers(const StationIdentity& other) const noexcept {
  return (model.empty() || model == other.model) && (id.empty() || id == other.id) &&
         (channel.empty() || channel == other.channel);
}

StationIdentity station_of(const Payload& payload) {
  return {.model = payload.text_at("/model").value_or(""),
          .id = payload.text_at("/id").value_or(""),
          .channel = payload.text_at("/channel").value_or("")};
}

std::string describe(const StationIdentity& station) {
  constexpr std::size_t kLongest = 40;
  if (station.is_empty()) return "a station without a name";
  std::string text;
  for (const auto& [label, value] :
       {std::pair{"", &station.model}, std::pair{"id ", &station.id}, std::pair{"channel ", &station.channel}}) {
    if (value->empty()) continue;
    std::string shown = *value;
    make_printable(shown);
    text += fmt::format("{}{}{}", text.empty() ? "" : ", ", label, shortened(shown, kLongest));
  }
  return text;
}

bool StationChoice::offer(const StationIdentity& station, MonoTime now) {
  if (!read_ || (read_ != station && now - read_at_ >= patience_)) {
    read_ = station;
    other_.reset();
  }
  if (read_ == station) {
    read_at_ = now;
    return true;
  }
  // Of several others the first is named for as long as it is heard, so that the text does not change at each message.
  if (!other_ || other_ == station || now - other_at_ >= patience_) {
    other_ = station;
    other_at_ = now;
  }
  return false;
}

void StationChoice::restart() noexcept {
  read_.reset();
  other_.reset();
}

std::string StationChoice::warning(MonoTime now) const {
  if (!other_ || now - other_at_ >= patience_) return {};
  return fmt::format("; it reads {}, but another station is received, too: {}; select one with model, id, channel",
                     describe(*read_), describe(*other_));
}

}  // namespace yuragi::drivers::mqtt
