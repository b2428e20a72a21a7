#!/usr/bin/env python3
"""Measures what the files of `lightvein guide` do for a renderer that is not ours: Mitsuba 3.

    lightvein guide scenes/gallery/gallery.toml -o /tmp/gallery
    guided_mitsuba.py scenes/gallery/gallery.toml /tmp/gallery --oracle PATH/mitsuba_irradiance.py [--spp 65536]

Paths start at the scene's sensors, ask one light at every vertex (next-event estimation) and end by Russian roulette. Twice by
the same code: plain (directions by the cosine, lights evenly) and guided (at least half of the directions by the cosine, the
others by the lobes of the nearest place of the guide; lights by what reaches that place; roulette by what a path is expected
to bring). Prints for each sensor both means, their standard errors, the scene's reference and the ratio of the variances at
equal samples.

Both are unbiased: what is drawn is divided by the density of the whole mixture, so a wrong guide costs samples and never a
wrong answer. What a path hits by chance is never counted as emission, so lobes need to tell of reflected light alone.
Needs Python 3.11, mitsuba, numpy and scipy. Does not know thin glazing or daylight.
"""
import argparse
import copy
import csv
import importlib.util
import json
import math
import sys
import tempfile
import time
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

from guide_places import LANES, LIFT_M, Guide, flat, vector
from guided_paths import TURNS_BEFORE_ROULETTE, estimate

# Above this part of a sensor's sum in one sample, its variance is not known.
TRUSTED_SHARE = 0.05


def load(scene_path, oracle_path):
    """The scene in Mitsuba as the oracle builds it, its setup (lights), its file, and the oracle."""
    sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scenes"))
    import mesh_files
    import reference
    module = importlib.util.spec_from_file_location("oracle", oracle_path)
    oracle = importlib.util.module_from_spec(module)
    module.loader.exec_module(oracle)

    file = mesh_files.SceneFile(scene_path)
    setup = {"reflectance": {m or "none": r for m, r in file.reflectance.items()}, "lights": list(reference.lights(file))}
    with tempfile.TemporaryDirectory() as folder:
        obj = Path(folder) / "scene.obj"
        with obj.open("w") as out:
            out.writelines("v %.9g %.9g %.9g\n" % tuple(v) for v in file.vertices)
            for material, corners in file.faces:
                if not file.emission.get(material):
                    out.write(f"usemtl {material or 'none'}\nf {' '.join(str(c + 1) for c in corners)}\n")
        return oracle.build_scene(mi, str(obj), setup, folder), setup, file, oracle


def measure(scene, guide, sensors, places, holds, samples, seed):
    """For each sensor the mean, its standard error, the variance of a sample and the largest sample's part of the sum."""
    free = np.array([normal is None for _, _, normal in sensors])
    normals = np.array([normal or (0, 0, 1) for _, _, normal in sensors], dtype=float)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    points = np.array([position for _, position, _ in sensors]) + LIFT_M * np.where(free[:, None], 0, normals)
    sums = np.zeros((3, len(sensors)))
    done, began = 0, time.process_time()
    while done < samples:
        chunk = min(samples - done, max(1, LANES // len(sensors)))
        lane = np.repeat(np.arange(len(sensors)), chunk)
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(seed, len(lane))
        with dr.suspend_grad():
            value = estimate(scene, guide, sampler, vector(points[lane]), vector(normals[lane]), free[lane],
                             places[lane].astype(np.int32), flat(holds[lane]))
        value = np.array(value, dtype=np.float64).reshape(len(sensors), chunk)
        sums[:2] += value.sum(1), (value * value).sum(1)
        sums[2] = np.maximum(sums[2], value.max(1))
        done, seed = done + chunk, seed + 1
    mean = sums[0] / samples
    variance = np.maximum(sums[1] / samples - mean * mean, 0) * samples / (samples - 1)
    top_share = sums[2] / np.maximum(sums[0], 1e-300)
    return {"mean": mean, "stderr": np.sqrt(variance / samples), "variance": variance, "top_share": top_share,
            "seconds": time.process_time() - began}


def places_of(scene, guide, sensors):
    """The guide's place for each sensor, a wall's for one with a normal and a node's for one without, and how far it holds."""
    places, holds = np.full(len(sensors), -1), np.ones(len(sensors))
    free = np.array([normal is None for _, _, normal in sensors])
    points = np.array([position for _, position, _ in sensors])
    if (~free).any():
        normals = np.array([normal for _, _, normal in sensors if normal], dtype=float)
        places[~free] = guide.of_walls(scene, points[~free], normals)
    places[free], holds[free] = guide.of_open(scene, points[free])
    return places, holds


def reference_of(file):
    """{sensor: (irradiance, standard error)} of the scene's own reference table."""
    name = file.table["sensors"].get("reference")
    if not name or not (file.path.parent / name).exists():
        return {}
    lines = [line for line in (file.path.parent / name).read_text().splitlines() if not line.startswith("#")]
    return {row["id"]: (float(row["irradiance"]), float(row["stderr"])) for row in csv.DictReader(lines)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help="a scene file with sensors")
    parser.add_argument("guide", help="the folder that `lightvein guide` wrote")
    parser.add_argument("--oracle", required=True, help="mitsuba_irradiance.py, which builds the scene")
    parser.add_argument("--spp", type=int, default=1 << 16, help="samples a sensor, plain and guided each")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--own", action="store_true", help="Mitsuba's own path tracer too, through the oracle")
    parser.add_argument("--wrong", action="store_true", help="shuffles what the guide's places know: noise, and no bias")
    parser.add_argument("--json", help="writes the figures there too")
    options = parser.parse_args()
    for path, what in ((options.scene, "no such scene file"), (options.oracle, "no such script"),
                       (Path(options.guide) / "guide.json", "no such file; `lightvein guide SCENE -o DIR` writes it")):
        if not Path(path).is_file():
            sys.exit(f"{path}: {what}")
    if options.spp < 2:
        sys.exit(f"--spp {options.spp}: at least 2 samples are needed for a variance")
    scene, setup, file, oracle = load(options.scene, options.oracle)
    if not setup["lights"]:
        sys.exit(f"{options.scene}: has no lights")
    sensors = file.sensors()
    began = time.process_time()
    try:
        guide = Guide(scene, setup, options.guide, options.seed, options.wrong)
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f"{options.guide}: not a whole guide: {type(error).__name__}: {error}")
    print(f"tables for {guide.places} places: {time.process_time() - began:.1f} processor seconds")
    places, holds = places_of(scene, guide, sensors)
    lights_alone = copy.copy(guide)
    lights_alone.directions = False
    runs = []
    for number, contestant in enumerate((None, lights_alone, guide)):
        measure(scene, contestant, sensors, places, holds, 2, options.seed)  # has it compiled, so that times compare
        runs.append(measure(scene, contestant, sensors, places, holds, options.spp, options.seed + 1_000_000 * number))
    report(options, sensors, reference_of(file), *runs)
    if options.own:
        # Roulette as late as ours, and lights that are hit by chance weighed against those asked for (the path plugin does both).
        settings = argparse.Namespace(bounces=-1, rr_depth=TURNS_BEFORE_ROULETTE + 1, eps=LIFT_M, spp=options.spp, min_spp=options.spp,
                                      rel=0, lanes=LANES, seed=options.seed + 3_000_000, max_seconds=math.inf)
        own = np.array([row["se"] for row in oracle.run(mi, scene, sensors, settings)])
        ratio = np.square(own / runs[0]["stderr"])
        print(f"Mitsuba's own path tracer, its variance / plain: median {np.median(ratio):.2f}  least {ratio.min():.2f}"
              f"  most {ratio.max():.2f}")


def report(options, sensors, reference, plain, lights, guided):
    ratios = [plain["variance"] / np.maximum(run["variance"], 1e-300) for run in (lights, guided)]
    in_time = ratios[1] * plain["seconds"] / guided["seconds"]
    apart = (guided["mean"] - plain["mean"]) / np.maximum(np.hypot(guided["stderr"], plain["stderr"]), 1e-300)
    true, error = np.array([reference.get(name, (math.nan, math.nan)) for name, _, _ in sensors]).T
    from_true = (guided["mean"] - true) / np.maximum(np.hypot(guided["stderr"], error), 1e-300)
    top_share = np.maximum(plain["top_share"], guided["top_share"])

    print(f"{'sensor':16}{'plain':>12}{'+-':>10}{'guided':>12}{'+-':>10}{'apart':>7}{'reference':>12}{'apart':>7}{'lights':>8}{'ratio':>8}")
    for k, (name, _, _) in enumerate(sensors):
        print(f"{name:16}{plain['mean'][k]:12.5g}{plain['stderr'][k]:10.2g}{guided['mean'][k]:12.5g}{guided['stderr'][k]:10.2g}"
              f"{apart[k]:7.1f}{true[k]:12.5g}{from_true[k]:7.1f}{ratios[0][k]:8.2f}{ratios[1][k]:8.2f}"
              + "*" * bool(top_share[k] > TRUSTED_SHARE))
    print(f"W/m2, {options.spp} samples a sensor; apart: from plain and from the reference, in standard errors;\n"
          "ratio: variance of plain / guided at equal samples; lights: the same with lights alone guided;\n"
          f"*: one sample is over {TRUSTED_SHARE:.0%} of its sum, the variance is not known")
    print(f"processor seconds: plain {plain['seconds']:.2f}, guided {guided['seconds']:.2f}")
    for name, ratio in (("lights alone", ratios[0]), ("equal samples", ratios[1]), ("equal time", in_time)):
        print(f"{name:14} median {np.median(ratio):7.2f}  least {ratio.min():7.2f}  most {ratio.max():7.2f}")
    print(f"apart in standard errors, most: {np.abs(apart).max():.1f} from plain, {np.nanmax(np.abs(from_true)):.1f} from the reference")
    if options.json:
        table = {"plain": plain["mean"], "plain_stderr": plain["stderr"], "guided": guided["mean"], "guided_stderr": guided["stderr"],
                 "ratio_of_lights": ratios[0], "ratio": ratios[1], "ratio_in_time": in_time, "top_share": top_share}
        rows = [{"id": name} | {key: float(column[k]) for key, column in table.items()} for k, (name, _, _) in enumerate(sensors)]
        document = {"samples": options.spp, "seconds": [plain["seconds"], guided["seconds"]], "sensors": rows}
        Path(options.json).write_text(json.dumps(document, indent=1))


if __name__ == "__main__":
    main()
