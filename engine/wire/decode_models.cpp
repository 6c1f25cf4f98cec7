#include "engine/wire/decode_models.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>

// Skeletons and poses. Their arrays have no padding in a message; it is added here.

namespace yuragi::wire {
namespace {

static_assert(std::endian::native == std::endian::little);

// Far beyond every real model, and small enough that sums and products of them stay finite.
constexpr float kMaxExtent_m = 1e6f;
constexpr float kMaxTreeScale = 100.0f;
constexpr float kMaxAngle_rad = 2.0f * std::numbers::pi_v<float>;
constexpr float kMaxBendStep_rad = 1e-3f;
constexpr float kMaxWayStep_m = 1.0f;
constexpr float kMaxSlopeStep = 1.0f;
constexpr float kUnitTolerance = 1e-2f;
constexpr float kMaxUnitComponent = 2.0f;  // checked before is_unit() uses all three
constexpr std::size_t kRampBytes = std::size_t{4} * 256;

template <class T>
std::size_t size_of(const flatbuffers::Vector<T>* vector) {
  return vector == nullptr ? 0 : vector->size();
}

/// The layout of an array's values before and after decoding: `rows` runs of `columns`, each padded to `stride`.
struct Layout {
  std::size_t columns;
  std::size_t rows = 1;
  std::size_t stride = columns;
};

Layout strands_of(std::size_t count) {
  return {.columns = count, .stride = pose::padded_to_blocks(count)};
}

/// The values, `convert`ed, and the padding filled with zeros.
template <class From, class To, class Convert>
bool read_array(const flatbuffers::Vector<From>* from, const Layout& layout, std::vector<To>& to, Convert convert) {
  if (size_of(from) != layout.columns * layout.rows) return false;
  to.assign(layout.stride * layout.rows, To());
  if (from == nullptr) return true;
  for (std::size_t row = 0; row < layout.rows; ++row) {
    const From* values = from->data() + row * layout.columns;
    std::transform(values, values + layout.columns, to.begin() + static_cast<std::ptrdiff_t>(row * layout.stride),
                   convert);
  }
  return true;
}

/// Numbers within +-limit.
bool read_numbers(const flatbuffers::Vector<float>* from, const Layout& layout, float limit, std::vector<float>& to) {
  return read_array(from, layout, to, [](float value) { return value; }) &&
         std::all_of(to.begin(), to.end(), [limit](float value) { return std::abs(value) <= limit; });
}

/// Lengths: numbers from 0 on.
bool read_lengths(const flatbuffers::Vector<float>* from, const Layout& layout, std::vector<float>& to) {
  return read_numbers(from, layout, kMaxExtent_m, to) &&
         std::all_of(to.begin(), to.end(), [](float value) { return value >= 0.0f; });
}

/// Indices below `limit`; padding is 0, which must exist, too.
bool read_indices(const flatbuffers::Vector<std::uint32_t>* from, const Layout& layout, std::size_t limit,
                  std::vector<std::uint32_t>& to) {
  return read_array(from, layout, to, [](std::uint32_t value) { return value; }) &&
         std::all_of(to.begin(), to.end(), [limit](std::uint32_t value) { return value < limit; });
}

bool read_units(const flatbuffers::Vector<std::int16_t>* from, const Layout& layout, float step,
                std::vector<float>& to) {
  return read_array(from, layout, to, [step](std::int16_t value) { return step * static_cast<float>(value); });
}

bool is_unit(float x, float y, float z) {
  return std::abs(x * x + y * y + z * z - 1.0f) <= kUnitTolerance;
}

/// Returns true if `rest` and `curl` of every strand are perpendicular unit vectors.
bool is_frame(const pose::StrandSkeleton& s) {
  for (std::size_t i = 0; i < s.strand_count; ++i) {
    const float across = s.rest_x[i] * s.curl_x[i] + s.rest_y[i] * s.curl_y[i] + s.rest_z[i] * s.curl_z[i];
    if (!is_unit(s.rest_x[i], s.rest_y[i], s.rest_z[i]) || !is_unit(s.curl_x[i], s.curl_y[i], s.curl_z[i]) ||
        std::abs(across) > kUnitTolerance)
      return false;
  }
  return true;
}

bool read(const fb::StrandSkeleton& from, pose::StrandSkeleton& to) {
  const std::size_t count = size_of(from.root_x_m());
  if (count > kMaxStrands || from.links_per_strand() < 1 || from.links_per_strand() > kMaxLinksPerStrand) return false;
  to.strand_count = count;
  to.links_per_strand = from.links_per_strand();
  to.columns = from.columns();
  if (to.columns != 0 && (to.columns > count || count % to.columns != 0)) return false;
  const Layout all = strands_of(count);
  return read_numbers(from.root_x_m(), all, kMaxExtent_m, to.root_x_m) &&
         read_numbers(from.root_y_m(), all, kMaxExtent_m, to.root_y_m) &&
         read_numbers(from.root_z_m(), all, kMaxExtent_m, to.root_z_m) &&
         read_numbers(from.rest_x(), all, kMaxUnitComponent, to.rest_x) &&
         read_numbers(from.rest_y(), all, kMaxUnitComponent, to.rest_y) &&
         read_numbers(from.rest_z(), all, kMaxUnitComponent, to.rest_z) &&
         read_numbers(from.curl_x(), all, kMaxUnitComponent, to.curl_x) &&
         read_numbers(from.curl_y(), all, kMaxUnitComponent, to.curl_y) &&
         read_numbers(from.curl_z(), all, kMaxUnitComponent, to.curl_z) &&
         read_numbers(from.rest_curl_rad(), all, kMaxAngle_rad, to.rest_curl_rad) &&
         read_lengths(from.link_length_m(), all, to.link_length_m) && is_frame(to);
}

/// Returns true if a grid has at most the allowed number of points, including padding.
bool is_grid(std::size_t columns, std::size_t rows, std::size_t stride) {
  return columns <= kMaxStrands && rows <= kMaxStrands && stride * rows <= kMaxStrands;
}

bool read(const fb::GridSkeleton& from, pose::GridSkeleton& to) {
  to.columns = from.columns();
  to.rows = from.rows();
  to.is_first_column_fixed = from.is_first_column_fixed();
  const Layout all{.columns = to.columns, .rows = to.rows, .stride = to.stride()};
  return is_grid(all.columns, all.rows, all.stride) && read_numbers(from.rest_x_m(), all, kMaxExtent_m, to.rest_x_m) &&
         read_numbers(from.rest_y_m(), all, kMaxExtent_m, to.rest_y_m) &&
         read_numbers(from.rest_z_m(), all, kMaxExtent_m, to.rest_z_m);
}

/// Reads a level that grows on the previous levels, which were already read.
bool read(const fb::TreeLevel& from, std::span<const pose::TreeLevel> before, pose::TreeLevel& to) {
  if (from.strands() == nullptr || !read(*from.strands(), to.strands)) return false;
  to.is_turned_by_block = from.is_turned_by_block();
  to.is_leaves = from.is_leaves();
  const Layout all = strands_of(to.strands.strand_count);
  if (!read_lengths(from.base_radius_m(), all, to.base_radius_m) ||
      !read_lengths(from.tip_radius_m(), all, to.tip_radius_m))
    return false;
  if (before.empty()) return size_of(from.parent()) == 0 && size_of(from.parent_link()) == 0;

  if (from.parent_level() >= before.size()) return false;
  to.parent_level = from.parent_level();
  const pose::StrandSkeleton& parents = before[to.parent_level].strands;
  return read_indices(from.parent(), all, parents.strand_count, to.parent) &&
         read_indices(from.parent_link(), all, parents.links_per_strand, to.parent_link);
}

bool read(const fb::TreeSkeleton& from, pose::TreeCopies& to) {
  const std::size_t count = size_of(from.copy_x_m());
  if (count > pose::kMaxTreeCopies) return false;
  const Layout all{.columns = count, .rows = 1, .stride = count};
  return read_numbers(from.copy_x_m(), all, kMaxExtent_m, to.x_m) &&
         read_numbers(from.copy_z_m(), all, kMaxExtent_m, to.z_m) &&
         read_numbers(from.copy_turn_rad(), all, kMaxAngle_rad, to.turn_rad) &&
         read_numbers(from.copy_scale(), all, kMaxTreeScale, to.scale) &&
         std::all_of(to.scale.begin(), to.scale.end(), [](float scale) { return scale > 0.0f; });
}

bool read(const fb::TreeSkeleton& from, pose::TreeSkeleton& to) {
  const std::size_t count = size_of(from.levels());
  if (count < 1 || count > pose::kMaxTreeLevels) return false;
  // A newer server may know more colours.
  if (from.foliage() <= fb::FoliageColor_MAX) to.foliage = static_cast<pose::FoliageColor>(from.foliage());
  to.levels.reserve(count);
  std::size_t room = 0;  // the levels can share arrays: few bytes must not need much memory
  for (std::size_t i = 0; i < count; ++i) {
    pose::TreeLevel level;
    if (!read(*from.levels()->Get(static_cast<flatbuffers::uoffset_t>(i)), to.levels, level)) return false;
    room += level.strands.strand_count;
    if (room > kMaxStrands) return false;
    to.levels.push_back(std::move(level));
  }
  return read(from, to.copies);
}

bool read(const fb::SurfaceSkeleton& from, pose::SurfaceSkeleton& to) {
  to.columns = from.columns();
  to.rows = from.rows();
  to.is_closed = from.is_closed();
  to.shells = from.shells();
  if (to.shells < 1 || to.columns % to.shells != 0) return false;
  const Layout all{.columns = to.columns, .rows = to.rows};
  const std::size_t ramp_bytes = size_of(from.ramp_rgba());
  if (!is_grid(all.columns, all.rows, all.stride) || (ramp_bytes != 0 && ramp_bytes != kRampBytes) ||
      !read_numbers(from.rest_x_m(), all, kMaxExtent_m, to.rest_x_m) ||
      !read_numbers(from.rest_y_m(), all, kMaxExtent_m, to.rest_y_m) ||
      !read_numbers(from.rest_z_m(), all, kMaxExtent_m, to.rest_z_m) ||
      !read_numbers(from.normal_x(), all, kMaxUnitComponent, to.normal_x) ||
      !read_numbers(from.normal_y(), all, kMaxUnitComponent, to.normal_y) ||
      !read_numbers(from.normal_z(), all, kMaxUnitComponent, to.normal_z))
    return false;
  for (std::size_t i = 0; i < to.normal_x.size(); ++i) {
    if (!is_unit(to.normal_x[i], to.normal_y[i], to.normal_z[i])) return false;
  }
  const Layout axis{.columns = size_of(from.axis_x_m()) == 0 ? 0 : to.rows};
  if (!read_numbers(from.axis_x_m(), axis, kMaxExtent_m, to.axis_x_m) ||
      !read_numbers(from.axis_z_m(), axis, kMaxExtent_m, to.axis_z_m))
    return false;
  if (ramp_bytes > 0) to.ramp_rgba.assign(from.ramp_rgba()->begin(), from.ramp_rgba()->end());
  return true;
}

bool read(const fb::StrandPose& from, pose::StrandPose& to) {
  const std::size_t count = size_of(from.bend_east());
  const float step_rad = from.bend_step_rad();
  return count <= kMaxStrands && step_rad > 0.0f && step_rad <= kMaxBendStep_rad &&
         read_units(from.bend_east(), strands_of(count), step_rad, to.bend_east_rad) &&
         read_units(from.bend_south(), strands_of(count), step_rad, to.bend_south_rad);
}

bool is_way_step(float step_m) {
  return step_m > 0.0f && step_m <= kMaxWayStep_m;
}

bool read(const fb::GridPose& from, pose::GridPose& to) {
  const std::size_t columns = from.columns();
  const std::size_t rows = columns == 0 ? 0 : size_of(from.offset_x()) / columns;
  const Layout all{.columns = columns, .rows = rows, .stride = pose::padded_to_blocks(columns)};
  return is_way_step(from.step_m()) && is_grid(all.columns, all.rows, all.stride) &&
         read_units(from.offset_x(), all, from.step_m(), to.offset_x_m) &&
         read_units(from.offset_y(), all, from.step_m(), to.offset_y_m) &&
         read_units(from.offset_z(), all, from.step_m(), to.offset_z_m);
}

bool read(const fb::TreePose& from, pose::TreePose& to) {
  const std::size_t count = size_of(from.levels());
  if (count < 1 || count > pose::kMaxTreeLevels) return false;
  std::size_t room = 0;
  for (std::size_t i = 0; i < count; ++i) {
    pose::StrandPose& level = to.levels.emplace_back();
    if (!read(*from.levels()->Get(static_cast<flatbuffers::uoffset_t>(i)), level)) return false;
    room += level.bend_east_rad.size();
    if (room > kMaxStrands + kMaxPadding) return false;
  }
  return true;
}

bool is_slope_step(float step) {
  return step > 0.0f && step <= kMaxSlopeStep;
}

bool read(const fb::SurfacePose& from, pose::SurfacePose& to) {
  const Layout all{.columns = size_of(from.displacement())};
  const Layout glowing{.columns = size_of(from.heat()) == 0 ? 0 : all.columns};
  const Layout rows{.columns = size_of(from.row_east())};
  return is_way_step(from.step_m()) && all.columns <= kMaxStrands &&
         read_units(from.displacement(), all, from.step_m(), to.displacement_m) &&
         read_array(from.heat(), glowing, to.heat,
                    [](std::uint8_t colour) { return static_cast<float>(colour) / 255.0f; }) &&
         rows.columns <= all.columns && (rows.columns == 0 || is_slope_step(from.slope_step())) &&
         read_units(from.row_east(), rows, from.step_m(), to.row_east_m) &&
         read_units(from.row_south(), rows, from.step_m(), to.row_south_m) &&
         read_units(from.row_drop(), rows, from.step_m(), to.row_drop_m) &&
         read_units(from.row_slope_east(), rows, from.slope_step(), to.row_slope_east) &&
         read_units(from.row_slope_south(), rows, from.slope_step(), to.row_slope_south);
}

template <class Kind, class Any, class Table>
bool read_kind(const Table* from, Any& to) {
  return from != nullptr && read(*from, to.template emplace<Kind>());
}

}  // namespace

namespace {

std::optional<look::Color> color_of(flatbuffers::Optional<std::uint32_t> rgb) {
  if (!rgb.has_value()) return std::nullopt;
  const auto part = [&](unsigned shift) { return static_cast<std::uint8_t>(*rgb >> shift & 0xFFU); };
  return look::Color{part(16), part(8), part(0)};
}

/// Returns a picture whose size matches its pixels, or null.
bool read(const fb::Cloth& from, look::ClothLook& to) {
  to.color = color_of(from.color());
  to.color_2 = color_of(from.color_2());
  const std::size_t width_px = from.image_width();
  const std::size_t height_px = from.image_height();
  if (width_px > look::Image::kMaxSide_px || height_px > look::Image::kMaxSide_px ||
      width_px * height_px > look::Image::kMaxPixels || size_of(from.image_rgb()) != 3 * width_px * height_px)
    return false;
  if (width_px * height_px == 0) return true;
  const auto* const rgb = from.image_rgb();
  to.image = std::make_shared<look::Image>(
      look::Image{.width_px = from.image_width(), .height_px = from.image_height(), .rgb = {rgb->begin(), rgb->end()}});
  return true;
}

}  // namespace

bool read_scene(const fb::Scene& from, SceneModel& to) {
  if (!read_text(from.name(), to.name) || !read_text(from.kind(), to.kind)) return false;
  if (from.cloth() != nullptr && !read(*from.cloth(), to.cloth)) return false;
  switch (from.skeleton_type()) {
    case fb::Skeleton_StrandSkeleton:
      return read_kind<pose::StrandSkeleton>(from.skeleton_as_StrandSkeleton(), to.skeleton);
    case fb::Skeleton_GridSkeleton:
      return read_kind<pose::GridSkeleton>(from.skeleton_as_GridSkeleton(), to.skeleton);
    case fb::Skeleton_TreeSkeleton:
      return read_kind<pose::TreeSkeleton>(from.skeleton_as_TreeSkeleton(), to.skeleton);
    case fb::Skeleton_SurfaceSkeleton:
      return read_kind<pose::SurfaceSkeleton>(from.skeleton_as_SurfaceSkeleton(), to.skeleton);
    case fb::Skeleton_NONE:
      return false;
  }
  to.skeleton.emplace<pose::StrandSkeleton>().links_per_strand = 1;  // of a newer server
  return true;
}

bool read_pose(const fb::ScenePose& from, pose::Pose& pose, float& opacity) {
  opacity = from.opacity();
  if (!is_within(static_cast<double>(opacity), 0.0, 1.0)) return false;
  switch (from.pose_type()) {
    case fb::Pose_StrandPose:
      return read_kind<pose::StrandPose>(from.pose_as_StrandPose(), pose);
    case fb::Pose_GridPose:
      return read_kind<pose::GridPose>(from.pose_as_GridPose(), pose);
    case fb::Pose_TreePose:
      return read_kind<pose::TreePose>(from.pose_as_TreePose(), pose);
    case fb::Pose_SurfacePose:
      return read_kind<pose::SurfacePose>(from.pose_as_SurfacePose(), pose);
    case fb::Pose_NONE:
      pose.emplace<pose::StrandPose>();
      return opacity == 0.0f;  // only a hidden scene's pose can be omitted
  }
  pose.emplace<pose::StrandPose>();  // of a newer server
  return true;
}

std::size_t room_of(const pose::Skeleton& skeleton) {
  if (const auto* strands = std::get_if<pose::StrandSkeleton>(&skeleton)) return strands->root_x_m.size();
  if (const auto* grid = std::get_if<pose::GridSkeleton>(&skeleton)) return grid->rest_x_m.size();
  if (const auto* surface = std::get_if<pose::SurfaceSkeleton>(&skeleton)) return surface->rest_x_m.size();
  std::size_t room = 0;
  for (const pose::TreeLevel& level : std::get<pose::TreeSkeleton>(skeleton).levels)
    room += level.strands.root_x_m.size();
  return room;
}

std::size_t room_of(const pose::Pose& pose) {
  if (const auto* strands = std::get_if<pose::StrandPose>(&pose)) return strands->bend_east_rad.size();
  if (const auto* grid = std::get_if<pose::GridPose>(&pose)) return grid->offset_x_m.size();
  if (const auto* surface = std::get_if<pose::SurfacePose>(&pose)) return surface->displacement_m.size();
  std::size_t room = 0;
  for (const pose::StrandPose& level : std::get<pose::TreePose>(pose).levels) room += level.bend_east_rad.size();
  return room;
}

}  // namespace yuragi::wire
