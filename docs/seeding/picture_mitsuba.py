#!/usr/bin/env python3
"""Draws a room twice in Mitsuba 3 with equal samples, plain on the left and guided on the right.

    picture_mitsuba.py SCENE.toml GUIDE_DIR --oracle PATH/mitsuba_irradiance.py --from X Y Z --to X Y Z -o room.png

Prints the relative error (root mean square over pixels, against a guided run of --truth times the samples) of both halves.
"""
import argparse
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

from guide_places import LANES, LIFT_M, Guide
from guided_mitsuba import load
from guided_paths import estimate


def radiance(scene, guide, camera, samples, seed):
    """An image of radiance, W/m2/sr; lights are black."""
    width, height = camera["size"]
    image = np.zeros(width * height)
    each = max(1, LANES // (width * height))
    for turn in range(0, samples, each):
        count = min(each, samples - turn)
        lanes = dr.arange(mi.UInt32, width * height * count)
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(seed + turn, width * height * count)
        pixel, jitter = lanes // count, sampler.next_2d()
        across = (mi.Float(pixel % width) + jitter.x) / width * 2 - 1
        down = (mi.Float(pixel // width) + jitter.y) / height * 2 - 1
        side = np.tan(np.radians(camera["view_deg"]) / 2)
        ahead = dr.normalize(mi.ScalarVector3f(camera["to"]) - mi.ScalarVector3f(camera["from"]))
        right = dr.normalize(dr.cross(ahead, mi.ScalarVector3f(0, 0, 1)))
        up = dr.cross(right, ahead)
        towards = dr.normalize(mi.Vector3f(ahead) + across * side * right - down * (side * height / width) * up)

        hit = scene.ray_intersect(mi.Ray3f(mi.Point3f(camera["from"]), towards))
        n = dr.select(dr.dot(hit.n, towards) > 0, -mi.Vector3f(hit.n), mi.Vector3f(hit.n))
        hit.wi = mi.Vector3f(0, 0, 1)
        reflected_per_sr = hit.bsdf().eval(mi.BSDFContext(), hit, mi.Vector3f(0, 0, 1), hit.is_valid())[0]
        place = guide.at(hit.p, n, hit.is_valid()) if guide else mi.Int32(dr.full(mi.Int32, -1, dr.width(lanes)))
        with dr.suspend_grad():
            on_surface = dr.full(mi.Bool, False, dr.width(lanes))
            irradiance = estimate(scene, guide, sampler, hit.p + LIFT_M * n, n, on_surface, place)
        value = dr.select(hit.is_valid(), reflected_per_sr * irradiance, 0)
        image += np.array(value, dtype=np.float64).reshape(-1, count).sum(1)
    return image.reshape(height, width) / samples


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("guide")
    parser.add_argument("--oracle", required=True)
    parser.add_argument("--from", dest="eye", type=float, nargs=3, required=True)
    parser.add_argument("--to", type=float, nargs=3, required=True)
    parser.add_argument("--view-deg", type=float, default=85.0, help="across the picture")
    parser.add_argument("--size", type=int, nargs=2, default=(480, 270))
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--truth", type=int, default=64, help="0 draws no truth")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-o", "--output", required=True)
    options = parser.parse_args()
    scene, setup, _, _ = load(options.scene, options.oracle)
    guide = Guide(scene, setup, options.guide, options.seed)
    camera = {"from": options.eye, "to": options.to, "view_deg": options.view_deg, "size": options.size}
    halves = [radiance(scene, contestant, camera, options.spp, options.seed) for contestant in (None, guide)]

    # As bright as the guided half asks for: its 95th percentile is nearly white.
    white = np.percentile(halves[1], 95) / 0.9
    both = np.clip(np.concatenate(halves, 1) / white, 0, 1) ** (1 / 2.2)
    mi.Bitmap((255 * both + 0.5).astype(np.uint8)[..., None]).write(options.output)
    print(f"{options.output}: {Path(options.output).stat().st_size / 1e3:.0f} kB, {options.spp} samples a pixel")
    if options.truth:
        truth = radiance(scene, guide, camera, options.spp * options.truth, options.seed + 1_000_000)
        errors = [np.sqrt(((half - truth) ** 2).mean()) / truth.mean() for half in halves]
        print(f"relative error: plain {errors[0]:.3f}, guided {errors[1]:.3f}; mean radiance {truth.mean():.4g} W/m2/sr")


if __name__ == "__main__":
    main()
