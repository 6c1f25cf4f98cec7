#include "viewer/stream/stream_notice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace yuragi::viewer::stream {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

const Status kConnecting{.state = State::kConnecting, .text = "connecting to 127.0.0.1:7410"};
const Status kConnected{.state = State::kConnected, .text = "connected to 127.0.0.1:7410"};
const Status kRefused{.state = State::kWaiting, .text = "no daemon replies at 127.0.0.1:7410: Connection refused"};

TEST(StreamNotice, AFailureIsShownAtOnceWithWhatToDo) {
  Notice notice;
  EXPECT_THAT(notice.advance(10.0, Playback::kNothing, kConnecting), IsEmpty());
  EXPECT_EQ(notice.advance(10.1, Playback::kNothing, kRefused),
            "no daemon replies at 127.0.0.1:7410: Connection refused\n"
            "Start `yuragi run` on this machine, or name another daemon with --connect HOST:PORT.");
}

TEST(StreamNotice, AFailureStaysWhileItIsTriedAgain) {
  Notice notice;
  notice.advance(10.0, Playback::kNothing, kRefused);
  for (const double now_s : {10.2, 11.3, 15.0}) {
    EXPECT_THAT(notice.advance(now_s, Playback::kNothing, kConnecting), HasSubstr("Connection refused")) << now_s;
  }
  EXPECT_THAT(notice.advance(16.0, Playback::kNothing, kConnected), HasSubstr("Connection refused"));
  EXPECT_THAT(notice.advance(17.0, Playback::kNothing, kConnected), HasSubstr("connected to 127.0.0.1:7410, but no"));
}

TEST(StreamNotice, AnAttemptThatTakesLongIsShownWithinTwoSeconds) {
  for (const Status& status : {kConnecting, kConnected}) {
    Notice notice;
    EXPECT_THAT(notice.advance(10.0, Playback::kNothing, status), IsEmpty());
    EXPECT_THAT(notice.advance(10.9, Playback::kNothing, status), IsEmpty()) << "most daemons answer sooner";
    EXPECT_THAT(notice.advance(11.9, Playback::kNothing, status),
                AllOf(HasSubstr(status.text), HasSubstr("yuragi run"), HasSubstr("--connect")));
  }
}

TEST(StreamNotice, GoesWhenFramesComeAndDoesNotReturnWhenTheyStop) {
  Notice notice;
  notice.advance(10.0, Playback::kNothing, kRefused);
  EXPECT_THAT(notice.advance(11.0, Playback::kLive, kConnected), IsEmpty());
  for (const Playback playback : {Playback::kReplaying, Playback::kReturning}) {
    EXPECT_THAT(notice.advance(90.0, playback, kRefused), IsEmpty());
  }
}

TEST(StreamNotice, ScenesThatReplaceOthersHaveTheirTimeToCome) {
  Notice notice;
  notice.advance(10.0, Playback::kNothing, kConnected);
  notice.advance(11.0, Playback::kLive, kConnected);
  EXPECT_THAT(notice.advance(20.0, Playback::kNothing, kConnected), IsEmpty());
}

}  // namespace
}  // namespace yuragi::viewer::stream
