#include "daemon/pictures/jpeg_picture.hpp"

#include <array>
#include <csetjmp>
#include <cstdio>
#include <string>

#include <jpeglib.h>

#include "daemon/pictures/picture_size.hpp"

namespace yuragi::daemon::pictures {
namespace {

/// A decoder and the jump target for an error, which is the only way out of libjpeg. Functions that set the jump must
/// have no objects with destructors.
struct JpegReading {
  jpeg_decompress_struct decoder{};
  jpeg_error_mgr errors{};
  std::jmp_buf on_error{};
  std::array<char, JMSG_LENGTH_MAX> message{};
  bool has_warned = false;
  jpeg_progress_mgr progress{};
  bool has_many_scans = false;
};

JpegReading& reading_of(j_common_ptr decoder) {
  return *static_cast<JpegReading*>(decoder->client_data);
}

[[noreturn]] void leave(j_common_ptr decoder) {
  JpegReading& reading = reading_of(decoder);
  decoder->err->format_message(decoder, reading.message.data());
  std::longjmp(reading.on_error, 1);  // NOLINT(cert-err52-cpp): libjpeg's way
}

/// A file that ends too early, or has wrong bytes, is only a warning to libjpeg, and grey. Remembers the first.
void remember_warning(j_common_ptr decoder, int level) {
  JpegReading& reading = reading_of(decoder);
  if (level >= 0 || reading.has_warned) return;
  reading.has_warned = true;
  decoder->err->format_message(decoder, reading.message.data());
}

/// Called by libjpeg again and again as it reads: a progressive file may have any number of scans, and each costs time
/// as the whole picture does.
void refuse_many_scans(j_common_ptr decoder) {
  const int scans = reinterpret_cast<j_decompress_ptr>(decoder)->input_scan_number;
  if (scans <= kMaxJpegScans) return;
  JpegReading& reading = reading_of(decoder);
  reading.has_many_scans = true;
  std::longjmp(reading.on_error, 1);  // NOLINT(cert-err52-cpp): libjpeg's way
}

bool read_jpeg_header(JpegReading& reading, const std::uint8_t* bytes, std::size_t size) {
  if (setjmp(reading.on_error) != 0) return false;  // NOLINT(cert-err52-cpp)
  jpeg_create_decompress(&reading.decoder);
  reading.decoder.progress = &reading.progress;
  jpeg_mem_src(&reading.decoder, bytes, static_cast<unsigned long>(size));
  jpeg_read_header(&reading.decoder, TRUE);
  reading.decoder.out_color_space = JCS_RGB;
  return true;
}

bool read_jpeg_pixels(JpegReading& reading, std::uint8_t* rgb) {
  if (setjmp(reading.on_error) != 0) return false;  // NOLINT(cert-err52-cpp)
  jpeg_start_decompress(&reading.decoder);
  const std::size_t row_bytes = std::size_t{3} * reading.decoder.output_width;
  while (reading.decoder.output_scanline < reading.decoder.output_height) {
    JSAMPROW row = rgb + row_bytes * reading.decoder.output_scanline;
    jpeg_read_scanlines(&reading.decoder, &row, 1);
  }
  jpeg_finish_decompress(&reading.decoder);
  return !reading.has_warned;
}

Failure damaged_jpeg(const JpegReading& reading) {
  if (reading.has_many_scans) {
    return {.message = "has more than " + std::to_string(kMaxJpegScans) + " scans; save it anew, not progressive",
            .kind = FailureKind::kBadData};
  }
  return {.message =
              "is a JPEG file that cannot be read (" + std::string(reading.message.data()) + "); save it anew, in RGB",
          .kind = FailureKind::kBadData};
}

}  // namespace

bool is_jpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF;
}

Result<look::Image, Failure> decoded_jpeg(std::span<const std::uint8_t> bytes) {
  JpegReading reading;
  reading.decoder.err = jpeg_std_error(&reading.errors);
  reading.decoder.client_data = &reading;
  reading.errors.error_exit = leave;
  reading.errors.emit_message = remember_warning;
  reading.progress.progress_monitor = refuse_many_scans;
  const struct Closed {
    jpeg_decompress_struct* decoder;
    ~Closed() { jpeg_destroy_decompress(decoder); }
  } closed{&reading.decoder};

  if (!read_jpeg_header(reading, bytes.data(), bytes.size())) return damaged_jpeg(reading);
  const std::uint32_t width_px = reading.decoder.image_width;
  const std::uint32_t height_px = reading.decoder.image_height;
  if (auto size = checked_size(width_px, height_px); !size) return size.error();
  look::Image pixels{.width_px = width_px, .height_px = height_px, .rgb = {}};
  pixels.rgb.resize(std::size_t{3} * width_px * height_px);
  if (!read_jpeg_pixels(reading, pixels.rgb.data())) return damaged_jpeg(reading);
  return pixels;
}

}  // namespace yuragi::daemon::pictures
