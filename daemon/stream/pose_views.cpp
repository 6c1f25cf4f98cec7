#include "daemon/stream/pose_views.hpp"

#include <span>
#include <utility>
#include <variant>

namespace yuragi::daemon::stream {

void PoseView::set_scenes(const SharedBytes& scenes) {
  whole_.reset();
  thinned_.reset();
  thinner_.reset();
  scenes_ = scenes;
  if (thinning_.is_all()) return;
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

}  // namespace yuragi::daemon::stream
