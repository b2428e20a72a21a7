#!/usr/bin/env python3
"""Computes a scene's reference table with an independent program: Mitsuba 3, through mitsuba_irradiance.py.

    scenes/reference.py scenes/gallery/gallery.toml --oracle PATH/mitsuba_irradiance.py [--spp N] [--rel R]

Reads the scene file, its meshes and its sensors by code of its own, hands them to the oracle and writes the table that
[sensors] names as reference: id,irradiance,stderr,fx,fy,fz (W/m2; f is the net flux vector, 0,0,0 = not known).
Needs Python 3.11, and mitsuba and numpy for the oracle. Does not know thin glazing.
"""
import argparse
import csv
import datetime
import json
import math
import os
import subprocess
import sys
import tempfile
from importlib.metadata import version
from pathlib import Path

from mesh_files import SceneFile

# A sensor one of whose samples makes up more of its sum than this has seen too few of the paths that light it.
TRUSTED_SHARE = 0.05


def lights(scene):
    """The scene's lights as the oracle takes them; an emissive parallelogram of the mesh is a quad light."""
    for light in scene.table.get("lights", []):
        setup = {"type": light["kind"], "power": light["flux_w"]}
        setup |= {k: v for k, v in light.items() if k not in ("kind", "flux_w")}
        yield setup
    for material, corners in scene.faces:
        if not scene.emission.get(material):
            continue
        a, b, c, d = (scene.vertices[i] for i in corners)
        if any(abs(a[k] + c[k] - b[k] - d[k]) > 1e-6 for k in range(3)):
            raise SystemExit(f"{scene.path}: an emissive face of {material} is no parallelogram")
        yield {
            "type": "quad", "corner": a, "radiance": scene.emission[material],
            "u": [b[k] - a[k] for k in range(3)], "v": [d[k] - a[k] for k in range(3)],
        }


def kept(target):
    """The table that is there: its remarks, and its rows by sensor id."""
    lines = target.read_text().splitlines() if target.exists() else []
    rows = {line.split(",")[0]: line for line in lines if line and not line.startswith(("#", "id,"))}
    return [line for line in lines if line.startswith("#")], rows


def ask(scene, sensors, options):
    """Runs the oracle in a folder of its own for these sensors and gives its rows by sensor id."""
    with tempfile.TemporaryDirectory() as folder:
        obj, setup, out = (Path(folder) / name for name in ("scene.obj", "setup.json", "out.csv"))
        with obj.open("w") as file:
            file.writelines("v %.9g %.9g %.9g\n" % tuple(v) for v in scene.vertices)
            for material, corners in scene.faces:
                # An emissive face is handed over as a light, and must not lie in front of itself.
                if not scene.emission.get(material):
                    file.write(f"usemtl {material or 'none'}\nf {' '.join(str(c + 1) for c in corners)}\n")
        setup.write_text(json.dumps({
            "reflectance": {material or "none": value for material, value in scene.reflectance.items()},
            "lights": list(lights(scene)),
            "sensors": [
                {"name": name, "position": p} | ({"normal": n} if n else {}) for name, p, n in sensors
            ],
        }))
        command = [sys.executable, options.oracle, obj, setup, out]
        for flag in ("variant", "spp", "min_spp", "rel", "rr_depth", "seed", "max_seconds"):
            command += ["--" + flag.replace("_", "-"), str(getattr(options, flag))]
        subprocess.run([str(c) for c in command], check=True, stdout=subprocess.DEVNULL)
        with out.open() as file:
            return {row["name"]: row for row in csv.DictReader(file)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="+")
    parser.add_argument("--oracle", required=True)
    parser.add_argument("--variant", default="llvm_ad_mono")
    parser.add_argument("--spp", type=int, default=1 << 24, help="most samples a sensor")
    parser.add_argument("--min-spp", type=int, default=1 << 17, help="fewest samples a sensor")
    parser.add_argument("--rel", type=float, default=0.005, help="enough once stderr / irradiance is below this")
    # Roulette by throughput keeps reflectance^depth of the paths: begun early, it starves dark sensors.
    parser.add_argument("--rr-depth", type=int, default=24)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--max-seconds", type=float, default=600.0, help="for the scalar and the planar sensors each")
    parser.add_argument("--add", action="store_true", help="keep the table's rows, ask for the sensors it lacks alone")
    options = parser.parse_args()
    for path in options.scene:
        scene = SceneFile(path)
        if "reference" not in scene.table.get("sensors", {}):
            print(f"{path}: skipped, it names no reference")
            continue
        target = scene.path.parent / scene.table["sensors"]["reference"]
        remarks, old = kept(target) if options.add else ([], {})
        sensors = [sensor for sensor in scene.sensors() if sensor[0] not in old]
        if not sensors:
            print(f"{path}: no sensor lacks a reference")
            continue
        rows = ask(scene, sensors, options)
        order = [name for name, _, _ in sensors]
        planar = {name for name, _, normal in sensors if normal}
        rare = [name for name in order if float(rows[name]["top_share"]) > TRUSTED_SHARE]
        relative = {name: float(rows[name]["se"]) / max(float(rows[name]["E"]), 1e-300) for name in order}
        made = [
            "# values of an independent program, not of Lightvein: Mitsuba "
            f"{version('mitsuba')}, {options.variant}, integrator path, through mitsuba_irradiance.py",
            f"# {min(int(rows[n]['spp']) for n in order)} to {max(int(rows[n]['spp']) for n in order)} samples a sensor"
            f" (until stderr / irradiance <= {options.rel}), any number of bounces,"
            f" roulette from depth {options.rr_depth}, seed {options.seed}",
            f"# made {datetime.date.today()} by scenes/reference.py {scene.path.name}",
        ]
        if any(scene.emission.get(material) for material, _ in scene.faces):
            made.append("# emissive faces of the mesh shine to one side and reflect nothing, whatever their Kd")
        if rare:
            made.append(f"# one sample over {TRUSTED_SHARE:.0%} of the sum, standard error not to be trusted: {' '.join(rare)}")
        title = f"# {scene.table.get('name', scene.path.stem)}: irradiance and standard error in W/m2; f = net flux vector in W/m2, 0,0,0 = not known"
        added = [f"# added: {' '.join(order)}"] if old else []
        lines = [*(remarks or [title]), *added, *made, "id,irradiance,stderr,fx,fy,fz"]
        new = {}
        for name in order:
            row = rows[name]
            flux = [0.0, 0.0, 0.0] if name in planar else [float(row[k]) for k in ("fx", "fy", "fz")]
            new[name] = ",".join([name] + ["%.6g" % v for v in [float(row["E"]), float(row["se"]), *flux]])
        lines += [(old | new)[name] for name, _, _ in scene.sensors()]
        # Beside, then renamed: an interrupted run leaves the old table.
        beside = target.with_suffix(".part")
        beside.write_text("\n".join(lines) + "\n")
        os.replace(beside, target)
        worst = sorted(order, key=relative.get)[-3:]
        values = [float(rows[n]["E"]) for n in order]
        print(f"{scene.path}: {min(values):.3g} to {max(values):.3g} W/m2 ({math.log10(max(values) / max(min(values), 1e-300)):.2f} decades),"
              f" worst {', '.join(f'{n} {relative[n]:.2%}' for n in worst)}" + (f", rare {' '.join(rare)}" if rare else ""))


if __name__ == "__main__":
    main()
