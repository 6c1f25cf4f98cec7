// A client that was built when the stream was young, and what it makes of the stream of today: fields are only added,
// so it goes on working. And the other way round: what a server said then is understood today.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <protocol1_generated.h>

#include "engine/pose/kinematics.hpp"
#include "engine/pose/pose_hash.hpp"
#include "engine/wire/message_reader.hpp"
#include "engine/wire/thinner.hpp"
#include "engine/wire/wire.hpp"
#include "tests/engine/wire/samples.hpp"
#include "tests/support/places.hpp"

namespace yuragi::wire {
namespace {

namespace p1 = yuragi::protocol1;
using Point = std::array<float, 3>;

/// A client of the first protocol. It knows protocol1.fbs and nothing else of this project.
class FirstClient {
 public:
  /// Takes whole messages, one after the other.
  void take(std::span<const std::uint8_t> stream) {
    while (!stream.empty()) {
      std::uint32_t size = 0;
      std::memcpy(&size, stream.data(), sizeof size);
      const auto message = stream.subspan(0, sizeof size + size);
      flatbuffers::Verifier verifier(message.data(), message.size());
      if (!p1::VerifySizePrefixedMessageBuffer(verifier)) throw std::runtime_error("not a message");
      take(*p1::GetSizePrefixedMessage(message.data()));
      stream = stream.subspan(message.size());
    }
  }

  const std::vector<p1::Body>& bodies() const { return bodies_; }
  const std::vector<std::string>& names() const { return names_; }
  double wind_u_m_s() const { return wind_u_m_s_; }
  double speed_m_s() const { return speed_m_s_; }

  /// Of the last frame, scene by scene: the joints of a cloth or the points of a surface; of strands and trees the
  /// bends (east, south, 0).
  const std::vector<std::vector<Point>>& shown() const { return shown_; }
  /// The colours of the points of each scene.
  const std::vector<std::vector<std::uint8_t>>& heat() const { return heat_; }

 private:
  void take(const p1::Message& message) {
    bodies_.push_back(message.body_type());
    if (const auto* scenes = message.body_as_Scenes()) {
      names_.clear();
      rest_.clear();
      for (const auto* scene : *scenes->scenes()) {
        names_.push_back(scene->name()->str());
        rest_.push_back(rest_of(*scene));
      }
    } else if (const auto* frame = message.body_as_Frame()) {
      wind_u_m_s_ = static_cast<double>(frame->wind()->u_m_s());
      shown_.clear();
      heat_.clear();
      for (flatbuffers::uoffset_t i = 0; i < frame->scenes()->size(); ++i) show(rest_[i], *frame->scenes()->Get(i));
    } else if (const auto* sensors = message.body_as_Sensors()) {
      speed_m_s_ = sensors->sensors()->Get(0)->speed_m_s().value_or(-1.0);
    }
  }

  struct Rest {
    std::vector<Point> place_m, normal;
  };

  static Rest rest_of(const p1::Scene& scene) {
    Rest rest;
    if (const auto* cloth = scene.skeleton_as_GridSkeleton()) {
      for (flatbuffers::uoffset_t i = 0; i < cloth->columns() * cloth->rows(); ++i) {
        rest.place_m.push_back({cloth->rest_x_m()->Get(i), cloth->rest_y_m()->Get(i), cloth->rest_z_m()->Get(i)});
      }
    } else if (const auto* surface = scene.skeleton_as_SurfaceSkeleton()) {
      for (flatbuffers::uoffset_t i = 0; i < surface->columns() * surface->rows(); ++i) {
        rest.place_m.push_back({surface->rest_x_m()->Get(i), surface->rest_y_m()->Get(i), surface->rest_z_m()->Get(i)});
        rest.normal.push_back({surface->normal_x()->Get(i), surface->normal_y()->Get(i), surface->normal_z()->Get(i)});
      }
    }
    return rest;
  }

  static void add_bends(const p1::StrandPose& strands, std::vector<Point>& to) {
    const float step_rad = strands.bend_step_rad();
    for (flatbuffers::uoffset_t i = 0; i < strands.bend_east()->size(); ++i) {
      to.push_back({step_rad * static_cast<float>(strands.bend_east()->Get(i)),
                    step_rad * static_cast<float>(strands.bend_south()->Get(i)), 0.0F});
    }
  }

  void show(const Rest& rest, const p1::ScenePose& scene) {
    std::vector<Point>& points = shown_.emplace_back();
    std::vector<std::uint8_t>& heat = heat_.emplace_back();
    if (const auto* strands = scene.pose_as_StrandPose()) {
      add_bends(*strands, points);
    } else if (const auto* tree = scene.pose_as_TreePose()) {
      for (const auto* level : *tree->levels()) add_bends(*level, points);
    } else if (const auto* cloth = scene.pose_as_GridPose()) {
      const std::array axes = {cloth->offset_x(), cloth->offset_y(), cloth->offset_z()};
      for (std::size_t i = 0; i < rest.place_m.size(); ++i) {
        Point& point = points.emplace_back(rest.place_m.at(i));
        for (std::size_t axis = 0; axis < 3; ++axis) {
          point[axis] += cloth->step_m() * static_cast<float>(axes[axis]->Get(static_cast<flatbuffers::uoffset_t>(i)));
        }
      }
    } else if (const auto* surface = scene.pose_as_SurfacePose()) {
      for (std::size_t i = 0; i < rest.place_m.size(); ++i) {
        const auto units = surface->displacement()->Get(static_cast<flatbuffers::uoffset_t>(i));
        Point& point = points.emplace_back(rest.place_m.at(i));
        for (std::size_t axis = 0; axis < 3; ++axis) {
          point[axis] += surface->step_m() * static_cast<float>(units) * rest.normal.at(i)[axis];
        }
      }
      if (surface->heat() != nullptr) heat.assign(surface->heat()->begin(), surface->heat()->end());
    }
  }

  std::vector<p1::Body> bodies_;
  std::vector<std::string> names_;
  std::vector<Rest> rest_;
  std::vector<std::vector<Point>> shown_;
  std::vector<std::vector<std::uint8_t>> heat_;
  double wind_u_m_s_ = 0.0;
  double speed_m_s_ = 0.0;
};

/// hello, scenes of all kinds and a frame of them, sensors, a reply and a raw message, as a server said them when
/// protocol1.fbs was the whole schema.
Bytes first_stream() {
  std::ifstream file(test::source_path("tests/engine/wire/protocol1.stream"), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The same messages as they are encoded today.
Bytes stream_of_today() {
  Bytes stream;
  for (const Bytes& message :
       {encode(samples::hello()), encode(samples::all_kinds()), samples::frame_of_all_kinds(),
        encode(samples::sensors()), encode(samples::control_reply()), encode(samples::raw_trace())}) {
    stream.insert(stream.end(), message.begin(), message.end());
  }
  return stream;
}

/// What our own decoder and kinematics make of a stream: its scenes and its last frame.
struct Understood {
  explicit Understood(const Bytes& stream) {
    MessageReader reader;
    reader.feed(stream);
    while (auto message = reader.next()) {
      if (const auto* some = std::get_if<Scenes>(&message->value())) scenes = *some;
      if (const auto* one = std::get_if<Frame>(&message->value())) frame = *one;
      ++messages;
    }
  }
  Scenes scenes;
  Frame frame;
  int messages = 0;
};

void expect_that_it_goes_on_working(const Bytes& stream) {
  FirstClient client;
  ASSERT_NO_THROW(client.take(stream));
  EXPECT_EQ(client.bodies(), (std::vector{p1::Body_Hello, p1::Body_Scenes, p1::Body_Frame, p1::Body_Sensors,
                                          p1::Body_ControlReply, p1::Body_RawTrace}));
  EXPECT_EQ(client.names(), (std::vector<std::string>{"meadow", "window", "elm", "pond", "fire"}));
  EXPECT_EQ(client.wind_u_m_s(), 3.25);
  EXPECT_EQ(client.speed_m_s(), samples::sensors().sensors[0].speed_m_s);

  // Every number that it finds is the one that is meant: strands, and trees level by level; cloth; surfaces, which
  // stand where their rows would stand at rest.
  const Understood now(stream);
  ASSERT_TRUE(fits(now.frame, now.scenes));
  const auto& meadow = std::get<pose::StrandPose>(now.frame.poses[0]);
  ASSERT_EQ(client.shown()[0].size(), 37U);
  for (std::size_t i = 0; i < 37; ++i) {
    EXPECT_EQ(client.shown()[0][i], (Point{meadow.bend_east_rad[i], meadow.bend_south_rad[i], 0.0F}));
  }
  std::size_t bends = 0;
  for (const pose::TreeLevel& level : std::get<pose::TreeSkeleton>(now.scenes.scenes[2].skeleton).levels) {
    bends += level.strands.strand_count;
  }
  EXPECT_EQ(client.shown()[2].size(), bends);
  for (const std::size_t scene : {1U, 3U, 4U}) {
    const pose::Skeleton& skeleton = now.scenes.scenes[scene].skeleton;
    pose::Pose pose = now.frame.poses[scene];
    if (auto* surface = std::get_if<pose::SurfacePose>(&pose)) {
      for (auto* rows : {&surface->row_east_m, &surface->row_south_m, &surface->row_drop_m, &surface->row_slope_east,
                         &surface->row_slope_south}) {
        std::fill(rows->begin(), rows->end(), 0.0F);
      }
    }
    pose::Kinematics kinematics(skeleton);
    ASSERT_TRUE(kinematics.run(pose));
    ASSERT_EQ(client.shown()[scene].size(), pose::node_count(skeleton)) << scene;
    for (std::size_t i = 0; i < client.shown()[scene].size(); ++i) {
      const pose::JointPosition joint = kinematics.joint(i);
      EXPECT_NEAR(client.shown()[scene][i][0], joint.x_m, 1e-5F);
      EXPECT_NEAR(client.shown()[scene][i][1], joint.y_m, 1e-5F);
      EXPECT_NEAR(client.shown()[scene][i][2], joint.z_m, 1e-5F);
    }
  }
  EXPECT_TRUE(client.heat()[3].empty());
  ASSERT_EQ(client.heat()[4].size(), client.shown()[4].size());
  EXPECT_GT(*std::max_element(client.heat()[4].begin(), client.heat()[4].end()), 200);
}

TEST(Protocol1, ItsClientReadsItsStream) {
  expect_that_it_goes_on_working(first_stream());
}

TEST(Protocol1, ItsClientReadsTheStreamOfToday) {
  expect_that_it_goes_on_working(stream_of_today());
  EXPECT_EQ(kProtocol, 1U) << "another protocol needs another client";
}

TEST(Protocol1, ItsStreamIsUnderstoodTodayAsItWasThen) {
  const Understood then(first_stream());
  EXPECT_EQ(then.messages, 6);
  ASSERT_TRUE(fits(then.frame, then.scenes));
  std::uint64_t hash = pose::kPoseHashSeed;
  for (std::size_t i = 0; i < then.scenes.scenes.size(); ++i) {
    pose::Kinematics kinematics(then.scenes.scenes[i].skeleton);
    ASSERT_TRUE(kinematics.run(then.frame.poses[i]));
    hash = kinematics.hash(pose::pose_hash(hash, then.frame.poses[i]));
  }
  EXPECT_EQ(hash, 0x3fc317f37de23c3aU);  // written by the decoder and the kinematics of then
}

TEST(Protocol1, WhatItsServerDoesNotTellIsNotKnownToday) {
  MessageReader reader;
  reader.feed(first_stream());
  Sensors sensors = samples::sensors();
  while (auto message = reader.next()) {
    if (const auto* some = std::get_if<Sensors>(&message->value())) sensors = *some;
  }
  EXPECT_FALSE(sensors.io_lateness || sensors.tick_lateness || sensors.recorder || sensors.animation);
  EXPECT_EQ(sensors.refused_clients + sensors.stuck_clients + sensors.idle_clients, 0U);
}

TEST(Protocol1, ItsClientsRequestsAreUnderstoodToday) {
  flatbuffers::FlatBufferBuilder builder;
  const auto name = builder.CreateString("a wall");
  const auto request = p1::CreateSubscribe(builder, 1, true, false, name);
  builder.FinishSizePrefixed(p1::CreateMessage(builder, p1::Body_Subscribe, request.Union()), p1::MessageIdentifier());
  const Bytes bytes(builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize());
  const auto subscribe = std::get<Subscribe>(decode(samples::body(bytes)).value());
  EXPECT_TRUE(subscribe.poses);
  EXPECT_EQ(subscribe.client, "a wall");
  EXPECT_FALSE(subscribe.takes_new_scenes) << "it would take other scenes for a mistake";
  EXPECT_TRUE(subscribe.thinning.is_all()) << "it would not know that there is more";
  EXPECT_EQ(subscribe.rate_hz, 0.0);
  EXPECT_FALSE(subscribe.wind);
}

/// It sends only Hello, Sensors and replies to a client without poses.
TEST(Protocol1, ItsServerUnderstandsOneWhoWantsTheWindAlone) {
  const Bytes bytes = encode(Subscribe{.poses = false, .client = "a lamp", .wind = true});
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  ASSERT_TRUE(p1::VerifySizePrefixedMessageBuffer(verifier));
  const auto* subscribe = p1::GetSizePrefixedMessage(bytes.data())->body_as_Subscribe();
  ASSERT_NE(subscribe, nullptr);
  EXPECT_FALSE(subscribe->poses());
  EXPECT_EQ(subscribe->client()->str(), "a lamp");
}

TEST(Protocol1, ItsClientReadsAFrameOfTheWindAlone) {
  FirstClient client;
  client.take(Thinner(Scenes{}, {.is_wind_alone = true}).frame(samples::frame_of_all_kinds()));
  EXPECT_EQ(client.bodies(), (std::vector{p1::Body_Frame}));
  EXPECT_NEAR(client.wind_u_m_s(), samples::frame_info().wind.wind.u_m_s, 1e-6);
  EXPECT_TRUE(client.shown().empty());
}

TEST(Protocol1, ItsServerUnderstandsOneWhoWantsLessAndSendsEverything) {
  const Bytes bytes = encode(Subscribe{
      .sensors = true, .client = "a phone", .thinning = {.scenes = {"elm", "pond"}, .every = 8}, .rate_hz = 12.5});
  flatbuffers::Verifier verifier(bytes.data(), bytes.size());
  ASSERT_TRUE(p1::VerifySizePrefixedMessageBuffer(verifier));
  const auto* subscribe = p1::GetSizePrefixedMessage(bytes.data())->body_as_Subscribe();
  ASSERT_NE(subscribe, nullptr);
  EXPECT_EQ(subscribe->protocol(), 1u);
  EXPECT_TRUE(subscribe->poses());
  EXPECT_TRUE(subscribe->sensors());
  EXPECT_EQ(subscribe->client()->str(), "a phone");
}

TEST(Protocol1, ItsClientReadsWhatIsThinnedOut) {
  const Thinner thinner(samples::all_kinds(), {.scenes = {"window", "pond"}, .every = 2});
  FirstClient client;
  client.take(encode(thinner.scenes()));
  client.take(thinner.frame(samples::frame_of_all_kinds()));
  EXPECT_EQ(client.names(), (std::vector<std::string>{"window", "pond"}));
  ASSERT_EQ(client.shown().size(), 2u);
  EXPECT_EQ(client.shown()[0].size(), 11u * 5u);  // of 21 x 9
  EXPECT_EQ(client.shown()[1].size(), 8u * 4u);   // of 15 x 7
}

}  // namespace
}  // namespace yuragi::wire
