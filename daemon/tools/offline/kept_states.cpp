#include "daemon/tools/offline/kept_states.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "engine/base/snapshot.hpp"
#include "engine/platform/whole_file.hpp"

namespace yuragi::daemon::tools::offline {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSuffix = ".state";
constexpr std::size_t kMaxState_bytes = 1UL << 30;

/// What is in the name of a file: the ticks before the state, and the log time of the last of them.
struct Place {
  std::uint64_t ticks = 0;
  Nanoseconds log_time{0};
};

std::string prefix_of(std::uint64_t made_of) {
  return fmt::format("{:016x}-", made_of);
}

std::string name_of(std::uint64_t made_of, const Place& place) {
  return fmt::format("{}{}-{}{}", prefix_of(made_of), place.ticks, place.log_time.count(), kSuffix);
}

std::optional<Place> place_in(std::string_view name, std::uint64_t made_of) {
  const std::string prefix = prefix_of(made_of);
  if (!name.starts_with(prefix) || !name.ends_with(kSuffix)) return std::nullopt;
  std::uint64_t ticks = 0;
  std::int64_t log_time_ns = 0;
  const char* const end = name.data() + name.size();
  const auto ticks_end = std::from_chars(name.data() + prefix.size(), end, ticks).ptr;
  if (ticks_end == end || *ticks_end != '-') return std::nullopt;
  std::from_chars(ticks_end + 1, end, log_time_ns);
  const Place place{ticks, Nanoseconds(log_time_ns)};
  return ticks > 0 && name == name_of(made_of, place) ? std::optional(place) : std::nullopt;
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

Result<KeptStates, Failure> KeptStates::open(const fs::path& folder, std::uint64_t made_of, Nanoseconds begin) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && !fs::is_directory(folder)) error = std::make_error_code(std::errc::not_a_directory);
  if (error)
    return Failure{fmt::format("{}: cannot be a folder for states: {}", folder.string(), error.message()),
                   FailureKind::kCannotCreate};
  KeptStates states(folder, made_of);
  std::vector<Place> places;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const auto place = place_in(at->path().filename().string(), made_of);
    if (place && place->log_time < begin) places.push_back(*place);
  }
  std::ranges::sort(places, std::ranges::greater(), &Place::ticks);
  for (const Place& place : places) {
    auto text = platform::read_whole(folder / name_of(made_of, place), kMaxState_bytes);
    if (!text || !opened_snapshot(bytes_of(*text), made_of)) continue;
    states.first_ticks_ = place.ticks;
    states.first_ = std::move(*text);
    states.next_ = place.log_time - place.log_time % kEvery + kEvery;
    break;
  }
  return states;
}

Result<void, Failure> KeptStates::load(animation::Animation& animation, MonoTime now) {
  const std::string first = std::exchange(first_, {});
  if (const auto loaded = load_snapshot(animation, made_of_, bytes_of(first), now); !loaded) {
    return Failure{fmt::format("{}: the state after {} ticks {}: empty the folder", folder_.string(), first_ticks_,
                               loaded.error().message),
                   FailureKind::kBadData};
  }
  return {};
}

Result<void, Failure> KeptStates::keep(animation::Animation& animation, std::uint64_t ticks, Nanoseconds log_time,
                                       MonoTime now) {
  if (log_time < next_) return {};
  next_ = log_time - log_time % kEvery + kEvery;
  const std::vector<std::uint8_t> state = save_snapshot(animation, made_of_, now);
  try {
    return platform::write_whole(folder_ / name_of(made_of_, {ticks, log_time}),
                                 {reinterpret_cast<const char*>(state.data()), state.size()});
  } catch (const FailureError& failure) {  // the folder has vanished
    return Failure{failure.what(), failure.kind()};
  }
}

}  // namespace yuragi::daemon::tools::offline
