"""Samples of CSV files as loggers, stations and archives write them, and a reader of each in plain Python.

Each sample is written after the maker's or archive's own description (drivers/SOURCES.md S12), with marks for
missing values where the format has them. The readers share nothing with the program but the knowledge of the format.
"""
import csv
import dataclasses
import datetime
import io
import math
import random
import zoneinfo

UTC = datetime.timezone.utc
KMH, KNOT, MPH = 1 / 3.6, 1852 / 3600, 0.44704
POINTS = "N NNE NE ENE E ESE SE SSE S SSW SW WSW W WNW NW NNW".split()
BEGIN = datetime.datetime(2023, 6, 25, 22, 0, tzinfo=UTC)


@dataclasses.dataclass
class Sample:
    name: str
    text: str
    read: object  # text -> [(utc, speed m/s, direction or None, gust or None)]
    options: tuple = ()
    refused: int = 0
    told: tuple = ()  # what the report must say
    units: str = "m/s"  # of speed, as found
    encoding: str = "utf-8"
    weather: dict = dataclasses.field(default_factory=dict)  # of the first row: quantity: value


@dataclasses.dataclass
class Moment:
    utc: datetime.datetime
    speed: float  # in the format's unit
    gust: float
    direction: int
    temperature: float


def moments(count, step, scale=1.0, seed=1, decimals=1):
    draw = random.Random(seed)
    for i in range(count):
        speed = round(abs(draw.gauss(4.0, 1.5)) * scale, decimals)
        yield Moment(BEGIN + i * step, speed, round(speed * (1.2 + draw.random()), decimals), draw.randrange(1, 360),
                     round(draw.gauss(18.0, 2.0), 1))


def minutes(count):
    return datetime.timedelta(minutes=count)


def table(text, delimiter=",", skip=1, comment=None):
    """The rows below `skip` lines; with a delimiter of None blanks separate."""
    lines = [line for line in text.splitlines()[skip:] if line.strip() and not (comment and line.startswith(comment))]
    if delimiter is None:
        return [line.split() for line in lines]
    return [[field.strip() for field in row] for row in csv.reader(io.StringIO("\n".join(lines)), delimiter=delimiter)]


def number(text, scale=1.0, missing=()):
    if text in missing or text == "":
        return None
    return float(text.replace(",", ".")) * scale


def moment(text, pattern, zone=UTC):
    return datetime.datetime.strptime(text, pattern).replace(tzinfo=zone).astimezone(UTC)


def readings(rows):
    """Those that have a speed."""
    return [row for row in rows if row[1] is not None]


SAMPLES = []


def sample(function):
    SAMPLES.append(function())
    return function


@sample
def campbell_toa5():
    lines = ['"TOA5","CR1000X","CR1000X","12345","CR1000X.Std.05.01","CPU:wind.CR1X","1234","Wind10"',
             '"TIMESTAMP","RECORD","WS_ms_S_WVT","WindDir_D1_WVT","WindDir_SD1_WVT","WS_ms_Max","AirTC_Avg"',
             '"TS","RN","meters/second","Deg","Deg","meters/second","Deg C"', '"","","WVc","WVc","WVc","Max","Avg"']
    for i, m in enumerate(moments(40, minutes(10), decimals=3)):
        missing = i in (5, 6)
        lines.append(f'"{m.utc:%Y-%m-%d %H:%M:%S}",{i},{chr(34) + "NAN" + chr(34) if missing else m.speed},{m.direction},'
                     f'12.3,{m.gust},{m.temperature}')
    return Sample("Campbell TOA5", "\n".join(lines) + "\n",
                  lambda text: readings((moment(r[0], "%Y-%m-%d %H:%M:%S"), number(r[2], missing=("NAN",)), float(r[3]), float(r[5]))
                                        for r in table(text, skip=4)), refused=2,
                  told=("from the row of units",), weather={"air_temperature_c": None})


@sample
def hobo():
    lines = ['"Plot Title: garden"', '"#","Date Time, GMT-07:00","Wind Speed, m/s (LGR S/N: 10, SEN S/N: 11)",'
             '"Gust Speed, m/s (LGR S/N: 10, SEN S/N: 11)","Wind Direction, \u00f8 (LGR S/N: 10, SEN S/N: 12)","Temp, \u00b0C (LGR S/N: 10, SEN S/N: 13)"']
    zone = datetime.timezone(datetime.timedelta(hours=-7))
    for i, m in enumerate(moments(30, minutes(15), decimals=2)):
        local = m.utc.astimezone(zone)
        lines.append(f'{i + 1},{local:%m/%d/%y %I:%M:%S %p},{m.speed},{m.gust},{m.direction}.0,{m.temperature}')
    return Sample("HOBO", "\ufeff" + "\n".join(lines) + "\n",
                  lambda text: [(moment(r[1], "%m/%d/%y %I:%M:%S %p", zone), float(r[2]), float(r[4]), float(r[3]))
                                for r in table(text, skip=2)], told=("in -07:00 as the file states", "the month comes first"))


@sample
def open_meteo():
    lines = ["latitude,longitude,elevation,utc_offset_seconds,timezone,timezone_abbreviation",
             "52.52,13.419998,38.0,7200,Europe/Berlin,GMT+2", "",
             "time,temperature_2m (\u00b0C),wind_speed_10m (km/h),wind_direction_10m (\u00b0),wind_gusts_10m (km/h)"]
    zone = datetime.timezone(datetime.timedelta(hours=2))
    for m in moments(48, minutes(60), 3.6):
        lines.append(f"{m.utc.astimezone(zone):%Y-%m-%dT%H:%M},{m.temperature},{m.speed},{m.direction},{m.gust}")
    return Sample("open-meteo", "\n".join(lines) + "\n",
                  lambda text: [(moment(r[0], "%Y-%m-%dT%H:%M", zone), float(r[2]) * KMH, float(r[3]), float(r[4]) * KMH)
                                for r in table(text, skip=4)], units="km/h", told=("in +02:00 as the file states",))


@sample
def dwd_hourly():
    lines = ["STATIONS_ID;MESS_DATUM;QN_3;   F;   D;eor"]
    for i, m in enumerate(moments(48, minutes(60))):
        lines.append(f"       3987;{m.utc:%Y%m%d%H};   10;{-999 if i == 7 else m.speed:>8};{-999 if i in (3, 7) else m.direction:>4};eor")
    return Sample("DWD, hourly", "\n".join(lines) + "\n",
                  lambda text: readings((moment(r[1], "%Y%m%d%H"), number(r[3], missing=("-999",)), number(r[4], missing=("-999",)), None)
                                        for r in table(text, ";")), refused=1, told=("compact", "as DWD writes it"))


@sample
def dwd_ten_minutes():
    lines = ["STATIONS_ID;MESS_DATUM;  QN;FF_10;DD_10;eor"]
    for i, m in enumerate(moments(60, minutes(10))):
        lines.append(f"       3987;{m.utc:%Y%m%d%H%M};    3;{m.speed:>5};{-999 if i == 3 else m.direction:>5};eor")
    return Sample("DWD, 10 minutes", "\n".join(lines) + "\n",
                  lambda text: [(moment(r[1], "%Y%m%d%H%M"), float(r[3]), number(r[4], missing=("-999",)), None) for r in table(text, ";")],
                  told=("compact",))


@sample
def knmi():
    lines = ["# BRON: KONINKLIJK NEDERLANDS METEOROLOGISCH INSTITUUT (KNMI)", "# YYYYMMDD   : Date (YYYY=year MM=month DD=day)",
             "# HH         : Time (HH uur/hour, UT. 12 UT=13 MET, 14 MEZT. Hourly division 05 runs from 04.00 UT to 5.00 UT)",
             "# DD         : Mean wind direction (in degrees) during the 10-minute period preceding the time of observation",
             "#              (360=north, 90=east, 180=south, 270=west, 0=calm 990=variable)",
             "# FH         : Hourly mean wind speed (in 0.1 m/s)",
             "# FF         : Mean wind speed (in 0.1 m/s) during the 10-minute period preceding the time of observation",
             "# FX         : Maximum wind gust (in 0.1 m/s) during the hourly division",
             "# T          : Temperature (in 0.1 degrees Celsius) at 1.50 m at the time of observation", "#",
             "# STN,YYYYMMDD,   HH,   DD,   FH,   FF,   FX,    T", ""]
    for i, m in enumerate(moments(48, minutes(60), 10, decimals=0)):
        end = m.utc  # the hour 24 is the next day's first
        day, hour = (end, end.hour) if end.hour else (end - datetime.timedelta(days=1), 24)
        lines.append(f"  260,{day:%Y%m%d},{hour:>5},{990 if i == 4 else m.direction:>5},{int(m.speed) // 10 * 10:>5},{int(m.speed):>5},"
                     f"{int(m.gust):>5},{int(m.temperature * 10):>5}")

    def read(text):
        for r in table(text, skip=0, comment="#"):
            utc = moment(r[1], "%Y%m%d") + datetime.timedelta(hours=int(r[2]))
            yield utc, int(r[5]) * 0.1, number(r[3], missing=("990",)), int(r[6]) * 0.1
    return Sample("KNMI, hourly", "\n".join(lines) + "\n", lambda text: list(read(text)), units="0.1 m/s",
                  told=("from the lines before the header",))


@sample
def metar_of_iem():
    lines = ["#DEBUG: Format Typ    -> onlycomma", "#DEBUG: Time Period   -> 2023-06-25 00:00:00+00:00 2023-06-27 00:00:00+00:00",
             "station,valid,tmpf,drct,sknt,gust"]
    for i, m in enumerate(moments(48, minutes(60), 2, decimals=0)):
        lines.append(f"EDDB,{m.utc:%Y-%m-%d %H:%M},{m.temperature * 1.8 + 32:.2f},{'M' if i % 9 == 4 else f'{m.direction:.2f}'},"
                     f"{'M' if i == 11 else f'{m.speed:.2f}'},{f'{m.gust:.2f}' if i % 5 == 0 else 'M'}")
    return Sample("METAR (IEM)", "\n".join(lines) + "\n",
                  lambda text: readings((moment(r[1], "%Y-%m-%d %H:%M"), number(r[4], KNOT, "M"), number(r[3], missing="M"), number(r[5], KNOT, "M"))
                                        for r in table(text, skip=3)), refused=1, units="kn")


@sample
def isd():
    lines = ['"STATION","DATE","SOURCE","LATITUDE","LONGITUDE","WND","TMP"']
    for i, m in enumerate(moments(48, minutes(60), 10, decimals=0)):
        speed = "9999,9" if i == 6 else f"{int(m.speed):04},1"
        direction = "999,9,V" if i in (2, 3) else f"{m.direction:03},1,N"
        lines.append(f'"10384099999","{m.utc:%Y-%m-%dT%H:%M:%S}","4","52.4","13.1","{direction},{speed}","+{int(m.temperature * 10):04},1"')

    def read(text):
        for r in table(text):
            direction, _, _, speed, _ = r[5].split(",")
            if speed != "9999":
                yield moment(r[1], "%Y-%m-%dT%H:%M:%S"), int(speed) * 0.1, number(direction, missing=("999",)), None
    return Sample("NOAA ISD", "\n".join(lines) + "\n", lambda text: list(read(text)), refused=1, units="",
                  options=())


@sample
def ndbc():
    lines = ["#YY  MM DD hh mm WDIR WSPD GST  WVHT   DPD   APD MWD   PRES  ATMP  WTMP  DEWP  VIS  TIDE",
             "#yr  mo dy hr mn degT m/s  m/s     m   sec   sec degT   hPa  degC  degC  degC  nmi    ft"]
    for i, m in enumerate(moments(60, minutes(10))):
        wind = "999 99.0 99.0" if i in (8, 9) else f"{m.direction:03} {m.speed:4} {m.gust:4}"
        lines.append(f"{m.utc:%Y %m %d %H %M} {wind} 99.00 99.00 99.00 999 1013.{i % 10} {m.temperature} 999.0 999.0 99.0 99.00")

    def read(text):
        for r in table(text, None, comment="#", skip=0):
            if r[6] != "99.0":
                yield moment(" ".join(r[:5]), "%Y %m %d %H %M"), float(r[6]), number(r[5], missing=("999",)), float(r[7])
    return Sample("NDBC", "\n".join(lines) + "\n", lambda text: list(read(text)), refused=2,
                  told=("99 in \"WSPD\" is treated as a missing value", "from the row of units"))


@sample
def weatherlink_text():
    lines = ["\t\tTemp\tOut\tWind\tWind\tWind\tHi\tHi\tRain", "Date\tTime\tOut\tHum\tSpeed\tDir\tRun\tSpeed\tDir\tRate"]
    for i, m in enumerate(moments(40, minutes(30), 2)):
        half = f"{m.utc:%I:%M}".lstrip("0") + ("a" if m.utc.hour < 12 else "p")
        direction = "---" if i % 7 == 0 else POINTS[i % 16]
        lines.append(f"{m.utc:%d.%m.%y}\t{half}\t{m.temperature}\t55\t{m.speed}\t{direction}\t1.0\t{m.gust}\tN\t0.0")

    def read(text):
        for r in table(text, "\t", 2):
            utc = moment(f"{r[0]} {r[1]}m".upper(), "%d.%m.%y %I:%M%p")
            yield utc, float(r[4]) * MPH, POINTS.index(r[5]) * 22.5 if r[5] != "---" else None, float(r[7]) * MPH
    return Sample("Davis WeatherLink, text", "\n".join(lines) + "\n", lambda text: list(read(text)), options=("--unit", "mph"), units="mph",
                  told=("by --unit",))


@sample
def weatherlink_cloud():
    lines = ['"Station name"', '"garden"', "", '"Date & Time","Avg Wind Speed - mph","High Wind Speed - mph","Prevailing Wind Direction","Temp - \u00b0F"']
    for i, m in enumerate(moments(40, minutes(15), 2, decimals=0)):
        hour = m.utc.hour % 12 or 12
        lines.append(f'"{m.utc.month}/{m.utc.day}/{m.utc:%y} {hour}:{m.utc:%M} {m.utc:%p}","{int(m.speed)}","{int(m.gust)}",'
                     f'"{"--" if i % 7 == 0 else POINTS[i % 16]}","{m.temperature * 1.8 + 32:.1f}"')
    return Sample("Davis weatherlink.com", "\n".join(lines) + "\n",
                  lambda text: [(moment(r[0], "%m/%d/%y %I:%M %p"), float(r[1]) * MPH, POINTS.index(r[3]) * 22.5 if r[3] != "--" else None,
                                 float(r[2]) * MPH) for r in table(text, skip=4)], units="mph", told=("the month comes first",))


@sample
def wunderground():
    lines = ["Time,TemperatureF,DewpointF,PressureIn,WindDirection,WindDirectionDegrees,WindSpeedMPH,WindSpeedGustMPH,Humidity,DateUTC"]
    for m in moments(40, minutes(5), 2):
        lines.append(f"{m.utc - datetime.timedelta(hours=7):%Y-%m-%d %H:%M:%S},{m.temperature * 1.8 + 32:.1f},55.0,29.92,{POINTS[m.direction // 30]},"
                     f"{m.direction},{m.speed},{m.gust},60,{m.utc:%Y-%m-%d %H:%M:%S}")
    return Sample("Weather Underground", "\n".join(lines) + "\n",
                  lambda text: [(moment(r[9], "%Y-%m-%d %H:%M:%S"), float(r[6]) * MPH, float(r[5]), float(r[7]) * MPH) for r in table(text)],
                  units="mph", told=('time from "DateUTC"',),
                  weather={"pressure_hpa": 29.92 * 33.8638866667, "relative_humidity_percent": 60.0})


@sample
def wunderground_page():
    lines = ["Date,Time,Temperature,Wind,Speed,Gust,Pressure"]
    for i, m in enumerate(moments(40, minutes(5), 2)):
        calm = i in (4, 5)
        lines.append(f"{m.utc:%Y/%m/%d},{m.utc:%I:%M %p},{m.temperature * 1.8 + 32:.1f} \u00b0F,{'Calm' if calm else POINTS[i % 16]},"
                     f"{'0.0' if calm else m.speed} mph,{m.gust} mph,29.92 in")
    return Sample("Weather Underground, page", "\n".join(lines) + "\n",
                  lambda text: [(moment(r[0] + " " + r[1], "%Y/%m/%d %I:%M %p"), float(r[4].split()[0]) * MPH,
                                 POINTS.index(r[3]) * 22.5 if r[3] != "Calm" else None, float(r[5].split()[0]) * MPH) for r in table(text)],
                  options=("--direction", "Wind"), units="mph", told=("from its fields",))


@sample
def ambient():
    lines = ['"Date","Simple Date","Outdoor Temperature (\u00b0F)","Wind Speed (mph)","Wind Gust (mph)","Max Daily Gust (mph)","Wind Direction (\u00b0)","Outdoor Humidity (%)"']
    zone = datetime.timezone(datetime.timedelta(hours=-5))
    rows = [f'"{m.utc.astimezone(zone).isoformat()}","{m.utc.astimezone(zone):%Y-%m-%d %H:%M:%S}","{m.temperature * 1.8 + 32:.1f}","{m.speed}","{m.gust}","30.0","{m.direction}","61"'
            for m in moments(50, minutes(5), 2)]
    return Sample("Ambient Weather", "\n".join(lines + rows[::-1]) + "\n",
                  lambda text: [(datetime.datetime.fromisoformat(r[0]).astimezone(UTC), float(r[3]) * MPH, float(r[6]), float(r[4]) * MPH)
                                for r in reversed(table(text))], units="mph", told=("the newest row comes first", "with zones of their own"))


@sample
def ecowitt():
    lines = ["Time,Outdoor Temperature(\u2103),Outdoor Humidity(%),Wind Speed(m/s),Wind Gust(m/s),Wind Direction(\u00ba),ABS Pressure(hPa)"]
    zone = zoneinfo.ZoneInfo("Europe/Berlin")
    for i, m in enumerate(moments(50, minutes(5))):
        lines.append(f"{m.utc.astimezone(zone):%Y/%m/%d %H:%M},{m.temperature},55,{'-' if i == 9 else m.speed},{m.gust},{m.direction},1001.2")
    return Sample("Ecowitt", "\n".join(lines) + "\n",
                  lambda text: readings((moment(r[0], "%Y/%m/%d %H:%M", zone), number(r[3], missing="-"), float(r[5]), float(r[4])) for r in table(text)),
                  options=("--zone", "Europe/Berlin"), refused=1, told=("in Europe/Berlin by --zone",))


@sample
def meteostat():
    lines = ["date,hour,temp,dwpt,rhum,prcp,snow,wdir,wspd,wpgt,pres,tsun,coco"]
    for i, m in enumerate(moments(48, minutes(60), 3.6)):
        lines.append(f"{m.utc:%Y-%m-%d},{m.utc.hour},{m.temperature},9.0,60,,,{m.direction},{m.speed},{m.gust if i % 2 else ''},1013.2,,2")
    return Sample("Meteostat", "\n".join(lines) + "\n",
                  lambda text: [(moment(r[0] + " " + r[1], "%Y-%m-%d %H"), float(r[8]) * KMH, float(r[7]), number(r[9], KMH)) for r in table(text)],
                  units="km/h", told=("as Meteostat writes it",))


@sample
def weewx():
    lines = ["dateTime,usUnits,interval,barometer,outTemp,outHumidity,windSpeed,windDir,windGust,windGustDir"]
    for i, m in enumerate(moments(40, minutes(5), 2)):
        lines.append(f"{int(m.utc.timestamp())},1,5,29.92,{m.temperature * 1.8 + 32:.1f},60,{m.speed},{'' if i % 6 == 0 else m.direction},{m.gust},")
    return Sample("weewx", "\n".join(lines) + "\n",
                  lambda text: [(datetime.datetime.fromtimestamp(int(r[0]), UTC), float(r[6]) * MPH, number(r[7]), float(r[8]) * MPH)
                                for r in table(text)], units="mph", told=('by the column "usUnits"',))


@sample
def pandas_index():
    lines = [",speed_ms,direction,gust_ms"]
    for m in moments(40, minutes(1), decimals=3):
        lines.append(f"{m.utc:%Y-%m-%d %H:%M:%S+00:00},{m.speed},{float(m.direction)},{m.gust}")
    return Sample("pandas, index without a name", "\n".join(lines) + "\n",
                  lambda text: [(datetime.datetime.fromisoformat(r[0]), float(r[1]), float(r[2]), float(r[3])) for r in table(text)])


@sample
def excel_german():
    lines = ["Datum;Uhrzeit;Windgeschwindigkeit (km/h);Windrichtung;Windb\u00f6e (km/h)"]
    for m in moments(40, minutes(10), 3.6):
        lines.append(f"{m.utc:%d.%m.%Y};{m.utc:%H:%M:%S};{m.speed};{m.direction};{m.gust}".replace(".", ",").replace(
            f"{m.utc:%d,%m,%Y}", f"{m.utc:%d.%m.%Y}"))
    return Sample("Excel, German", "\r\n".join(lines) + "\r\n",
                  lambda text: [(moment(r[0] + r[1], "%d.%m.%Y%H:%M:%S"), number(r[2], KMH), number(r[3]), number(r[4], KMH)) for r in table(text, ";")],
                  units="km/h")


@sample
def vaisala():
    lines = ["Date\tTime\tDm\tSm\tSx\tTa\tUa\tPa", "\t\tdeg\tm/s\tm/s\tC\t%\thPa"]
    for m in moments(40, minutes(1)):
        lines.append(f"{m.utc:%Y-%m-%d}\t{m.utc:%H:%M:%S}\t{m.direction}\t{m.speed}\t{m.gust}\t{m.temperature}\t50.1\t1009.3")
    return Sample("Vaisala WXT, logged", "\n".join(lines) + "\n",
                  lambda text: [(moment(r[0] + r[1], "%Y-%m-%d%H:%M:%S"), float(r[3]), float(r[2]), float(r[4])) for r in table(text, "\t", 2)],
                  told=("from the row of units",))


@sample
def lufft():
    lines = ["Timestamp;wind speed act. [m/s];wind speed max. [m/s];wind direction act. [\u00b0];air temperature act. [\u00b0C]"]
    for m in moments(40, minutes(1)):
        lines.append(f"{m.utc:%d.%m.%Y %H:%M:%S};{m.speed};{m.gust};{m.direction};{m.temperature}")
    return Sample("Lufft SmartView", "\n".join(lines) + "\n",
                  lambda text: [(moment(r[0], "%d.%m.%Y %H:%M:%S"), float(r[1]), float(r[3]), float(r[2])) for r in table(text, ";")])


@sample
def nrel_midc():
    lines = ["DATE (MM/DD/YYYY),MST,Avg Wind Speed @ 2m [m/s],Peak Wind Speed @ 2m [m/s],Avg Wind Direction @ 2m [deg from N]"]
    zone = datetime.timezone(datetime.timedelta(hours=-7))
    for m in moments(60, minutes(1), decimals=3):
        local = m.utc.astimezone(zone)
        lines.append(f"{local:%m/%d/%Y},{local:%H:%M},{m.speed},{m.gust},{m.direction}.1")
    return Sample("NREL MIDC", "\n".join(lines) + "\n",
                  lambda text: [(moment(r[0] + r[1], "%m/%d/%Y%H:%M", zone), float(r[2]), float(r[4]), float(r[3])) for r in table(text)],
                  told=("in -07:00 as the file states",))


@sample
def nsrdb():
    lines = ["Source,Location ID,City,Latitude,Longitude,Time Zone,Local Time Zone,Wind Direction Units,Wind Speed Units",
             "NSRDB,123,-,39.7,-105.2,-7,-7,Degrees,m/s", "Year,Month,Day,Hour,Minute,Temperature,Wind Direction,Wind Speed"]
    zone = datetime.timezone(datetime.timedelta(hours=-7))
    for m in moments(48, minutes(30)):
        local = m.utc.astimezone(zone)
        lines.append(f"{local.year},{local.month},{local.day},{local.hour},{local.minute},{m.temperature},{m.direction},{m.speed}")
    return Sample("NREL NSRDB", "\n".join(lines) + "\n",
                  lambda text: [(datetime.datetime(*map(int, r[:5]), tzinfo=zone).astimezone(UTC), float(r[7]), float(r[6]), None)
                                for r in table(text, skip=3)], told=("in -07 as the file states", "from the lines before the header"))


@sample
def era5():
    lines = ["valid_time,u10,v10,t2m,latitude,longitude"]
    for m in moments(48, minutes(60), decimals=4):
        angle = math.radians(m.direction)
        lines.append(f"{m.utc:%Y-%m-%d %H:%M:%S},{-m.speed * math.sin(angle):.6f},{-m.speed * math.cos(angle):.6f},{m.temperature + 273.15:.2f},52.5,13.5")

    def read(text):
        for r in table(text):
            u, v = float(r[1]), float(r[2])
            yield moment(r[0], "%Y-%m-%d %H:%M:%S"), math.hypot(u, v), math.degrees(math.atan2(-u, -v)) % 360, None
    return Sample("ERA5 (Copernicus)", "\n".join(lines) + "\n", lambda text: list(read(text)),
                  told=("as ECMWF writes it",))


@sample
def tempest():
    lines = ["timestamp,wind_lull,wind_avg,wind_gust,wind_dir,pressure,temperature,humidity"]
    for m in moments(40, minutes(1)):
        lines.append(f"{int(m.utc.timestamp())},0.1,{m.speed},{m.gust},{m.direction},1012.3,{m.temperature},50")
    return Sample("WeatherFlow Tempest", "\n".join(lines) + "\n",
                  lambda text: [(datetime.datetime.fromtimestamp(int(r[0]), UTC), float(r[2]), float(r[4]), float(r[3])) for r in table(text)],
                  told=("as WeatherFlow writes it",))


@sample
def home_assistant():
    lines = ["entity_id,state,last_changed"]
    for i, m in enumerate(moments(60, minutes(1), 3.6)):
        stamp = f"{m.utc:%Y-%m-%dT%H:%M:%S}.{i:03}Z"
        lines.append(f"sensor.roof_wind_speed,{'unavailable' if i == 20 else m.speed},{stamp}")
        lines.append(f"sensor.roof_temperature,{m.temperature},{stamp}")
    return Sample("Home Assistant, history", "\n".join(lines) + "\n",
                  lambda text: readings((datetime.datetime.fromisoformat(r[2].replace("Z", "+00:00")), number(r[1], KMH, ("unavailable",)), None, None)
                                        for r in table(text) if r[0].endswith("wind_speed")),
                  options=("--where", "entity_id=sensor.roof_wind_speed", "--speed", "state", "--unit", "km/h"), refused=1, units="km/h")


@sample
def influxdb():
    lines = ["name,time,direction,speed_kn"]
    for i, m in enumerate(moments(60, datetime.timedelta(seconds=1), 2)):
        lines.append(f"wind,{int(m.utc.timestamp()) * 10**9 + i},{m.direction},{m.speed}")
    return Sample("InfluxDB, nanoseconds", "\n".join(lines) + "\n",
                  lambda text: [(int(r[1]), float(r[3]) * KNOT, float(r[2]), None) for r in table(text)], units="kn", told=("unix-ns",))


@sample
def thingspeak():
    lines = ["created_at,entry_id,field1,field2,latitude"]
    for i, m in enumerate(moments(40, datetime.timedelta(seconds=20))):
        lines.append(f"{m.utc:%Y-%m-%d %H:%M:%S} UTC,{i},{m.speed},{m.direction},")
    return Sample("ThingSpeak", "\n".join(lines) + "\n",
                  lambda text: [(moment(r[0], "%Y-%m-%d %H:%M:%S UTC"), float(r[2]), float(r[3]), None) for r in table(text)],
                  options=("--speed", "field1", "--direction", "field2"), told=("assumed",))


@sample
def kestrel():
    lines = ["Device Name,WEATHER - 2310003", "Device Model,5500L", "Serial Number,2310003",
             "FORMATTED DATE_TIME,Direction ,Wind Speed,Crosswind Speed,Headwind Speed,Temperature,Relative Humidity",
             "YYYY-MM-DD HH:MM:SS,Deg,kt,kt,kt,\u00b0C,%"]
    for i, m in enumerate(moments(40, minutes(2), 2)):
        lines.append(f"{m.utc:%Y-%m-%d %H:%M:%S},{m.direction},{m.speed},{'***' if i == 3 else '0.1'},1.0,{m.temperature},51.0")
    return Sample("Kestrel 5500", "\n".join(lines) + "\n",
                  lambda text: [(moment(r[0], "%Y-%m-%d %H:%M:%S"), float(r[2]) * KNOT, float(r[1]), None) for r in table(text, skip=5)],
                  units="kn", told=("from the row of units",))


@sample
def meteoswiss():
    lines = ["station_abbr;reference_timestamp;tre200s0;fkl010z0;fkl010z1;dkl010z0"]
    for i, m in enumerate(moments(40, minutes(10))):
        lines.append(f"BAS;{m.utc:%d.%m.%Y %H:%M};{m.temperature};{'' if i == 5 else m.speed};{m.gust};{m.direction}")
    return Sample("MeteoSwiss", "\n".join(lines) + "\n",
                  lambda text: readings((moment(r[1], "%d.%m.%Y %H:%M"), number(r[3]), float(r[5]), float(r[4])) for r in table(text, ";")),
                  refused=1, told=("as MeteoSwiss writes it",))


@sample
def sonic():
    lines = ["TIMESTAMP Ux Uy Uz Ts"]
    for i, m in enumerate(moments(100, datetime.timedelta(milliseconds=100), decimals=3)):
        lines.append(f"{m.utc:%Y-%m-%dT%H:%M:%S}.{i % 10}Z   {m.speed}  {-m.gust}  0.1{i}   {m.temperature}")

    def read(text):
        for r in table(text, None):
            u, v = float(r[1]), float(r[2])
            yield datetime.datetime.fromisoformat(r[0].replace("Z", "00+00:00")), math.hypot(u, v), math.degrees(math.atan2(-u, -v)) % 360, None
    return Sample("sonic, blanks as separators", "\n".join(lines) + "\n", lambda text: list(read(text)), options=("--unit", "m/s"),
                  weather={"vertical_speed_m_s": None})


@sample
def daylight_saving():
    zone = zoneinfo.ZoneInfo("Europe/Berlin")
    begin = datetime.datetime(2023, 10, 28, 22, 0, tzinfo=UTC)  # the hour from 2 to 3 comes twice
    lines = ["Zeit;Wind [m/s];Richtung"]
    true = []
    for i, m in enumerate(moments(36, minutes(10))):
        utc = begin + i * minutes(10)
        lines.append(f"{utc.astimezone(zone):%d.%m.%Y %H:%M};{m.speed};{m.direction}")
        true.append((utc, m.speed, float(m.direction), None))
    return Sample("a change to winter time", "\n".join(lines) + "\n", lambda text: true,
                  options=("--zone", "Europe/Berlin"))


def typical_hours(count):
    """Hours of a year whose months are of different years, as (year, month, day, hour from 1 to 24, moment)."""
    years = {1: 1988, 2: 1979, 3: 1991, 4: 1985}
    begin = datetime.datetime(1989, 1, 30, tzinfo=UTC)
    for i, m in enumerate(moments(count, minutes(60))):
        end = begin + datetime.timedelta(hours=i + 1)
        day, hour = (end, end.hour) if end.hour else (end - datetime.timedelta(days=1), 24)
        yield years[day.month], day, hour, end, m


@sample
def tmy3():
    lines = ['723170,"GREENSBORO",NC,-5.0,36.100,-79.950,273',
             "Date (MM/DD/YYYY),Time (HH:MM),GHI (W/m^2),Dry-bulb (C),Wdir (degrees),Wdir source,Wspd (m/s),Wspd source"]
    true = []
    for year, day, hour, end, m in typical_hours(100):
        lines.append(f"{day:%m/%d}/{year},{hour:02}:00,0,{m.temperature},{m.direction},A,{m.speed},A")
        true.append((end + datetime.timedelta(hours=5), m.speed, float(m.direction), None))
    return Sample("NREL TMY3", "\n".join(lines) + "\n", lambda text: true, told=("a typical year", "in -05:00 as the file states"))


@sample
def epw():
    lines = ["LOCATION,Berlin,-,DEU,IWEC Data,103840,52.47,13.40,1.0,49.0"] + ["DESIGN CONDITIONS,0", "TYPICAL/EXTREME PERIODS,0",
             "GROUND TEMPERATURES,0", "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0", "COMMENTS 1,made up", "COMMENTS 2,", "DATA PERIODS,1,1,Data,Sunday,1/1,12/31"]
    true = []
    for year, day, hour, end, m in typical_hours(100):
        wind = "999" if hour == 5 else m.direction
        lines.append(f"{year},{day.month},{day.day},{hour},60,?9?9,{m.temperature},3.0,80,101300,{'0,' * 10}{wind},{m.speed},5,5,16.0,77777,9,999999999")
        true.append((end - datetime.timedelta(hours=1), m.speed, None if hour == 5 else float(m.direction), None))
    return Sample("EnergyPlus weather (EPW)", "\r\n".join(lines) + "\r\n", lambda text: true, told=("written by EnergyPlus weather", "a typical year"))


@sample
def pvgis():
    lines = ["Latitude (decimal degrees): 45.000", "Longitude (decimal degrees): 8.000", "month,year", "1,2016", "2,2007",
             "time(UTC),T2m,RH,G(h),WS10m,WD10m,SP"]
    true = []
    begin = datetime.datetime(2016, 1, 30, tzinfo=UTC)
    for i, m in enumerate(moments(90, minutes(60))):
        utc = begin + datetime.timedelta(hours=i)
        lines.append(f"{2016 if utc.month == 1 else 2007}{utc:%m%d:%H%M},{m.temperature},80.0,0.0,{m.speed},{m.direction}.0,99000.0")
        true.append((utc.replace(year=2017), m.speed, float(m.direction), None))  # the next year without a 29 February
    return Sample("PVGIS, typical year", "\r\n".join(lines) + "\r\n", lambda text: true, told=("a typical year",), units="m/s")


@sample
def nasa_power():
    lines = ["-BEGIN HEADER-", "NASA/POWER Source Native Resolution Hourly Data", "WS10M     MERRA-2 Wind Speed at 10 Meters (m/s)",
             "WD10M     MERRA-2 Wind Direction at 10 Meters (Degrees)", "-END HEADER-", "YEAR,MO,DY,HR,WS10M,WD10M"]
    for i, m in enumerate(moments(60, minutes(60))):
        lines.append(f"{m.utc.year},{m.utc.month},{m.utc.day},{m.utc.hour},{'-999.0' if i == 7 else m.speed},{m.direction}")
    return Sample("NASA POWER", "\n".join(lines) + "\n",
                  lambda text: readings((datetime.datetime(*map(int, r[:4]), tzinfo=UTC), number(r[4], missing=("-999.0",)), float(r[5]), None)
                                        for r in table(text, skip=6)), refused=1)


@sample
def midc_raw():
    zone = datetime.timezone(datetime.timedelta(hours=-7))
    lines = ["Year,DOY,MST,Air Temperature [deg C],Avg Wind Speed @ 3m [m/s],Avg Wind Direction @ 3m [deg from N],Peak Wind Speed @ 3m [m/s]"]
    for m in moments(200, minutes(1)):
        local = m.utc.astimezone(zone)
        lines.append(f"{local.year},{local.timetuple().tm_yday},{local.hour * 100 + local.minute},{m.temperature},{m.speed},{m.direction},{m.gust}")

    def read(text):
        for r in table(text):
            local = datetime.datetime(int(r[0]), 1, 1, int(r[2]) // 100, int(r[2]) % 100, tzinfo=zone) + datetime.timedelta(days=int(r[1]) - 1)
            yield local.astimezone(UTC), float(r[4]), float(r[5]), float(r[6])
    return Sample("NREL MIDC, raw", "\n".join(lines) + "\n", lambda text: list(read(text)), told=("in -07:00 as the file states",))


@sample
def environment_canada():
    lines = ['"Longitude (x)","Latitude (y)","Station Name","Climate ID","Date/Time (LST)","Year","Month","Day","Time (LST)","Temp (\u00b0C)",'
             '"Wind Dir (10s deg)","Wind Dir Flag","Wind Spd (km/h)","Wind Spd Flag","Stn Press (kPa)"']
    for i, m in enumerate(moments(48, minutes(60), 3.6, decimals=0)):
        direction = "" if i == 6 else m.direction // 10 + 1
        lines.append(f'"-123","49","VANCOUVER","1","{m.utc:%Y-%m-%d %H:%M}","{m.utc.year}","{m.utc:%m}","{m.utc:%d}","{m.utc:%H:%M}","{m.temperature}",'
                     f'"{direction}","","{int(m.speed)}","","101.3"')
    return Sample("Environment Canada", "\ufeff" + "\n".join(lines) + "\n",
                  lambda text: [(moment(r[4], "%Y-%m-%d %H:%M"), int(r[12]) * KMH, number(r[10], 10), None) for r in table(text)], units="km/h")


@sample
def nrg():
    lines = ["NRG Export Service", "Time Zone:\tUTC-5:00", "", "Sensor History"]
    for channel, unit in ((1, "m/s"), (2, "m/s"), (13, "Deg")):
        lines += [f"Channel:\t{channel}", f"Units:\t{unit}", "Height:\t10.00", ""]
    lines += ["Gust Source Channel:\t2", ""] + [f"Note:\t{i}" for i in range(250)]
    lines.append("Timestamp\tCh1_Anem_85.00m_S_Avg_m/s\tCh2_Anem_10.00m__Avg_m/s\tCh2_Anem_10.00m__SD_m/s\tCh13_Vane_10.00m_SSE_Avg_Deg")
    zone = datetime.timezone(datetime.timedelta(hours=-5))
    for m in moments(40, minutes(10)):
        lines.append(f"{m.utc.astimezone(zone):%Y-%m-%d %H:%M:%S}\t9.9\t{m.speed}\t0.1\t{m.direction}")
    return Sample("NRG Symphonie", "\r\n".join(lines) + "\r\n",
                  lambda text: [(moment(r[0], "%Y-%m-%d %H:%M:%S", zone), float(r[2]), float(r[4]), None)
                                for r in table(text, "\t", len(lines) - 40)])


@sample
def japan_meteorological_agency():
    kanji = "北 北北東 北東 東北東 東 東南東 南東 南南東 南 南南西 南西 西南西 西 西北西 北西 北北西".split()
    zone = datetime.timezone(datetime.timedelta(hours=9))
    lines = ["ダウンロードした時刻：2024/02/01 12:00:00", "", ",東京,東京,東京,東京,東京", "年月日時,風速(m/s),風速(m/s),風速(m/s),風速(m/s),風速(m/s)",
             ",,,風向,風向,", ",,品質情報,,品質情報,均質番号"]
    for i, m in enumerate(moments(48, minutes(60))):
        local = m.utc.astimezone(zone)
        lines.append(f"{local.year}/{local.month}/{local.day} {local.hour}:00:00,{m.speed},8,{'静穏' if i == 9 else kanji[i % 16]},8,1")
    return Sample("JMA (Shift_JIS)", "\r\n".join(lines) + "\r\n",
                  lambda text: [(moment(r[0], "%Y/%m/%d %H:%M:%S", zone), float(r[1]), kanji.index(r[3]) * 22.5 if r[3] in kanji else None, None)
                                for r in table(text, skip=6)],
                  options=("--zone", "Asia/Tokyo"), told=("text in Shift_JIS", "written by Japan Meteorological Agency"), encoding="cp932")


@sample
def cumulus_mx():
    lines = [f"{m.utc:%d/%m/%y},{m.utc:%H:%M},{m.temperature},80,9.0,{m.speed},{m.gust},{m.direction}" + ",0.0" * 20 for m in moments(40, minutes(10), 3.6)]
    return Sample("CumulusMX", "\n".join(lines) + "\n",
                  lambda text: [(moment(r[0] + r[1], "%d/%m/%y%H:%M"), float(r[5]) * KMH, float(r[7]), float(r[6]) * KMH) for r in table(text, skip=0)],
                  options=("--unit", "km/h"), units="km/h", told=("written by CumulusMX",))


@sample
def excel_unicode_text():
    lines = ["Zeit\tWind (km/h)\tB\u00f6e (km/h)\tWindrichtung (\u00b0)"]
    for m in moments(40, minutes(10), 3.6):
        lines.append(f"{m.utc:%d.%m.%Y %H:%M}\t{m.speed}\t{m.gust}\t{m.direction}".replace(".", ",").replace(f"{m.utc:%d,%m,%Y}", f"{m.utc:%d.%m.%Y}"))
    return Sample("Excel, Unicode text", "\r\n".join(lines) + "\r\n",
                  lambda text: [(moment(r[0], "%d.%m.%Y %H:%M"), number(r[1], KMH), number(r[3]), number(r[2], KMH)) for r in table(text, "\t")],
                  units="km/h", told=("text in UTF-16",), encoding="utf-16")


@sample
def windographer():
    lines = ["Windographer export", "Latitude = N 52", "Time zone = UTC", "",
             "Date/Time\tSpeed 50 m [m/s]\tSpeed 50 m SD [m/s]\tSpeed 50 m Max [m/s]\tDirection 50 m [\u00b0]\tTemperature 3 m [\u00b0C]"]
    for m in moments(40, minutes(10)):
        lines.append(f"{m.utc:%Y-%m-%d %H:%M}\t{m.speed}\t0.5\t{m.gust}\t{m.direction}\t{m.temperature}")
    return Sample("Windographer", "\n".join(lines) + "\n",
                  lambda text: [(moment(r[0], "%Y-%m-%d %H:%M"), float(r[1]), float(r[4]), float(r[3])) for r in table(text, "\t", 5)])


@sample
def french_latin1():
    lines = ["Date;Heure;Vent (km/h);Rafale (km/h);Direction du vent (\u00b0)"]
    for m in moments(40, minutes(10), 3.6):
        lines.append(f"{m.utc:%d/%m/%Y};{m.utc:%H:%M};{m.speed};{m.gust};{m.direction}")
    return Sample("French, Latin-1", "\r\n".join(lines) + "\r\n",
                  lambda text: [(moment(r[0] + r[1], "%d/%m/%Y%H:%M"), float(r[2]) * KMH, float(r[4]), float(r[3]) * KMH) for r in table(text, ";")],
                  units="km/h", told=("text in Latin-1",), encoding="latin-1")
