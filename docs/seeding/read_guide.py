"""Reads what `lightvein guide SCENE -o DIR` wrote: import read_guide; guide = read_guide.read("DIR")."""
import json
from pathlib import Path

import numpy as np


def read(folder):
    """A dict: guide.json as it is, and under each array's name (walls, walls_lobes, ...) the array.

    Tables are split by column: guide["walls"]["x"], metres. Lobes: [place, lobe, (dx, dy, dz, concentration, weight,
    distance)]; lights: [place, emitter, (direct W/m2, share)]. A neck's outline is an array of corners, metres.
    """
    folder = Path(folder)
    guide = json.loads((folder / "guide.json").read_text())
    for file, layout in guide["arrays"].items():
        array, name = np.load(folder / file), file.removesuffix(".npy")
        guide[name] = array if array.ndim > 2 else dict(zip(layout["columns"], array.T))
    for neck in guide["necks"]:
        neck["outline"] = np.array(neck["outline"])
    return guide
