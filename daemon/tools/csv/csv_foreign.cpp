#include "daemon/tools/csv/csv_foreign.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "daemon/tools/csv/csv_encoding.hpp"
#include "daemon/tools/csv/csv_words.hpp"

namespace yuragi::daemon::tools::csv {
namespace {

struct Kind {
  std::string_view begin;  ///< in lower case
  std::string_view what;
};

using namespace std::string_view_literals;

constexpr std::array kKinds = {
    Kind{"sqlite format 3\0"sv,
         "a recording of Yuragi or another SQLite database: `yuragi export` writes a recording as CSV"},
    Kind{"\x89png"sv, "a picture (PNG)"},
    Kind{"\xFF\xD8\xFF"sv, "a photo (JPEG)"},
    Kind{"gif8"sv, "a picture (GIF)"},
    Kind{"%pdf"sv, "a document (PDF)"},
    Kind{"pk\x03\x04"sv, "a spreadsheet or an archive (ZIP): save the sheet as CSV, or unpack the archive"},
    Kind{"\x1F\x8B"sv, "compressed (gzip): unpack it first, or use zcat FILE | yuragi import -"},
    Kind{"bzh"sv, "compressed (bzip2): unpack it first"},
    Kind{"\xFD\x37zxz"sv, "compressed (xz): unpack it first"},
    Kind{"\x89hdf"sv, "HDF5 or NetCDF: save its table as CSV first"},
    Kind{"cdf\x01"sv, "NetCDF: save its table as CSV first"},
    Kind{"cdf\x02"sv, "NetCDF: save its table as CSV first"},
    Kind{"grib"sv, "GRIB: save its table as CSV first"},
    Kind{"<!doctype html"sv, "a web page (HTML): download the file itself"},
    Kind{"<html"sv, "a web page (HTML): download the file itself"},
    Kind{"<?xml"sv, "XML: save its table as CSV first"},
    Kind{"<gpx"sv, "a track of a GPS (GPX), which has no wind"},
};

}  // namespace

std::optional<std::string_view> foreign_kind(std::string_view beginning) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (beginning.starts_with(kByteOrderMark)) beginning.remove_prefix(kByteOrderMark.size());
  constexpr std::size_t kLongest = 16;
  const auto first = std::min(beginning.find_first_not_of(" \t\r\n"), beginning.size());
  const std::string start = lower(beginning.substr(first, kLongest));
  const auto* const found =
      std::ranges::find_if(kKinds, [&](const Kind& kind) { return start.starts_with(kind.begin); });
  if (found != kKinds.end()) return found->what;
  const Encoding encoding = encoding_of(beginning);
  const bool has_wide_characters = encoding == Encoding::kUtf16Little || encoding == Encoding::kUtf16Big;
  if (!has_wide_characters && beginning.find('\0') != std::string_view::npos) return "binary data";
  return std::nullopt;
}

}  // namespace yuragi::daemon::tools::csv
