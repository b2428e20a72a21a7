#!/usr/bin/env python3
"""Writes the scene files and sensors of the real scenes in this folder.

    scenes/real/make_real.py ../shared/data [NAME...]

The data lies beside the project and is not part of it. Lights come from the data where it has any; sensors are points
spread over the void (void_points.py), named s1, s2, ..., or over the faces of a city (open_faces.py). Lights and sensors are
in metres, Z up, as everything after loading. Needs Python 3.11, numpy and scipy, and pyradiance for the cities.
"""
import json
import math
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from mesh_files import SceneFile, luminance, read_obj  # noqa: E402
from open_faces import OFF_M, in_open_air  # noqa: E402
from void_points import Void  # noqa: E402

# Where the data is, seen from this folder.
DATA = "../../../shared/data"
QUAKE_UNIT_M = 0.0254
# Quake gives a light a number, the brightness at its place that falls to 0 over as many units; it has no watts. A tenth of
# a watt for each makes the usual 300 a lamp of 30 W of radiant flux.
WATTS_PER_QUAKE_LIGHT = 0.1


def number(v):
    return repr(round(v, 6) + 0.0)


def vector(p):
    return "[" + ", ".join(number(c) for c in p) + "]"


def point_light(position, flux_w):
    return f'[[lights]]\nkind = "point"\nposition = {vector(position)}\nflux_w = {number(flux_w)}\n'


def write(name, about, meshes, *, unit_m=1.0, up="z", reflectance=0.5, blocks=(), voxel_m, starts, count, clearance_m, within=None):
    """Writes <name>.toml and <name>_sensors.csv; `starts` are points of the void, `within` the corners of the sensors' box."""
    lines = ["# made by: scenes/real/make_real.py ../shared/data"]
    lines += [f"# {line}" for line in about.strip().splitlines()]
    lines += [f'name = "{name}"', "", "[geometry]"]
    lines += ["meshes = [" + ", ".join(f'"{DATA}/{mesh}"' for mesh in meshes) + "]"]
    lines += [f"unit_m = {unit_m}", f'up = "{up}"', f"reflectance = {number(reflectance)}", "", *blocks]
    lines += ["[sensors]", f'file = "{name}_sensors.csv"', f'reference = "{name}_reference.csv"', "", "[model]", f"voxel_m = {voxel_m}"]
    path = HERE / f"{name}.toml"
    path.write_text("\n".join(lines) + "\n")

    # The sensors come last, for they are sought in the scene as written.
    void = Void(SceneFile(path), voxel_m, starts, within)
    rows = [f"s{i + 1},{','.join(number(c) for c in p)}" for i, p in enumerate(void.spread(count, clearance_m))]
    about = f"# in the void reached from the lights, at least {clearance_m} m from any face"
    (HERE / f"{name}_sensors.csv").write_text("\n".join([lines[0], about, "id,x,y,z", *rows]) + "\n")
    voids = len({label for label in void.start_labels if label})
    blocked = [i for i, label in enumerate(void.start_labels) if not label]
    print(f"{name}: {'leaks' if void.leaks else 'sealed'}, {voids} void(s) with lights"
          + (f", lights in voxels with matter: {blocked}" if blocked else ""))


def quake(data, name, about, parts, voxel_m):
    facts = json.loads((data / f"quake/{name}.json").read_text())
    lights = [([c * QUAKE_UNIT_M for c in light["origin"]], light["light"]) for light in facts["lights"]]
    write(
        f"quake_{name}",
        f"""{about}
Its own lights as point lights, switched and flickering ones lit: flux_w = {WATTS_PER_QUAKE_LIGHT} x the map's light value
(300 -> 30 W; Quake has no watts). Light from the sky is left out. The lights' places and
values are the map's own: this file and its sensors, like the map, are under GPL-2 (id Software).""",
        [f"quake/{name}_{part}.obj" for part in parts],
        unit_m=QUAKE_UNIT_M,
        reflectance=0.4,
        blocks=[point_light(p, value * WATTS_PER_QUAKE_LIGHT) for p, value in lights],
        voxel_m=voxel_m,
        starts=[p for p, _ in lights],
        count=20,
        clearance_m=0.5,
    )


def duplex():
    lights = [
        # One in each large room of the two flats, and in the upper hallways.
        ((3.31, -15.17, 2.13), 60.0),
        ((5.47, -2.71, 2.13), 60.0),
        ((6.57, -14.29, 5.13), 40.0),
        ((2.31, -3.47, 5.13), 40.0),
        ((6.89, -9.13, 5.17), 30.0),
        ((1.93, -8.71, 5.17), 30.0),
    ]
    write(
        "duplex",
        """A house of two flats. Structure and shut, opaque windows; the doors are left out, so all rooms are open to each other
and the outer doorways to the outside: the void leaks. Lights are the project's own: living rooms, bedrooms, hallways.
Data: CC BY 4.0, buildingSMART.""",
        ["duplex/duplex_structure.obj", "duplex/duplex_window.obj"],
        blocks=[point_light(p, flux) for p, flux in lights],
        voxel_m=0.1,
        starts=[p for p, _ in lights],
        count=14,
        clearance_m=0.25,
        within=((0.42, -17.38, 0.02), (8.38, -0.42, 5.7)),
    )


def cabin(data):
    facts = json.loads((data / "cabin/cabin_furnished_meta.json").read_text())
    mesh = "cabin/cabin_furnished_opaque.obj"
    used = {material for material, _ in read_obj(data / mesh)[1]}
    blocks, starts = [], []
    for material, (kind, values) in sorted(facts["materials"].items()):
        # Radiance's plastic reflects its colour diffusely but for the specular share; of metal and mirror all is taken
        # as diffuse, since black would lose its light.
        if material in used and kind in ("plastic", "metal", "mirror"):
            diffuse = 1.0 - values[3] if kind == "plastic" else 1.0
            blocks.append(f'[[materials]]\nname = "{material}"\nreflectance = {number(luminance(values) * diffuse)}\n')
    for light in facts["lights"]:
        if light["prim"] != "sphere":
            continue
        radius = math.sqrt(light["area"] / (4 * math.pi))
        flux = luminance(light["rgb_radiance"]) * math.pi * light["area"]
        blocks.append(
            f'# {light["name"]}\n[[lights]]\nkind = "sphere"\ncenter = {vector(light["centroid"])}\n'
            f"radius = {number(radius)}\nflux_w = {number(flux)}\n"
        )
        starts.append(light["centroid"])
    write(
        "cabin",
        """Radiance's furnished cabin. Left out: the two floods (spotlights have no counterpart here) and the glass, so the
windows are holes and the void leaks. Its globes are spheres of the same area, flux_w = radiance x pi x area.
Reflectance: Rec. 709 luminance of the diffuse colour, plastic less its specular share; metal and mirror as if diffuse.
Materials go by the mesh's object names (it has no usemtl); glass_mat and Phong, which the data does not describe, are 0.5.
Data: Radiance Software License 2.0, LBNL.""",
        [mesh],
        blocks=blocks,
        voxel_m=0.05,
        starts=starts,
        count=20,
        clearance_m=0.2,
        within=((0.1, 0.1, 0.1), (8.1, 5.4, 2.9)),
    )


def cornell(name, mesh, about):
    write(
        name,
        about + """
Y up in the file; lights and sensors are in metres, Z up, where the open front faces -Y. The light is the mesh's own
emissive face (Ke), which looks down. Data: McGuire's Computer Graphics Archive.""",
        [f"cornell/{mesh}.obj"],
        up="y",
        voxel_m=0.03,
        starts=[(0.011, -0.13, 1.7)],
        count=8,
        clearance_m=0.1,
        within=((-0.9, -0.9, 0.1), (0.9, 0.9, 1.9)),
    )


def kind_of(normal):
    """What a face is, by where it looks: up, aside or down."""
    return "roof" if normal[2] > 0.5 else "facade" if normal[2] > -0.5 else "soffit"


def city(name, mesh, about):
    """Writes <name>.toml, a scene under Chicago's sky, and its sensors on the faces that stand in the open air."""
    lines = ["# made by: scenes/real/make_real.py ../shared/data"]
    lines += [f"# {line}" for line in about.strip().splitlines()]
    lines += [f'name = "{name}"', "", "[geometry]", f'meshes = ["{DATA}/city/{mesh}.obj"]', "unit_m = 1.0", 'up = "z"']
    lines += ["reflectance = 0.5", "", "[sensors]", f'file = "{name}_sensors.csv"', ""]
    lines += ["# Chicago as a stand-in; its weather is no part of this project, so the sky is a clear one.", "[site]"]
    lines += ["latitude_deg = 41.98", "longitude_deg = -87.92", "utc_offset_h = -6.0", "turbidity = 3.0"]
    path = HERE / f"{name}.toml"
    path.write_text("\n".join(lines) + "\n")
    rows = [
        f"{kind_of(normal)}_{i + 1:03},{','.join(number(c) for c in [*position, *normal])}"
        for i, (position, normal) in enumerate(in_open_air(SceneFile(path), 400, seed=1))
    ]
    spread = f"# on faces in the open air, at random by area, {1000 * OFF_M:g} mm off them on the side that sees more sky"
    (HERE / f"{name}_sensors.csv").write_text("\n".join([lines[0], spread, "id,x,y,z,nx,ny,nz", *rows]) + "\n")


def main():
    data = Path(sys.argv[1])
    scenes = {
        "dm4": lambda: quake(data, "dm4", """Quake's dm4. Solid: its brushes and its sky, which together seal it. Lava and water are left out: their
pools are void.""", ["solid", "sky"], 0.15),
        "e1m1": lambda: quake(data, "e1m1", """Quake's e1m1. Solid: its brushes and its sky, which together seal it, and its movers (lifts, bridges) where the
map draws them. Doors are left out, for shut they part the void in eight; so are water and slime, whose pools are void.
Three lights lie exactly on the faces of ceiling beams.""", ["solid", "sky", "mover"], 0.15),
        "duplex": duplex,
        "cabin": lambda: cabin(data),
        "cornell_original": lambda: cornell("cornell_original", "CornellBox-Original", """The Cornell box with its two blocks. Its MTL is named by a path of its maker's machine; the file of that name
beside the mesh is meant."""),
        "cornell_empty_white": lambda: cornell("cornell_empty_white", "CornellBox-Empty-White", """The empty Cornell box in white: walls of reflectance 1, which only the open front drains."""),
        "ingolstadt": lambda: city("ingolstadt", "ingolstadt_lod3_mid", """The middle part of Ingolstadt's road space models, LoD3: eaves, balconies, windows; no height field, and no ground.
As it comes: faces twice, faces without area, sheets, and faces that look inwards.
Sensors are the mesh's: this file and its sensors, like the mesh, are under CC BY-SA 4.0 (savenow/lod3-road-space-models)."""),
        "den_haag": lambda: city("den_haag", "DenHaag_01", """A part of Den Haag, LoD2, 790 x 670 m: blocks with roofs, on terrain.
Data: CC BY 4.0, Gemeente Den Haag."""),
    }
    for name in sys.argv[2:] or scenes:
        scenes[name]()


if __name__ == "__main__":
    main()
