# SPDX-License-Identifier: Apache-2.0
"""A model file of a few triangles, written by hand."""
import json
import struct

# Corners of a tetrahedron that faces all ways, and a nod of its node over one second.
_CORNERS = [(1, 1, 1), (-1, -1, 1), (-1, 1, -1), (1, -1, -1)]
_TRIANGLES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


def write_glb(path):
    """One red tetrahedron, node "tetra", that rises by a metre within a second."""
    corners = b"".join(struct.pack("<3f", *corner) for corner in _CORNERS)
    indices = b"".join(struct.pack("<3H", *triangle) for triangle in _TRIANGLES)
    times = struct.pack("<2f", 0, 1)
    places = struct.pack("<6f", 0, 0, 0, 0, 1, 0)
    blocks = [corners, indices, times, places]
    starts = [sum(len(block) for block in blocks[:k]) for k in range(4)]
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "tetra", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.1, 0.1, 1]}, "doubleSided": True}],
        "animations": [{
            "samplers": [{"input": 2, "output": 3}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
        }],
        "buffers": [{"byteLength": sum(map(len, blocks))}],
        "bufferViews": [{"buffer": 0, "byteOffset": start, "byteLength": len(block)}
                        for start, block in zip(starts, blocks)],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, -1], "max": [1, 1, 1]},
            {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"},
            {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
            {"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"},
        ],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = b"".join(blocks)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(binary)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)
