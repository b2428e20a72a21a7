#!/usr/bin/env python3
"""Times the path tracer and Mitsuba 3 on the gallery in one run: benches/peers/trace_peer.py PATH/mitsuba_irradiance.py

Both take 65,536 samples at each of the seven sensors, any number of bounces. Prints sensor-samples a second of both, and the
seconds that each sensor needs for a standard error of 1%. Mitsuba's own roulette starts at its default depth (8) and,
as the references were made, at depth 24. Needs mitsuba and numpy, and scenes/reference.py.
"""
import argparse
import csv
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scenes"))
from mesh_files import SceneFile  # noqa: E402
from reference import lights  # noqa: E402


def mitsuba(oracle, rr_depth, samples):
    """(seconds, {sensor: stderr / irradiance}) of one run, starting up and compiling not counted."""
    scene = SceneFile(ROOT / "scenes/gallery/gallery.toml")
    with tempfile.TemporaryDirectory() as folder:
        obj, setup, out = (Path(folder) / name for name in ("scene.obj", "setup.json", "out.csv"))
        with obj.open("w") as file:
            file.writelines("v %.9g %.9g %.9g\n" % tuple(v) for v in scene.vertices)
            for material, corners in scene.faces:
                file.write(f"usemtl {material or 'none'}\nf {' '.join(str(c + 1) for c in corners)}\n")
        sensors = [{"name": name, "position": p} | ({"normal": n} if n else {}) for name, p, n in scene.sensors()]
        reflectance = {material or "none": value for material, value in scene.reflectance.items()}
        setup.write_text(json.dumps({"reflectance": reflectance, "lights": list(lights(scene)), "sensors": sensors}))
        command = [sys.executable, oracle, obj, setup, out, "--spp", samples, "--rr-depth", rr_depth, "--threads", 2]
        done = subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True)
        seconds = float(re.search(r"samples, ([0-9.]+) s", done.stderr).group(1))
        with out.open() as file:
            return seconds, {row["name"]: float(row["se"]) / float(row["E"]) for row in csv.DictReader(file)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("oracle")
    options = parser.parse_args()
    samples = 65536
    print(subprocess.run(["cargo", "bench", "--no-default-features", "--bench", "trace"], cwd=ROOT, check=True, capture_output=True, text=True).stdout)
    for rr_depth in (8, 24):
        seconds, shares = mitsuba(options.oracle, rr_depth, samples)
        print(f"Mitsuba, roulette from depth {rr_depth}: {seconds:.2f} s, {len(shares) * samples / seconds:.3e} sensor-samples/s")
        for name, share in shares.items():
            print(f"{name}: +- {100 * share:.2f}%, {seconds / len(shares) * (share / 0.01) ** 2:.3f} s for 1%")


if __name__ == "__main__":
    main()
