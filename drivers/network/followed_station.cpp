#include "drivers/network/followed_station.hpp"

namespace yuragi::drivers::network {

bool FollowedStation::hears(const std::string& identity, const std::string& name, MonoTime now) {
  if (chosen_.empty() && !followed_) followed_ = identity;
  if (identity == (chosen_.empty() ? *followed_ : chosen_)) {
    if (other_ && other_->identity == identity) other_.reset();
    return true;
  }
  other_ = Heard{identity, name, now};
  return false;
}

void FollowedStation::lose() {
  followed_.reset();
}

std::string FollowedStation::rival(MonoTime now) const {
  const bool is_there = chosen_.empty() && followed_ && other_ && now - other_->at <= kStillThere;
  return is_there ? other_->name : std::string();
}

}  // namespace yuragi::drivers::network
