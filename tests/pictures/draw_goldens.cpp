// Draws the golden pictures, and says how far they are from others of the same names. tests/pictures/renew.sh calls
// this.
//
//   draw_goldens FOLDER [OTHER_FOLDER] [--samples N] [--scene NAME]...

#include <cstdio>
#include <exception>
#include <filesystem>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "tests/pictures/golden_pictures.hpp"
#include "viewer/picture/picture_file.hpp"

int main(int argc, char** argv) {
  using namespace yuragi::viewer;
  try {
    std::filesystem::path folder;
    std::filesystem::path others;
    int samples = 4;
    std::vector<std::string> names{picture_scenes().begin(), picture_scenes().end()};
    CLI::App app("The golden pictures");
    app.add_option("folder", folder)->required()->check(CLI::ExistingDirectory);
    app.add_option("others", others, "to compare with")->check(CLI::ExistingDirectory);
    app.add_option("--samples", samples)->capture_default_str();
    app.add_option("--scene", names, "only this; can be given again")->check(CLI::IsMember(names));
    CLI11_PARSE(app, argc, argv);

    GoldenDrawing drawing(samples);
    for (const std::string& name : names) {
      for (const Weather& weather : kWeathers) {
        const Picture picture = drawing.draw(golden_moment(name, weather));
        const std::string file = golden_file(name, weather);
        const auto other = others.empty() ? std::nullopt : read_picture(others / file);
        picture::write_picture(folder / file, picture.width_px, picture.height_px, picture.rgb);
        if (!other) {
          fmt::print("{}\n", file);
          continue;
        }
        const PictureDifference differs = difference(picture, *other);
        fmt::print("{:20} mean {:6.2f}, changed part {:.4f}\n", file, differs.mean, differs.changed_part);
      }
    }
    return gl::gl_error_count() == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "draw_goldens: %s\n", error.what());
    return 70;
  }
}
