#pragma once

#include <CLI/CLI.hpp>

#include "viewer/picture/viewer_options.hpp"

namespace yuragi::viewer::app {

/// Declares the options; app.parse() fills `options`, which must outlive it.
void add_options(CLI::App& app, picture::ViewerOptions& options);

}  // namespace yuragi::viewer::app
