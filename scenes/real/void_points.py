"""Where is there room in a mesh? Coarse voxels, a flood and points spread over the void, to choose sensors and check lights.

A scratch tool of make_real.py (numpy, scipy): it samples triangles and may miss a passage narrower than two voxels.
"""
import numpy as np
from scipy import ndimage


class Void:
    """The voxels of a mesh (metres, Z up) and the void that can be walked from some points."""

    def __init__(self, scene, voxel_m, starts, within=None):
        corners = np.array([
            [scene.vertices[polygon[0]], scene.vertices[polygon[k]], scene.vertices[polygon[k + 1]]]
            for _, polygon in scene.faces for k in range(1, len(polygon) - 1)
        ])
        self.voxel_m = voxel_m
        # Two voxels of outside all around, so that a leak has somewhere to go.
        self.low = corners.reshape(-1, 3).min(0) - 2.5 * voxel_m
        shape = np.ceil((corners.reshape(-1, 3).max(0) + 2.5 * voxel_m - self.low) / voxel_m).astype(int)
        solid = np.zeros(shape, bool)
        for a, b, c in corners:
            # Points no more than half a voxel apart on the triangle.
            steps = int(np.ceil(max(np.linalg.norm(b - a), np.linalg.norm(c - a), np.linalg.norm(c - b)) / (voxel_m / 2))) + 1
            i, j = np.meshgrid(np.arange(steps + 1), np.arange(steps + 1))
            keep = i + j <= steps
            points = a + np.outer(i[keep] / steps, b - a) + np.outer(j[keep] / steps, c - a)
            solid[tuple(self.voxels(points).T)] = True
        labels, _ = ndimage.label(~solid)
        self.start_labels = [int(labels[tuple(self.voxels(np.array(p)))]) for p in starts]
        self.void = np.isin(labels, [label for label in set(self.start_labels) if label])
        rim = np.ones(shape, bool)
        rim[1:-1, 1:-1, 1:-1] = False
        self.leaks = bool((self.void & rim).any())
        self.clearance_m = ndimage.distance_transform_edt(~solid) * voxel_m
        if within is not None:
            low, high = (self.voxels(np.array(p)) for p in within)
            inside = np.zeros(shape, bool)
            inside[tuple(slice(a, b + 1) for a, b in zip(low, high))] = True
            self.void &= inside

    def voxels(self, points):
        return np.floor((points - self.low) / self.voxel_m).astype(int)

    def spread(self, count, clearance_m):
        """`count` points of the R3 sequence (M. Roberts 2018) that lie in the void, at least `clearance_m` from any face."""
        room = self.void & (self.clearance_m >= clearance_m)
        cells = np.argwhere(room)
        low = self.low + cells.min(0) * self.voxel_m
        span = (cells.max(0) + 1 - cells.min(0)) * self.voxel_m
        ratios = np.array([0.8191725133961645, 0.6710436067037893, 0.5497004779019703])
        chosen, i = [], 0
        while len(chosen) < count:
            i += 1
            point = np.round(low + span * ((0.5 + i * ratios) % 1.0), 3)
            if room[tuple(self.voxels(point))]:
                chosen.append(point.tolist())
        return chosen
