#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

namespace yuragi::drivers::windlog {

// A recording (.windlog) is one SQLite database, so that it survives a power cut, seeks by time, and opens in any tool:
//
//   sqlite3 FILE.windlog "SELECT datetime(utc_ns / 1e9, 'unixepoch'), speed_m_s FROM reading LIMIT 10"
//
// It is in WAL mode while it is written (FILE.windlog-wal and -shm beside it) and one file when it is closed. Each
// start of the daemon adds a session. Version 1; a reader refuses a newer one.

/// What SQLite keeps beside a recording while it is open, by the end of its name; where one of them is left, the
/// recorder was killed, and it holds the newest readings.
inline constexpr std::string_view kWalSuffix = "-wal";
inline constexpr std::array<std::string_view, 3> kSideSuffixes = {kWalSuffix, "-shm", "-journal"};

inline constexpr std::int64_t kApplicationId = 0x59724c67;  ///< "YrLg"; `file` and `PRAGMA application_id` show it
inline constexpr std::int64_t kFormatVersion = 1;           ///< `PRAGMA user_version`

/// Times outside are not times of a wind: they could not be subtracted without overflow. About 146 years.
inline constexpr std::int64_t kMaxTime_ns = std::numeric_limits<std::int64_t>::max() / 2;

/// The comments stay in the file and explain it to its readers.
inline constexpr const char* kSchema = R"sql(
CREATE TABLE session (  -- one run of the program that recorded
  id              INTEGER PRIMARY KEY,
  started_utc_ns  INTEGER NOT NULL,  -- since 1970-01-01T00:00:00Z
  started_mono_ns INTEGER NOT NULL,  -- on that machine's clock that is never set; comparable inside a session only
  software        TEXT NOT NULL,
  configuration   TEXT NOT NULL      -- TOML
) STRICT;
CREATE TABLE sensor (
  id      INTEGER PRIMARY KEY,
  session INTEGER NOT NULL REFERENCES session (id),
  name    TEXT NOT NULL,
  driver  TEXT NOT NULL,
  options TEXT NOT NULL
) STRICT;
CREATE TABLE reading (  -- as decoded, before calibration
  session       INTEGER NOT NULL REFERENCES session (id),
  sensor        INTEGER NOT NULL REFERENCES sensor (id),
  utc_ns        INTEGER NOT NULL,
  mono_ns       INTEGER NOT NULL,
  speed_m_s     REAL NOT NULL,
  direction_deg REAL,             -- where the wind comes from, clockwise from north; NULL: not known
  gust_m_s      REAL,             -- NULL: not told
  quality       INTEGER NOT NULL  -- 0 good, 1 uncertain, 2 simulated
) STRICT;
CREATE INDEX reading_by_time ON reading (session, mono_ns);
)sql";

}  // namespace yuragi::drivers::windlog
