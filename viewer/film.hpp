#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "viewer/film_output.hpp"
#include "viewer/film_stream.hpp"
#include "viewer/options.hpp"
#include "viewer/renderer.hpp"

namespace yuragi::viewer {

/// How far a film is: pictures made, and how many there will be, where that is known.
using FilmProgress = std::function<void(int made, std::optional<int> total)>;

/// Makes a film of a stream that waits for its reader: a picture each 1 / options.fps seconds of its time, from its
/// first frame to its last or options.duration_s. No clock and no delay has a part in it: the same stream gives the
/// same pictures. Ends early once `is_stopping` is set; returns whether it is whole. Throws ViewerExit.
bool make_film(const ViewerOptions& options, FilmStream& stream, Renderer& renderer, FilmOutput& output,
               const FilmProgress& progress, const std::atomic<bool>& is_stopping);

/// The whole of `yuragi-viewer --render`: stream, renderer and output as `options` ask for, and progress on standard
/// error. Throws ViewerExit, also where `is_stopping` ended it.
void render_recording(const ViewerOptions& options, const std::atomic<bool>& is_stopping);

}  // namespace yuragi::viewer
