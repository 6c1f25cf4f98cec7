// Any bytes as the input of `yuragi decode`, in any format and with any policy: what comes out is sound, or refused.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "tests/support/decoded_units.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace yuragi;
  if (size < 2) return 0;
  const auto formats = daemon::tools::decode::unit_formats();
  const daemon::tools::decode::UnitFormat& format = formats[data[0] % formats.size()];
  const auto bit = [&](unsigned number) { return ((data[1] >> number) & 1U) != 0; };
  daemon::tools::decode::UnitDecoderOptions options;
  if (bit(0)) options.makers_checksum = drivers::decode::WhenMissing::kAccept;
  if (bit(1)) options.checksum = options.status = drivers::decode::WhenMissing::kRefuse;
  options.are_reports = bit(2);
  if (bit(3)) options.interval_s = 0.5;
  if (bit(4)) options.vane_reference_v = 5.0;
  options.profile = "renke-rs-fsjt-rs-fxjt-n01";
  const bool is_hex = bit(5) || !format.is_text;
  const std::size_t piece = bit(6) ? 7 : 4096;
  test::decode_units(format, options, is_hex, drivers::decode::ByteSpan(data, size).subspan(2), piece,
                     [](const daemon::tools::decode::UnitDecoder::Outcome& outcome) {
                       if (outcome && !test::is_sound(*outcome)) std::abort();
                     });
  return 0;
}
