#!/usr/bin/env python3
"""The mean sky of a weather file by Radiance: benches/peers/sky_gendaymtx.py WEATHER [--subdivisions 1] > mean.csv

Runs `gendaymtx -s -O1 -c 1 1 1` (Perez's all-weather sky, without the sun's disc, in watts, uncoloured) on a WEA or EPW file
and writes the mean radiance of each sky patch over all hours of the file, W/m2/sr, and without subdivision the parts of it
that the hours of each of the eight rows of Perez's table bring (row 1 overcast, row 8 clear; by gendaymtx's own formulas). Patches are
Tregenza's 145, or finer by Reinhart, in gendaymtx's order without its first, the ground: rows upwards, each from north
clockwise, the zenith last.

An EPW becomes WEA here: hour - 0.5, direct normal and diffuse horizontal, so that gendaymtx sees the same numbers and the
same moments as we do, whatever its version does with EPW. Needs pyradiance (pip install pyradiance) and numpy.
"""
import argparse
import csv
import math
import subprocess
import sys
import tempfile
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pyradiance

GENDAYMTX = Path(pyradiance.__file__).parent / "bin" / "gendaymtx"
PATCHES_IN_ROW = [30, 30, 24, 24, 18, 12, 6]
CLEARNESS_FROM = [1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2]
MONTH_DAYS = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31]


def read(path):
    """Header of a WEA and its rows: month, day, hour, direct, diffuse."""
    lines = path.read_text(encoding="latin-1").splitlines()
    if path.suffix.lower() == ".wea":
        return lines[:6], [line.split()[:5] for line in lines[6:] if line.strip()]
    place = next(csv.reader([lines[0]]))
    latitude, longitude, zone, altitude = map(float, place[6:10])
    head = [
        "place somewhere_else",
        f"latitude {latitude}",
        f"longitude {-longitude}",
        f"time_zone {-15 * zone}",
        f"site_elevation {altitude}",
        "weather_data_file_units 1",
    ]
    rows = [line.split(",") for line in lines[8:] if line.strip()]
    return head, [[row[1], row[2], str(float(row[3]) - 0.5), row[14], row[15]] for row in rows]


def bins(head, rows):
    """Row of Perez's table, 0 to 7, of each hour, with gendaymtx's sun as its option -D tells it (Cooper's declination)."""
    latitude, longitude, meridian = (math.radians(float(line.split()[1])) for line in head[1:4])
    found = []
    for month, day, hour, direct, diffuse in ((int(r[0]), int(r[1]), *map(float, r[2:])) for r in rows):
        number = sum(MONTH_DAYS[: month - 1]) + day
        declination = math.radians(23.45) * math.sin(2 * math.pi * (284 + number) / 365)
        shift = 0.170 * math.sin(4 * math.pi * (number - 80) / 373) - 0.129 * math.sin(2 * math.pi * (number - 8) / 355)
        solar = hour + shift + 12 * (meridian - longitude) / math.pi
        up = math.sin(latitude) * math.sin(declination)
        up -= math.cos(latitude) * math.cos(declination) * math.cos(math.pi * solar / 12)
        zenith = min(max(math.pi / 2 - math.asin(up), math.radians(3)), math.pi / 2)
        steep = 1.041 * zenith**3
        clearness = 99 if diffuse <= 0 else ((direct + diffuse) / diffuse + steep) / (1 + steep)
        found.append(sum(clearness >= start for start in CLEARNESS_FROM))
    return np.array(found)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("weather", type=Path)
    parser.add_argument("--subdivisions", type=int, default=1, help="of Tregenza's patches, along each side")
    options = parser.parse_args()

    head, rows = read(options.weather)
    patches = 1 + options.subdivisions**2 * sum(PATCHES_IN_ROW)
    with tempfile.TemporaryDirectory() as folder:
        tape = Path(folder) / "tape.wea"
        tape.write_text("\n".join([*head, *(" ".join(row) for row in rows)]) + "\n")
        command = "-h -of -s -O1 -c 1 1 1 -m".split() + [str(options.subdivisions), str(tape)]
        answer = subprocess.run([GENDAYMTX, *command], check=True, stdout=subprocess.PIPE).stdout
    sky = np.frombuffer(answer, dtype="<f4").reshape(patches + 1, len(rows), 3)[1:, :, 0]

    direct, diffuse = (np.array([float(row[column]) for row in rows]) for column in (3, 4))
    lit = direct + diffuse > 1e-4
    of = bins(head, rows)
    parts = range(8) if options.subdivisions == 1 else []
    print(f"# {len(rows)} hours of {options.weather.name}: mean radiance of {patches} sky patches, W/m2/sr, by Radiance's")
    print(f"# gendaymtx in pyradiance {version('pyradiance')}: benches/peers/sky_gendaymtx.py --subdivisions {options.subdivisions}")
    print("# lit hours of each row of Perez's table:", *(int(np.sum(lit & (of == number))) for number in range(8)))
    print(",".join(["mean", *(f"row{number + 1}" for number in parts)]))
    for patch in sky.astype(float):
        values = [patch.mean(), *(patch[of == number].sum() / len(rows) for number in parts)]
        print(",".join(f"{value:.6g}" for value in values))


if __name__ == "__main__":
    sys.exit(main())
