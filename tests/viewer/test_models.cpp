#include "tests/viewer/test_models.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "engine/base/units.hpp"
#include "engine/math/philox.hpp"
#include "engine/pose/pose_arrays.hpp"
#include "tests/viewer/test_meadow.hpp"

namespace yuragi::viewer {
namespace {

using Point = std::array<double, 3>;

pose::GridSkeleton cloth_of(std::size_t columns, std::size_t rows, bool is_pole_fixed, TestPlace place,
                            const std::function<Point(double, double)>& at) {
  pose::GridSkeleton cloth;
  cloth.columns = columns;
  cloth.rows = rows;
  cloth.is_first_column_fixed = is_pole_fixed;
  const std::size_t size = rows * cloth.stride();
  cloth.rest_x_m.resize(size);
  cloth.rest_y_m.resize(size);
  cloth.rest_z_m.resize(size);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const Point p = at(static_cast<double>(column) / static_cast<double>(columns - 1),
                         static_cast<double>(row) / static_cast<double>(rows - 1));
      const std::size_t i = row * cloth.stride() + column;
      cloth.rest_x_m[i] = static_cast<float>(p[0] + place.east_m);
      cloth.rest_y_m[i] = static_cast<float>(p[1]);
      cloth.rest_z_m[i] = static_cast<float>(p[2] + place.south_m);
    }
  }
  return cloth;
}

/// Gathered folds, as deep at the hem as they are many at the rod.
pose::GridSkeleton curtain(TestPlace place) {
  return cloth_of(120, 90, false, place, [](double across, double down) {
    return Point{
        2.4 * (across - 0.5), 2.5 - 2.3 * down,
        0.055 * std::sin(2 * kPi * 14 * across) * (0.45 + 0.55 * down) + 0.02 * std::sin(2 * kPi * 5 * across + 1.0)};
  });
}
pose::GridSkeleton flag(TestPlace place) {
  return cloth_of(70, 110, false, place, [](double down, double out) {
    return Point{1.8 * out, 4.0 - 1.2 * down, 0.0};
  });
}
pose::GridSkeleton banner(TestPlace place) {
  return cloth_of(40, 150, true, place, [](double across, double down) {
    return Point{0.7 * across, 4.6 - 3.6 * down, 0.0};
  });
}

pose::SurfaceSkeleton surface_of(std::size_t columns, std::size_t rows, TestPlace place,
                                 const std::function<std::array<Point, 2>(double, double)>& at) {
  pose::SurfaceSkeleton surface;
  surface.columns = columns;
  surface.rows = rows;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const auto [p, n] = at(static_cast<double>(column), static_cast<double>(row) / static_cast<double>(rows - 1));
      surface.rest_x_m.push_back(static_cast<float>(p[0] + place.east_m));
      surface.rest_y_m.push_back(static_cast<float>(p[1]));
      surface.rest_z_m.push_back(static_cast<float>(p[2] + place.south_m));
      surface.normal_x.push_back(static_cast<float>(n[0]));
      surface.normal_y.push_back(static_cast<float>(n[1]));
      surface.normal_z.push_back(static_cast<float>(n[2]));
    }
  }
  return surface;
}

pose::SurfaceSkeleton water(TestPlace place) {
  constexpr std::size_t kColumns = 120;
  return surface_of(kColumns, 120, place, [](double column, double down) {
    return std::array{Point{5.0 * (column / (kColumns - 1) - 0.5), 0.0, 5.0 * (down - 0.5)}, Point{0.0, 1.0, 0.0}};
  });
}

/// Black and clear, red, orange, yellow, white.
std::vector<std::uint8_t> fire_ramp() {
  std::vector<std::uint8_t> ramp;
  for (int i = 0; i < 256; ++i) {
    const double heat = i / 255.0;
    for (const double value : {heat / 0.35, (heat - 0.25) / 0.5, (heat - 0.7) / 0.3, (heat - 0.05) / 0.3}) {
      ramp.push_back(static_cast<std::uint8_t>(255.0 * std::clamp(value, 0.0, 1.0)));
    }
  }
  return ramp;
}

pose::SurfaceSkeleton flame_body(TestPlace place) {
  constexpr std::size_t kAround = 24;  // two shells
  pose::SurfaceSkeleton flame = surface_of(2 * kAround, 64, place, [](double column, double up) {
    const double angle = 2 * kPi * column / kAround;
    const double radius_m = (column < kAround ? 0.22 : 0.12) * std::sqrt(std::max(0.0, 1.0 - up)) * (0.75 + 0.9 * up);
    return std::array{Point{radius_m * std::cos(angle), 0.5 + 1.2 * up, radius_m * std::sin(angle)},
                      Point{std::cos(angle), 0.0, std::sin(angle)}};
  });
  flame.is_closed = true;
  flame.shells = 2;
  flame.axis_x_m.assign(64, static_cast<float>(place.east_m));
  flame.axis_z_m.assign(64, static_cast<float>(place.south_m));
  flame.ramp_rgba = fire_ramp();
  return flame;
}
pose::SurfaceSkeleton flame_panel(TestPlace place) {
  constexpr std::size_t kColumns = 64;
  pose::SurfaceSkeleton flame = surface_of(kColumns, 96, place, [](double column, double up) {
    return std::array{Point{0.9 * (column / (kColumns - 1) - 0.5), 0.5 + 1.35 * up, 0.0}, Point{0.0, 0.0, 1.0}};
  });
  flame.ramp_rgba = fire_ramp();
  return flame;
}

/// Hairs on a lying egg, combed to the east and down.
pose::StrandSkeleton fur(TestPlace place) {
  constexpr std::size_t kHairs = 12'000;
  constexpr std::size_t kLinks = 8;
  pose::StrandSkeleton coat;
  coat.strand_count = kHairs;
  coat.links_per_strand = kLinks;
  const math::RandomStream chance(2, math::stream_id("test fur"));
  const Point radius_m{0.62, 0.40, 0.40};
  for (std::size_t i = 0; i < coat.padded_count(); ++i) {
    const auto [jitter, longer] = chance.uniform_pair(i);
    const double height = 1.0 - 1.75 * (static_cast<double>(i) + 0.5) / kHairs;
    const double around = static_cast<double>(i) * 2.399963 + 0.02 * jitter;
    const double ring = std::sqrt(std::max(0.0, 1.0 - height * height));
    const Point unit{ring * std::cos(around), height, ring * std::sin(around)};
    Point out{unit[0] / radius_m[0], unit[1] / radius_m[1], unit[2] / radius_m[2]};
    const double out_length = std::hypot(out[0], out[1], out[2]);
    Point rest{out[0] / out_length + 1.0, out[1] / out_length - 0.25, out[2] / out_length};
    const double rest_length = std::hypot(rest[0], rest[1], rest[2]);
    for (double& axis : rest) axis /= rest_length;
    const double level = std::hypot(rest[0], rest[2]);
    coat.root_x_m.push_back(static_cast<float>(radius_m[0] * unit[0] + place.east_m));
    coat.root_y_m.push_back(static_cast<float>(0.36 + radius_m[1] * unit[1]));
    coat.root_z_m.push_back(static_cast<float>(radius_m[2] * unit[2] + place.south_m));
    coat.rest_x.push_back(static_cast<float>(rest[0]));
    coat.rest_y.push_back(static_cast<float>(rest[1]));
    coat.rest_z.push_back(static_cast<float>(rest[2]));
    coat.curl_x.push_back(static_cast<float>(rest[0] * rest[1] / level));
    coat.curl_y.push_back(static_cast<float>(-level));
    coat.curl_z.push_back(static_cast<float>(rest[2] * rest[1] / level));
    coat.rest_curl_rad.push_back(0.06F);
    coat.link_length_m.push_back(static_cast<float>((0.055 + 0.045 * longer) / kLinks));
  }
  return coat;
}

/// Strands of a level to be, one by one.
struct Growing {
  pose::TreeLevel level;

  Growing(std::size_t links, std::size_t parent_level, bool is_leaves) {
    level.strands.links_per_strand = links;
    level.parent_level = parent_level;
    level.is_leaves = level.is_turned_by_block = is_leaves;
  }

  void add(const Point& root, const Point& rest, double length_m, double curl_rad, double base_m, double tip_m,
           std::size_t parent, std::size_t parent_link) {
    pose::StrandSkeleton& s = level.strands;
    const double norm = std::hypot(rest[0], rest[1], rest[2]);
    const Point unit{rest[0] / norm, rest[1] / norm, rest[2] / norm};
    const double flat = std::max(1e-3, std::hypot(unit[0], unit[2]));
    const Point curl{-unit[0] * unit[1] / flat, flat, -unit[2] * unit[1] / flat};
    const double curl_norm = std::hypot(curl[0], curl[1], curl[2]);
    const auto push = [](std::vector<float>& to, double value) { to.push_back(static_cast<float>(value)); };
    push(s.root_x_m, root[0]);
    push(s.root_y_m, root[1]);
    push(s.root_z_m, root[2]);
    push(s.rest_x, unit[0]);
    push(s.rest_y, unit[1]);
    push(s.rest_z, unit[2]);
    push(s.curl_x, curl[0] / curl_norm);
    push(s.curl_y, curl[1] / curl_norm);
    push(s.curl_z, curl[2] / curl_norm);
    push(s.rest_curl_rad, curl_rad / static_cast<double>(s.links_per_strand));
    push(s.link_length_m, length_m / static_cast<double>(s.links_per_strand));
    push(level.base_radius_m, base_m);
    push(level.tip_radius_m, tip_m);
    level.parent.push_back(static_cast<std::uint32_t>(parent));
    level.parent_link.push_back(static_cast<std::uint32_t>(parent_link));
    s.strand_count = s.root_x_m.size();
  }

  /// Whole blocks: the last strand again and again.
  pose::TreeLevel finished() {
    pose::StrandSkeleton& s = level.strands;
    for (std::vector<float>* values :
         {&s.root_x_m, &s.root_y_m, &s.root_z_m, &s.rest_x, &s.rest_y, &s.rest_z, &s.curl_x, &s.curl_y, &s.curl_z,
          &s.rest_curl_rad, &s.link_length_m, &level.base_radius_m, &level.tip_radius_m}) {
      values->resize(s.padded_count(), values->back());
    }
    level.parent.resize(s.padded_count(), level.parent.back());
    level.parent_link.resize(s.padded_count(), level.parent_link.back());
    return level;
  }
};

/// Where the joint behind a link is at rest, on the arc of the strand.
Point joint_of(const pose::StrandSkeleton& s, std::size_t strand, std::size_t link) {
  Point at{static_cast<double>(s.root_x_m[strand]), static_cast<double>(s.root_y_m[strand]),
           static_cast<double>(s.root_z_m[strand])};
  for (std::size_t i = 0; i <= link; ++i) {
    const double angle = static_cast<double>(s.rest_curl_rad[strand]) * static_cast<double>(i);
    const auto length = static_cast<double>(s.link_length_m[strand]);
    at[0] += length * (std::cos(angle) * static_cast<double>(s.rest_x[strand]) +
                       std::sin(angle) * static_cast<double>(s.curl_x[strand]));
    at[1] += length * (std::cos(angle) * static_cast<double>(s.rest_y[strand]) +
                       std::sin(angle) * static_cast<double>(s.curl_y[strand]));
    at[2] += length * (std::cos(angle) * static_cast<double>(s.rest_z[strand]) +
                       std::sin(angle) * static_cast<double>(s.curl_z[strand]));
  }
  return at;
}

/// A trunk, 14 limbs, 12 twigs on each, and 16 leaves at each of four places of a twig.
pose::TreeSkeleton tree(TestPlace place) {
  constexpr double kGolden = 2.399963;
  const math::RandomStream chance(3, math::stream_id("test tree"));
  std::uint64_t drawn = 0;
  const auto between = [&](double low, double high) { return low + (high - low) * chance.uniform(drawn++); };
  Growing trunk(24, 0, false);
  Growing limbs(20, 0, false);
  Growing twigs(12, 1, false);
  Growing leaves(4, 2, true);
  trunk.add({place.east_m, 0.0, place.south_m}, {0.04, 1.0, 0.02}, 4.6, 0.05, 0.17, 0.02, 0, 0);
  for (std::size_t limb = 0; limb < 14; ++limb) {
    const std::size_t link = 7 + limb * 16 / 14;
    const double share = static_cast<double>(link) / 24.0;
    const double bearing = kGolden * static_cast<double>(limb);
    const double length_m = (2.9 - 1.9 * share) * between(0.9, 1.15);
    limbs.add(joint_of(trunk.level.strands, 0, link), {std::cos(bearing), 0.35 + 0.8 * share, std::sin(bearing)},
              length_m, 0.45, 0.022 + 0.04 * (1.0 - share), 0.006, 0, link);
    for (std::size_t twig = 0; twig < 12; ++twig) {
      const std::size_t twig_link = 4 + twig * 15 / 12;
      const double side = bearing + (twig % 2 == 0 ? 0.9 : -0.9) + between(-0.4, 0.4);
      twigs.add(joint_of(limbs.level.strands, limb, twig_link), {std::cos(side), between(0.0, 1.0), std::sin(side)},
                between(0.5, 0.95), 0.3, 0.007, 0.002, limb, twig_link);
      for (const std::size_t spray : {5U, 7U, 9U, 11U}) {
        const std::size_t index = twigs.level.strands.strand_count - 1;
        const Point root = joint_of(twigs.level.strands, index, spray);
        for (int leaf = 0; leaf < 16; ++leaf) {
          const double to = between(0.0, 2 * kPi);
          leaves.add(root, {std::cos(to), between(-0.8, 0.9), std::sin(to)}, between(0.10, 0.17), -0.6, 0.026, 0.0,
                     index, spray);
        }
      }
    }
  }
  pose::TreeSkeleton grown;
  grown.levels = {trunk.finished(), limbs.finished(), twigs.finished(), leaves.finished()};
  grown.levels[0].parent.clear();
  grown.levels[0].parent_link.clear();
  return grown;
}

pose::Skeleton skeleton_of(std::string_view kind, TestPlace place) {
  if (kind == "grass") {
    pose::Skeleton meadow = test_meadow(60, 6.0);
    auto& strands = std::get<pose::StrandSkeleton>(meadow);
    for (float& x_m : strands.root_x_m) x_m += static_cast<float>(place.east_m);
    for (float& z_m : strands.root_z_m) z_m += static_cast<float>(place.south_m);
    return meadow;
  }
  if (kind == "fur") return fur(place);
  if (kind == "curtain") return curtain(place);
  if (kind == "flag") return flag(place);
  if (kind == "banner") return banner(place);
  if (kind == "tree") return tree(place);
  if (kind == "ripple") return water(place);
  return kind == "flame" ? flame_body(place) : flame_panel(place);
}

/// A wave runs from the fixed edge to the free one, and grows; the joints go with their links.
pose::GridPose wave(const pose::GridSkeleton& cloth, double time_s, double strength) {
  pose::GridPose pose = std::get<pose::GridPose>(pose::rest_pose(cloth));
  const bool is_flag = cloth.rest_y_m[cloth.columns - 1] < cloth.rest_y_m[0];
  for (std::size_t row = 1; row < cloth.rows; ++row) {
    const double share = static_cast<double>(row) / static_cast<double>(cloth.rows - 1);
    for (std::size_t column = cloth.is_first_column_fixed ? 1 : 0; column < cloth.columns; ++column) {
      const double across = static_cast<double>(column) / static_cast<double>(cloth.columns - 1);
      const double pinned = cloth.is_first_column_fixed ? across : 1.0;
      const double phase = (is_flag ? 13.0 : 5.0) * share - 7.0 * time_s + 1.8 * across;
      const double swing = (is_flag ? 0.22 : 0.34) * strength * share * std::sin(phase) * pinned;
      const double lean = (is_flag || cloth.is_first_column_fixed ? 0.0 : 0.75) * strength * share * share;
      const std::size_t i = row * cloth.stride() + column;
      pose.offset_z_m[i] = static_cast<float>(swing + lean);
      pose.offset_y_m[i] = static_cast<float>(0.3 * lean * lean * 1.6 - (is_flag ? 0.12 * strength * share : 0.0));
      pose.offset_x_m[i] = static_cast<float>(is_flag ? -0.16 * strength * share : 0.12 * swing);
    }
  }
  return pose;
}

/// Each generation sways more than that before it, leaves quickly.
pose::TreePose sway(const pose::TreeSkeleton& tree, double time_s, double strength) {
  pose::TreePose pose = std::get<pose::TreePose>(pose::rest_pose(tree));
  for (std::size_t level = 0; level < pose.levels.size(); ++level) {
    const double gain = strength * (level == 0 ? 0.08 : 0.16 * static_cast<double>(level));
    for (std::size_t i = 0; i < pose.levels[level].bend_east_rad.size(); ++i) {
      const double phase = (1.5 + 2.0 * static_cast<double>(level)) * time_s + 0.7 * static_cast<double>(i % 97);
      pose.levels[level].bend_east_rad[i] = static_cast<float>(gain * (1.0 + 0.6 * std::sin(phase)));
      pose.levels[level].bend_south_rad[i] = static_cast<float>(0.5 * gain * std::sin(1.3 * phase));
    }
  }
  return pose;
}

pose::SurfacePose waves(const pose::SurfaceSkeleton& surface, double time_s, double strength) {
  pose::SurfacePose pose = std::get<pose::SurfacePose>(pose::rest_pose(surface));
  for (std::size_t i = 0; i < pose.displacement_m.size(); ++i) {
    const auto x_m = static_cast<double>(surface.rest_x_m[i]);
    const auto y_m = static_cast<double>(surface.rest_y_m[i]);
    const auto z_m = static_cast<double>(surface.rest_z_m[i]);
    if (surface.ramp_rgba.empty()) {
      const double sea = std::sin(5.1 * x_m + 1.7 * z_m - 4.0 * time_s) +
                         0.7 * std::sin(7.3 * x_m - 3.9 * z_m - 5.0 * time_s + 1.0) +
                         0.4 * std::sin(13.7 * x_m + 6.1 * z_m - 7.0 * time_s) +
                         0.3 * std::sin(17.3 * x_m - 11.1 * z_m - 8.0 * time_s);
      pose.displacement_m[i] = static_cast<float>(0.028 * strength * sea);
      continue;
    }
    const double up = (y_m - 0.5) / 1.35;
    const double lick = std::sin(9.0 * x_m + 7.0 * z_m + 3.0 * std::sin(3.0 * y_m - 3.0 * time_s)) +
                        0.8 * std::sin(17.0 * x_m - 9.0 * z_m + 5.0 * y_m - 9.0 * time_s) +
                        0.5 * std::sin(11.0 * y_m - 12.0 * time_s + 4.0 * x_m);
    const double aside = surface.is_closed ? 0.0 : std::pow(std::abs(x_m) / 0.25, 2.0);
    pose.heat[i] = static_cast<float>(std::clamp(0.95 - 0.85 * up - 0.8 * aside + 0.16 * lick, 0.0, 1.0));
    if (surface.is_closed) pose.displacement_m[i] = static_cast<float>(0.035 * lick * (0.3 + up));
  }
  for (std::size_t row = 0; row < pose.row_east_m.size(); ++row) {  // a body leans to the east
    const double up = static_cast<double>(row) / static_cast<double>(surface.rows - 1);
    pose.row_east_m[row] = static_cast<float>(0.5 * strength * up);
    pose.row_drop_m[row] = static_cast<float>(0.2 * strength * up);
    pose.row_slope_east[row] = static_cast<float>(0.3 * strength);
  }
  return pose;
}

}  // namespace

wire::SceneModel test_model(std::string_view kind, TestPlace place) {
  return {std::string(kind), kind == "flame panel" ? "flame" : std::string(kind), skeleton_of(kind, place)};
}

pose::Pose test_pose(const wire::SceneModel& model, double time_s, double strength) {
  if (std::holds_alternative<pose::StrandSkeleton>(model.skeleton)) {
    return test_pose(model.skeleton, time_s, 0.5 * strength, 0.7 * strength, 90.0);
  }
  if (const auto* const cloth = std::get_if<pose::GridSkeleton>(&model.skeleton)) return wave(*cloth, time_s, strength);
  if (const auto* const surface = std::get_if<pose::SurfaceSkeleton>(&model.skeleton)) {
    return waves(*surface, time_s, strength);
  }
  return sway(std::get<pose::TreeSkeleton>(model.skeleton), time_s, strength);
}

std::vector<wire::SceneModel> test_garden() {
  return {test_model("grass", {-7.0, 1.0}),  test_model("fur", {-2.4, 3.0}),   test_model("curtain", {0.5, 0.0}),
          test_model("flag", {4.2, -1.0}),   test_model("banner", {7.4, 0.5}), test_model("ripple", {3.5, 4.5}),
          test_model("flame", {-2.2, -0.5}), test_model("tree", {0.5, -6.0})};
}

wire::Bytes greeting_for(const std::vector<wire::SceneModel>& models) {
  return wire::encode(wire::Hello{wire::kProtocol, "a test garden", 60.0}) + wire::encode(wire::Scenes{models});
}

wire::Bytes frame_of(const std::vector<wire::SceneModel>& models, std::span<const float> opacities, double time_s,
                     double strength, std::uint64_t sequence, wire::FrameEncoder& encoder) {
  std::vector<pose::Pose> poses;
  std::vector<const pose::Skeleton*> skeletons;
  std::vector<const pose::Pose*> pointers;
  for (const wire::SceneModel& model : models) {
    poses.push_back(test_pose(model, time_s, strength));
    skeletons.push_back(&model.skeleton);
  }
  pointers.reserve(poses.size());
  for (const pose::Pose& pose : poses) pointers.push_back(&pose);
  wire::FrameInfo info;
  info.sequence = info.tick = sequence;
  info.time_s = time_s;
  info.wind.wind = wind::wind_from(12.0 * strength, 270.0);
  info.wind.source = wind::Source::kLive;
  info.wind.live_weight = 1.0;
  const auto bytes = encoder.encode(info, skeletons, pointers, opacities);
  return {bytes.begin(), bytes.end()};
}

}  // namespace yuragi::viewer
