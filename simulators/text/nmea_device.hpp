#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "simulators/text/text_simulator.hpp"

namespace yuragi::simulators::text {

/// The formats of make_nmea_device(): mwv, mwd, vwr, vwt, mda, xdr, gill, gill-uv, ft, umb.
std::vector<std::string> nmea_format_names();

/// An anemometer that sends its wind in one or several of those formats, one after the other in one burst. Throws
/// std::runtime_error for an unknown format.
std::unique_ptr<Device> make_nmea_device(const std::vector<std::string>& formats);

/// Returns true if a device of this format sends only on request.
bool is_only_polled(std::string_view nmea_format);

}  // namespace yuragi::simulators::text
