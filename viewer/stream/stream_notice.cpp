#include "viewer/stream/stream_notice.hpp"

namespace yuragi::viewer::stream {
namespace {

constexpr const char* kAdvice =
    "\nStart `yuragi run` on this machine, or name another daemon with --connect HOST:PORT.";

}  // namespace

const std::string& Notice::advance(double now_s, Playback playback, const Status& status) {
  if (playback != Playback::kNothing) {
    text_.clear();
    since_s_.reset();
    return text_;
  }
  if (!since_s_ || status.text != status_text_) {
    since_s_ = now_s;
    status_text_ = status.text;
  }
  if (status.state == State::kWaiting) {
    text_ = status.text + kAdvice;
  } else if (now_s - *since_s_ >= kPatience_s) {
    // An attempt that follows a failure does not hide its reason.
    if (status.state == State::kConnected) {
      text_ = status.text + ", but no picture has come yet." + kAdvice;
    } else if (text_.empty()) {
      text_ = status.text + ": no reply yet." + kAdvice;
    }
  }
  return text_;
}

}  // namespace yuragi::viewer::stream
