"""Times the package `edt` on an array and compares its distances with ours.

python3 edt_peer.py VOID.npy SQUARED.npy RUNS SECONDS...

VOID is 1 where void, indexed [z][y][x]; SQUARED our squared distances; SECONDS ours with 1, 2, ... threads.
"""

import sys
import time

import numpy

try:
    import edt
except ImportError:
    print("  edt skipped: python3 has no package edt (pip install edt)")
    sys.exit(0)

# As bytes: edt takes twice as long on booleans.
void = numpy.load(sys.argv[1]).astype(numpy.uint8)
ours = numpy.load(sys.argv[2])
runs = int(sys.argv[3])
for threads, seconds in enumerate(map(float, sys.argv[4:]), start=1):
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        squared = edt.edtsq(void, black_border=True, parallel=threads)
        times.append(time.perf_counter() - start)
    median = sorted(times)[len(times) // 2]
    print(
        f"  edt, {threads} thread{'s' if threads > 1 else ' '} {1e3 * median:.1f} ms, "
        f"{void.size / median / 1e6:.0f} Mvoxel/s; ours is {median / seconds:.2f} x as fast"
    )
different = int((squared != ours).sum())
print(f"  {different} of {void.size} distances differ")
sys.exit(different > 0)
