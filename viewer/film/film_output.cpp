#include "viewer/film/film_output.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "viewer/film/piped_child.hpp"
#include "viewer/film/write_all.hpp"
#include "viewer/picture/picture_file.hpp"
#include "viewer/picture/viewer_exit.hpp"

namespace yuragi::viewer::film {
namespace {

constexpr const char* kVideoExtension = ".mp4";

[[noreturn]] void throw_interrupted() {
  throw picture::ViewerExit(kExitInterrupted, "interrupted: the film is not whole");
}

/// A folder that is made, with its parents. Unless kept, the new ones are removed again if they are empty.
class MadeFolder {
 public:
  explicit MadeFolder(const std::filesystem::path& folder) {
    std::error_code error;
    make(folder, error);
    if (!error) return;
    remove_made();
    throw picture::ViewerExit(EX_CANTCREAT, "cannot make the folder " + folder.string() + ": " + error.message());
  }
  ~MadeFolder() { remove_made(); }
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;

  void keep() { made_.clear(); }

 private:
  void make(const std::filesystem::path& folder, std::error_code& error) {
    std::error_code ignored;
    if (folder.empty() || std::filesystem::is_directory(folder, ignored)) return;
    make(folder.parent_path(), error);
    if (!error && std::filesystem::create_directory(folder, error)) made_.push_back(folder);
  }
  void remove_made() {
    for (; !made_.empty(); made_.pop_back()) {
      std::error_code ignored;
      std::filesystem::remove(made_.back(), ignored);
    }
  }

  std::vector<std::filesystem::path> made_;  // parents first
};

class PictureFolder final : public Output {
 public:
  PictureFolder(std::filesystem::path folder, const Format& format)
      : folder_(std::move(folder)), made_(folder_), format_(format) {
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder_, error), end; !error && entry != end;
         entry.increment(error)) {
      if (is_picture(entry->path())) {
        throw picture::ViewerExit(EX_CANTCREAT,
                                  folder_.string() +
                                      " holds the pictures of another film, with which these would be mixed: "
                                      "remove them, or give another folder");
      }
    }
    if (error)
      throw picture::ViewerExit(EX_CANTCREAT, "cannot read the folder " + folder_.string() + ": " + error.message());
  }
  ~PictureFolder() override {
    if (is_finished_) return;
    std::error_code ignored;
    for (int number = 1; number <= count_; ++number) std::filesystem::remove(file(number), ignored);
  }
  PictureFolder(const PictureFolder&) = delete;
  PictureFolder& operator=(const PictureFolder&) = delete;

  void write(std::span<const std::uint8_t> rgb) override {
    picture::write_picture(file(count_ + 1), format_.width_px, format_.height_px, rgb);
    ++count_;
  }
  void finish() override {
    is_finished_ = true;
    made_.keep();
  }
  std::string text() const override { return folder_.string(); }

 private:
  std::filesystem::path file(int number) const { return folder_ / fmt::format("{:06}.png", number); }
  static bool is_picture(const std::filesystem::path& file) {
    return file.extension() == ".png" && file.stem().string().find_first_not_of("0123456789") == std::string::npos;
  }

  std::filesystem::path folder_;
  MadeFolder made_;
  Format format_;
  int count_ = 0;
  bool is_finished_ = false;
};

class RawPictures final : public Output {
 public:
  explicit RawPictures(const std::atomic<bool>& is_stopping) : is_stopping_(is_stopping) {
    if (::isatty(STDOUT_FILENO) != 0) {
      throw picture::ViewerExit(EX_USAGE, "--out -: pictures would be written to a terminal; send them through a pipe");
    }
  }

  void write(std::span<const std::uint8_t> rgb) override {
    if (const int error = write_all(STDOUT_FILENO, rgb, is_stopping_); error != 0) {
      if (error == ECANCELED) throw_interrupted();
      throw picture::ViewerExit(
          EX_CANTCREAT,
          error == EPIPE ? "whoever read the pictures from standard output has ended"
                         : fmt::format("cannot write to standard output: {}", std::generic_category().message(error)));
    }
  }
  void finish() override {}
  std::string text() const override { return "standard output"; }

 private:
  const std::atomic<bool>& is_stopping_;
};

/// Rec. 709, which players assume for this size; with 4:2:0 subsampling, which every player supports.
std::vector<std::string> ffmpeg_command(const Format& format, const std::filesystem::path& file) {
  return {"ffmpeg",
          "-nostdin",
          "-hide_banner",
          "-loglevel",
          "error",
          "-y",
          "-f",
          "rawvideo",
          "-pixel_format",
          "rgb24",
          "-video_size",
          fmt::format("{}x{}", format.width_px, format.height_px),
          "-framerate",
          fmt::format("{}", format.pictures_per_s),
          "-i",
          "pipe:0",
          "-vf",
          "scale=out_color_matrix=bt709:out_range=tv",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "bt709",
          "-color_range",
          "tv",
          "-c:v",
          "libx264",
          "-crf",
          "16",
          "-pix_fmt",
          "yuv420p",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          "file:" + file.string()};
}

class Video final : public Output {
 public:
  Video(std::filesystem::path file, const Format& format, const std::atomic<bool>& is_stopping)
      : file_(std::move(file)),
        beside_(file_.string() + ".part-" + std::to_string(::getpid())),
        is_stopping_(is_stopping) {
    if (format.width_px % 2 != 0 || format.height_px % 2 != 0) {
      throw picture::ViewerExit(EX_USAGE,
                                fmt::format("--size: the width and the height of an mp4 film are even; {}x{} is not",
                                            format.width_px, format.height_px));
    }
    try {
      ffmpeg_ = std::make_unique<PipedChild>(ffmpeg_command(format, beside_), PipedChild::Pipe::kStandardInput);
    } catch (const std::system_error& error) {
      throw picture::ViewerExit(
          EX_UNAVAILABLE, fmt::format("cannot start ffmpeg, which makes mp4 films: {}.\nOn Debian it is in the package "
                                      "ffmpeg; without it --out FOLDER writes pictures.",
                                      error.code().message()));
    }
  }
  ~Video() override {
    ffmpeg_.reset();
    std::error_code ignored;
    std::filesystem::remove(beside_, ignored);
  }
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;

  void write(std::span<const std::uint8_t> rgb) override {
    const int error = write_all(ffmpeg_->fd(), rgb, is_stopping_);
    if (error == ECANCELED) throw_interrupted();
    if (error == EPIPE) throw_failed(ffmpeg_->wait());
    if (error != 0)
      throw picture::ViewerExit(EX_CANTCREAT,
                                fmt::format("cannot write to ffmpeg: {}", std::generic_category().message(error)));
  }

  void finish() override {
    if (const platform::ChildEnd end = ffmpeg_->wait(); !end.is_good()) throw_failed(end);
    std::error_code error;
    std::filesystem::rename(beside_, file_, error);
    if (error) throw picture::ViewerExit(EX_CANTCREAT, "cannot write " + file_.string() + ": " + error.message());
  }
  std::string text() const override { return file_.string(); }

 private:
  [[noreturn]] void throw_failed(const platform::ChildEnd& end) const {
    throw picture::ViewerExit(EX_CANTCREAT, "cannot write " + file_.string() + ": ffmpeg, which makes it, " +
                                                (end.is_good() ? "has ended too early" : text_of(end)));
  }

  std::filesystem::path file_;
  std::filesystem::path beside_;  // until it is whole
  const std::atomic<bool>& is_stopping_;
  std::unique_ptr<PipedChild> ffmpeg_;
};

bool is_video(const std::filesystem::path& name) {
  return name.extension() == kVideoExtension;
}

}  // namespace

std::string check_film_name(const std::string& name) {
  const std::filesystem::path path(name);
  const bool is_file = path.has_extension() && path.has_filename() && !std::filesystem::is_directory(path);
  if (!name.empty() && (name == "-" || is_video(path) || !is_file)) return {};
  return "'" + name + "' is no film that can be made: give FILE.mp4, a folder for pictures, or - for standard output";
}

std::unique_ptr<Output> make_film_output(const std::string& name, const Format& format,
                                         const std::atomic<bool>& is_stopping) {
  if (name == "-") return std::make_unique<RawPictures>(is_stopping);
  if (is_video(name)) return std::make_unique<Video>(name, format, is_stopping);
  return std::make_unique<PictureFolder>(name, format);
}

}  // namespace yuragi::viewer::film
