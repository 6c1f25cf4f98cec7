#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/secret.hpp"
#include "engine/base/time.hpp"
#include "engine/look/camera.hpp"
#include "engine/look/cloth_look.hpp"
#include "engine/look/look.hpp"
#include "engine/pose/skeleton.hpp"
#include "engine/wind/judging/quantity_watch.hpp"
#include "engine/wind/judging/sensor_state.hpp"
#include "engine/wind/link_state.hpp"
#include "engine/wind/source_report.hpp"
#include "engine/wind/wind_state.hpp"
#include "engine/wire/parameters.hpp"

// The stream's messages as plain values, and their FlatBuffers form (pose.fbs, which is the public description).
//
// Encoders write a finished, size-prefixed buffer. Decoders take the bytes after the size prefix, run the FlatBuffers
// verifier and then check further conditions (matching lengths, finite numbers); their results are safe.

namespace yuragi::wire {

inline constexpr std::uint32_t kProtocol = 1;
inline constexpr std::size_t kSizePrefixBytes = 4;
inline constexpr std::size_t kMaxServerMessageBytes = 256u << 20;  ///< for a client that reads
inline constexpr std::size_t kMaxClientMessageBytes = 4096;        ///< for the server that reads
inline constexpr std::uint16_t kDefaultPort = 7410;

// The limits that decode() accepts; pose.fbs documents them for other clients.
inline constexpr std::size_t kMaxTextBytes = 1024;  ///< encoders cut longer texts
inline constexpr std::size_t kMaxScenes = 64;
/// Strands, joints of cloth and points of surfaces, of all scenes of a message together.
inline constexpr std::size_t kMaxStrands = 1u << 22;
inline constexpr std::size_t kMaxPixels = 1u << 23;  ///< in the pictures of all cloths of a message together
inline constexpr std::size_t kMaxLinksPerStrand = 256;
inline constexpr std::size_t kMaxSensors = 256;
inline constexpr std::uint32_t kMaxEvery = 65536;
inline constexpr double kMaxRate_hz = 1000.0;
inline constexpr std::size_t kMaxRefusalReasons = 64;
inline constexpr std::size_t kMaxQuantities = 16;  ///< of a sensor
inline constexpr std::size_t kMaxTroubles = 16;
inline constexpr std::size_t kMaxFeeds = 64;
inline constexpr double kMaxFade_s = 3600.0;
inline constexpr std::size_t kMaxReloadItems = 1024;  ///< of each kind in a ReloadReport; encoders omit further ones
inline constexpr std::uint32_t kMaxSteps = 1'000'000;
inline constexpr double kMinPlayRate = 0.01;
inline constexpr double kMaxPlayRate = 1000.0;
inline constexpr double kMaxHandWind_s = 3600.0;   ///< how long a wind can be set by hand
inline constexpr double kMaxHandHold_s = 86400.0;  ///< blackout and camera, if not until somebody ends it
inline constexpr double kMaxHandWind_m_s = 60.0;
inline constexpr std::size_t kMaxRawBytes = 512;  ///< of one message to or from a device; encoders cut longer ones

using Bytes = std::vector<std::uint8_t>;

struct Hello {
  std::uint32_t protocol = kProtocol;
  std::string software;
  double tick_rate_hz = 0.0;
  std::optional<std::string> refused = std::nullopt;   ///< why the server closes the connection behind this message
  std::optional<double> wind_from_deg = std::nullopt;  ///< direction of the wind while no sensor is live, 0 to 360
  bool takes_display = false;                          ///< the server takes Display
};

/// Why a client of this build cannot use the server, for a person, with the server as subject: "speaks protocol 3, this
/// program protocol 1: update this program". Nullopt if the protocols are the same.
std::optional<std::string> protocol_mismatch(const Hello& hello);

/// The part of the poses that a client requests (Subscribe in pose.fbs; thinner.hpp).
struct Thinning {
  std::vector<std::string> scenes = {};  ///< by their names; empty: all
  std::uint32_t every = 1;               ///< every n-th of strands, columns and rows, 1 to kMaxEvery
  bool is_wind_alone = false;            ///< no scenes at all: frames with their wind, time and number

  bool is_all() const { return scenes.empty() && every == 1 && !is_wind_alone; }
  friend bool operator==(const Thinning&, const Thinning&) = default;
};

struct Subscribe {
  std::uint32_t protocol = kProtocol;
  bool poses = true;
  bool sensors = false;
  std::string client;
  bool raw = false;               ///< RawTrace
  std::string raw_sensor = {};    ///< of this sensor only; empty: of every sensor
  bool takes_new_scenes = false;  ///< accepts Scenes again; otherwise disconnected when the scenes change
  Thinning thinning = {};
  double rate_hz = 0.0;  ///< maximum frames per second, up to kMaxRate_hz; 0: all
  Secret token = {};     ///< the installation's; empty: none is sent
  bool wind = false;     ///< without `poses`: frames without scenes; otherwise it changes nothing

  /// Returns true if it asks for frames, with scenes or without.
  bool wants_frames() const { return poses || wind; }
  /// What its frames have. `thinning` itself is what was asked for.
  Thinning frame_thinning() const { return poses ? thinning : Thinning{.is_wind_alone = true}; }
};

/// A skeleton of a kind that this build does not know is decoded as one of zero strands, and so are its poses.
struct SceneModel {
  std::string name;
  std::string kind;
  pose::Skeleton skeleton;
  look::ClothLook cloth =
      {};  ///< of a cloth, or a ground's picture; its size fits its pixels, and is within Image's limits
};

struct Scenes {
  std::vector<SceneModel> scenes;
};

struct FrameInfo {
  std::uint64_t sequence = 0;
  std::uint64_t tick = 0;
  double time_s = 0.0;
  std::int64_t utc_ns = 0;
  wind::State wind;                                         ///< its `time` is not sent
  std::optional<double> view_wind_from_deg = std::nullopt;  ///< for cameras with a wind_angle, [0, 360)
};

struct Frame {
  FrameInfo info;
  std::vector<pose::Pose> poses;  ///< padded with zeros; a hidden scene's has zero strands
  std::vector<float> opacities;   ///< one a scene, 0 (hidden) to 1; in between while it fades in or out
};

/// A quantity of a sensor's readings besides the speed, and whether it is still sent.
struct QuantityStatus {
  wind::judging::Quantity quantity = wind::judging::Quantity::kDirection;
  std::optional<double> age_s = std::nullopt;  ///< of the last value; nullopt: never received
  bool is_missing = false;                     ///< expected, but readings come without it
  std::string reason = {};                     ///< for is_missing: since when, the replacement, and what to do
};

struct SensorStatus {
  std::string name;
  std::string driver;
  wind::LinkState link = wind::LinkState::kConnecting;
  wind::SourceHealth health = wind::SourceHealth::kSilent;
  std::string detail;
  std::optional<double> speed_m_s;
  std::optional<double> direction_deg;
  std::optional<double> gust_m_s;
  bool simulated = false;
  double age_s = 0.0;
  double interval_s = 0.0;
  std::uint64_t readings = 0;
  std::vector<std::pair<std::string, std::uint64_t>> refused;
  std::uint64_t frames = 0;      ///< messages from the device, of use or not
  std::uint64_t reconnects = 0;  ///< how often the device was found again after it had been lost
  bool replayed = false;         ///< a recording that is played again
  wind::judging::SensorState state = wind::judging::SensorState::kConnecting;
  std::string state_reason;             ///< the reason, and what to do
  std::optional<double> raw_speed_m_s;  ///< the last reading before calibration
  std::optional<double> raw_direction_deg;
  std::vector<QuantityStatus> quantities = {};  ///< those that it has sent, or that its profile promises
  std::string value = {};          ///< what its speed is, with the source, for a person: "instantaneous (assumed)"
  double reads_times_group = 1.0;  ///< the wind of the sensors together; levelled by it. 1: not known, or not levelled
};

/// The differences between the wind that moves the scenes and the real one (engine/wind/shaping/wind_shaping.hpp).
struct Shaping {
  double site_gain = 1.0;
  double floor_gain = 1.0;
  double breeze_m_s = 0.0;
  double opening = 1.0;
  double ceiling_gain = 1.0;
  double mean_m_s = 0.0;
  double shaped_mean_m_s = 0.0;
  double site_median_m_s = 0.0;
  double site_strong_m_s = 0.0;
  double site_known_s = 0.0;
  std::string text = {};  ///< all active effects, for a person to read; empty: none
  double gusts = 1.0;
  double openness = 1.0;  ///< 0: closed, 1: open
};

/// Lateness of scheduled work, in the last 10 minutes.
struct Lateness {
  double p50_s = 0.0;
  double p99_s = 0.0;
  double max_s = 0.0;
};

enum class RecorderState : std::uint8_t { kWriting, kRetrying, kHanging };

/// How the recording of readings does.
struct RecorderStatus {
  RecorderState state = RecorderState::kWriting;
  std::uint64_t written = 0;                               ///< readings on the disk
  std::uint64_t waiting = 0;                               ///< readings that are not yet written
  std::uint64_t lost = 0;                                  ///< readings that were dropped
  std::optional<std::uint64_t> free_bytes = std::nullopt;  ///< on its disk
  std::string error = {};                                  ///< why it cannot write at present; empty: it can
  std::string clock_doubt = {};                            ///< why the date is doubted; empty: it is believed
  std::uint64_t recorded_elsewhere = 0;                    ///< readings left to another process that recorded
};

/// One scene's part of each tick of the animation: a mean of the last seconds. A hidden one has 0.
struct SceneCost {
  std::string scene;  ///< its name
  double tick_s = 0.0;
};

/// The state of the running animation.
struct AnimationStatus {
  double running_s = 0.0;  ///< since it began
  double period_s = 0.0;   ///< of its ticks
  double tick_s = 0.0;     ///< how long it works in one, with the frame's encoding: a mean of the last seconds
  std::vector<SceneCost> scenes = {};
};

/// An output of the wind for other programs.
struct FeedStatus {
  std::string kind;    ///< "osc"
  std::string name;    ///< as the configuration calls it
  std::string target;  ///< "192.168.1.40:9000"
  std::string sends;   ///< for a person
  std::uint64_t messages = 0, bytes = 0;
  std::optional<double> last_sent_age_s = std::nullopt;  ///< nullopt: nothing has been sent
  std::string trouble = {};  ///< why nothing can be sent at present, and what to do; empty: it can
};

/// Something that a person has set by hand.
struct Hold {
  std::optional<double> left_s = std::nullopt;  ///< nullopt: until somebody ends it

  friend bool operator==(const Hold&, const Hold&) = default;
};

/// The wind that a person has set, which moves the scenes in place of the real one.
struct HeldWind {
  double speed_m_s = 0.0;
  double direction_deg = 0.0;  ///< where it comes from, 0 to 360
  double left_s = 0.0;

  friend bool operator==(const HeldWind&, const HeldWind&) = default;
};

/// What people have set by hand at present; nullopt: not set.
struct ByHand {
  std::optional<HeldWind> wind = std::nullopt;
  std::optional<Hold> blackout = std::nullopt;  ///< Shaping::openness is 0, as when closed
  std::optional<Hold> camera = std::nullopt;    ///< Sensors::camera is the chosen one

  friend bool operator==(const ByHand&, const ByHand&) = default;
};

struct Sensors {
  std::vector<SensorStatus> sensors;
  wind::State wind;              ///< the real one; that of the frames is shaped
  std::uint64_t late_ticks = 0;  ///< skipped since the daemon began
  std::uint32_t clients = 0;
  Shaping shaping = {};
  std::uint64_t refused_clients = 0;                      ///< the maximum number was connected
  std::uint64_t stuck_clients = 0;                        ///< let go because they stopped reading
  std::uint64_t idle_clients = 0;                         ///< disconnected because they did not subscribe to anything
  std::optional<Lateness> io_lateness = std::nullopt;     ///< of the I/O thread's steps
  std::optional<Lateness> tick_lateness = std::nullopt;   ///< of the animation's ticks, including skipped ones
  std::optional<RecorderStatus> recorder = std::nullopt;  ///< nullopt: nothing is recorded, or unknown
  look::Look look = {};                                   ///< within_limits(), whatever was sent
  std::vector<look::Camera> cameras = {};                 ///< the same; at most look::kMaxCameras
  std::size_t camera = 0;                 ///< index of the camera that is on, by the time of day or by hand; or 0
  std::uint64_t parameters_revision = 0;  ///< changes whenever a ParameterReport would change
  std::optional<AnimationStatus> animation = std::nullopt;  ///< nullopt: unknown, or no scenes
  std::uint64_t recent_ticks = 0;          ///< in the last 10 minutes, including skipped ones; 0: unknown
  std::uint64_t recent_skipped_ticks = 0;  ///< the skipped ones of them
  std::vector<std::string> troubles = {};  ///< other things that fail at present and are tried again, for a person
  std::uint8_t given_up = 0;               ///< the most of all clients' Display
  /// Reach of gusts across the wind, and along it, relative to the usual; nullopt: unknown.
  std::optional<double> gust_reach_across = std::nullopt, gust_reach_along = std::nullopt;
  std::vector<FeedStatus> feeds = {};  ///< at most kMaxFeeds
  ByHand by_hand = {};
};

enum class PlayerAction : std::uint8_t { kReport, kPause, kResume, kStep, kSeek, kRate };

/// An order for sensors that play a recording.
struct PlayerCommand {
  PlayerAction action = PlayerAction::kReport;
  std::string sensor = {};  ///< its name; empty: every sensor that plays a recording
  std::uint32_t count = 1;  ///< kStep: 1 to kMaxSteps
  std::string place = {};   ///< kSeek: seconds, "+30", "-30", or a moment
  double rate = 1.0;        ///< kRate: kMinPlayRate to kMaxPlayRate
};

/// Makes the server read its configuration again.
struct ReloadCommand {
  std::string file = {};  ///< absolute path of the one that is meant; empty: whichever the server reads
};

/// What is set by hand. An unknown part is refused.
enum class HandPart : std::uint8_t { kReport, kWind, kBlackout, kCamera };

/// Sets something by hand for a time, or ends that. Its numbers are finite and within the limits above.
struct HandCommand {
  HandPart part = HandPart::kReport;
  bool is_release = false;                     ///< ends it; what follows has no meaning
  std::optional<double> for_s = std::nullopt;  ///< nullopt: until somebody ends it; not for the wind
  double speed_m_s = 0.0;                      ///< kWind: 0 to kMaxHandWind_m_s
  double direction_deg = 0.0;                  ///< kWind: where it comes from, 0 to 360
  std::string camera = {};                     ///< kCamera: its name
};

/// A request to show or hide scenes; or, with `player`, to change how recordings are played; or, with `reload`, to read
/// the configuration again; or, with `parameters`, to list and set values; or, with `hand`, to set something by hand.
struct Control {
  std::string scene;  ///< its name; empty: change nothing, only report the status
  bool shown = true;
  bool hide_others = false;  ///< also hides every other scene, in the same time
  double over_s = 2.0;       ///< 0 to kMaxFade_s
  std::optional<PlayerCommand> player = std::nullopt;
  std::optional<ReloadCommand> reload = std::nullopt;
  std::optional<ParameterCommand> parameters = std::nullopt;
  std::optional<HandCommand> hand = std::nullopt;
};

struct SceneState {
  std::string name;
  std::string kind;
  bool shown = true;  ///< its state, or the end of its fade
};

/// The status of a sensor that plays a recording.
struct PlayerState {
  std::string sensor;
  std::string file;
  bool is_open = false;     ///< otherwise the recording cannot be read
  double position_s = 0.0;  ///< since the recording's first reading
  double length_s = 0.0;
  std::int64_t recorded_utc_ns = 0;
  double rate = 1.0;
  bool is_paused = false;
  bool is_finished = false;
  bool loops = false;
  std::uint64_t rounds = 0;  ///< how often it began again
  std::uint64_t order = 0;   ///< the number of the order of this reply; 0: none
  std::uint64_t orders_done = 0;
  std::string refusal;  ///< why the last order was not carried out
};

/// kDone: applied, or nothing to apply. All others: nothing was changed. An unknown outcome is decoded as kFailed.
enum class ReloadOutcome : std::uint8_t { kDone, kMistake, kNotAllowed, kNoFile, kFailed };

/// The result of reading the configuration again.
struct ReloadReport {
  ReloadOutcome outcome = ReloadOutcome::kDone;
  std::vector<std::string> applied = {};
  std::vector<std::string> takes_restart = {};
  std::vector<std::string> mistakes = {};  ///< "file:line:column: key: what is wrong"
};

struct ControlReply {
  bool done = false;
  std::string message;  ///< what was done, or the reason why not
  std::vector<SceneState> scenes;
  std::vector<PlayerState> players = {};
  std::optional<ReloadReport> reload = std::nullopt;
  std::optional<ParameterReport> parameters = std::nullopt;
  std::optional<ByHand> by_hand = std::nullopt;  ///< nullopt: not asked, or an older server
};

/// One message to or from a sensor's device, as transmitted.
struct RawTrace {
  std::string sensor;
  std::int64_t mono_ns = 0;
  std::int64_t utc_ns = 0;
  bool received = true;             ///< true: from the device; false: sent to it
  std::vector<std::uint8_t> bytes;  ///< the first kMaxRawBytes of them at most
  std::uint32_t length = 0;         ///< of the whole message
  std::uint64_t lost = 0;           ///< messages of this sensor that were passed over just before
};

/// The state of a client that shows a part of a wall.
struct Display {
  std::uint8_t given_up = 0;  ///< steps of detail that it omits in its pictures; all parts should look the same
  /// Its machine's clock less UTC; nullopt: unknown, or its pictures do not depend on it.
  std::optional<double> clock_offset_s = std::nullopt;

  friend bool operator==(const Display&, const Display&) = default;
};

using Message = std::variant<Hello, Subscribe, Scenes, Frame, Sensors, Control, ControlReply, RawTrace, Display>;

enum class Error : std::uint8_t {
  kTooLong,       ///< the size prefix is above the limit
  kNotVerified,   ///< the FlatBuffers verifier refuses it
  kUnknown,       ///< a body of a newer protocol: skip it
  kInconsistent,  ///< verified, but lengths do not match or numbers are not finite
};
std::string_view name_of(Error error);

[[noreturn]] inline void throw_exception_from_error(Error error, const boost::source_location&) {
  throw std::runtime_error("stream message refused: " + std::string(name_of(error)));
}

/// A finished message, size prefix included. Vectors of a skeleton have the sizes of engine/pose/skeleton.hpp.
Bytes encode(const Hello& hello);
Bytes encode(const Subscribe& subscribe);
Bytes encode(const Scenes& scenes);
Bytes encode(const Sensors& sensors);
Bytes encode(const Control& control);
Bytes encode(const ControlReply& reply);
Bytes encode(const RawTrace& trace);
Bytes encode(const Display& display);

/// Encodes frame after frame into one buffer that it owns and keeps. Realtime-safe after the first frame that shows
/// every scene of a set: it quantises directly into the buffer, and does not allocate. Thread-safe: no.
class FrameEncoder {
 public:
  FrameEncoder();
  ~FrameEncoder();
  FrameEncoder(FrameEncoder&&) noexcept;
  FrameEncoder& operator=(FrameEncoder&&) noexcept;

  /// `poses` corresponds to `skeletons` and `opacities`, scene by scene; empty opacities: every scene is shown. A scene
  /// of opacity 0 is hidden, and sends no pose. The bytes, size prefix included, are valid until the next call.
  std::span<const std::uint8_t> encode(const FrameInfo& info, std::span<const pose::Skeleton* const> skeletons,
                                       std::span<const pose::Pose* const> poses, std::span<const float> opacities = {});

 private:
  struct Builder;
  std::unique_ptr<Builder> builder_;
};

/// The byte count of a size prefix, or kTooLong if it is above `limit` or zero.
Result<std::size_t, Error> read_size_prefix(std::span<const std::uint8_t, kSizePrefixBytes> prefix, std::size_t limit);

/// The message in `bytes` (without the size prefix; any alignment). Never reads outside them. Texts are returned as
/// valid UTF-8 without control characters (make_printable()), so that they are safe in a terminal or a log.
Result<Message, Error> decode(std::span<const std::uint8_t> bytes);

/// Returns true if the frame's poses match the skeletons. Check before kinematics: they are two messages, each only
/// consistent in itself. A hidden scene without its pose matches any skeleton.
bool fits(const Frame& frame, const Scenes& scenes);

}  // namespace yuragi::wire
