#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "engine/wire/wire.hpp"

namespace yuragi::viewer {

/// Where a model stands, east and south of the origin.
struct TestPlace {
  double east_m = 0.0;
  double south_m = 0.0;
};

/// A small model of a kind that the viewer has a look for, to look at: "grass", "fur", "curtain", "flag", "banner",
/// "tree", "ripple", "flame" (a body) or "flame panel". Its name is its kind.
wire::SceneModel test_model(std::string_view kind, TestPlace place = {});

/// That model in a made-up wind toward the east: strength 0 is calm (the rest pose; a flame burns), 1 a storm.
pose::Pose test_pose(const wire::SceneModel& model, double time_s, double strength);

/// All of them side by side.
std::vector<wire::SceneModel> test_garden();

/// A server of models: greets with Hello and Scenes.
wire::Bytes greeting_for(const std::vector<wire::SceneModel>& models);

/// A frame of them in that wind, as bytes. One opacity a model.
wire::Bytes frame_of(const std::vector<wire::SceneModel>& models, std::span<const float> opacities, double time_s,
                     double strength, std::uint64_t sequence, wire::FrameEncoder& encoder);

}  // namespace yuragi::viewer
