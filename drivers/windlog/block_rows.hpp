#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/windlog/logged.hpp"
#include "drivers/windlog/sqlite.hpp"
#include "engine/base/result.hpp"

namespace yuragi::drivers::windlog {

/// Reads the rows of a statement whose parameters are bound, up to its limit, and resets it. `logged_in_row()` returns
/// the reading in the current row, nullopt if it cannot be a reading, or a Failure if the rows can no longer be
/// followed. Adds the readings of the wanted sensors to `block`, and the rows that cannot be readings to `skipped`;
/// after a failure `block` is empty and `skipped` as it was. Returns the number of rows.
template <class LoggedInRow>
Result<std::int64_t, Failure> read_block(const sqlite::Database& database, sqlite::Statement& select,
                                         const std::vector<bool>& of_sensors, LoggedInRow logged_in_row,
                                         std::vector<LoggedReading>& block, std::size_t& skipped) {
  using Step = sqlite::Statement::Step;
  std::int64_t rows = 0;
  std::size_t passed_over = 0;
  std::optional<Failure> failure;
  Step step = select.step();
  for (; step == Step::kRow; step = select.step(), ++rows) {
    const Result<std::optional<LoggedReading>, Failure> logged = logged_in_row();
    if (!logged) {
      failure = logged.error();
      break;
    }
    if (!*logged) {
      ++passed_over;
    } else if (of_sensors[(*logged)->sensor]) {
      block.push_back(**logged);
    }
  }
  if (step == Step::kFailed) failure = database.failure();
  select.reset();
  if (failure) {
    block.clear();
    return *failure;
  }
  skipped += passed_over;
  return rows;
}

}  // namespace yuragi::drivers::windlog
