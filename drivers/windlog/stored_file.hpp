#pragma once

#include <filesystem>
#include <memory>
#include <stop_token>

#include "drivers/windlog/sqlite.hpp"
#include "drivers/windlog/stored_readings.hpp"

namespace yuragi::drivers::windlog {

/// One file of a recording, opened to be read.
struct StoredFile {
  std::unique_ptr<sqlite::Database> database;  // stays where it is: what follows refers to it
  std::unique_ptr<StoredReadings> readings;
};

/// Fails if there is no such file (kNoInput), or it is a folder or a device (kBadData).
Result<void, Failure> check_is_file(const std::filesystem::path& file);

/// Returns true if it is a file that a writer had created, and was killed before it wrote to it.
bool is_blank_file(const std::filesystem::path& file);

/// Opens a file of any version of the format that this one reads. As Reader::open(). A snapshot is read as it is
/// at this moment, independent of its writer; its readings must not be merged with their database.
Result<StoredFile, Failure> open_stored_file(const std::filesystem::path& file, const std::stop_token& stop,
                                             bool is_snapshot = false);

}  // namespace yuragi::drivers::windlog
