#pragma once

#include <memory>

#include "daemon/settings/config.hpp"
#include "engine/wind/turbulence/site_spectrum.hpp"

namespace yuragi {

/// How far the gusts of the default wind reach, m: [wind] default_length where it is set, or 57, as over open land at a
/// height of 10 m. Pure.
double default_gust_length_m(const Config& config);

/// Does the height of a sensor say how far its gusts reach?
bool is_length_by_height(const Config& config, const SensorConfig& sensor);

/// What the gusts of a sensor are taken for, until and as far as it tells of them itself, m: [wind] default_length
/// where it is set; or by the height that its calibration tells, 8.1 * 0.7 times it up to 60 m (IEC 61400-1); or the
/// default wind's. Where the calibration brings the speeds to another height, the length goes with them: what is
/// measured goes on passing the sensor in the same time. Pure.
double gust_length_m(const Config& config, const SensorConfig& sensor);

/// What a configuration expects of its site, with nothing learnt.
std::shared_ptr<SiteSpectrum> make_site_spectrum(const Config& config);

/// Is a recording to be played when all sensors are silent?
bool has_fallback(const Config& config);

}  // namespace yuragi
