"""The guide's places on Mitsuba's device: which one speaks for a point, its lobes and how they are drawn from, its lights."""
import drjit as dr
import mitsuba as mi
import numpy as np
from scipy.spatial import cKDTree

import read_guide

mi.set_variant("llvm_ad_mono")
mi.set_log_level(mi.LogLevel.Error)

# How far points are lifted off surfaces, metres: 10 times what single precision resolves 80 m from the origin.
LIFT_M = 1e-4
# The part of directions drawn without the lobes, and of lights chosen as if nothing cast shadows: where the guide is wrong,
# this bounds the noise.
DEFENSIVE = {"directions": 0.5, "lights": 0.25}
# Bounds of a re-aimed lobe. Under the first it is even over the sphere; over the second, single precision fails.
CONCENTRATION = (1e-2, 5e3)
# The table that finds a place for a point: its cells in voxels, and how many neighbours are asked whether they see the point.
CELL_VOXELS = 2.0
NEIGHBOURS = 16
# Chi-square distance that lobes have by chance: four of them are 15 numbers, fitted to about a hundred lines.
CHANCE = 0.15
# Draws that tell how far the lobes of a place are from the plain draw.
DRAWS_FOR_SHARE = 64
# Paths at a time.
LANES = 1 << 20


class Guide:
    """The guide's places on the device: walls first, then nodes, then one of nothing. Place -1 is none."""

    def __init__(self, scene, setup, folder, seed, wrong=False):
        guide = read_guide.read(folder)
        if wrong:
            # Each place is told what another knows.
            for name in ("walls_lobes", "walls_lights", "nodes_lobes", "nodes_lights"):
                guide[name] = np.random.default_rng(seed).permutation(guide[name])
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
        if not self.places:
            return flat(np.zeros(1))
        place = np.repeat(np.arange(self.places), DRAWS_FOR_SHARE)
        normal = np.concatenate([self.normal, np.tile([0, 0, 1.0], (self.places - self.wall_count, 1))])
        n, p = vector(normal[place]), mi.Point3f(vector(self.position[place]))
        free = mi.Bool(place >= self.wall_count)
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(seed, len(place))
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
    return light["radiance"] * np.pi * np.linalg.norm(np.cross(light["u"], light["v"]))


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
