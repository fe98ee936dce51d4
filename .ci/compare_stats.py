"""Compares `tessgraph info --json` with an independent measurement of a mesh."""

import json
import sys

ours, theirs = (json.load(open(path)) for path in sys.argv[1:3])
name = sys.argv[3]
pairs = {
    "vertices": "V",
    "edges": "E",
    "faces": "F",
    "euler": "euler",
    "components": "components",
    "boundary_edges": "boundary_edges",
    "boundary_loops": "boundary_loops",
    "nonmanifold_edges": "nonmanifold_edges",
    "isolated_vertices": "isolated_vertices",
}
# STL has no shared vertices: both sides weld equal positions, but count them apart.
wrong = [
    f"{key}: {ours[key]} here, {theirs[other]} there"
    for key, other in pairs.items()
    if ours[key] != theirs[other]
]
for key in ("area", "volume"):
    a, b = ours[key], theirs.get(key)
    if (a is None) != (b is None) or (a is not None and abs(a - b) > 1e-9 * max(abs(a), abs(b), 1e-9)):
        wrong.append(f"{key}: {a} here, {b} there")
print(f"{name}: {'; '.join(wrong) if wrong else 'agrees'}")
sys.exit(bool(wrong))
