#!/usr/bin/env python3
"""Computes the outdoor scenes' references with an independent program: Radiance, through radiance_annual.py.

    scenes/outdoor/reference.py scenes/outdoor/*/*.toml --oracle PATH/radiance_annual.py --weather PATH/chicago.epw

Reads the scene file, its meshes and its sensors by code of its own, hands them to the oracle and writes beside the scene:
    exposure_<weather>.csv   id,beam,sky,reflected,total   kWh/m2 over the weather's year
    svf.csv                  id,svf                        cosine-weighted sky view factor, nothing reflected
A scene that has no folder of its own puts its name before theirs: ingolstadt_svf.csv.
Needs Python 3.11, and pyradiance and numpy for the oracle. Knows one reflectance a scene, and no glazing.
"""
import argparse
import datetime
import os
import subprocess
import sys
import tempfile
import time
from importlib.metadata import version
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from mesh_files import SceneFile


def ask(scene, options, flags):
    """Runs the oracle in a folder of its own; gives its table without the header, and how long it took."""
    with tempfile.TemporaryDirectory() as folder:
        obj, sensors, out = (Path(folder) / name for name in ("scene.obj", "sensors.csv", "out.csv"))
        with obj.open("w") as file:
            file.writelines("v %.9g %.9g %.9g\n" % tuple(v) for v in scene.vertices)
            file.writelines(f"f {' '.join(str(c + 1) for c in corners)}\n" for _, corners in scene.faces)
        with sensors.open("w") as file:
            file.write("id,x,y,z,nx,ny,nz\n")
            for name, position, normal in scene.sensors():
                if not normal:
                    raise SystemExit(f"{scene.path}: sensor {name} has no normal")
                file.write(",".join([name] + ["%.9g" % v for v in position + normal]) + "\n")
        begun = time.monotonic()
        command = [sys.executable, options.oracle, obj, options.weather, sensors, out, *flags]
        subprocess.run([str(c) for c in command], check=True)
        return out.read_text().splitlines()[1:], time.monotonic() - begun


def write(target, lines):
    """Beside, then renamed: an interrupted run leaves the old table."""
    beside = target.with_suffix(".part")
    beside.write_text("\n".join(lines) + "\n")
    os.replace(beside, target)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="+")
    parser.add_argument("--oracle", required=True)
    parser.add_argument("--weather", required=True, help="an .epw file")
    parser.add_argument("--bounces", type=int, default=5, help="0: beam and sky alone, in a tenth of the time")
    parser.add_argument("--mf", type=int, default=4, help="the sky's patches: 145 mf^2")
    parser.add_argument("--samples", type=int, default=20000, help="rays of the first bounce, a sensor")
    parser.add_argument("--table", help="name of the exposure's table, if not exposure_<weather>.csv")
    parser.add_argument("--only", choices=["exposure", "svf"], help="one table alone")
    options = parser.parse_args()
    weather = Path(options.weather)
    for path in options.scene:
        scene = SceneFile(path)
        reflectance, *others = set(scene.reflectance.values())
        if others:
            raise SystemExit(f"{path}: more than one reflectance")
        name = scene.table.get("name", scene.path.stem)
        stem = scene.path.stem
        prefix = "" if scene.path.resolve().parent.name == stem else f"{stem}_"
        made = [
            f"# values of an independent program, not of Lightvein: Radiance as pyradiance {version('pyradiance')} ships it,"
            " through radiance_annual.py",
            f"# made {datetime.date.today()} by scenes/outdoor/reference.py {scene.path.name}",
        ]
        taken = [f"--samples={options.samples}"]
        if options.only != "exposure":
            rows, seconds = ask(scene, options, ["--svf", *taken])
            setup = f"# {options.samples} rays a sensor, {seconds:.0f} s for {len(rows)} sensors"
            title = f"# {name}: sky view factor, cosine-weighted: open ground 1, a wall on open ground 0.5"
            table = scene.path.parent / f"{prefix}svf.csv"
            write(table, [title, *made, setup, "id,svf", *rows])
            print(f"{path}: {table.name}, {len(rows)} sensors in {seconds:.0f} s", flush=True)
        if options.only != "svf":
            flags = [f"--reflectance={reflectance}", f"--bounces={options.bounces}", f"--mf={options.mf}", *taken]
            rows, seconds = ask(scene, options, flags)
            bounced = f"reflectance {reflectance}, {options.bounces} bounces" if options.bounces else "nothing reflected"
            setup = (
                f"# {bounced}, sky of {145 * options.mf ** 2} patches (MF{options.mf}),"
                f" suns where they stand every hour, {options.samples} rays a sensor, {seconds:.0f} s for {len(rows)} sensors"
            )
            title = f"# {name}: kWh/m2 over the year of {weather.name}, the sky of another place taken as it is"
            table = scene.path.parent / (options.table or f"{prefix}exposure_{weather.stem}.csv")
            write(table, [title, *made, setup, "id,beam,sky,reflected,total", *rows])
            print(f"{path}: {table.name}, {len(rows)} sensors in {seconds:.0f} s", flush=True)


if __name__ == "__main__":
    main()
