#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/settings/config.hpp"
#include "daemon/settings/parameter_edit.hpp"
#include "daemon/settings/reload_plan.hpp"
#include "engine/base/time.hpp"
#include "engine/wire/wire.hpp"

namespace yuragi::daemon::service {

/// The parts of the daemon that a Reload needs.
struct ReloadParts {
  /// Carries out a function on the I/O thread, soon. Call it on any thread.
  std::function<void(std::function<void()>)> post;

  /// The absolute path of the configuration, and how it is read: on the reload's thread, which a disk may hold up for
  /// ever; so it owns all that it uses. Throws ConfigError. Empty: there is no file.
  std::string file;
  std::function<settings::Config()> read;

  /// Returns the problems of the next start with the configuration that was read, as texts for people; it is applied
  /// anyway. On the reload's thread, and so it owns all that it uses. Empty: no check.
  std::function<std::vector<std::string>(const settings::Config& running, const settings::Config& next)> rehearse = {};

  /// Makes the scenes of a configuration, on the reload's thread. What it returns brings them to the animation, on the
  /// I/O thread, and cannot fail. Throws ConfigError or FailureError if they cannot be made; if `is_given_up`
  /// returns true, it should return early, with any result. Empty: other scenes need a restart.
  using Adopt = std::function<void()>;
  std::function<Adopt(const settings::Config& next, const std::function<bool()>& is_given_up)> make_scenes;

  /// Applies all except the scenes, on the I/O thread. Cannot fail.
  std::function<void(const settings::ReloadPlan& plan)> apply;

  /// The same for values that are set: of [look] alone, if anything is to be applied besides scenes.
  std::function<void(const settings::ReloadPlan& plan)> apply_edits = {};

  /// Returns true while scenes still fade for the last reload. The next begins after that (go_on()). Empty: never.
  std::function<bool()> is_settling = {};
};

/// Reads the configuration again while the daemon runs, and applies what can change: file, check and scenes on a thread
/// of its own, and then, when nothing can fail any more, everything at once on the I/O thread. A mistake changes
/// nothing. What was done is logged and sent to the clients who asked.
///
/// Single values of [look] and of scenes are set in the same way, without the file; the next reload puts them back to
/// the values of the file.
///
/// The file has kMaxRead to be read; then the reload has failed, and the next one begins. Its thread is left behind, at
/// most kMaxLeftBehind of them.
///
/// Requests that come while a reload is under way are answered by one more after it; values that are set meanwhile are
/// set together, those of [look] without waiting for scenes that fade. Belongs to the I/O thread.
class Reload {
 public:
  using Reply = std::function<void(const wire::ReloadReport&)>;

  /// At most this many clients wait for a reload; further ones are refused with "try again".
  static constexpr std::size_t kMaxWaiting = 64;

  static constexpr Nanoseconds kMaxRead = std::chrono::seconds(20);
  static constexpr std::size_t kMaxLeftBehind = 4;

  /// `running`: the configuration that the daemon began with.
  Reload(const settings::Config& running, ReloadParts parts);

  /// Abandons the present reload: waits for scenes that are being made, but not for a disk that hangs.
  ~Reload();
  Reload(const Reload&) = delete;
  Reload& operator=(const Reload&) = delete;

  /// Reads the configuration again. `expected_file`: the client's, as wire::ReloadCommand::file. `reply` is called
  /// once with the result, unless the daemon ends before.
  void request(const std::string& expected_file = {}, Reply reply = {});

  /// Sets values. A mistake changes nothing, and `reply` gets it at once.
  void set(const std::vector<settings::ParameterEdit>& edits, Reply reply = {});
  /// Returns what is wrong with such edits; nullopt if nothing is.
  std::optional<std::string> mistake_in(const std::vector<settings::ParameterEdit>& edits) const;

  /// The running values, including those set by clients, and the values of the file when it was last read, as far as
  /// they are applied.
  const settings::Config& running() const noexcept { return *running_; }
  const settings::Config& configured() const noexcept { return *configured_; }

  /// Begins the reload that waits, if one does. Call it whenever the last one may have been carried out.
  void go_on();

  /// Gives up a file that has been read for longer than kMaxRead; call it about every second, with the time.
  void give_up_late(MonoTime now);

  /// Returns true while the file is waiting to be read, being read, or not yet applied.
  bool is_under_way() const noexcept;

 private:
  struct Task;

  /// What is to be done: read the file, or set values.
  struct Due {
    bool reads_file = false;
    std::vector<settings::ParameterEdit> edits = {};
    std::vector<Reply> asked = {};  ///< those whom it answers

    bool is_of_look_alone() const;
  };

  bool takes_another_reply() const;
  Due& due_file();
  Due& due_edits(bool is_of_look_alone);
  void begin();
  void finish();
  void answer(const Due& done, const wire::ReloadReport& report);

  ReloadParts parts_;
  std::shared_ptr<const settings::Config> running_, configured_;
  std::shared_ptr<Task> task_;                    ///< shared with its thread, which may outlive this
  std::optional<MonoTime> seen_at_;               ///< when give_up_late() saw the task first
  std::vector<std::weak_ptr<Task>> left_behind_;  ///< tasks that were given up; expired ones have ended
  Due present_;                                   ///< what the task does
  std::deque<Due> due_;                           ///< what is to be done after it, in order
};

}  // namespace yuragi::daemon::service
