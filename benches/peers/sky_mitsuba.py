#!/usr/bin/env python3
"""Hosek and Wilkie's sky by Mitsuba 3, and their spectral data from Mitsuba's files.

benches/peers/sky_mitsuba.py rgb      > tests/data/hosek_mitsuba.csv
benches/peers/sky_mitsuba.py spectral > tests/data/hosek_spectral_mitsuba.csv
benches/peers/sky_mitsuba.py data     > src/sky/hosek/spectral.bin

`rgb` and `spectral` evaluate the emitter `sunsky` with the sun left out (sun_scale 0) over sun elevations, turbidities,
albedos and directions; `spectral` at wavelengths on and between those of the data. `data` copies the spectral coefficients:
8 bytes HWSPEC01; five u32: turbidities, albedos, control points over elevation, wavelengths, parameters; then f32, little
endian: the parameters in that order, parameter fastest, and the mean radiances, wavelength fastest.
Needs mitsuba 3.9.1 and numpy, Python 3.11; its scalar variants, so no LLVM.
"""
import itertools
import math
import random
import struct
import sys
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

# The sun's elevation, degrees. At 0 itself Mitsuba's sky is black: its sun's height rounds to -4e-8. 0.01 stands for it.
ELEVATIONS = (0.01, 1.0, 4.0, 12.0, 30.0, 48.0, 66.0, 82.0, 90.0)
TURBIDITIES = (1.0, 1.5, 2.0, 3.3, 5.0, 6.75, 8.2, 10.0)
ALBEDOS = (0.0, 0.2, 0.55, 1.0)
# Nanometres. At 720 itself Mitsuba reads beyond its data (times 0, so mostly right, but sometimes NaN): 719 stands for it.
WAVELENGTHS = (320.0, 333.0, 400.0, 437.0, 480.0, 555.0, 600.0, 690.0, 719.0)


def towards(azimuth_deg, elevation_deg):
    """A direction in Mitsuba's sky, z up."""
    azimuth, elevation = math.radians(azimuth_deg), math.radians(elevation_deg)
    return [math.sin(azimuth) * math.cos(elevation), math.cos(azimuth) * math.cos(elevation), math.sin(elevation)]


def skies(directions):
    """Rows of (sun's elevation, turbidity, albedo, view azimuth from the sun, view elevation): each sun with each turbidity."""
    draw = random.Random(4)
    for (at, sun), turbidity in itertools.product(enumerate(ELEVATIONS), TURBIDITIES):
        albedo = ALBEDOS[(at + TURBIDITIES.index(turbidity)) % len(ALBEDOS)]
        # Mitsuba's sky ends at the horizon: a view of 0 may fall beneath it in rounding.
        views = [(0.0, 90.0), (0.0, max(sun, 0.5)), (180.0, 0.2)]
        views += [(round(draw.uniform(0, 360), 2), round(draw.uniform(0.2, 90), 2)) for _ in range(directions)]
        yield sun, turbidity, albedo, views[-directions:] if sun < 80 else views


def emitter(sun, turbidity, albedo):
    return mi.load_dict({
        "type": "sunsky", "sun_direction": towards(0.0, sun), "turbidity": turbidity,
        "albedo": albedo if mi.variant().endswith("rgb") else {"type": "uniform", "value": albedo}, "sun_scale": 0.0,
    })


def radiance(sky, view, wavelengths=None):
    si = dr.zeros(mi.SurfaceInteraction3f)
    si.wi = -mi.Vector3f(towards(*view))
    if wavelengths is not None:
        si.wavelengths = mi.Spectrum(wavelengths)
    return list(sky.eval(si))


def rgb():
    mi.set_variant("scalar_rgb")
    print("# Hosek-Wilkie RGB by Mitsuba", mi.__version__, "sunsky, scalar_rgb, sun_scale 0: benches/peers/sky_mitsuba.py rgb")
    print("# Mitsuba's values are the data's over 106.75. Views by azimuth from the sun and elevation.")
    print("sun_elevation_deg,turbidity,albedo,view_azimuth_deg,view_elevation_deg,r,g,b")
    for sun, turbidity, albedo, views in skies(5):
        sky = emitter(sun, turbidity, albedo)
        for view in views:
            values = ",".join(f"{value:.7g}" for value in radiance(sky, view))
            print(f"{sun},{turbidity},{albedo},{view[0]},{view[1]},{values}")


def spectral():
    mi.set_variant("scalar_spectral")
    print("# Hosek-Wilkie spectral radiance by Mitsuba", mi.__version__, "sunsky, scalar_spectral, sun_scale 0:",
          "benches/peers/sky_mitsuba.py spectral")
    print("# W/(m2 sr nm); linear between the wavelengths of the data.")
    print("sun_elevation_deg,turbidity,albedo,view_azimuth_deg,view_elevation_deg,wavelength_nm,radiance")
    draw = random.Random(5)
    for sun, turbidity, albedo, views in skies(1):
        sky = emitter(sun, turbidity, albedo)
        chosen = sorted(draw.sample(WAVELENGTHS, 4))
        values = radiance(sky, views[-1], chosen)
        for wavelength, value in zip(chosen, values):
            print(f"{sun},{turbidity},{albedo},{views[-1][0]},{views[-1][1]},{wavelength},{value:.7g}")


def tensor(data, wanted):
    """A field of Mitsuba's tensor file."""
    at = 18
    for _ in range(struct.unpack_from("<I", data, 14)[0]):
        (length,) = struct.unpack_from("<H", data, at)
        name = data[at + 2:at + 2 + length].decode()
        at += 2 + length
        rank, kind, start = struct.unpack_from("<HBQ", data, at)
        shape = struct.unpack_from(f"<{rank}Q", data, at + 11)
        at += 11 + 8 * rank
        if name == wanted:
            assert kind == 11, "f64 is expected"
            return np.frombuffer(data, "<f8", math.prod(shape), start).reshape(shape)
    raise KeyError(wanted)


def data():
    file = (Path(mi.__file__).parent / "data/sunsky/sunsky_datasets.bin").read_bytes()
    params, radiances = tensor(file, "sky_params_spec"), tensor(file, "sky_rad_spec")
    sys.stdout.buffer.write(b"HWSPEC01" + struct.pack("<5I", *params.shape))
    sys.stdout.buffer.write(params.astype("<f4").tobytes() + radiances.astype("<f4").tobytes())


if __name__ == "__main__":
    {"rgb": rgb, "spectral": spectral, "data": data}[sys.argv[1]]()
