#include "viewer/app/swap_log.hpp"

#include <fmt/format.h>

#include "viewer/picture/viewer_exit.hpp"

namespace yuragi::viewer::app {

SwapLog::SwapLog(const std::string& file) : file_(std::fopen(file.c_str(), "we")) {
  if (!file_) throw picture::ViewerExit(EX_CANTCREAT, "--swaps: " + file + " cannot be written; check its folder");
  std::setvbuf(file_.get(), nullptr, _IOLBF, BUFSIZ);
  std::fputs("utc_ns,tick,chosen_utc_ns,in_step,late_frames\n", file_.get());
}

void SwapLog::add(const Swap& swap) {
  const std::string line = fmt::format("{},{},{},{},{}\n", swap.utc_ns, swap.tick, swap.chosen_utc_ns,
                                       swap.is_in_step ? 1 : 0, swap.late_frames);
  if (std::fputs(line.c_str(), file_.get()) >= 0 || has_failed_) return;
  has_failed_ = true;
  std::fputs("yuragi-viewer: --swaps: the file cannot be written; is the disk full?\n", stderr);
}

}  // namespace yuragi::viewer::app
