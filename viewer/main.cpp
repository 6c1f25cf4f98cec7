#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

#include "engine/base/result.hpp"
#include "engine/base/version.hpp"
#include "engine/base/word_suggestion.hpp"
#include "viewer/app/command_line.hpp"
#include "viewer/app/viewer.hpp"
#include "viewer/app/window.hpp"
#include "viewer/film/film.hpp"
#include "viewer/picture/viewer_exit.hpp"

namespace {

std::atomic<bool> is_stopping{false};
static_assert(std::atomic<bool>::is_always_lock_free);

int run(int argc, char** argv) {
  using namespace yuragi;
  CLI::App app{"Shows the scenes that a Yuragi daemon streams.", "yuragi-viewer"};
  app.set_version_flag("--version", with_version("yuragi-viewer"));
  viewer::picture::ViewerOptions options;
  viewer::app::add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (const std::string text = unexpected_arguments_of(app); error.get_exit_code() != 0 && !text.empty()) {
      std::fprintf(stderr, "yuragi-viewer: %s\nRun with --help for more information.\n", text.c_str());
      return EX_USAGE;
    }
    return app.exit(error) == 0 ? 0 : EX_USAGE;
  }

  if (options.lists_monitors) {
    std::fputs(viewer::app::list_monitors().c_str(), stdout);
    return 0;
  }
  std::signal(SIGINT, [](int) { is_stopping = true; });
  std::signal(SIGTERM, [](int) { is_stopping = true; });
  // Its terminal was closed; under nohup it continues.
  if (std::signal(SIGHUP, [](int) { is_stopping = true; }) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  if (!options.render.empty()) {
    viewer::film::render_recording(options, is_stopping);
  } else {
    viewer::app::Viewer(options, is_stopping).run();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const yuragi::viewer::picture::ViewerExit& error) {
    std::fprintf(stderr, "yuragi-viewer: %s\n", error.what());
    return error.code();
  } catch (const yuragi::FailureError& error) {
    std::fprintf(stderr, "yuragi-viewer: %s\n", error.what());
    return yuragi::viewer::picture::exit_code_of(error.kind());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "yuragi-viewer: %s\n", error.what());
    return EX_SOFTWARE;
  }
}
