// What a viewer draws of a stream that is hurt: bytes of its scenes and frames are replaced at random; what the decoder
// lets through is drawn. By hand, for as long as one likes:
//
//     yuragi replay gale.windlog --rate max --to-stdout --duration 0.5 --config garden.toml > garden.stream
//     hurt_stream garden.stream FIRST-SEED SEEDS
//
// It says each seed before it is tried, so that the last one said is the one that ended the program.
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>

#include "engine/wire/wire.hpp"
#include "viewer/gl/headless_context.hpp"
#include "viewer/gl/render_target.hpp"
#include "viewer/looks/stage.hpp"
#include "viewer/stream/lockstep_timeline.hpp"
#include "viewer/stream/scene_timeline.hpp"

namespace yuragi::viewer {
namespace {

constexpr int kWidth_px = 96;
constexpr int kHeight_px = 54;
constexpr double kTick_s = 1.0 / 60.0;

/// Each message of a file, without its size.
std::vector<wire::Bytes> messages_in(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const wire::Bytes bytes(text.begin(), text.end());
  std::vector<wire::Bytes> messages;
  std::span<const std::uint8_t> rest = bytes;
  while (rest.size() > wire::kSizePrefixBytes) {
    const auto size = wire::read_size_prefix(rest.first<wire::kSizePrefixBytes>(), wire::kMaxServerMessageBytes);
    rest = rest.subspan(wire::kSizePrefixBytes);
    if (!size || *size > rest.size()) break;
    messages.emplace_back(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(*size));
    rest = rest.subspan(*size);
  }
  return messages;
}

/// Another word in the place of this one, so that the verifier lets most of them through: another number for a number,
/// another count for a count, and now and then anything.
std::uint32_t hurt(std::uint32_t word, std::mt19937& random) {
  constexpr std::array<float, 10> kNumbers{0.0F, -0.0F, 1.0F, -1.0F, 1e-30F, 1e-3F, -1e-3F, 100.0F, 1e6F, -1e6F};
  constexpr std::uint32_t kMaxCount = 5000;
  if (random() % 50 == 0) return static_cast<std::uint32_t>(random());
  const float number = std::abs(std::bit_cast<float>(word));
  if (number > 1e-6F && number < 1e6F) return std::bit_cast<std::uint32_t>(kNumbers.at(random() % kNumbers.size()));
  return word <= kMaxCount ? static_cast<std::uint32_t>(random() % kMaxCount) >> random() % 12 : word;
}

wire::Bytes hurt(wire::Bytes bytes, std::mt19937& random) {
  const unsigned count = 1U << random() % 4;
  for (unsigned i = 0; i < count; ++i) {
    const std::size_t at = random() % (bytes.size() - 3) / 4 * 4;
    std::uint32_t word = 0;
    std::memcpy(&word, &bytes[at], sizeof word);
    word = hurt(word, random);
    std::memcpy(&bytes[at], &word, sizeof word);
  }
  return bytes;
}

struct Counts {
  int scenes = 0;
  int pictures = 0;
  int refused = 0;
};

class HurtViewer {
 public:
  void take(const wire::Bytes& bytes, Counts& counts) {
    auto message = wire::decode(bytes);
    if (!message) {
      ++counts.refused;
      return;
    }
    if (auto* scenes = std::get_if<wire::Scenes>(&*message)) {
      lockstep_.set_scenes(scenes->scenes);
      stage_.set_scenes(scenes->scenes);
      live_.set_scenes(std::move(*scenes));
      ++counts.scenes;
    } else if (auto* frame = std::get_if<wire::Frame>(&*message)) {
      wire::Frame other = *frame;
      if (lockstep_.accept(other)) {
        draw(lockstep_.at(lockstep_.newest_s() - 0.3 * kTick_s));
        ++counts.pictures;
      }
      now_s_ += kTick_s;
      live_.accept(*frame, now_s_);
      live_.advance(now_s_ + 0.3 * kTick_s);
      live_.take_new_scenes();
    } else if (auto* status = std::get_if<wire::Sensors>(&*message)) {
      stage_.set_light(light::light_of(status->look, 1e9));
    }
  }

 private:
  void draw(const stream::PoseMoment& moment) {
    meshes::OrbitCamera camera;
    camera.frame(stage_.home(static_cast<double>(kWidth_px) / kHeight_px));
    stage_.draw(moment, camera, target_);
  }

  const gl::HeadlessContext context_;
  looks::Stage stage_;
  gl::RenderTarget target_{kWidth_px, kHeight_px, 1};
  stream::LockstepTimeline lockstep_;
  stream::SceneTimeline live_;
  double now_s_ = 0.0;
};

void hurt_stream(const std::string& file, unsigned first_seed, unsigned seeds) {
  const std::vector<wire::Bytes> messages = messages_in(file);
  HurtViewer viewer;
  Counts counts;
  for (unsigned seed = first_seed; seed < first_seed + seeds; ++seed) {
    std::printf("seed %u\n", seed);
    std::fflush(stdout);
    std::mt19937 random(seed);
    int frames = 0;
    for (const wire::Bytes& message : messages) {
      const auto whole = wire::decode(message);
      const bool is_frame = whole && std::holds_alternative<wire::Frame>(*whole);
      if (is_frame && ++frames > 3) break;
      viewer.take(random() % 4 == 0 ? message : hurt(message, random), counts);
    }
  }
  std::printf("%d times scenes, %d pictures, %d messages refused\n", counts.scenes, counts.pictures, counts.refused);
}

}  // namespace
}  // namespace yuragi::viewer

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: hurt_stream FILE.stream FIRST-SEED SEEDS\n");
    return 64;
  }
  try {
    yuragi::viewer::hurt_stream(argv[1], static_cast<unsigned>(std::atoi(argv[2])),
                                static_cast<unsigned>(std::atoi(argv[3])));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hurt_stream: %s\n", error.what());
    return 1;
  }
}
