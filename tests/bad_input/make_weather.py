#!/usr/bin/env python3
"""Writes the broken weather files of this folder and the sound ones they come from: python3 make_weather.py"""
import pathlib

here = pathlib.Path(__file__).parent

LOCATION = "LOCATION,Anywhere,BY,DEU,made,000000,48.0,11.0,1.0,500.0"
OTHERS = [
    'DESIGN CONDITIONS,0',
    'TYPICAL/EXTREME PERIODS,0',
    'GROUND TEMPERATURES,0',
    'HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0',
    'COMMENTS 1,"A day, made up; M\u00fcnchen"',
    'COMMENTS 2,none',
]
PERIODS = "DATA PERIODS,1,1,Data,Sunday, 6/21, 6/21"
DAY = [0, 0, 0, 0, 12, 90, 230, 380, 510, 620, 700, 740, 745, 710, 640, 540, 410, 260, 120, 25, 2, 0, 0, 0]


def row(hour, year=2005, month=6, day=21, minute=60, ghi=None, dni=None, dhi=None, end=",,,,,,,,,,,,,,,,,,,"):
    """A row with made numbers where none are given."""
    value = DAY[int(hour) - 1] if str(hour).isdigit() and 1 <= int(hour) <= 24 else 0
    ghi = value if ghi is None else ghi
    dni = value // 2 if dni is None else dni
    dhi = value // 3 if dhi is None else dhi
    return f"{year},{month},{day},{hour},{minute},?9?9,20.0,10.0,50,95000,0,0,300,{ghi},{dni},{dhi}{end}"


def epw(name, rows, location=LOCATION, periods=PERIODS, newline="\n", last="\n"):
    """An EPW file, in Latin-1."""
    lines = [location, *OTHERS, periods, *rows]
    write(f"{name}.epw", (newline.join(lines) + last).encode("latin-1"))


def wea(name, rows, header=None, **other):
    """A WEA file; `other` are header lines that differ."""
    lines = {
        "place": "Anywhere_DEU",
        "latitude": "48.0",
        "longitude": "-11.0",
        "time_zone": "-15",
        "site_elevation": "500",
        "weather_data_file_units": "1",
    }
    lines.update(other)
    header = [f"{key} {value}" for key, value in lines.items()] if header is None else header
    write(f"{name}.wea", ("\n".join([*header, *rows]) + "\n").encode("latin-1"))


def write(name, content):
    (here / name).write_bytes(content)


hours = [row(hour) for hour in range(1, 25)]
epw("sound/day", hours)
epw("sound/day_crlf", hours, newline="\r\n", last="\r\n\r\n")

# The header.
write("epw_empty.epw", b"")
write("epw_no_location.epw", (row(1) + "\n").encode())
write("epw_picture.epw", bytes.fromhex("89504e470d0a1a0a0000000d49484452"))
epw("epw_location_short", hours[:1], location=LOCATION.rsplit(",", 1)[0])
epw("epw_location_long", hours[:1], location=LOCATION + ",1")
for name, old, new in [
    ("latitude_91", "48.0", "91"),
    ("latitude_letters", "48.0", "48N"),
    ("latitude_nothing", "48.0", ""),
    ("longitude_181", "11.0", "-181"),
    ("zone_15", "1.0", "15"),
    ("elevation_infinite", "500.0", "inf"),
    ("elevation_feet", "500.0", "29032"),
]:
    fields = [new if field == old else field for field in LOCATION.split(",")]
    epw(f"epw_{name}", hours[:1], location=",".join(fields))
write("epw_no_periods.epw", "\n".join([LOCATION, *OTHERS, ""]).encode("latin-1"))
epw("epw_header_only", [])
for name, periods in [
    ("none", "DATA PERIODS,0,1,Data,Sunday, 6/21, 6/21"),
    ("two", "DATA PERIODS,2,1,Data,Sunday, 6/21, 6/21"),
    ("short", "DATA PERIODS,1,1,Data"),
    ("records_0", "DATA PERIODS,1,0,Data,Sunday, 6/21, 6/21"),
    ("records_7", "DATA PERIODS,1,7,Data,Sunday, 6/21, 6/21"),
    ("month", "DATA PERIODS,1,1,Data,Sunday,13/ 1,12/31"),
    ("day", "DATA PERIODS,1,1,Data,Sunday, 2/30,12/31"),
    ("word", "DATA PERIODS,1,1,Data,Sunday,January,12/31"),
    ("year", "DATA PERIODS,1,1,Data,Sunday, 6/21/99999, 6/21"),
]:
    epw(f"epw_periods_{name}", hours[:1], periods=periods)

# One row.
for name, broken in [
    ("fields_few", row(2, end="")),
    ("fields_many", row(2) + ",,"),
    ("month_13", row(2, month=13)),
    ("month_letters", row(2, month="June")),
    ("day_0", row(2, day=0)),
    ("day_31", row(2, day=31)),
    ("leap_day", row(2, month=2, day=29)),
    ("hour_0", row(0)),
    ("hour_25", row(25)),
    ("hour_half", row("1.5")),
    ("minute_61", row(2, minute=61)),
    ("minute_nothing", row(2, minute="")),
    ("year_letters", row(2, year="MMV")),
    ("year_huge", row(2, year=20050000)),
    ("direct_12000", row(2, dni=12000)),
    ("direct_negative", row(2, dni=-1)),
    ("direct_letters", row(2, dni="1l")),
    ("direct_huge", row(2, dni="1e400")),
    ("diffuse_infinite", row(2, dhi="-inf")),
    ("diffuse_quoted", row(2, dhi='"a, b"')),
    ("global_nan", row(2, ghi="nan")),
    ("nul", row(2, ghi="1\0")),
    ("latin1", row(2, ghi="1\u00b0")),
    ("quote", row(2).replace("?9?9", '"?9')),
    ("hour_twice", row(1)),
    ("hour_skipped", row(3)),
    ("day_skipped", row(1, day=23)),
    ("month_back", row(2, month=5)),
]:
    epw(f"epw_row_{name}", [row(1), broken])

# The order and the number of rows.
epw("epw_begins_late", hours[1:])
epw("epw_begins_other_day", [row(1, day=20)])
epw("epw_ends_early", hours[:-1])
epw("epw_goes_on", [*hours, row(1, day=22)])
epw("epw_cut", hours[:7], last="")
cut = (here / "epw_cut.epw").read_bytes()
write("epw_cut.epw", cut[:-25])
twice = "DATA PERIODS,1,2,Data,Sunday, 6/21, 6/21"
epw("epw_half_minute", [row(1, minute=30), row(1, minute=50)], periods=twice)
epw("epw_half_missing", [row(1, minute=30), row(2, minute=30)], periods=twice)
epw("epw_half_more", [row(1, minute=30), row(1, minute=60), row(1, minute=90)], periods=twice)
write("epw_old_mac.epw", "\r".join([LOCATION, *OTHERS, PERIODS, *hours, ""]).encode("latin-1"))

# WEA.
rows = [f"6 21 {hour}.5 {DAY[hour] // 2} {DAY[hour] // 3}" for hour in range(24)]
wea("sound/day", rows)
write("wea_empty.wea", b"")
wea("wea_no_rows", [])
wea("wea_header_order", rows[:1], header=["place Anywhere_DEU", "longitude -11", "latitude 48"])
wea("wea_header_short", [], header=["place Anywhere_DEU", "latitude 48", "longitude -11"])
wea("wea_header_word", rows[:1], header=["placeAnywhere_DEU"])
for key, name, value in [
    ("latitude", "91", "-91"),
    ("longitude", "letters", "11W"),
    ("longitude", "huge", "1e9"),
    ("time_zone", "hours", "-300"),
    ("site_elevation", "nan", "nan"),
    ("weather_data_file_units", "3", "3"),
    ("weather_data_file_units", "4", "4"),
    ("weather_data_file_units", "half", "1.5"),
]:
    wea(f"wea_{key}_{name}", rows[:1], **{key: value})
for name, broken in [
    ("fields", "6 21 1.5 0"),
    ("month", "0 21 1.5 0 0"),
    ("april_31", "4 31 1.5 0 0"),
    ("hour", "6 21 24.5 0 0"),
    ("hour_clock", "6 21 1:30 0 0"),
    ("direct", "6 21 1.5 1501 0"),
    ("diffuse_negative", "6 21 1.5 0 -1"),
    ("diffuse_huge", "6 21 1.5 0 1e999"),
    ("nul", "6 21 1.5 0 \0"),
    ("twice", "6 21 0.5 0 0"),
    ("back", "5 21 12.5 0 0"),
    ("near", "6 21 0.51 0 0"),
]:
    wea(f"wea_row_{name}", [rows[0], broken])
