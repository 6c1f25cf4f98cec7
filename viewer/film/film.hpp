#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "viewer/film/film_output.hpp"
#include "viewer/film/film_stream.hpp"
#include "viewer/picture/renderer.hpp"
#include "viewer/picture/viewer_options.hpp"

namespace yuragi::viewer::film {

/// Progress of a film: the pictures made, and their total, if it is known.
using Progress = std::function<void(int made, std::optional<int> total)>;

/// Makes a film of a stream that waits for its reader: a picture each 1 / options.fps seconds of its time, from its
/// first frame to its last or options.duration_s. It depends on no clock and no delay: the same stream gives the same
/// pictures. Ends early once `is_stopping` is set; returns whether it is whole. Throws ViewerExit.
bool make_film(const picture::ViewerOptions& options, Stream& stream, picture::Renderer& renderer, Output& output,
               const Progress& progress, const std::atomic<bool>& is_stopping);

/// The whole of `yuragi-viewer --render`: stream, renderer and output according to `options`, and progress on standard
/// error. Throws ViewerExit, also if `is_stopping` ended it.
void render_recording(const picture::ViewerOptions& options, const std::atomic<bool>& is_stopping);

}  // namespace yuragi::viewer::film
