#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

namespace yuragi::drivers::windlog {

// A recording (.windlog) is one SQLite database, so that it survives a power cut, seeks by time, and opens in any tool:
//
//   sqlite3 FILE.windlog "SELECT datetime(utc_ns / 1e9, 'unixepoch'), speed_m_s FROM reading LIMIT 10"
//
// It is in WAL mode while it is written (FILE.windlog-wal and -shm beside it) and one file when it is closed. Each
// start of the daemon adds a session.
//
// Version 2, which is written: each sensor's name has a table of readings of its own, whose row ids are their times. So
// any sensor is read from any time on without a look at the others', and a reading takes 38 bytes (46 with a gust).
// Version 1, which can still be read: one table of readings of all sensors, with an index by time. A reader refuses
// newer ones.

/// Suffixes of SQLite's files beside an open recording; if one of them is left, the recorder was killed, and it
/// contains the newest readings.
inline constexpr std::string_view kWalSuffix = "-wal";
inline constexpr std::array<std::string_view, 3> kSideSuffixes = {kWalSuffix, "-shm", "-journal"};

inline constexpr std::int64_t kApplicationId = 0x59724c67;  ///< "YrLg"; `file` and `PRAGMA application_id` show it
inline constexpr std::int64_t kFormatVersion = 2;           ///< `PRAGMA user_version`

/// Times outside are not times of a wind: they could not be subtracted without overflow. About 146 years.
inline constexpr std::int64_t kMaxTime_ns = std::numeric_limits<std::int64_t>::max() / 2;

/// So many names of sensors one recording can hold: a query over all of them joins no more tables.
inline constexpr std::size_t kMaxSeries = 480;

/// The comments stay in the file and explain it to its readers.
inline constexpr const char* kSchema = R"sql(
CREATE TABLE session (  -- one run of the program that recorded
  id              INTEGER PRIMARY KEY,
  begin_ns        INTEGER NOT NULL UNIQUE,  -- its start on the recording's time line, on which sessions follow each other
  started_utc_ns  INTEGER NOT NULL,  -- since 1970-01-01T00:00:00Z
  started_mono_ns INTEGER NOT NULL,  -- on that machine's clock that is never set; comparable inside a session only
  software        TEXT NOT NULL,
  configuration   TEXT NOT NULL      -- TOML
) STRICT;
CREATE TABLE series (  -- a sensor's name; the readings of series 1 are in the table reading_1
  id   INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE
) STRICT;
CREATE TABLE sensor (
  id      INTEGER PRIMARY KEY,
  session INTEGER NOT NULL REFERENCES session (id),
  series  INTEGER NOT NULL REFERENCES series (id),
  driver  TEXT NOT NULL,
  options TEXT NOT NULL
) STRICT;
)sql";

/// The columns of a series' table.
inline constexpr std::string_view kSeriesColumns = R"sql((  -- as decoded, before calibration
  time_ns       INTEGER PRIMARY KEY,  -- on the recording's time line
  clock_ns      INTEGER NOT NULL,     -- UTC less started_utc_ns + (time_ns - begin_ns): large where the clock was set
  speed_m_s     REAL NOT NULL,
  direction_deg REAL,                 -- where the wind comes from, clockwise from north; NULL: not known
  gust_m_s      REAL,                 -- NULL: not told
  quality       INTEGER NOT NULL      -- 0 good, 1 uncertain, 2 simulated
) STRICT)sql";

/// Other quantities of stations. A file has this table from the first such row on; one without it is complete, too.
/// Older programs read and continue a file that has it. At most one row a sensor and second: later values in the same
/// second are added to the row, and replace those of the same quantity. The columns that follow are
/// wind::kStationQuantities, each REAL or NULL (not sent).
inline constexpr std::string_view kQuantityTable = "quantity";
inline constexpr std::string_view kQuantityKeys = R"sql((  -- as decoded
  time_ns  INTEGER NOT NULL,  -- on the recording's time line: whole seconds after the session's begin_ns
  series   INTEGER NOT NULL,
  clock_ns INTEGER NOT NULL,  -- UTC less started_utc_ns + (time_ns - begin_ns), as in the tables of readings)sql";
inline constexpr std::string_view kQuantityPrimaryKey = "\n  PRIMARY KEY (time_ns, series)\n) STRICT, WITHOUT ROWID";

/// The counts of each series in a closed session, which `yuragi verify` compares. A session that was not closed, or is
/// of an older program, has no row. The checksum is SessionCount's.
inline constexpr std::string_view kSessionCountTable = "session_count";
inline constexpr std::string_view kSessionCountColumns = R"sql((  -- written when the session was closed
  session  INTEGER NOT NULL,
  series   INTEGER NOT NULL,
  readings INTEGER NOT NULL,
  checksum INTEGER NOT NULL,  -- of all readings of the session and series, in any order
  PRIMARY KEY (session, series)
) STRICT, WITHOUT ROWID)sql";

/// The completed file before this one in a series, by the moment in its name: one row, or no such table.
inline constexpr std::string_view kPreviousPartTable = "previous_part";
inline constexpr std::string_view kPreviousPartColumns = R"sql((  -- the file before this one in the series
  begin_utc_ns INTEGER NOT NULL  -- the moment in its name
) STRICT)sql";

}  // namespace yuragi::drivers::windlog
