#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/tools/csv/csv_columns.hpp"
#include "daemon/tools/csv/csv_options.hpp"
#include "daemon/tools/logs/log_message.hpp"

namespace yuragi::daemon::tools::logs {

/// The names and values in a line, and what stands before them.
struct KeyedLine {
  std::string_view prefix = {};
  std::vector<std::string> keys = {};
  std::vector<std::string> values = {};
};

/// Takes a line apart that is a JSON object ({"wind": {"speed": 4.2}} has the key "wind.speed"), a form that a station
/// pushes (a=1&b=2, or a request with one), or text ("speed=4.2 direction: 270"). Nullopt if it is none of them.
/// Thread-safe: yes.
std::optional<KeyedLine> split_keyed_line(std::string_view line);

/// Reads lines whose keys name the wind, as the columns of a table do (choose_columns): "wind_avg_m_s", "windspeedmph".
/// A program can print one key a line; lines are then one message until a key comes again. Thread-safe: no.
class KeyReader {
 public:
  /// Uses `columns`, `unit`, `gust_unit` and the options of directions.
  explicit KeyReader(const csv::ImportOptions& options) : options_(options) {}

  /// The message in a line, or, of one key a line, the one that it ends; nullopt if there is none.
  std::optional<Message> take(std::string_view line);
  /// Returns true if the last line that was taken is a part of a message that goes on.
  bool has_absorbed() const { return has_absorbed_; }
  /// Returns true if the last line that was taken has several keys, of a wind or not.
  bool has_keys() const { return has_keys_; }
  /// The last one of one key a line.
  std::optional<Message> finish();

  /// How the keys of a source were understood, a line each; empty if it is not one of keys.
  std::vector<std::string> describe(std::string_view source) const;

 private:
  /// What is known of lines with the same keys.
  struct Form {
    std::vector<std::string> keys = {};
    std::optional<csv::Columns> columns = std::nullopt;  ///< nullopt: they have no wind
    std::string source = {};
    std::string failure = {};
  };

  const Form& form_of(const KeyedLine& line);
  std::optional<Message> message_of(const KeyedLine& line);

  csv::ImportOptions options_;
  std::vector<Form> forms_;  ///< the newest last; bounded
  KeyedLine block_;          ///< of one key a line
  std::string block_prefix_;
  bool has_absorbed_ = false;
  bool has_keys_ = false;
};

}  // namespace yuragi::daemon::tools::logs
