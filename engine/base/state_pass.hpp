#pragma once

#include <bit>
#include <chrono>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <ranges>
#include <span>
#include <type_traits>
#include <vector>

#include "engine/base/time.hpp"

namespace yuragi {

class StatePass;

/// A class whose member `list_state(pass)` passes everything that later ticks depend on, besides what the object was
/// made of and its input. It is the only list: saving, checking and loading are three passes over it.
template <class T>
concept ListsState = requires(T& object, StatePass& pass) {
  object.list_state(pass);
};

/// One pass over the moving state of an object, in the order of its list_state(): it saves the state to bytes, checks
/// bytes against it, or loads it from bytes. Bytes are little-endian, without names or lengths: the object that was
/// made of the same configuration determines them all. A pass that checks changes nothing.
///
///     void list_state(StatePass& pass) {
///       pass(wind_, oscillators_);           // numbers, and whatever lists its state or is a range of these
///       pass.within(phase_, 0.0, 1.0);       // a narrower range
///       pass.index(latest_, samples_.size());
///     }
///
/// Allocates while it saves. Thread-safe: no. Realtime-safe: no.
class StatePass {
 public:
  /// The largest magnitude of a number whose range is not given: more is refused, so that sums stay finite.
  static constexpr double kLargest = 1e6;
  /// The same of totals (the way of the wind, seconds), which grow for years.
  static constexpr double kLargestTotal = 1e12;

  enum class Problem : std::uint8_t {
    kNone,
    kLengthDiffers,  ///< there are fewer or more bytes than the state has
    kOutOfRange,     ///< a number is not finite, or beyond its range
  };

  /// Appends to `bytes`. `now`: moments (MonoTime) are saved relative to it.
  static StatePass saving(std::vector<std::uint8_t>& bytes, MonoTime now = {}) {
    return {Mode::kSave, &bytes, {}, now};
  }
  static StatePass checking(std::span<const std::uint8_t> bytes) { return {Mode::kCheck, nullptr, bytes, {}}; }
  /// Only bytes that a pass has checked. `now`: the moment that takes the place of the one at which they were saved.
  static StatePass loading(std::span<const std::uint8_t> bytes, MonoTime now = {}) {
    return {Mode::kLoad, nullptr, bytes, now};
  }

  /// The first problem, after the whole state was passed.
  Problem problem() const noexcept {
    return problem_ == Problem::kNone && !bytes_.empty() ? Problem::kLengthDiffers : problem_;
  }

  template <class... Values>
  void operator()(Values&&... values) {
    (pass(values), ...);
  }

  /// A number from `min` to `max`, both included.
  template <std::floating_point Number>
  void within(Number& value, double min, double max) {
    const Number passed = transfer(value);
    // NaN is in no range.
    accept(value, passed, static_cast<double>(passed) >= min && static_cast<double>(passed) <= max);
  }
  template <std::floating_point Number>
  void within(std::span<Number> values, double min, double max) {
    for (Number& value : values) within(value, min, max);
  }

  /// The parts of a unit vector, to rounding.
  void unit_vector(double& x, double& y) {
    const double passed_x = transfer(x);
    const double passed_y = transfer(y);
    const bool is_unit = std::abs(passed_x * passed_x + passed_y * passed_y - 1.0) < 1e-6;
    accept(x, passed_x, is_unit);
    accept(y, passed_y, is_unit);
  }

  /// A total from -kLargestTotal to kLargestTotal.
  void total(double& value) { within(value, -kLargestTotal, kLargestTotal); }

  /// A count that is below `end`.
  void index(std::size_t& value, std::size_t end) {
    const auto passed = transfer(std::uint64_t{value});
    accept(value, static_cast<std::size_t>(passed), passed < end);
  }

  /// Values to whose end further ones may have been added since they were saved: these are not touched.
  template <class Value>
  void grown(std::span<Value> values) {
    const auto saved = transfer(std::uint64_t{values.size()});
    if (saved > values.size()) {
      note(Problem::kLengthDiffers);
      bytes_ = {};
      return;
    }
    for (Value& value : values.first(saved)) pass(value);
  }

  /// An enumerator from 0 to `last`.
  template <class Enum>
  void choice(Enum& value, Enum last) {
    const auto passed = transfer(static_cast<std::uint8_t>(value));
    accept(value, static_cast<Enum>(passed), passed <= static_cast<std::uint8_t>(last));
  }

 private:
  enum class Mode : std::uint8_t { kSave, kCheck, kLoad };

  StatePass(Mode mode, std::vector<std::uint8_t>* saved, std::span<const std::uint8_t> bytes, MonoTime now)
      : mode_(mode), saved_(saved), bytes_(bytes), now_(now) {}

  template <class Value>
  void pass(Value& value) {
    if constexpr (ListsState<Value>) {
      value.list_state(*this);
    } else if constexpr (std::is_same_v<Value, bool>) {
      flag(value);
    } else if constexpr (std::is_floating_point_v<Value>) {
      within(value, -kLargest, kLargest);
    } else if constexpr (std::is_unsigned_v<Value>) {
      accept(value, transfer(value), true);
    } else if constexpr (std::is_same_v<Value, MonoTime>) {
      // All moments of a run lie within centuries of one another, so that no difference overflows.
      const Nanoseconds since(transfer((value - now_).count()));
      accept(value, now_ + since, since > -kLongest && since < kLongest);
    } else if constexpr (std::is_same_v<Value, UtcTime>) {
      accept(value, UtcTime(Nanoseconds(transfer(value.time_since_epoch().count()))), true);
    } else {
      static_assert(std::ranges::range<Value>, "a class needs list_state(), an enum choice()");
      for (auto& element : value) pass(element);
    }
  }

  template <class Value>
  void pass(std::optional<Value>& value) {
    const bool is_there = flag_of(value.has_value());
    if (!is_there) {
      if (mode_ == Mode::kLoad) value.reset();
      return;
    }
    Value passed = value.value_or(Value());
    pass(passed);
    if (mode_ == Mode::kLoad) value = passed;
  }

  void flag(bool& value) { accept(value, flag_of(value), true); }
  bool flag_of(bool value) {
    const std::uint8_t passed = transfer(static_cast<std::uint8_t>(value ? 1 : 0));
    if (passed > 1) note(Problem::kOutOfRange);
    return passed == 1;
  }

  template <class Value>
  void accept(Value& value, Value passed, bool is_valid) {
    if (!is_valid && mode_ != Mode::kSave) note(Problem::kOutOfRange);
    if (is_valid && mode_ == Mode::kLoad) value = passed;
  }

  void note(Problem problem) noexcept {
    if (problem_ == Problem::kNone) problem_ = problem;
  }

  /// Returns the value that the bytes have; if it saves, the given one.
  template <class Number>
  Number transfer(Number value) {
    using Bits = std::conditional_t<sizeof(Number) == 8, std::uint64_t,
                                    std::conditional_t<sizeof(Number) == 4, std::uint32_t, std::uint8_t>>;
    static_assert(sizeof(Bits) == sizeof(Number));
    if (mode_ == Mode::kSave) {
      const auto bits = std::bit_cast<Bits>(value);
      for (std::size_t i = 0; i < sizeof bits; ++i)
        saved_->push_back(static_cast<std::uint8_t>(bits >> (8 * i) & 0xFFU));
      return value;
    }
    if (bytes_.size() < sizeof(Bits)) {
      note(Problem::kLengthDiffers);
      bytes_ = {};
      return value;
    }
    Bits bits = 0;
    for (std::size_t i = 0; i < sizeof bits; ++i) bits = static_cast<Bits>(bits | Bits{bytes_[i]} << (8 * i));
    bytes_ = bytes_.subspan(sizeof bits);
    return std::bit_cast<Number>(bits);
  }

  static constexpr Nanoseconds kLongest = std::chrono::hours(24 * 365 * 100);

  Mode mode_;
  std::vector<std::uint8_t>* saved_;
  std::span<const std::uint8_t> bytes_;  ///< still to be read
  MonoTime now_;
  Problem problem_ = Problem::kNone;
};

}  // namespace yuragi
