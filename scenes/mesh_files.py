"""Reads scene files and their OBJ + MTL meshes, for the scripts beside it; independent of the Rust loader on purpose."""
import csv
import math
import tomllib
from pathlib import Path


def luminance(rgb):
    """The reflectance of a coloured material: its Rec. 709 luminance."""
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]


def read_obj(path):
    """Gives (vertices, [(material, corner indices)], names of MTL files); a face without usemtl is named by its o or g."""
    vertices, faces, libraries = [], [], []
    material = group = ""
    for line in Path(path).read_text().splitlines():
        words = line.split("#")[0].split()
        if not words:
            continue
        key, rest = words[0], words[1:]
        if key == "v":
            vertices.append([float(c) for c in rest[:3]])
        elif key in "og" and rest:
            group = rest[0]
        elif key == "usemtl" and rest:
            material = rest[0]
        elif key == "mtllib":
            libraries += rest
        elif key == "f":
            corners = [int(c.split("/")[0]) for c in rest]
            corners = [c - 1 if c > 0 else len(vertices) + c for c in corners]
            faces.append((material or group, corners))
    return vertices, faces, libraries


def read_mtl(path):
    """Gives {material: {"Kd": rgb, "Ke": rgb}}."""
    materials, current = {}, None
    for line in Path(path).read_text().splitlines():
        words = line.split("#")[0].split()
        if words[:1] == ["newmtl"]:
            current = materials.setdefault(words[1], {})
        elif words and current is not None and words[0] in ("Kd", "Ke"):
            current[words[0]] = [float(c) for c in words[1:4]]
    return materials


def read_sensors(path):
    """Gives [(id, position, normal or None)]."""
    lines = [line for line in Path(path).read_text().splitlines() if line and not line.startswith("#")]
    sensors = []
    for row in csv.DictReader(lines):
        normal = [row.get(c) for c in ("nx", "ny", "nz")]
        sensors.append((
            row["id"],
            [float(row[c]) for c in "xyz"],
            [float(c) for c in normal] if all(normal) else None,
        ))
    return sensors


class SceneFile:
    """A scene file with its meshes in metres, Z up: vertices, faces (material, corners), reflectance and emission by material."""

    def __init__(self, path):
        self.path = Path(path)
        self.table = tomllib.loads(self.path.read_text())
        geometry = self.table["geometry"]
        unit = geometry.get("unit_m", 1.0)
        y_up = geometry.get("up", "z") == "y"
        self.vertices, self.faces = [], []
        self.reflectance, self.emission = {}, {}
        for mesh in geometry["meshes"]:
            mesh = self.path.parent / mesh
            vertices, faces, libraries = read_obj(mesh)
            first = len(self.vertices)
            self.vertices += [self._metres(v, unit, y_up) for v in vertices]
            self.faces += [(material, [first + c for c in corners]) for material, corners in faces]
            for library in libraries:
                # Some files name a folder of their maker's machine: the file beside the mesh counts too.
                found = [p for p in (mesh.parent / library, mesh.parent / Path(library).name) if p.exists()]
                for name, values in (read_mtl(found[0]) if found else {}).items():
                    if "Kd" in values:
                        self.reflectance[name] = luminance(values["Kd"])
                    if any(values.get("Ke", [])):
                        self.emission[name] = luminance(values["Ke"])
        for name in {material for material, _ in self.faces}:
            self.reflectance.setdefault(name, geometry.get("reflectance", 0.5))
            for override in self.table.get("materials", []):
                pattern = override["name"]
                if name == pattern or (pattern.endswith("*") and name.startswith(pattern[:-1])):
                    self.reflectance[name] = override.get("reflectance", self.reflectance[name])
                    if override.get("transmittance"):
                        raise SystemExit(f"{self.path}: material {name} transmits light, which is not supported here")
                    if "emission" in override:
                        self.emission[name] = override["emission"]

    @staticmethod
    def _metres(v, unit, y_up):
        x, y, z = (c * unit for c in v)
        return [x, -z, y] if y_up else [x, y, z]

    def sensors(self):
        return read_sensors(self.path.parent / self.table["sensors"]["file"])

    def area_by_material(self):
        """Gives {material: m2}, both sides of a face counted once."""
        areas = {}
        for material, corners in self.faces:
            points = [self.vertices[c] for c in corners]
            normal = [0.0, 0.0, 0.0]
            for p, q in zip(points, points[1:] + points[:1]):
                for axis in range(3):
                    a, b = (axis + 1) % 3, (axis + 2) % 3
                    normal[axis] += (p[a] - q[a]) * (p[b] + q[b]) / 2
            areas[material] = areas.get(material, 0.0) + math.hypot(*normal)
        return areas
