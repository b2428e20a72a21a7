"""Times other skeleton programs on an array that `cargo bench --bench skeleton` wrote.

    python3 skeleton_peers.py ARRAY.npy [SECONDS]

ARRAY is uint8, 1 where the void is. SECONDS is our own time, for the ratios. Needs scikit-image, kimimaro and edt.
"""

import statistics
import sys
import time

import numpy as np


def seconds_of(work, runs):
    times = []
    for _ in range(runs):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return statistics.median(times)


def main():
    array = np.load(sys.argv[1])
    ours = float(sys.argv[2]) if len(sys.argv) > 2 else None

    def report(name, work, runs):
        seconds = seconds_of(work, runs)
        ratio = f"; ours {seconds / ours:.1f} x as fast" if ours else ""
        print(f"  {name}: {seconds:.3f} s, {array.size / seconds / 1e6:.1f} Mvoxel/s{ratio}", flush=True)

    try:
        import edt
        seconds = seconds_of(lambda: edt.edt(array, parallel=2), 3)
        print(f"  edt, 2 threads: {seconds:.3f} s, {array.size / seconds / 1e6:.1f} Mvoxel/s", flush=True)
    except ImportError as error:
        print(f"  edt skipped: {error}")
    try:
        from skimage.morphology import skeletonize
        report("scikit-image skeletonize", lambda: skeletonize(array.astype(bool)), 3)
    except ImportError as error:
        print(f"  scikit-image skipped: {error}")
    try:
        import kimimaro
        report("kimimaro.skeletonize", lambda: kimimaro.skeletonize(array.astype(np.uint32), progress=False, parallel=1), 1)
    except ImportError as error:
        print(f"  kimimaro skipped: {error}")


if __name__ == "__main__":
    main()
