#include "viewer/film/film_stream.hpp"

#include <cerrno>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "viewer/picture/viewer_exit.hpp"

namespace yuragi::viewer::film {
namespace {

constexpr int kStopCheck_ms = 100;

std::string replay_program() {
  std::error_code error;
  const auto beside = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "yuragi";
  return !error && ::access(beside.c_str(), X_OK) == 0 ? beside.string() : "yuragi";
}

std::vector<std::string> replay_command(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {replay_program(), "replay"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  for (const char* word : {"--rate", "max", "--to-stdout"}) command.emplace_back(word);
  return command;
}

/// Exit codes of sysexits.h are passed on: 66 if the recording does not exist.
int exit_code_after(const platform::ChildEnd& end) {
  return end.exit_code >= EX__BASE && end.exit_code <= EX__MAX ? end.exit_code : EX_SOFTWARE;
}

}  // namespace

ReplayFilmStream::ReplayFilmStream(const std::vector<std::string>& arguments, const std::atomic<bool>& is_stopping) try
    : is_stopping_(is_stopping), replay_(replay_command(arguments), PipedChild::Pipe::kStandardOutput) {
} catch (const std::system_error& error) {
  throw picture::ViewerExit(
      EX_UNAVAILABLE,
      fmt::format("cannot start `yuragi replay`, which plays the recording: {}.\nThe program yuragi has to "
                  "stand beside yuragi-viewer, or in a folder of PATH.",
                  error.what()));
}

std::optional<wire::Message> ReplayFilmStream::next() {
  for (;;) {
    if (auto message = reader_.next()) {
      if (*message) return std::move(**message);
      if (message->error() == wire::Error::kUnknown) continue;  // of a newer version
      throw picture::ViewerExit(EX_SOFTWARE,
                                fmt::format("`yuragi replay` sent what is no message of a stream ({}): is it of "
                                            "another version than this program?",
                                            wire::name_of(message->error())));
    }
    if (!receive()) return std::nullopt;
  }
}

/// False at the end.
bool ReplayFilmStream::receive() {
  for (;;) {
    if (is_stopping_) return false;
    pollfd waiting{.fd = replay_.fd(), .events = POLLIN, .revents = 0};
    if (::poll(&waiting, 1, kStopCheck_ms) <= 0) continue;
    const ssize_t count = ::read(replay_.fd(), received_.data(), received_.size());
    if (count < 0 && errno == EINTR) continue;
    if (count > 0) {
      reader_.feed(std::span(received_).first(static_cast<std::size_t>(count)));
      return true;
    }
    const platform::ChildEnd end = replay_.wait();
    if (!end.is_good()) {
      throw picture::ViewerExit(exit_code_after(end), "`yuragi replay`, which plays the recording, " + text_of(end));
    }
    if (reader_.buffered_bytes() > 0)
      throw picture::ViewerExit(EX_SOFTWARE, "`yuragi replay` ended in the middle of a message");
    return false;
  }
}

}  // namespace yuragi::viewer::film
