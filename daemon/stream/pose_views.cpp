#include "daemon/stream/pose_views.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <variant>

#include <fmt/core.h>

#include "engine/base/printable_text.hpp"

namespace yuragi::daemon::stream {

void PoseView::set_scenes(const SharedBytes& scenes) {
  whole_.reset();
  thinned_.reset();
  thinner_.reset();
  scenes_ = scenes;
  if (thinning_.is_all()) return;
  if (thinning_.is_wind_alone) {
    thinner_ = std::make_unique<wire::Thinner>(wire::Scenes{}, thinning_);
    scenes_.reset();
    return;
  }
  const auto message = wire::decode(std::span(*scenes).subspan(wire::kSizePrefixBytes));
  const auto* all = message ? std::get_if<wire::Scenes>(&*message) : nullptr;
  thinner_ = std::make_unique<wire::Thinner>(all != nullptr ? *all : wire::Scenes{}, thinning_);
  scenes_ = std::make_shared<const wire::Bytes>(wire::encode(thinner_->scenes()));
}

void PoseView::set_frame(const SharedBytes& frame) {
  whole_ = frame;
  thinned_.reset();
  ++sequence_;
}

SharedBytes PoseView::frame() {
  if (!thinner_ || !whole_) return whole_;
  if (!thinned_) thinned_ = std::make_shared<const wire::Bytes>(thinner_->frame(*whole_));
  return thinned_;
}

void PoseViews::set_scenes(SharedBytes scenes) {
  scenes_ = std::move(scenes);
  frame_.reset();
  names_.clear();
  for (std::string& name : wire::scene_names(*scenes_)) {
    // A scene that fades out and the one that replaces it may have the same name.
    if (std::ranges::find(names_, name) == names_.end()) names_.push_back(std::move(name));
  }
  for (const auto& weak : views_) {
    if (const auto view = weak.lock()) view->set_scenes(scenes_);
  }
}

void PoseViews::set_frame(SharedBytes frame) {
  frame_ = std::move(frame);
  for (const auto& weak : views_) {
    if (const auto view = weak.lock()) view->set_frame(frame_);
  }
}

std::shared_ptr<PoseView> PoseViews::view(const wire::Thinning& thinning) {
  std::erase_if(views_, [](const auto& weak) { return weak.expired(); });
  for (const auto& weak : views_) {
    if (auto view = weak.lock(); view && view->thinning() == thinning) return view;
  }
  auto view = std::make_shared<PoseView>(thinning);
  if (scenes_) view->set_scenes(scenes_);
  if (frame_) view->set_frame(frame_);
  views_.push_back(view);
  return view;
}

std::optional<std::string> PoseViews::refusal(const wire::Thinning& thinning) const {
  const auto unknown = std::ranges::find_if(
      thinning.scenes, [&](const std::string& name) { return std::ranges::find(names_, name) == names_.end(); });
  if (unknown == thinning.scenes.end()) return std::nullopt;
  constexpr std::size_t kShownCharacters = 64;  // of a client's text
  std::string why = fmt::format("there is no scene \"{}\"; the scenes are", shortened(*unknown, kShownCharacters));
  for (std::size_t i = 0; i < names_.size(); ++i) why += fmt::format("{} \"{}\"", i == 0 ? ":" : ",", names_[i]);
  return names_.empty() ? "there are no scenes" : why;
}

}  // namespace yuragi::daemon::stream
