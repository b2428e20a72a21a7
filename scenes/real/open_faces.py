"""Which faces of a mesh stand in the open air, and on which side? Points on them, for sensors of exposure.

A scratch tool of make_real.py (numpy, pyradiance). Meshes of cities have faces twice, faces without area, sheets, and faces
that look the wrong way; so a point's side is the one that sees more sky, asked by rays of an independent program (rtrace).
"""
import math
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import pyradiance

RADIANCE = Path(pyradiance.__file__).parent
# How far points stand off their faces, metres.
OFF_M = 1e-3
# Rays a side, by the cosine, and how many must leave to the sky: fewer see it through cracks, if at all.
RAYS, LEAST_TO_SKY = 256, 8
# A place where no ray goes farther than this is a crevice, metres; and a face nearer than this in any direction is a
# corner or a copy of the face, on which side of which a point stands is chance.
CREVICE_M, TOUCHING_M = 0.3, 5e-3
# Faces smaller than this have no side, m2.
LEAST_AREA_M2 = 1e-6


def triangles(scene):
    """Gives corners [triangle, corner, axis] of the faces that have an area."""
    corners = np.array([
        [scene.vertices[face[0]], scene.vertices[face[k]], scene.vertices[face[k + 1]]]
        for _, face in scene.faces for k in range(1, len(face) - 1)
    ])
    return corners[np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) > 2 * LEAST_AREA_M2]


def cosine_about(normals):
    """Gives directions [normal, ray, axis]: spread by the cosine, the same pattern for all (R2 sequence, M. Roberts 2018)."""
    index = np.arange(1, RAYS + 1)
    u, v = (0.5 + index * 0.7548776662466927) % 1.0, (0.5 + index * 0.5698402909980532) % 1.0
    x, y, z = np.sqrt(u) * np.cos(2 * math.pi * v), np.sqrt(u) * np.sin(2 * math.pi * v), np.sqrt(1 - u)
    aside = np.where(np.abs(normals[:, :1]) > 0.9, [[0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0]])
    first = np.cross(normals, aside)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(normals, first)
    frame = np.stack([first, second, normals], axis=1)
    return np.einsum("rk,nka->nra", np.stack([x, y, z], axis=1), frame)


class Rays:
    """A mesh under rtrace."""

    def __init__(self, corners):
        self.folder = tempfile.TemporaryDirectory()
        self.environment = dict(os.environ, RAYPATH=f".:{RADIANCE}/lib", PATH=f"{RADIANCE}/bin:" + os.environ["PATH"])
        with (Path(self.folder.name) / "scene.rad").open("w") as file:
            file.write("void plastic wall\n0\n0\n5 0 0 0 0 0\n")
            for number, triangle in enumerate(corners):
                file.write(f"wall polygon t{number}\n0\n0\n9 " + " ".join("%.9g" % c for c in triangle.ravel()) + "\n")
        with (Path(self.folder.name) / "scene.oct").open("wb") as file:
            subprocess.run(["oconv", "scene.rad"], cwd=self.folder.name, env=self.environment, stdout=file, check=True)

    def lengths_m(self, points, directions):
        """How far each ray goes; infinite where it leaves."""
        rays = np.concatenate([np.broadcast_to(points[:, None], directions.shape), directions], axis=2).reshape(-1, 6)
        command = ["rtrace", "-h", "-n", "2", "-ab", "0", "-fdf", "-oL", "scene.oct"]
        told = subprocess.run(command, cwd=self.folder.name, env=self.environment, input=rays.tobytes(), capture_output=True, check=True)
        lengths = np.frombuffer(told.stdout, dtype=np.float32).reshape(directions.shape[:2])
        return np.where(lengths > 1e9, np.inf, lengths)


def in_open_air(scene, count, seed):
    """`count` points [(position, normal)] on faces, evenly by area, 1 mm off on the side that sees more sky."""
    corners = triangles(scene)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1) / 2
    normals /= 2 * areas[:, None]
    rays, random, chosen, tried = Rays(corners), np.random.Generator(np.random.PCG64(seed)), [], 0
    while len(chosen) < count:
        picked = np.searchsorted(np.cumsum(areas) / areas.sum(), random.random(count))
        u, v = random.random((2, count, 1))
        u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
        a, b, c = corners[picked].transpose(1, 0, 2)
        on_face = a + u * (b - a) + v * (c - a)
        sides = []
        for sign in (1, -1):
            outwards = sign * normals[picked]
            directions = cosine_about(outwards)
            lengths = rays.lengths_m(on_face + OFF_M * outwards, directions)
            to_sky = (np.isinf(lengths) & (directions[..., 2] > 0)).sum(1)
            fit = (lengths.max(1) > CREVICE_M) & (lengths.min(1) > TOUCHING_M) & (to_sky >= LEAST_TO_SKY)
            sides.append((to_sky, fit, outwards))
        for point in range(count):
            tried += 1
            to_sky, fit, outwards = max(sides, key=lambda side: side[0][point])
            if fit[point] and len(chosen) < count:
                chosen.append(((on_face[point] + OFF_M * outwards[point]).tolist(), outwards[point].tolist()))
    print(f"{count} of some {tried} points stand in the open air")
    return chosen
