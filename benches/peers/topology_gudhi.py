"""Checks the topology of voids and of their skeletons with GUDHI.

    cargo bench --bench skeleton -- --write DIR
    python3 topology_gudhi.py DIR

For each NAME.npy beside a NAME-skeleton.npy in DIR: the Betti numbers of the void (a cubical complex whose cubes are the
void's voxels, so 26-connected) and of the skeleton (drawn twice as large, so that lines one voxel apart do not touch).
Components and loops have to be equal, and a skeleton has no cavity.
"""

import pathlib
import sys

import gudhi
import numpy as np


def betti(array):
    complex = gudhi.CubicalComplex(top_dimensional_cells=np.pad(1.0 - (array > 0), 1, constant_values=1.0))
    complex.compute_persistence(homology_coeff_field=2, min_persistence=0.0)
    # What is there at 0.5: born before, alive after.
    return [complex.persistent_betti_numbers(0.5, 0.5)[dimension] for dimension in range(3)]


def main():
    folder = pathlib.Path(sys.argv[1])
    failed = False
    for path in sorted(folder.glob("*-skeleton.npy")):
        void = np.load(path.with_name(path.name.replace("-skeleton", "")))
        skeleton = np.load(path)
        # Only where the curve is, to save memory.
        filled = np.argwhere(skeleton)
        if len(filled):
            low, high = filled.min(0), filled.max(0) + 1
            skeleton = skeleton[tuple(slice(a, b) for a, b in zip(low, high))]
        of_void, of_skeleton = betti(void), betti(skeleton)
        equal = of_void[:2] == of_skeleton[:2] and of_skeleton[2] == 0
        failed |= not equal
        print(f"{path.stem}: void {of_void}, skeleton {of_skeleton}: {'equal' if equal else 'DIFFERENT'}", flush=True)
    sys.exit(failed)


if __name__ == "__main__":
    main()
