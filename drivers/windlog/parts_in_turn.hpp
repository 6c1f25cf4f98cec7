#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "drivers/windlog/file_identity.hpp"
#include "drivers/windlog/stored_file.hpp"
#include "drivers/windlog/stored_readings.hpp"

namespace yuragi::drivers::windlog {

/// The content of a recording that is a series of files: one after the other on the line of log time, with the UTC gap
/// between two (at least zero). Its ids of sessions count through all files. Only the file that is read is open.
class PartsInTurn final : public StoredReadings {
 public:
  /// Opens each file, oldest first, for what it contains. A file without readings adds only its quantities, and a
  /// damaged one nothing; fails if no file can be read, and with the first failure.
  static Result<std::unique_ptr<PartsInTurn>, Failure> open(const std::vector<std::filesystem::path>& files,
                                                            const std::stop_token& stop);

  Result<std::vector<std::unique_ptr<ReadingBlocks>>, Failure> blocks(
      const std::vector<bool>& of_sensors) const override;
  Result<std::string, Failure> configuration(std::int64_t session) const override;
  Result<std::optional<Nanoseconds>, Failure> log_time_of(UtcTime moment) const override;
  Result<std::optional<Nanoseconds>, Failure> last_log_time(const std::vector<bool>& of_sensors) const override;

  Result<std::size_t, Failure> each_quantities(Nanoseconds from, Nanoseconds to,
                                               const UseQuantities& use) const override;

  /// A file, and where its sensors and its log time begin in the whole.
  struct Part {
    std::filesystem::path file;
    std::optional<FileIdentity> identity;  ///< the writer may rename it meanwhile, and give its name to the next
    Nanoseconds log_begin{0};
    Nanoseconds log_end{0};
    std::size_t first_sensor = 0;
    std::size_t sensor_count = 0;
    UtcTime last{};  ///< its last reading; without any, when it was begun
  };

  std::vector<std::string> damage() const override { return damage_; }
  /// Is this failure one of the part's data, so that the rest of the part is left out? Then it is noted in damage().
  /// A failing disk, or a request to stop, is not: the same place must be tried again.
  bool leave_out_rest(const Part& part, const std::optional<UtcTime>& read_to, const Failure& failure) const;

  const std::vector<Part>& parts() const { return parts_; }
  /// The flags of a part's own sensors.
  static std::vector<bool> flags_of(const Part& part, const std::vector<bool>& of_sensors);
  /// Opens it by the name that it has now.
  Result<StoredFile, Failure> open_part(const Part& part) const;

 private:
  Result<void, Failure> add(const std::filesystem::path& file);

  void leave_out(const std::filesystem::path& file, const std::string& span, const Failure& failure) const;

  std::stop_token stop_;
  mutable std::vector<std::string> damage_;
  mutable std::set<std::filesystem::path> damaged_files_;
  std::vector<Part> parts_;
  std::vector<std::pair<std::size_t, std::int64_t>> session_places_;  ///< of session 1, 2, ...: its part, its id there
};

}  // namespace yuragi::drivers::windlog
