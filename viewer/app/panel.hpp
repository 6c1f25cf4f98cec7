#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/wire/wire.hpp"

namespace yuragi::viewer::app {

/// The values of the daemon's [look] and scenes as a person sees and sets them: it decides which Control to send when,
/// and what is shown meanwhile. It contains no parameter's name; the daemon sends them all. Pure: time is a parameter.
/// Thread-safe: no.
///
/// While a slider is dragged at most one value in kSendEvery_s is sent, and of each scene one at a time is on its way;
/// the last one is always sent. What a person has set is shown until the daemon has answered.
class Panel {
 public:
  static constexpr double kSendEvery_s = 0.1;
  static constexpr double kListEvery_s = 0.5;  ///< minimum interval between requests for the list of all parameters

  /// Call when the connection is made or lost: forgets the daemon's values.
  void set_connected(bool is_connected);
  /// Takes Sensors::parameters_revision each time it is received.
  void take_revision(std::uint64_t revision);
  void take_reply(const wire::ControlReply& reply);

  /// Takes a value that a person has set; `value` as in wire::ParameterEdit.
  void set(std::string_view scene, std::string_view key, std::string value);
  /// Back to the configuration's value.
  void reset(std::string_view scene, std::string_view key);

  /// Returns what to send at now_s; nullopt: nothing. Call it until it returns nullopt.
  std::optional<wire::Control> next(double now_s);

  const std::vector<wire::ParameterGroup>& groups() const { return groups_; }
  /// Returns the value to show for a parameter: the one that a person has set, or else the daemon's.
  const std::optional<std::string>& value(const wire::ParameterGroup& group, const wire::ParameterState& state) const;
  /// Returns true if a person has set a value that the daemon's list does not have yet.
  bool is_setting() const { return !edits_.empty(); }
  /// The reason why nothing can be set; empty: values can be set.
  const std::string& refusal() const { return refusal_; }
  /// Why the last value was not set; empty: it was.
  const std::string& mistake() const { return mistake_; }
  /// Returns true once the list of parameters was received.
  bool has_list() const { return !groups_.empty(); }

 private:
  enum class Stage : std::uint8_t {
    kWaiting,  ///< to be sent
    kSent,     ///< as `number`
    kDone,     ///< and the list that confirms it was not requested yet
    kListed,   ///< and the next list has it
  };
  struct Edit {
    std::string scene, key;
    std::optional<std::string> value;
    std::optional<std::string> shown;
    Stage stage = Stage::kWaiting;
    std::uint32_t number = 0;
  };

  void put(Edit edit);
  std::optional<wire::Control> next_edits(double now_s);
  std::optional<wire::Control> next_list(double now_s);

  std::vector<wire::ParameterGroup> groups_;
  std::vector<Edit> edits_;
  std::string refusal_, mistake_;
  bool is_connected_ = false;
  bool is_list_due_ = false;
  bool is_list_asked_ = false;
  std::optional<std::uint64_t> revision_;
  std::uint32_t number_ = 0;
  std::optional<double> sent_s_, asked_s_;
};

}  // namespace yuragi::viewer::app
