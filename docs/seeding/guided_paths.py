"""A path tracer of irradiance in Mitsuba, plain or guided by the same code."""
import drjit as dr
import mitsuba as mi

from guide_places import LIFT_M, by_lobes, density_by_lobes

# Reflections before roulette. From then on a plain path survives with the reflectance, so that its weight stays. A guided one
# does when the rest of it is expected to bring at least a third of what the sensor gets (a weight window of 1 to 5, Vorba &
# Krivanek 2016), else with less chance: the guide knows which paths are worth following.
TURNS_BEFORE_ROULETTE = 4
SURVIVAL = (0.1, 0.99)
WINDOW = 3.0


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


@dr.syntax
def estimate(scene, guide, sampler, p, n, free, place, holds=1.0):
    """One sample a lane of the irradiance at p on a surface of normal n, of the scalar irradiance where free.

    guide None is the plain path tracer; place (-1 for none) is the guide's at p and holds how far it does there, 0 to 1.
    Points stand off surfaces by LIFT_M.
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
