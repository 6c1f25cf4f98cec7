#include <array>
#include <cstdio>
#include <functional>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "daemon/stream/tcp_stream.hpp"
#include "tests/engine/wire/samples.hpp"
#include "tests/support/places.hpp"

namespace yuragi::daemon::stream {
namespace {

namespace asio = boost::asio;
using namespace std::chrono_literals;

/// The example client of tests/e2e, an independent program, beside a server of meadows.
class PythonClient : public testing::Test {
 protected:
  static wire::Scenes meadow_of(std::size_t strands) { return {{{"meadow", "grass", samples::meadow(strands)}}}; }

  static TcpStreamSettings settings_of(wire::Scenes scenes) {
    TcpStreamSettings settings;
    settings.hello = {.software = "test", .tick_rate_hz = 60.0};
    settings.scenes = std::move(scenes);
    return settings;
  }

  /// Runs it until it ends; before each frame, of `strands(tick)` strands, `before_frame(stream, tick)`. Returns what
  /// it said.
  template <class Strands, class Before>
  static std::string run(const std::string& options, Strands strands, Before before_frame) {
    asio::io_context io{1};
    TcpStream stream(io, "127.0.0.1:0", settings_of(meadow_of(strands(0))));
    const std::string command = "/usr/bin/python3 " + test::source_path("tests/e2e/pose_client.py") +
                                " --check --json " + options + " --connect " + stream.local_endpoint() + " 2>&1";
    std::FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) throw std::runtime_error("no python3");

    // What the client says, until it ends.
    asio::posix::stream_descriptor output(io, dup(fileno(pipe)));
    std::string said;
    bool ended = false;
    std::array<char, 4096> chunk{};
    const std::function<void()> read = [&] {
      output.async_read_some(asio::buffer(chunk), [&](const auto& error, std::size_t count) {
        said.append(chunk.data(), count);
        ended = static_cast<bool>(error);
        if (!ended) read();
      });
    };
    read();

    // A frame every few milliseconds, for a minute at most.
    wire::FrameEncoder encoder;
    for (std::uint64_t tick = 1; tick < 12'000 && !ended; ++tick) {
      before_frame(stream, tick);
      const pose::Skeleton skeleton = samples::meadow(strands(tick));
      const pose::Pose pose = samples::bent(strands(tick), 0.01f * static_cast<float>(tick % 100));
      const std::vector<const pose::Skeleton*> skeletons{&skeleton};
      const std::vector<const pose::Pose*> poses{&pose};
      wire::FrameInfo info = samples::frame_info();
      info.sequence = info.tick = tick;
      info.time_s = static_cast<double>(tick) / 60.0;
      const auto bytes = encoder.encode(info, skeletons, poses);
      stream.publish(std::make_shared<const wire::Bytes>(bytes.begin(), bytes.end()));
      io.restart();
      io.run_for(5ms);
    }
    EXPECT_TRUE(ended) << said;
    EXPECT_EQ(pclose(pipe), 0) << said;
    EXPECT_THAT(said, testing::HasSubstr("\"problems\": []"));
    return said;
  }
};

TEST_F(PythonClient, ItFindsNothingWrongWithALiveStreamOfAHundredThousandNodes) {
  const std::string said = run(
      "--frames 60", [](std::uint64_t) { return std::size_t{10'000}; }, [](TcpStream&, std::uint64_t) {});
  EXPECT_THAT(said, testing::HasSubstr("\"frames\": 60,"));
  EXPECT_THAT(said, testing::HasSubstr("\"nodes\": 100000,"));
}

TEST_F(PythonClient, ItGetsAsMuchAsItAsksFor) {
  const auto strands = [](std::uint64_t) { return std::size_t{1'000}; };
  const std::string said = run("--frames 60 --scene meadow --every 10 --rate 100", strands, [](TcpStream&, auto) {});
  EXPECT_THAT(said, testing::HasSubstr("\"nodes\": 1000,")) << "of 10000";
}

/// The scenes change again and again, once every 50 frames: it is of another number of strands then.
TEST_F(PythonClient, ItTakesNewScenesOrConnectsAgain) {
  const auto strands = [](std::uint64_t tick) { return static_cast<std::size_t>(10 + tick / 50); };
  const auto change = [&](TcpStream& stream, std::uint64_t tick) {
    if (tick % 50 == 0)
      stream.publish_scenes(std::make_shared<const wire::Bytes>(wire::encode(meadow_of(strands(tick)))));
  };
  for (const char* options : {"--frames 120", "--frames 120 --old"}) {
    const std::string said = run(options, strands, change);
    const std::string key = "\"lists_of_scenes\": ";
    ASSERT_THAT(said, testing::HasSubstr(key));
    EXPECT_GE(std::stoi(said.substr(said.find(key) + key.size())), 3) << said;
  }
}

}  // namespace
}  // namespace yuragi::daemon::stream
