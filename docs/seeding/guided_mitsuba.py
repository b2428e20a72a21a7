#!/usr/bin/env python3
"""Measures what the files of `lightvein guide` do for a renderer that is not ours: Mitsuba 3.

    lightvein guide scenes/gallery/gallery.toml -o /tmp/gallery
    guided_mitsuba.py scenes/gallery/gallery.toml /tmp/gallery --oracle PATH/mitsuba_irradiance.py [--spp 65536]

Paths start at the scene's sensors, ask one light at every vertex (next-event estimation) and end by Russian roulette. Twice by
the same code: plain (directions by the cosine, lights evenly) and guided (half of the directions by the cosine, half by the
lobes of the nearest place of the guide; lights by what reaches that place). Prints for each sensor both means, their
standard errors, the scene's reference and the ratio of the variances at equal samples.

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
from scipy.spatial import cKDTree

import read_guide

# How far points are lifted off surfaces, metres: 10 times what single precision resolves 80 m from the origin.
LIFT_M = 1e-4
# The part of directions drawn without the lobes, and of lights chosen as if nothing cast shadows: where the guide is wrong,
# this bounds the noise.
DEFENSIVE = {"directions": 0.5, "lights": 0.25}
# Reflections before roulette. From then on a plain path survives with the reflectance, so that its weight stays. A guided one
# does when the rest of it is expected to bring at least a third of what the sensor gets (a weight window of 1 to 5, Vorba &
# Krivanek 2016), else with less chance: the guide knows which paths are worth following.
TURNS_BEFORE_ROULETTE = 4
SURVIVAL = (0.1, 0.99)
WINDOW = 3.0
# Bounds of a re-aimed lobe. Under the first it is even over the sphere; over the second, single precision fails.
CONCENTRATION = (1e-2, 5e3)
# The table that finds a place for a point: its cells in voxels, and how many neighbours are asked whether they see the point.
CELL_VOXELS = 2.0
NEIGHBOURS = 16
# Chi-square distance that lobes have by chance: four of them are 15 numbers, fitted to about a hundred lines.
CHANCE = 0.15
# Draws that tell how far the lobes of a place are from the plain draw.
DRAWS_FOR_SHARE = 64
# Above this part of a sensor's sum in one sample, its variance is not known.
TRUSTED_SHARE = 0.05
# Paths at a time.
LANES = 1 << 20

mi.set_variant("llvm_ad_mono")
mi.set_log_level(mi.LogLevel.Error)


def load(scene_path, oracle_path):
    """The scene in Mitsuba as the oracle builds it, its setup (lights), its sensors and its file."""
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
        return oracle.build_scene(mi, str(obj), setup, folder), setup, file


class Guide:
    """The guide's places on the device: walls first, then nodes, then one of nothing. Place -1 is none."""

    def __init__(self, scene, setup, folder, seed):
        guide = read_guide.read(folder)
        # Whether directions and roulette are guided too, or lights alone.
        self.directions = True
        walls, nodes = guide["walls"], guide["nodes"]
        self.wall_count, self.places = len(walls["x"]), len(walls["x"]) + len(nodes["x"])
        self.position = np.concatenate([np.stack([t[c] for c in "xyz"], 1) for t in (walls, nodes)])
        self.normal = np.stack([walls[c] for c in ("nx", "ny", "nz")], 1)
        self.radius_m = nodes["radius"]
        lobes = np.concatenate([guide["walls_lobes"], guide["nodes_lobes"], np.zeros((1, 4, 6))])
        direct = np.concatenate([guide["walls_lights"], guide["nodes_lights"]])[..., 0]

        # What a lobe points at, so that a neighbour of the place can aim at the same.
        distance = np.where(lobes[..., 5] > 0, lobes[..., 5], 1e3)
        target = np.append(self.position, [[0, 0, 0]], 0)[:, None] + distance[..., None] * lobes[..., :3]
        self.aims = flat(np.concatenate([target, lobes[..., 3:4]], 2))
        self.weights = flat(np.stack([lobes[..., 4], distance], 2))
        self.light_sums = flat(np.cumsum(light_chances(scene, setup, guide, self.position, direct), 1))

        self.arriving = flat(np.concatenate([walls["irradiance"], nodes["scalar"], [0]]))
        self.reflected = flat(np.concatenate([walls["reflected"], nodes["reflected"], [0]]))
        self.walls_tree = cKDTree(np.concatenate([self.position[:self.wall_count], self.normal], 1))
        self.nodes_tree = cKDTree(self.position[self.wall_count:])
        self.shares = self._shares(seed)
        self.cell_m = CELL_VOXELS * guide["voxel_m"]
        self._fill_table(scene, seed)

    def _shares(self, seed):
        """For each place the part of directions to draw by its lobes: none where they differ from the plain draw by chance alone.

        Of lobes whose chi-square distance from the plain draw is d, of which chance makes e, the part 1 - e / d costs least.
        """
        place = np.repeat(np.arange(self.places), DRAWS_FOR_SHARE)
        normal = np.concatenate([self.normal, np.tile([0, 0, 1.0], (self.places - self.wall_count, 1))])
        n, p = vector(normal[place]), mi.Point3f(vector(self.position[place]))
        free = mi.Bool(place >= self.wall_count)
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(seed, max(1, len(place)))
        lobes = self.lobes_at(p, mi.UInt32(place), dr.full(mi.Bool, True, len(place)))
        towards = by_lobes(lobes, n, free, sampler.next_1d(), sampler.next_2d())
        # At grazing angles the quotient has no bound, and little light.
        plain = dr.select(free, dr.inv_four_pi, dr.maximum(dr.dot(n, towards), 0.1) * dr.inv_pi)
        quotient = np.array(density_by_lobes(lobes, n, free, towards) / plain).reshape(self.places, DRAWS_FOR_SHARE).mean(1)
        known = 1 - CHANCE / np.maximum(quotient - 1, CHANCE)
        return flat(np.append(np.minimum(known, 1 - DEFENSIVE["directions"]), 0))

    def _fill_table(self, scene, seed):
        """For each cell of a grid and each of six orientations the place of a surface that paths hit there."""
        box = scene.bbox()
        self.low = np.array(box.min).ravel() - self.cell_m
        self.shape = np.ceil((np.array(box.max).ravel() + self.cell_m - self.low) / self.cell_m).astype(int)
        table = np.full(6 * np.prod(self.shape), -1, dtype=np.int32)
        if self.wall_count:
            # What paths from the guide's own places hit stands for its slot.
            start = np.repeat(np.arange(self.wall_count), max(1, LANES // self.wall_count))
            normal = vector(self.normal[start])
            sampler = mi.load_dict({"type": "independent"})
            sampler.seed(seed, len(start))
            towards = mi.Frame3f(normal).to_world(mi.warp.square_to_cosine_hemisphere(sampler.next_2d()))
            hit = scene.ray_intersect(mi.Ray3f(mi.Point3f(vector(self.position[start]) + LIFT_M * normal), towards))
            facing = mi.Normal3f(dr.select(dr.dot(hit.n, towards) > 0, -hit.n, hit.n))
            found = np.array(hit.is_valid())
            point, normal = (np.array(a).T[found] for a in (hit.p, facing))
            slot, first = np.unique(np.array(self._slot(hit.p, facing))[found], return_index=True)
            table[slot] = self.of_walls(scene, point[first], normal[first])
        self.table = mi.Int32(table)

    def _slot(self, p, n):
        cell = [dr.clip(mi.Int32(dr.floor((p[k] - self.low[k]) / self.cell_m)), 0, int(self.shape[k]) - 1) for k in range(3)]
        size = dr.abs(n)
        axis = dr.select((size.x >= size.y) & (size.x >= size.z), 0, dr.select(size.y >= size.z, 1, 2))
        along = dr.select(axis == 0, n.x, dr.select(axis == 1, n.y, n.z))
        side = 2 * mi.Int32(axis) + dr.select(along < 0, mi.Int32(1), mi.Int32(0))
        index = (cell[0] * int(self.shape[1]) + cell[1]) * int(self.shape[2]) + cell[2]
        return mi.UInt32(6 * index + side)

    def at(self, p, n, active):
        """The place for points on surfaces, inside a loop."""
        return dr.gather(mi.Int32, self.table, self._slot(p, n), active)

    def of_walls(self, scene, point, normal):
        """The nearest wall place of a like normal that sees each point; the nearest at all where none does."""
        count = min(NEIGHBOURS, self.wall_count)
        if not count or not len(point):
            return np.full(len(point), -1)
        near = self.walls_tree.query(np.concatenate([point, normal], 1), count)[1].reshape(len(point), count)
        like = (self.normal[near] * normal[:, None]).sum(2) > 0.5
        seen = visible(scene, (point + 1e-2 * normal)[:, None], self.position[near] + 1e-2 * self.normal[near])
        best = np.where((like & seen).any(1), (like & seen).argmax(1), like.argmax(1))
        return np.where(like.any(1), near[np.arange(len(near)), best], -1)

    def of_open(self, scene, point):
        """The nearest node that sees each point (-1 where none does), and how far its lobes hold there.

        Fully in the empty ball about the node; beyond, as radius over distance: what stands nearer looks other than from there.
        """
        count = min(NEIGHBOURS, self.nodes_tree.n)
        if not count or not len(point):
            return np.full(len(point), -1), np.ones(len(point))
        apart_m, near = (found.reshape(len(point), count) for found in self.nodes_tree.query(point, count))
        seen = visible(scene, point[:, None], self.position[near + self.wall_count])
        best = np.arange(len(near)), seen.argmax(1)
        holds = np.minimum(1, self.radius_m[near[best]] / np.maximum(apart_m[best], 1e-6))
        return np.where(seen.any(1), near[best] + self.wall_count, -1), holds

    def lobes_at(self, p, place, active):
        """The lobes of a place re-aimed from p: [(direction, concentration, weight)]."""
        lobes = []
        for lobe in range(4):
            index = mi.UInt32(4 * place + lobe)
            aim = dr.gather(mi.Vector4f, self.aims, index, active)
            weight, distance = dr.gather(mi.Vector2f, self.weights, index, active)
            towards = mi.Vector3f(aim.x, aim.y, aim.z) - p
            length = dr.maximum(dr.norm(towards), 1e-4)
            concentration = dr.clip(aim.w * dr.square(length / distance), *CONCENTRATION)
            # An unused lobe is all zeros; a direction of no length would make a nan of the whole mixture.
            lobes.append((dr.select(weight > 0, towards / length, mi.Vector3f(0, 0, 1)), concentration, weight))
        return lobes


def flat(array):
    return mi.Float(np.ascontiguousarray(array, dtype=np.float32).ravel())


def vector(array):
    return mi.Vector3f(np.ascontiguousarray(array.T, dtype=np.float32))


def visible(scene, a, b):
    """Whether nothing stands between points a and b, arrays of 3-vectors that broadcast."""
    shape = np.broadcast_shapes(a.shape, b.shape)
    a, b = (np.broadcast_to(points, shape).reshape(-1, 3) for points in (a, b))
    ray = mi.Ray3f(mi.Point3f(vector(a)), vector(b - a))
    ray.maxt = mi.Float(1 - 1e-4)
    return ~np.array(scene.ray_test(ray)).reshape(shape[:-1])


def light_chances(scene, setup, guide, position, direct):
    """[place, Mitsuba light]: how often each is to be asked. The last row is for no place: evenly."""
    lights = setup["lights"]
    centre = np.array([centre_of(light) for light in lights])
    flux = np.array([flux_of(light) for light in lights])
    known = np.array([emitter["position"] for emitter in guide["emitters"]]).reshape(-1, 3)
    # Joined emissive faces are one emitter of the guide and several quads here: they share its column by flux.
    owner = np.linalg.norm(centre[:, None] - known[None], axis=2).argmin(1)
    told = direct[:, owner] * (flux / np.bincount(owner, flux, len(known))[owner])
    # What each would bring if nothing stood between; nearer than a voxel counts as a voxel away.
    apart_m = np.linalg.norm(position[:, None] - centre, axis=2)
    bare = flux / np.maximum(apart_m, guide["voxel_m"]) ** 2

    bare, total = bare / bare.sum(1, keepdims=True), told.sum(1, keepdims=True)
    share = np.where(total > 0, DEFENSIVE["lights"], 1)
    chances = (1 - share) * told / np.where(total > 0, total, 1) + share * bare
    chances = np.append(chances, np.full((1, len(lights)), 1 / len(lights)), 0)
    # Mitsuba numbers its emitters by itself.
    names = [(emitter.get_shape() or emitter).id() for emitter in scene.emitters()]
    return chances[:, [int(name.removeprefix("light")) for name in names]]


def centre_of(light):
    if light["type"] == "quad":
        return np.array(light["corner"]) + 0.5 * np.array(light["u"]) + 0.5 * np.array(light["v"])
    return np.array(light["position" if light["type"] == "point" else "center"])


def flux_of(light):
    if "power" in light:
        return light["power"]
    return light["radiance"] * math.pi * np.linalg.norm(np.cross(light["u"], light["v"]))


def choose_light(scene, guide, sampler, place, active):
    """A light for each point by the chances of its place: its number and its chance."""
    count = len(scene.emitters())
    if guide is None or count < 2:
        index = dr.minimum(mi.UInt32(sampler.next_1d(active) * count), count - 1)
        return index, mi.Float(1 / count)
    row = count * mi.UInt32(dr.select(place >= 0, place, guide.places))
    number = sampler.next_1d(active)
    index = dr.binary_search(0, count - 1, lambda i: dr.gather(mi.Float, guide.light_sums, row + i, active) <= number)
    above = dr.gather(mi.Float, guide.light_sums, row + index, active)
    below = dr.select(index > 0, dr.gather(mi.Float, guide.light_sums, row + index - 1, active & (index > 0)), 0)
    return index, above - below


def direct(scene, guide, sampler, p, n, free, place, active):
    """Irradiance at p straight from one light, scalar irradiance where free."""
    index, chance = choose_light(scene, guide, sampler, place, active)
    lights = scene.emitters_dr()
    here = dr.zeros(mi.SurfaceInteraction3f)
    here.p = p
    sample, radiance = dr.gather(mi.EmitterPtr, lights, index, active).sample_direction(here, sampler.next_2d(active), active)
    cosine = dr.select(free, 1, dr.dot(n, sample.d))
    active = active & (sample.pdf > 0) & (cosine > 0)
    shadow = mi.Ray3f(p, sample.d)
    shadow.maxt = sample.dist * (1 - 1e-4)
    return dr.select(active & ~scene.ray_test(shadow, active), cosine * radiance[0] / chance, 0)


def onwards(guide, sampler, p, n, free, place, holds, active):
    """Where a path goes on: a direction, and its density per steradian in the mixture it is drawn from."""
    frame = mi.Frame3f(n)
    square = sampler.next_2d(active)
    towards = dr.select(free, mi.warp.square_to_uniform_sphere(square),
                        frame.to_world(mi.warp.square_to_cosine_hemisphere(square)))

    def even(w):
        return dr.select(free, dr.inv_four_pi, dr.maximum(dr.dot(n, w), 0) * dr.inv_pi)

    if guide is None or not guide.directions:
        return towards, even(towards)
    share = holds * dr.gather(mi.Float, guide.shares, mi.UInt32(place), active & (place >= 0))
    lobes = guide.lobes_at(p, place, active & (place >= 0))
    number = sampler.next_1d(active)
    towards = dr.select(number < share, by_lobes(lobes, n, free, number / share, square), towards)
    return towards, dr.select(share > 0, share * density_by_lobes(lobes, n, free, towards), 0) + (1 - share) * even(towards)


def by_lobes(lobes, n, free, number, square):
    """A direction by one of the lobes, chosen by weight with a number in [0, 1) (Jakob 2012)."""
    axis, concentration = lobes[0][:2]
    left = mi.Float(number)
    for (_, _, weight), (next_axis, next_concentration, next_weight) in zip(lobes, lobes[1:]):
        left -= weight
        later = (left > 0) & (next_weight > 0)
        axis, concentration = dr.select(later, next_axis, axis), dr.select(later, next_concentration, concentration)
    # The cosine falls short of 1 by this much; kept apart, for single precision cannot tell 0.99999995 from 1.
    short = dr.clip(-dr.log(1 - square.x * (1 - dr.exp(-2 * concentration))) / concentration, 0, 2)
    sine, cosine = dr.sincos(dr.two_pi * square.y)
    radius = dr.sqrt(short * (2 - short))
    about = dr.normalize(mi.Frame3f(axis).to_world(mi.Vector3f(radius * cosine, radius * sine, 1 - short)))
    # What points into the wall is mirrored out of it, so that none is lost.
    below = dr.select(free, 0, dr.minimum(dr.dot(n, about), 0))
    return about - 2 * below * n


def density_by_lobes(lobes, n, free, towards):
    """The density of by_lobes, per steradian."""
    mirrored = towards - 2 * dr.dot(n, towards) * n
    density = mi.Float(0)
    for axis, concentration, weight in lobes:
        peak = weight * concentration * dr.inv_two_pi / (1 - dr.exp(-2 * concentration))
        density += peak * dr.exp(-0.5 * concentration * dr.squared_norm(towards - axis))
        density += dr.select(free, 0, peak * dr.exp(-0.5 * concentration * dr.squared_norm(mirrored - axis)))
    return density


@dr.syntax
def estimate(scene, guide, sampler, p, n, free, place, holds=1.0):
    """One sample a lane of the irradiance at p on a surface of normal n, of the scalar irradiance where free.

    guide None is the plain path tracer; place (-1 for none) is the guide's at p and holds how far it does there, 0 to 1. Points stand off surfaces by LIFT_M.
    """
    p, n, free, place, holds = mi.Point3f(p), mi.Vector3f(n), mi.Bool(free), mi.Int32(place), mi.Float(holds)
    value, weight, turns = mi.Float(0), mi.Float(1), mi.UInt32(0)
    hope = mi.Float(0)
    if guide is not None:
        hope = dr.gather(mi.Float, guide.reflected, mi.UInt32(place), place >= 0)
    active = dr.full(mi.Bool, True, dr.width(p))
    while active:
        value += weight * direct(scene, guide, sampler, p, n, free, place, active)

        # The next surface: lights are black, the rest reflects on both sides.
        towards, density = onwards(guide, sampler, p, n, free, place, holds, active)
        cosine = dr.select(free, 1, dr.dot(n, towards))
        active &= (cosine > 0) & (density > 0)
        hit = scene.ray_intersect(mi.Ray3f(p, towards), active)
        active &= hit.is_valid()
        hit.wi = mi.Vector3f(0, 0, 1)
        reflectance = dr.pi * hit.bsdf().eval(mi.BSDFContext(), hit, mi.Vector3f(0, 0, 1), active)[0]
        active &= reflectance > 0
        weight *= cosine / density * reflectance * dr.inv_pi

        n = dr.select(dr.dot(hit.n, towards) > 0, -mi.Vector3f(hit.n), mi.Vector3f(hit.n))
        p = mi.Point3f(hit.p + LIFT_M * n)
        free, holds = mi.Bool(False), mi.Float(1)
        if guide is not None:
            place = guide.at(hit.p, n, active)

        # Roulette once the path is long; with a guide by what the rest of the path is expected to bring.
        turns += 1
        survival = dr.minimum(reflectance, SURVIVAL[1])
        if guide is not None and guide.directions:
            rest = dr.gather(mi.Float, guide.arriving, mi.UInt32(place), active & (place >= 0))
            survival = dr.select((place >= 0) & (hope > 0), dr.clip(WINDOW * weight * rest / hope, *SURVIVAL), survival)
        survival = dr.select(turns > TURNS_BEFORE_ROULETTE, survival, 1)
        active &= sampler.next_1d(active) < survival
        weight /= survival
    return value


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
    parser.add_argument("--json", help="writes the figures there too")
    options = parser.parse_args()
    for path, what in ((options.scene, "no such scene file"), (options.oracle, "no such script"),
                       (Path(options.guide) / "guide.json", "no such file; `lightvein guide SCENE -o DIR` writes it")):
        if not Path(path).is_file():
            sys.exit(f"{path}: {what}")
    if options.spp < 2:
        sys.exit(f"--spp {options.spp}: at least 2 samples are needed for a variance")
    scene, setup, file = load(options.scene, options.oracle)
    if not setup["lights"]:
        sys.exit(f"{options.scene}: has no lights")
    sensors = file.sensors()
    try:
        guide = Guide(scene, setup, options.guide, options.seed)
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f"{options.guide}: not a whole guide: {type(error).__name__}: {error}")
    places, holds = places_of(scene, guide, sensors)
    lights_alone = copy.copy(guide)
    lights_alone.directions = False
    runs = []
    for number, contestant in enumerate((None, lights_alone, guide)):
        measure(scene, contestant, sensors, places, holds, 2, options.seed)  # has it compiled, so that times compare
        runs.append(measure(scene, contestant, sensors, places, holds, options.spp, options.seed + 1_000_000 * number))
    report(options, sensors, reference_of(file), *runs)


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
        Path(options.json).write_text(json.dumps({"samples": options.spp, "seconds": [plain["seconds"], guided["seconds"]], "sensors": rows}, indent=1))


if __name__ == "__main__":
    main()
