#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace yuragi::viewer::app {

/// A panel of the overlay.
enum class PanelId : std::uint8_t { kTexts, kHelp, kProfile, kValues, kTrace, kNotice, kPause };
inline constexpr std::size_t kPanelCount = 7;
template <class Value>
using OfPanels = std::array<Value, kPanelCount>;

/// Size in ImGui's pixels.
struct PanelSize {
  float width = 0.0F;
  float height = 0.0F;
  bool is_empty() const { return width <= 0.0F || height <= 0.0F; }
};
struct PanelRect {
  float x = 0.0F;
  float y = 0.0F;
  PanelSize size;
};

/// The places of the overlay's panels, which never overlap. Each panel has its usual place (texts upper left, help in
/// the middle, profile lower left, values and trace on the right). If they do not fit beside each other, they are put
/// into three columns, two or one, whichever cuts them least. Notice and pause are never narrowed for others.
class OverlayLayout {
 public:
  /// `wanted`: the sizes that show everything; empty: not shown, and its rectangle is empty. `gap`: around the
  /// picture's edge and between panels.
  OfPanels<PanelRect> place(const PanelSize& picture, float gap, const OfPanels<PanelSize>& wanted);

 private:
  std::size_t arrangement_ = 0;  // columns; changed only if another number is much better: panels do not jump
};

}  // namespace yuragi::viewer::app
