#!/usr/bin/env python3
"""Times Radiance's mean sky of a year: benches/peers/sky_speed.py WEATHER SECONDS

Runs `gendaymtx -A -O1 -m M` (Perez' sky and the sun, the mean of all hours) on a WEA or EPW file at some subdivisions M, the
median of three, and compares each with SECONDS, what our map of 512 x 512 texels took on the same file. gendaymtx uses one
thread; its patches are coarser than our texels at every M here, and its time grows with their number. Needs pyradiance
(pip install pyradiance) and numpy, as sky_gendaymtx.py does.
"""
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from sky_gendaymtx import GENDAYMTX, read

TEXELS = 512 * 512


def main():
    path, ours = Path(sys.argv[1]), float(sys.argv[2])
    head, rows = read(path)
    print(f"\ngendaymtx, one thread, against {ours:.3f} s of ours for {TEXELS} texels")
    with tempfile.NamedTemporaryFile("w", suffix=".wea") as wea:
        wea.write("\n".join(head + [" ".join(map(str, row)) for row in rows]) + "\n")
        wea.flush()
        for subdivision in (1, 4, 8, 16):
            seconds = []
            for _ in range(3):
                begin = time.perf_counter()
                out = subprocess.run([GENDAYMTX, "-A", "-O1", "-h", "-m", str(subdivision), wea.name],
                                     capture_output=True, text=True, check=True).stdout
                seconds.append(time.perf_counter() - begin)
            patches, taken = len(out.split("\n")) - 1, statistics.median(seconds)
            per_direction = (taken / patches) / (ours / TEXELS)
            print(f"  -m {subdivision:2}: {patches:6} patches, {taken:7.3f} s: {taken / ours:6.1f} x our time, "
                  f"{per_direction:6.0f} x a direction")


main()
