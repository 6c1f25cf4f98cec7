#include "engine/wire/thinner.hpp"

#include <algorithm>
#include <array>

#include "engine/wire/decode_models.hpp"

namespace yuragi::wire {
namespace {

using Numbers = std::vector<std::uint32_t>;

Numbers every_so_many(std::size_t count, std::size_t every, bool keeps_last) {
  Numbers kept;
  for (std::size_t i = 0; i < count; i += every) kept.push_back(static_cast<std::uint32_t>(i));
  if (keeps_last && count > 0 && kept.back() + 1 < count) kept.push_back(static_cast<std::uint32_t>(count - 1));
  return kept;
}

/// The numbers of the points in kept rows and columns; a row has room for `stride`.
Numbers points_of(const Numbers& rows, const Numbers& columns, std::size_t stride) {
  Numbers points;
  points.reserve(rows.size() * columns.size());
  for (const std::uint32_t row : rows) {
    for (const std::uint32_t column : columns) points.push_back(static_cast<std::uint32_t>(row * stride + column));
  }
  return points;
}

/// The kept values, in a vector of `room` elements, padded with zeros.
template <class T>
void keep(std::vector<T>& values, const Numbers& kept, std::size_t room) {
  std::vector<T> left(room);
  std::transform(kept.begin(), kept.end(), left.begin(), [&](std::uint32_t i) { return values[i]; });
  values = std::move(left);
}

void keep_strands(pose::StrandSkeleton& strands, const Numbers& kept, std::size_t every) {
  // Taking every n-th strand of a row equals every n-th overall if the rows are whole multiples of n.
  strands.columns = strands.columns % every == 0 ? strands.columns / every : 0;
  strands.strand_count = kept.size();
  for (auto* values :
       {&strands.root_x_m, &strands.root_y_m, &strands.root_z_m, &strands.rest_x, &strands.rest_y, &strands.rest_z,
        &strands.curl_x, &strands.curl_y, &strands.curl_z, &strands.rest_curl_rad, &strands.link_length_m})
    keep(*values, kept, strands.padded_count());
}

}  // namespace

Thinner::Kept Thinner::thin(pose::StrandSkeleton& strands, std::size_t every) const {
  Kept kept{.of = {every_so_many(strands.strand_count, every, false)}, .count_before = {strands.strand_count}};
  keep_strands(strands, kept.of[0], every);
  return kept;
}

Thinner::Kept Thinner::thin(pose::GridSkeleton& grid, std::size_t every) const {
  const Numbers columns = every_so_many(grid.columns, every, true);
  const Numbers rows = every_so_many(grid.rows, every, true);
  Kept kept{.of = {points_of(rows, columns, grid.columns)},
            .count_before = {grid.columns * grid.rows},
            .columns = static_cast<std::uint32_t>(columns.size())};
  const pose::GridSkeleton before = grid;
  grid.columns = columns.size();
  grid.rows = rows.size();
  const auto keep_axis = [&](const std::vector<float>& from, std::vector<float>& to) {
    to.assign(grid.rows * grid.stride(), 0.0F);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      for (std::size_t column = 0; column < columns.size(); ++column)
        to[row * grid.stride() + column] = from[rows[row] * before.stride() + columns[column]];
    }
  };
  keep_axis(before.rest_x_m, grid.rest_x_m);
  keep_axis(before.rest_y_m, grid.rest_y_m);
  keep_axis(before.rest_z_m, grid.rest_z_m);
  return kept;
}

Thinner::Kept Thinner::thin(pose::TreeSkeleton& tree, std::size_t every) const {
  Kept kept;
  kept.of.resize(tree.levels.size());
  // From the leaves down: a strand is kept by itself, or because a kept one grows on it.
  std::vector<std::vector<bool>> stays;
  for (const pose::TreeLevel& level : tree.levels) {
    kept.count_before.push_back(level.strands.strand_count);
    stays.emplace_back(level.strands.strand_count, false);
    for (const std::uint32_t i : every_so_many(level.strands.strand_count, every, false)) stays.back()[i] = true;
  }
  for (std::size_t l = tree.levels.size(); l-- > 0;) {
    const pose::TreeLevel& level = tree.levels[l];
    for (std::uint32_t i = 0; i < level.strands.strand_count; ++i) {
      if (!stays[l][i]) continue;
      kept.of[l].push_back(i);
      if (l > 0) stays[level.parent_level][level.parent[i]] = true;
    }
  }
  for (std::size_t l = 0; l < tree.levels.size(); ++l) {
    pose::TreeLevel& level = tree.levels[l];
    const bool is_whole = kept.of[l].size() == kept.count_before[l];
    keep_strands(level.strands, kept.of[l], is_whole ? 1 : every);
    const std::size_t room = level.strands.padded_count();
    keep(level.base_radius_m, kept.of[l], room);
    keep(level.tip_radius_m, kept.of[l], room);
    if (l == 0) continue;
    keep(level.parent, kept.of[l], room);
    keep(level.parent_link, kept.of[l], room);
    const Numbers& parents = kept.of[level.parent_level];
    for (std::size_t i = 0; i < kept.of[l].size(); ++i) {
      const auto place = std::ranges::lower_bound(parents, level.parent[i]);
      level.parent[i] = static_cast<std::uint32_t>(place - parents.begin());
    }
    // The blocks of 16 have changed.
    level.is_turned_by_block = level.is_turned_by_block && is_whole;
  }
  return kept;
}

Thinner::Kept Thinner::thin(pose::SurfaceSkeleton& surface, std::size_t every) const {
  const std::size_t ring = surface.columns / surface.shells;
  const std::size_t step = surface.is_closed ? std::min(every, std::max<std::size_t>(ring / 3, 1)) : every;
  Numbers columns;
  for (std::size_t shell = 0; shell < surface.shells; ++shell) {
    for (const std::uint32_t i : every_so_many(ring, step, !surface.is_closed))
      columns.push_back(static_cast<std::uint32_t>(shell * ring + i));
  }
  Kept kept{.of = {},
            .count_before = {surface.columns * surface.rows},
            .rows = every_so_many(surface.rows, every, true),
            .rows_before = surface.rows};
  kept.of.push_back(points_of(kept.rows, columns, surface.columns));
  surface.columns = columns.size();
  surface.rows = kept.rows.size();
  for (auto* values : {&surface.rest_x_m, &surface.rest_y_m, &surface.rest_z_m, &surface.normal_x, &surface.normal_y,
                       &surface.normal_z})
    keep(*values, kept.of[0], kept.of[0].size());
  if (surface.moves_rows()) {
    keep(surface.axis_x_m, kept.rows, kept.rows.size());
    keep(surface.axis_z_m, kept.rows, kept.rows.size());
  }
  return kept;
}

Thinner::Thinner(const Scenes& scenes, const Thinning& thinning) {
  if (thinning.is_wind_alone) return;
  for (std::size_t i = 0; i < scenes.scenes.size(); ++i) {
    const SceneModel& scene = scenes.scenes[i];
    if (!thinning.scenes.empty() && std::ranges::find(thinning.scenes, scene.name) == thinning.scenes.end()) continue;
    scenes_.scenes.push_back(scene);
    const std::size_t every = std::max<std::size_t>(thinning.every, 1);
    kept_.push_back(std::visit([&](auto& skeleton) { return thin(skeleton, every); }, scenes_.scenes.back().skeleton));
    kept_.back().scene = i;
  }
}

struct Thinner::FrameMaker {
  flatbuffers::FlatBufferBuilder buffer;

  template <class T>
  using Values = flatbuffers::Vector<T>;
  template <class T>
  using Offset = flatbuffers::Offset<Values<T>>;

  template <class T>
  static std::size_t size_of(const Values<T>* values) {
    return values == nullptr ? 0 : values->size();
  }

  template <class T>
  Offset<T> keep(const Values<T>* from, const std::vector<std::uint32_t>& kept) {
    T* to = nullptr;
    const auto vector = buffer.CreateUninitializedVector(kept.size(), &to);
    for (const std::uint32_t i : kept) *to++ = from->data()[i];
    return vector;
  }

  /// No offset: the pose does not fit.
  flatbuffers::Offset<fb::StrandPose> add(const fb::StrandPose* pose, const Kept& kept, std::size_t level = 0) {
    if (pose == nullptr || level >= kept.of.size() || size_of(pose->bend_east()) != kept.count_before[level] ||
        size_of(pose->bend_south()) != kept.count_before[level])
      return {};
    const auto east = keep(pose->bend_east(), kept.of[level]);
    const auto south = keep(pose->bend_south(), kept.of[level]);
    return fb::CreateStrandPose(buffer, pose->bend_step_rad(), east, south);
  }

  flatbuffers::Offset<fb::GridPose> add(const fb::GridPose* pose, const Kept& kept) {
    const std::size_t count = kept.count_before[0];
    if (kept.columns == 0 || size_of(pose->offset_x()) != count || size_of(pose->offset_y()) != count ||
        size_of(pose->offset_z()) != count)
      return {};
    const auto x = keep(pose->offset_x(), kept.of[0]);
    const auto y = keep(pose->offset_y(), kept.of[0]);
    const auto z = keep(pose->offset_z(), kept.of[0]);
    return fb::CreateGridPose(buffer, kept.columns, pose->step_m(), x, y, z);
  }

  flatbuffers::Offset<fb::TreePose> add(const fb::TreePose* pose, const Kept& kept) {
    if (size_of(pose->levels()) != kept.of.size()) return {};
    std::vector<flatbuffers::Offset<fb::StrandPose>> levels;
    for (std::size_t l = 0; l < kept.of.size(); ++l) {
      levels.push_back(add(pose->levels()->Get(static_cast<flatbuffers::uoffset_t>(l)), kept, l));
      if (levels.back().IsNull()) return {};
    }
    return fb::CreateTreePose(buffer, buffer.CreateVector(levels));
  }

  flatbuffers::Offset<fb::SurfacePose> add(const fb::SurfacePose* pose, const Kept& kept) {
    const std::size_t heat_count = size_of(pose->heat());
    const bool moves_rows = size_of(pose->row_east()) > 0;
    if (size_of(pose->displacement()) != kept.count_before[0] || (heat_count > 0 && heat_count != kept.count_before[0]))
      return {};
    const std::array rows = {pose->row_east(), pose->row_south(), pose->row_drop(), pose->row_slope_east(),
                             pose->row_slope_south()};
    if (moves_rows &&
        !std::ranges::all_of(rows, [&](const auto* values) { return size_of(values) == kept.rows_before; }))
      return {};
    const auto displacement = keep(pose->displacement(), kept.of[0]);
    const auto heat = heat_count > 0 ? keep(pose->heat(), kept.of[0]) : Offset<std::uint8_t>();
    if (!moves_rows) return fb::CreateSurfacePose(buffer, pose->step_m(), displacement, heat);
    const auto east = keep(pose->row_east(), kept.rows);
    const auto south = keep(pose->row_south(), kept.rows);
    const auto drop = keep(pose->row_drop(), kept.rows);
    const auto slope_east = keep(pose->row_slope_east(), kept.rows);
    const auto slope_south = keep(pose->row_slope_south(), kept.rows);
    return fb::CreateSurfacePose(buffer, pose->step_m(), displacement, heat, east, south, drop, pose->slope_step(),
                                 slope_east, slope_south);
  }

  flatbuffers::Offset<fb::ScenePose> add_scene(const fb::ScenePose& scene, const Kept& kept) {
    flatbuffers::Offset<void> body;
    if (const auto* strands = scene.pose_as_StrandPose()) body = add(strands, kept).Union();
    if (const auto* grid = scene.pose_as_GridPose()) body = add(grid, kept).Union();
    if (const auto* tree = scene.pose_as_TreePose()) body = add(tree, kept).Union();
    if (const auto* surface = scene.pose_as_SurfacePose()) body = add(surface, kept).Union();
    if (body.IsNull()) return fb::CreateScenePose(buffer, fb::Pose_NONE, 0, 0.0F);
    return fb::CreateScenePose(buffer, scene.pose_type(), body, scene.opacity());
  }
};

Bytes Thinner::frame(std::span<const std::uint8_t> message) const {
  const fb::Frame* from = fb::GetSizePrefixedMessage(message.data())->body_as_Frame();
  FrameMaker maker;
  std::vector<flatbuffers::Offset<fb::ScenePose>> scenes;
  const std::size_t count = from->scenes() == nullptr ? 0 : from->scenes()->size();
  for (const Kept& kept : kept_) {
    if (kept.scene >= count) break;
    scenes.push_back(maker.add_scene(*from->scenes()->Get(static_cast<flatbuffers::uoffset_t>(kept.scene)), kept));
  }
  const auto frame =
      fb::CreateFrame(maker.buffer, from->sequence(), from->tick(), from->time_s(), from->utc_ns(), from->wind(),
                      maker.buffer.CreateVector(scenes), from->wind_place(), from->view_wind_from_deg());
  fb::FinishSizePrefixedMessageBuffer(maker.buffer, fb::CreateMessage(maker.buffer, fb::Body_Frame, frame.Union()));
  return {maker.buffer.GetBufferPointer(), maker.buffer.GetBufferPointer() + maker.buffer.GetSize()};
}

std::vector<std::string> scene_names(std::span<const std::uint8_t> message) {
  std::vector<std::string> names;
  const fb::Scenes* scenes = fb::GetSizePrefixedMessage(message.data())->body_as_Scenes();
  if (scenes == nullptr || scenes->scenes() == nullptr) return names;
  for (const fb::Scene* scene : *scenes->scenes()) {
    std::string name;
    if (read_text(scene->name(), name)) names.push_back(std::move(name));
  }
  return names;
}

}  // namespace yuragi::wire
