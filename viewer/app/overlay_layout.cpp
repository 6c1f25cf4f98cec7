#include "viewer/app/overlay_layout.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace yuragi::viewer::app {
namespace {

/// A part of a line: of a row of columns, or of a column of panels.
struct Piece {
  float wanted = 0.0F;
  float anchor = 0.0F;  // preferred position along the line: 0 at its beginning, 1 at its end
  float at = 0.0F;
  float length = 0.0F;
};

/// Places pieces in their order, with `gap` between. If there is not enough room, short ones are whole and the others
/// equally long.
void place_along(float begin, float length, float gap, std::span<Piece> pieces) {
  if (pieces.empty()) return;
  float left = std::max(0.0F, length - gap * static_cast<float>(pieces.size() - 1));
  std::vector<Piece*> by_length;
  for (Piece& piece : pieces) by_length.push_back(&piece);
  std::ranges::sort(by_length, {}, &Piece::wanted);
  for (std::size_t i = 0; i < by_length.size(); ++i) {
    by_length[i]->length = std::floor(std::min(by_length[i]->wanted, left / static_cast<float>(by_length.size() - i)));
    left -= by_length[i]->length;
  }
  float first = begin;
  for (Piece& piece : pieces) {
    piece.at = std::max(first, std::floor(begin + piece.anchor * (length - piece.length)));
    first = piece.at + piece.length + gap;
  }
  // From the last one back: moves pieces that the anchors have pushed over the end.
  float end = begin + length;
  for (std::size_t i = pieces.size(); i-- > 0;) {
    pieces[i].at = std::min(pieces[i].at, end - pieces[i].length);
    end = pieces[i].at - gap;
  }
}

/// A panel's preferred place, and its column.
struct Home {
  PanelId panel;
  float across;  // as Piece::anchor
  float down;
  std::array<std::size_t, 3> column;  // in layouts of three, two and one columns
};
/// From the top down.
constexpr std::array<Home, 5> kHomes{{{PanelId::kTexts, 0.0F, 0.0F, {0, 0, 0}},
                                      {PanelId::kValues, 1.0F, 0.0F, {2, 1, 0}},
                                      {PanelId::kHelp, 0.5F, 0.5F, {1, 0, 0}},
                                      {PanelId::kProfile, 0.0F, 1.0F, {0, 0, 0}},
                                      {PanelId::kTrace, 1.0F, 1.0F, {2, 1, 0}}}};
constexpr std::size_t kArrangements = 3;
constexpr float kMuchBetter = 1.25F;

constexpr std::size_t index_of(PanelId panel) {
  return static_cast<std::size_t>(panel);
}

/// Returns the part that is seen of the panel that is cut most.
float place_columns(std::size_t arrangement, const PanelRect& room, float gap, const OfPanels<PanelSize>& wanted,
                    OfPanels<PanelRect>& places) {
  std::array<std::vector<const Home*>, 3> columns;
  for (const Home& home : kHomes) {
    if (!wanted[index_of(home.panel)].is_empty()) columns.at(home.column.at(arrangement)).push_back(&home);
  }
  std::vector<Piece> across;
  for (const auto& column : columns) {
    if (column.empty()) continue;
    Piece piece{.wanted = 0.0F, .anchor = column.front()->across};
    for (const Home* home : column) piece.wanted = std::max(piece.wanted, wanted[index_of(home->panel)].width);
    across.push_back(piece);
  }
  place_along(room.x, room.size.width, gap, across);

  float least_seen = 1.0F;
  std::size_t next = 0;
  for (const auto& column : columns) {
    if (column.empty()) continue;
    const Piece& band = across[next++];
    std::vector<Piece> down;
    for (const Home* home : column) {
      down.push_back({.wanted = wanted[index_of(home->panel)].height, .anchor = home->down});
    }
    place_along(room.y, room.size.height, gap, down);
    for (std::size_t i = 0; i < column.size(); ++i) {
      const PanelSize& whole = wanted[index_of(column[i]->panel)];
      const float width = std::min(whole.width, band.length);
      places[index_of(column[i]->panel)] = {.x = std::floor(band.at + band.anchor * (band.length - width)),
                                            .y = down[i].at,
                                            .size = {.width = width, .height = down[i].length}};
      least_seen = std::min(least_seen, width * down[i].length / (whole.width * whole.height));
    }
  }
  return least_seen;
}

bool overlaps(const PanelRect& a, const PanelRect& b) {
  return !a.size.is_empty() && !b.size.is_empty() && a.x < b.x + b.size.width && b.x < a.x + a.size.width &&
         a.y < b.y + b.size.height && b.y < a.y + a.size.height;
}

}  // namespace

OfPanels<PanelRect> OverlayLayout::place(const PanelSize& picture, float gap, const OfPanels<PanelSize>& wanted) {
  OfPanels<PanelRect> places{};
  PanelRect room{.x = gap,
                 .y = gap,
                 .size = {.width = std::max(0.0F, picture.width - 2.0F * gap),
                          .height = std::max(0.0F, picture.height - 2.0F * gap)}};
  const PanelRect whole = room;
  // These texts have the full width, and so do the panels below them.
  for (const PanelId words : {PanelId::kPause, PanelId::kNotice}) {
    const PanelSize& size = wanted[index_of(words)];
    if (size.is_empty()) continue;
    const float width = std::min(size.width, room.size.width);
    const float height = std::min(size.height, std::floor(0.5F * room.size.height));
    places[index_of(words)] = {.x = std::floor(room.x + 0.5F * (room.size.width - width)),
                               .y = room.y + room.size.height - height,
                               .size = {.width = width, .height = height}};
    room.size.height = std::max(0.0F, room.size.height - height - gap);
  }

  std::array<OfPanels<PanelRect>, kArrangements> tried{};
  std::array<float, kArrangements> seen{};
  for (std::size_t i = 0; i < kArrangements; ++i) {
    tried[i] = places;
    seen[i] = place_columns(i, room, gap, wanted, tried[i]);
  }
  if (seen[0] >= 1.0F) arrangement_ = 0;
  for (std::size_t i = 0; i < kArrangements; ++i) {
    if (seen[i] > kMuchBetter * seen[arrangement_]) arrangement_ = i;
  }
  places = tried[arrangement_];

  // A notice is in the middle if the middle is free.
  PanelRect& notice = places[index_of(PanelId::kNotice)];
  PanelRect middle = notice;
  middle.y = std::floor(whole.y + 0.5F * (whole.size.height - middle.size.height));
  const bool is_free = std::ranges::none_of(
      places, [&](const PanelRect& other) { return &other != &notice && overlaps(other, middle); });
  if (is_free) notice = middle;
  return places;
}

}  // namespace yuragi::viewer::app
