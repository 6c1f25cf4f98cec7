#pragma once

#include <string>

#include "engine/wind/shaping/wind_shaping.hpp"

namespace yuragi::daemon::shaping {

/// The state of the opening hours.
struct OpeningNews {
  bool has_hours = false;
  bool is_open = true;
  std::string until;  ///< OpeningHours::until_text
};

/// Returns true if the floor raises the mean by more than this share of the result.
bool is_raised(const wind::shaping::WindShapingReport& report, double share = 0.02);

/// What is shaping the wind at present, in one line: "site gain 1.80 (in 5 days 3 h
/// median 1.2, strong 3.9 m/s); floor: raised 0.6 to 1.5 m/s; gusts 2.00 times the real ones; closed until 10:00".
/// Empty if nothing is.
std::string shaping_text(const wind::shaping::WindShapingReport& report,
                         const wind::shaping::WindShapingSettings& settings, const OpeningNews& opening);

}  // namespace yuragi::daemon::shaping
