#include "daemon/tools/csv/csv_usual_names.hpp"

#include <array>

namespace yuragi::daemon::tools::csv {
namespace {

constexpr auto kTimeNames = std::to_array<std::string_view>({"timestamp",
                                                             "datetime",
                                                             "isotime",
                                                             "time",
                                                             "obstimeutc",
                                                             "observationtime",
                                                             "valid",
                                                             "validtime",
                                                             "messdatum",
                                                             "lastchanged",
                                                             "lastupdated",
                                                             "datetimelocal",
                                                             "timelocal",
                                                             "localtime",
                                                             "obstimelocal",
                                                             "createdat",
                                                             "formatteddatetime",
                                                             "datumuhrzeit",
                                                             "datumzeit",
                                                             "zeitstempel",
                                                             "zeitpunkt",
                                                             "dateheure",
                                                             "date",
                                                             "datum",
                                                             "unixtime",
                                                             "unix",
                                                             "epoch",
                                                             "ts",
                                                             "uhrzeit",
                                                             "zeit",
                                                             "heure",
                                                             "t",
                                                             "tmstamp",
                                                             "referencetimestamp",
                                                             "timeepoch",
                                                             "hour",
                                                             "hh",
                                                             "clock",
                                                             "mst",
                                                             "est",
                                                             "cst",
                                                             "pst",
                                                             "lst",
                                                             "simpledate",
                                                             "datetimelst",
                                                             "datetimelocaltime",
                                                             "dateandtime",
                                                             "dateandtimestamp"});
constexpr auto kDateNames = std::to_array<std::string_view>(
    {"date", "datum", "yyyymmdd", "datemmddyyyy", "dateddmmyyyy", "dateyyyymmdd", "day", "dt", "jour"});
constexpr auto kSpeedNames = std::to_array<std::string_view>({"speed",
                                                              "windspeed",
                                                              "windspd",
                                                              "wspeed",
                                                              "wspd",
                                                              "ws",
                                                              "wv",
                                                              "ff",
                                                              "ff10",
                                                              "windspeedavg",
                                                              "avgwindspeed",
                                                              "windavg",
                                                              "averagewindspeed",
                                                              "windspeedmean",
                                                              "meanwindspeed",
                                                              "wind",
                                                              "sknt",
                                                              "spd",
                                                              "windvelocity",
                                                              "windgeschwindigkeit",
                                                              "windgeschw",
                                                              "vitesseduvent",
                                                              "vitessevent",
                                                              "windspdms",
                                                              "hourlywindspeed",
                                                              "avgspeed",
                                                              "speedavg",
                                                              "windspeed10",
                                                              "windspeedavg10",
                                                              "sm",
                                                              "wnd",
                                                              "wndspd",
                                                              "wsavg",
                                                              "fkl010z0",
                                                              "fkl010h0",
                                                              "fh",
                                                              "fm",
                                                              "f",
                                                              "windspeedavgms",
                                                              "vent",
                                                              "vento",
                                                              "viento",
                                                              "vind",
                                                              "velocitavento",
                                                              "velocitadelvento",
                                                              "velocidadviento",
                                                              "velocidaddelviento",
                                                              "velocidaddeviento",
                                                              "windsnelheid",
                                                              "vitessemoyenneduvent",
                                                              "vitessevent",
                                                              "wspeedavg",
                                                              "t1ws"});
constexpr auto kDirectionNames = std::to_array<std::string_view>({"direction",
                                                                  "winddirection",
                                                                  "winddir",
                                                                  "wdir",
                                                                  "wd",
                                                                  "dd",
                                                                  "dd10",
                                                                  "dir",
                                                                  "winddirectionavg",
                                                                  "avgwinddirection",
                                                                  "bearing",
                                                                  "windbearing",
                                                                  "drct",
                                                                  "dkl010z0",
                                                                  "dkl010h0",
                                                                  "prevailingwinddirection",
                                                                  "windrichtung",
                                                                  "richtung",
                                                                  "directionduvent",
                                                                  "directionvent",
                                                                  "hourlywinddirection",
                                                                  "winddirectiontrue",
                                                                  "wnddir",
                                                                  "winddirdeg",
                                                                  "winddirectiondegrees",
                                                                  "directiontrue",
                                                                  "dm",
                                                                  "vane",
                                                                  "d",
                                                                  "direzionevento",
                                                                  "direzionedelvento",
                                                                  "direccionviento",
                                                                  "direcciondelviento",
                                                                  "direcciondeviento",
                                                                  "windrichting",
                                                                  "t1wdir",
                                                                  "direction10m"});
constexpr auto kGustNames = std::to_array<std::string_view>({"gust",
                                                             "windgust",
                                                             "windgusts",
                                                             "windspeedgust",
                                                             "windboee",
                                                             "fkl010z1",
                                                             "fkl010h1",
                                                             "gustspeed",
                                                             "gusts",
                                                             "windgustspeed",
                                                             "wgust",
                                                             "maxwindspeed",
                                                             "windspeedmax",
                                                             "speedgust",
                                                             "gst",
                                                             "highwindspeed",
                                                             "hispeed",
                                                             "hiwindspeed",
                                                             "highspeed",
                                                             "wpgt",
                                                             "sx",
                                                             "fx10",
                                                             "fx",
                                                             "fx911",
                                                             "fxx",
                                                             "windgustmax",
                                                             "maxdailygust",
                                                             "boe",
                                                             "boeen",
                                                             "windboe",
                                                             "windboen",
                                                             "windboeen",
                                                             "boeengeschwindigkeit",
                                                             "rafale",
                                                             "rafales",
                                                             "hourlywindgustspeed",
                                                             "peakwindspeed",
                                                             "maxspeed",
                                                             "maxgust",
                                                             "gustkmh",
                                                             "boee",
                                                             "boeenmax",
                                                             "windboeenmax",
                                                             "raffica",
                                                             "raffiche",
                                                             "rafficavento",
                                                             "rafficadivento",
                                                             "racha",
                                                             "rachas",
                                                             "rachaviento",
                                                             "rachadeviento",
                                                             "rafaga",
                                                             "rafagas",
                                                             "rafaledevent",
                                                             "rafalesdevent",
                                                             "rafalemax",
                                                             "windstoot",
                                                             "windstoten",
                                                             "maxwv",
                                                             "windgustspd",
                                                             "t1wgust"});
constexpr auto kUNames = std::to_array<std::string_view>(
    {"u", "uwind", "windu", "ucomponent", "ugrd", "eastward", "u10", "ux", "eastwardwind"});
constexpr auto kVNames = std::to_array<std::string_view>(
    {"v", "vwind", "windv", "vcomponent", "vgrd", "northward", "v10", "uy", "northwardwind"});
constexpr auto kVerticalNames = std::to_array<std::string_view>(
    {"w", "wwind", "windw", "wcomponent", "uz", "verticalspeed", "verticalwind", "verticalwindspeed"});
constexpr auto kTemperatureNames = std::to_array<std::string_view>({"airtemperature",
                                                                    "temperature",
                                                                    "temp",
                                                                    "airtemp",
                                                                    "outdoortemperature",
                                                                    "outtemp",
                                                                    "outsidetemp",
                                                                    "tempout",
                                                                    "outdoortemp",
                                                                    "temperatureoutdoor",
                                                                    "tmp",
                                                                    "airt",
                                                                    "airtc",
                                                                    "atmp",
                                                                    "ta",
                                                                    "tt10",
                                                                    "tre200s0",
                                                                    "tre200h0",
                                                                    "drybulbtemperature",
                                                                    "hourlydrybulbtemperature",
                                                                    "lufttemperatur",
                                                                    "temperatur",
                                                                    "t2m",
                                                                    "t",
                                                                    "temperaturaussen",
                                                                    "aussentemperatur",
                                                                    "drybulb",
                                                                    "t1tem"});
constexpr auto kPressureNames = std::to_array<std::string_view>({"pressure",
                                                                 "stationpressure",
                                                                 "airpressure",
                                                                 "surfacepressure",
                                                                 "absolutepressure",
                                                                 "baromabs",
                                                                 "baromabsin",
                                                                 "barometer",
                                                                 "barom",
                                                                 "baro",
                                                                 "bar",
                                                                 "pres",
                                                                 "press",
                                                                 "barometricpressure",
                                                                 "pressuremsl",
                                                                 "sealevelpressure",
                                                                 "relativepressure",
                                                                 "baromrel",
                                                                 "baromrelin",
                                                                 "mslp",
                                                                 "luftdruck",
                                                                 "hourlystationpressure",
                                                                 "bp",
                                                                 "p",
                                                                 "stnpress",
                                                                 "stnpressure",
                                                                 "abspressure",
                                                                 "absluftdruck"});
constexpr auto kHumidityNames = std::to_array<std::string_view>({"relativehumidity",
                                                                 "humidity",
                                                                 "rh",
                                                                 "relhum",
                                                                 "relh",
                                                                 "rhum",
                                                                 "outdoorhumidity",
                                                                 "outhumidity",
                                                                 "outhum",
                                                                 "humout",
                                                                 "humidityoutdoor",
                                                                 "outsidehum",
                                                                 "luftfeuchte",
                                                                 "relativefeuchte",
                                                                 "hourlyrelativehumidity",
                                                                 "hum",
                                                                 "airrh",
                                                                 "luftfeuchtigkeit",
                                                                 "luftfeuchtigkeitaussen",
                                                                 "relhumidity"});
// Not "rain" and the like: the amount of an interval is no counter.
constexpr auto kRainTotalNames =
    std::to_array<std::string_view>({"raintotal", "totalrain", "raincounter", "rainaccumulated"});
constexpr auto kRainRateNames = std::to_array<std::string_view>(
    {"rainrate", "rainintensity", "hourlyrainrate", "rainfallrate", "precipitationrate", "preciprate"});

}  // namespace

std::span<const std::string_view> usual_names(Role role) {
  switch (role) {
    case Role::kTime:
      return kTimeNames;
    case Role::kDate:
      return kDateNames;
    case Role::kSpeed:
      return kSpeedNames;
    case Role::kDirection:
      return kDirectionNames;
    case Role::kGust:
      return kGustNames;
    case Role::kU:
      return kUNames;
    case Role::kV:
      return kVNames;
    case Role::kVerticalSpeed:
      return kVerticalNames;
    case Role::kTemperature:
      return kTemperatureNames;
    case Role::kPressure:
      return kPressureNames;
    case Role::kHumidity:
      return kHumidityNames;
    case Role::kRainTotal:
      return kRainTotalNames;
    case Role::kRainRate:
      return kRainRateNames;
    case Role::kElapsed:
    case Role::kQuality:
    case Role::kSensor:
      break;  // only in yuragi's own exports
  }
  return {};
}

}  // namespace yuragi::daemon::tools::csv
