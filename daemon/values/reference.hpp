#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/values/moment.hpp"
#include "daemon/values/quantity.hpp"
#include "engine/base/result.hpp"

namespace yuragi::daemon::values {

/// A value as a configuration or another program names it: "speed", "place:door", "place:door.gust_norm",
/// "sensor:roof.direction", "scene:meadow". Without a part: the speed of a place or a sensor, the opacity of a scene.
class Reference {
 public:
  /// Fails with what is wrong and what is allowed. Names are not checked: find_in() does that.
  static Result<Reference, Failure> parse(std::string_view text);

  /// The reason why it cannot be read of an installation with these names; nullopt: it can.
  std::optional<std::string> missing_in(const Names& names) const;

  /// The value; nullopt: there is none at present.
  std::optional<double> value_in(const Moment& moment, Wind wind) const;

  /// Its unit and range; `name` is the part's.
  QuantityDescription description() const;

  const std::string& text() const noexcept { return text_; }

 private:
  enum class Owner : std::uint8_t { kWind, kSensor, kPlace, kScene };

  std::string text_;
  Owner owner_ = Owner::kWind;
  std::string name_;
  Quantity quantity_ = Quantity::kSpeed;
};

}  // namespace yuragi::daemon::values
