#include "drivers/hid/hid_station.hpp"

#include <array>

namespace yuragi::drivers::hid {

std::span<const StationKind> station_kinds() {
  static constexpr std::array<StationKind, 5> kKinds = {
      {{"wmr100", "Oregon Scientific WMR100", {0x0FDE, 0xCA01}, make_wmr100_station},
       {"wmr300", "Oregon Scientific WMR300", {0x0FDE, 0xCA08}, make_wmr300_station},
       {"fineoffset", "Fine Offset WH1080 or WH3080", {0x1941, 0x8021}, make_fineoffset_station},
       {"acurite", "AcuRite 01035", {0x24C0, 0x0003}, make_acurite_station},
       {"te923", "Hideki TE923", {0x1130, 0x6801}, make_te923_station}}};
  return kKinds;
}

}  // namespace yuragi::drivers::hid
