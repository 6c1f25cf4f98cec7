#include <array>
#include <cstdio>
#include <functional>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <gtest/gtest.h>
#include <unistd.h>

#include "daemon/stream/tcp_stream.hpp"
#include "tests/engine/wire/samples.hpp"
#include "tests/support/places.hpp"

namespace yuragi::daemon::stream {
namespace {

namespace asio = boost::asio;
using namespace std::chrono_literals;

// The example client of tests/e2e, an independent program, against the real server.
TEST(PythonClient, ItFindsNothingWrongWithALiveStreamOfAHundredThousandNodes) {
  constexpr std::size_t kStrands = 10'000;
  asio::io_context io{1};
  TcpStreamSettings settings;
  settings.hello = {.software = "test", .tick_rate_hz = 60.0};
  settings.scenes.scenes = {{"meadow", "grass", samples::meadow(kStrands)}};
  TcpStream stream(io, "127.0.0.1:0", settings);

  const std::string command = "/usr/bin/python3 " + test::source_path("tests/e2e/pose_client.py") +
                              " --frames 60 --check --json --connect " + stream.local_endpoint() + " 2>&1";
  std::FILE* pipe = popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);

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
  const pose::Skeleton& skeleton = settings.scenes.scenes[0].skeleton;
  const std::vector<const pose::Skeleton*> skeletons{&skeleton};
  wire::FrameEncoder encoder;
  for (std::uint64_t tick = 1; tick < 12'000 && !ended; ++tick) {
    const pose::Pose pose = samples::bent(kStrands, 0.01f * static_cast<float>(tick % 100));
    const std::vector<const pose::Pose*> poses{&pose};
    wire::FrameInfo info = samples::frame_info();
    info.sequence = info.tick = tick;
    info.time_s = static_cast<double>(tick) / 60.0;
    const auto bytes = encoder.encode(info, skeletons, poses);
    stream.publish(std::make_shared<const wire::Bytes>(bytes.begin(), bytes.end()));
    io.restart();
    io.run_for(5ms);
  }
  ASSERT_TRUE(ended) << said;
  EXPECT_EQ(pclose(pipe), 0) << said;
  EXPECT_NE(said.find("\"frames\": 60,"), std::string::npos) << said;
  EXPECT_NE(said.find("\"nodes\": 100000,"), std::string::npos) << said;
  EXPECT_NE(said.find("\"problems\": []"), std::string::npos) << said;
}

}  // namespace
}  // namespace yuragi::daemon::stream
