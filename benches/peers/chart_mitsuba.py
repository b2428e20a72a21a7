#!/usr/bin/env python3
"""Mitsuba 3 as a series of the chart: benches/peers/chart_mitsuba.py SCENE.toml... --oracle PATH/mitsuba_irradiance.py > peer.csv

Writes the table that `lightvein chart --peer` reads: seconds and errors at a scene's referenced sensors with 4, 16, 64 ...
samples, as far as the budget goes. Mitsuba runs as fast as it does: many sensors in one kernel launch, kernels compiled
before the clock starts, roulette from its default depth (8). Seconds are measured for 7, 1,000, 10,000 and 100,000 sensors
(the scene's own, repeated) where they fit the budget (measured at a smaller number before), and scaled from the largest measured number where not. Its start and the
compiling of the first launch are told on stderr and count nowhere. The references were made by the same program with
another seed and 2^17 samples and more.
Needs mitsuba and numpy, Python 3.11, and scenes/reference.py. Does not know thin glazing.
"""
import argparse
import csv
import importlib.util
import json
import math
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scenes"))
from mesh_files import SceneFile  # noqa: E402
from reference import lights  # noqa: E402

SENSORS = (7, 1_000, 10_000, 100_000)
SAMPLES = [4**power for power in range(1, 11)]
# A reference known to worse than this is left out, as Lightvein leaves it out.
WORST_REFERENCE = 0.1
# Seconds by the wall; with --processor-time of all threads.
CLOCK = time.perf_counter
HEAD = ("scene", "method", "quality", "sensors", "seconds", "scaled", "rms_factor", "max_factor", "lost")


def load(oracle):
    """The oracle as a module, and Mitsuba."""
    spec = importlib.util.spec_from_file_location("oracle", oracle)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    import mitsuba as mi

    mi.set_variant("llvm_ad_mono")
    mi.set_log_level(mi.LogLevel.Error)
    return module, mi


def built(oracle, mi, scene, folder):
    """The scene in Mitsuba; emissive faces are handed over as lights."""
    obj = Path(folder) / "scene.obj"
    with obj.open("w") as file:
        file.writelines("v %.9g %.9g %.9g\n" % tuple(v) for v in scene.vertices)
        for material, corners in scene.faces:
            if not scene.emission.get(material):
                file.write(f"usemtl {material or 'none'}\nf {' '.join(str(c + 1) for c in corners)}\n")
    setup = {
        "reflectance": {material or "none": value for material, value in scene.reflectance.items()},
        "lights": json.loads(json.dumps(list(lights(scene)))),
    }
    return oracle.build_scene(mi, str(obj), setup, folder)


def references(scene):
    """{sensor: irradiance} where the reference is good."""
    path = scene.path.parent / scene.table["sensors"]["reference"]
    lines = [line for line in path.read_text().splitlines() if line and not line.startswith("#")]
    rows = [(row["id"], float(row["irradiance"]), float(row["stderr"])) for row in csv.DictReader(lines)]
    return {name: value for name, value, stderr in rows if value > 0 and stderr <= WORST_REFERENCE * value}


def errors(values, known):
    """(rms_factor, max_factor, lost) as Lightvein has them: infinite where an estimate is zero."""
    ratios = [values[name] / known[name] for name in known]
    lost = sum(ratio == 0 for ratio in ratios)
    if lost or not ratios:
        return math.inf, math.inf, lost
    logs = [math.log10(ratio) for ratio in ratios]
    return 10 ** math.sqrt(sum(log * log for log in logs) / len(logs)), 10 ** max(map(abs, logs)), 0


class Sensors:
    """Sensors as arrays, those without a normal and those with one apart: each kind is a kernel of its own."""

    def __init__(self, sensors):
        self.kinds = []
        for free in (True, False):
            some = [sensor for sensor in sensors if (sensor[2] is None) == free]
            normals = np.array([sensor[2] or (0.0, 0.0, 1.0) for sensor in some], float).reshape(-1, 3)
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
            positions = np.array([sensor[1] for sensor in some], float).reshape(-1, 3)
            if some:
                self.kinds.append((free, [sensor[0] for sensor in some], positions, normals))

    def __len__(self):
        return sum(len(names) for _, names, _, _ in self.kinds)

    def run(self, oracle, mi, scene, integrator, samples, seed, lanes):
        """(seconds, {sensor: irradiance}), the clock around the launches and the sums of their samples alone."""
        began, means = CLOCK(), []
        for free, names, positions, normals in self.kinds:
            total, done = np.zeros(len(names)), 0
            while done < samples:
                chunk = min(samples - done, max(1, lanes // len(names)))
                sums, _ = oracle.llvm_batch(mi, scene, integrator, positions, normals, chunk, 1e-4, seed, free)
                total, done, seed = total + sums[:, 4], done + chunk, seed + 1
            means.append((names, total / samples))
        seconds = CLOCK() - began
        return seconds, {name: float(value) for names, values in means for name, value in zip(names, values)}


def median(run, count, samples):
    """The median of three runs when they are short; the first launch of a size compiles and counts nowhere."""
    warm, _ = run(11)
    runs = [run(12)]
    if runs[0][0] < 1.0:
        runs += [run(12), run(12)]
    print(f"{count} sensors, {samples} samples: first launch {warm:.3f} s, then {runs[0][0]:.3f} s", file=sys.stderr)
    return sorted(seconds for seconds, _ in runs)[len(runs) // 2], runs[0][1]


def chart(oracle, mi, path, options, out):
    """The rows of one scene."""
    scene = SceneFile(path)
    own = scene.sensors()
    known = references(scene)
    name = scene.table.get("name", scene.path.stem)
    with tempfile.TemporaryDirectory() as folder:
        built_scene = built(oracle, mi, scene, folder)
        integrator = mi.load_dict({"type": "path", "max_depth": -1, "rr_depth": 8})
        spread = {
            count: Sensors([(f"{number}", *own[number % len(own)][1:]) for number in range(count)]) for count in SENSORS
        }
        at_own = Sensors(own)

        def measured(sensors, samples):
            run = lambda seed: sensors.run(oracle, mi, built_scene, integrator, samples, seed, options.lanes)  # noqa: E731
            return median(run, len(sensors), samples)

        per_sample = 0.0
        for samples in SAMPLES:
            if per_sample * samples * len(own) > options.budget:
                break
            seconds, values = measured(at_own, samples)
            per_sample = seconds / (samples * len(own))
            rms_factor, max_factor, lost = errors(values, known)
            largest = (len(own), seconds)
            for count in SENSORS:
                # Many sensors fill the machine better than few: what a launch costs besides is shared by more.
                fits = largest[1] * max(count / largest[0], 1.0) <= options.budget
                if fits:
                    seconds, _ = measured(spread[count], samples)
                    largest = max(largest, (count, seconds))
                else:
                    seconds = largest[1] * count / largest[0]
                out.writerow((name, "mitsuba", f"{samples} samples", count, f"{seconds:.6f}", str(not fits).lower(),
                              f"{rms_factor:.4f}", f"{max_factor:.4f}", lost))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="+")
    parser.add_argument("--oracle", required=True)
    parser.add_argument("--budget", type=float, default=20.0, help="seconds; no run is begun that would take longer")
    parser.add_argument("--lanes", type=int, default=1 << 20, help="samples in one launch")
    parser.add_argument("--threads", type=int, default=0, help="0: one a core")
    parser.add_argument("--processor-time", action="store_true", help="as lightvein chart --processor-time")
    options = parser.parse_args()
    if options.processor_time:
        global CLOCK
        CLOCK = time.process_time
    began = time.perf_counter()
    oracle, mi = load(options.oracle)
    if options.threads:
        import drjit

        drjit.set_thread_count(options.threads)
    print(f"Mitsuba {mi.__version__} started in {time.perf_counter() - began:.1f} s, not counted", file=sys.stderr)
    print(f"# Mitsuba {mi.__version__}, llvm_ad_mono, {options.lanes} samples a launch, roulette from depth 8; by benches/peers/chart_mitsuba.py")
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(HEAD)
    for path in options.scene:
        chart(oracle, mi, path, options, out)


if __name__ == "__main__":
    main()
