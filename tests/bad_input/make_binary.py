#!/usr/bin/env python3
"""Makes the broken binary meshes of this folder from the sound ones in sound/: tests/bad_input/make_binary.py

The same bytes on every run; each entry of FILES says what is broken.
"""
import struct
from pathlib import Path

HERE = Path(__file__).resolve().parent
GLB = (HERE / "sound/box.glb").read_bytes()
STL = (HERE / "sound/box_binary.stl").read_bytes()
PLY = (HERE / "sound/box_little.ply").read_bytes()


def with_bytes(file: bytes, at: int, new: bytes) -> bytes:
    """The file with some bytes written over."""
    return file[:at] + new + file[at + len(new):]


json_end = 20 + struct.unpack_from("<I", GLB, 12)[0]
body = PLY.index(b"end_header\n") + len(b"end_header\n")
FILES = {
    "glb_magic.glb": with_bytes(GLB, 1, b"I"),
    "glb_version.glb": with_bytes(GLB, 4, struct.pack("<I", 1)),
    "glb_length_small.glb": with_bytes(GLB, 8, struct.pack("<I", 3)),
    "glb_chunk_length.glb": with_bytes(GLB, 12, struct.pack("<I", 0x7FFF_FFFF)),
    "glb_header.glb": GLB[:10],
    "glb_short.glb": GLB[:-5],
    "glb_no_binary.glb": with_bytes(GLB[:json_end], 8, struct.pack("<I", json_end + 8)) + struct.pack("<I", 0) + b"BIN\0",
    "stl_binary_count.stl": with_bytes(STL, 80, struct.pack("<I", 0xFFFF_FFFF)),
    "stl_binary_nan.stl": with_bytes(STL, 100, struct.pack("<I", 0x7FFF_FFFF)),
    "stl_binary_none.stl": with_bytes(STL[:84], 80, struct.pack("<I", 0)),
    "stl_binary_short.stl": STL[:-1],
    "ply_binary_short.ply": PLY[:-3],
    "ply_binary_no_body.ply": PLY[:body],
    "ply_binary_nan.ply": with_bytes(PLY, 277, struct.pack("<H", 0x7FC0)),
    "ply_binary_list.ply": PLY.replace(b"list uchar", b"list uint"),
}

for name, content in FILES.items():
    (HERE / name).write_bytes(content)
