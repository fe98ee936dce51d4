"""Holds CheckIntersections at tolerance 0 against CGAL's exact predicates.

    compare_crossings.py TESSGRAPH GRAPH TOOLS OUT MESH...

`pairs + contacts` must be what the judge finds, and two kinds of pairs that it
leaves out, found here with rational numbers: faces with a triangle in common
(it drops identical triangles, so that of two equal quads it sees only those
whose diagonals differ), and triangles in one plane folded over a common edge,
which it misses for some coordinates.
"""

import json
import os
import subprocess
import sys
from collections import defaultdict
from fractions import Fraction

import numpy as np
from igl.copyleft import cgal

tessgraph, graph, tools, out = sys.argv[1:5]
sys.path.insert(0, tools)
from mesh_stats import fan, read_obj, weld_  # noqa: E402


def ordered(a, b):
    return (min(a, b), max(a, b))


def judged(points, triangles, owners):
    """Pairs of polygons by the exact kernel, as mesh_stats.py asks it."""
    sides = points[triangles]
    area = np.linalg.norm(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1)
    triangles, owners = triangles[area > 0], owners[area > 0]
    if len(triangles) == 0:
        return set()
    found = cgal.remesh_self_intersections(
        np.ascontiguousarray(points, dtype=np.float64),
        np.ascontiguousarray(triangles, dtype=np.int64),
        True, False, False, False, 2**31 - 1,
    )[2]
    pairs = np.asarray(found).reshape(-1, 2)
    return {ordered(a, b) for a, b in owners[pairs].tolist() if a != b}


def exact(point):
    return [Fraction(x) for x in point]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def has_area(points, triangle):
    a, b, c = (exact(points[v]) for v in triangle)
    arms = ([x - o for x, o in zip(end, a)] for end in (b, c))
    return any(cross(*arms))


def folded(points, edge, one, two):
    """Whether two triangles over an edge lie in one plane, on one side of it."""
    origin = exact(points[edge[0]])
    axis, a, b = ([x - o for x, o in zip(exact(points[v]), origin)] for v in (edge[1], one, two))
    normal = cross(axis, a)
    return dot(normal, b) == 0 and dot(normal, cross(axis, b)) > 0


def left_out(points, triangles, owners):
    """Pairs that the judge drops or may miss."""
    pairs, same, edges = set(), defaultdict(set), defaultdict(list)
    for triangle, owner in zip(triangles.tolist(), owners.tolist()):
        same[tuple(sorted(triangle))].add(owner)
        for k in range(3):
            edges[ordered(triangle[k], triangle[k - 2])].append((triangle[k - 1], owner))
    for triangle, faces in same.items():
        if has_area(points, triangle):
            pairs |= {ordered(a, b) for a in faces for b in faces if a < b}
    for edge, wings in edges.items():
        for k, (one, a) in enumerate(wings):
            for two, b in wings[k + 1:]:
                if a != b and one != two and folded(points, edge, one, two):
                    pairs.add(ordered(a, b))
    return pairs


wrong = compared = 0
for path in sys.argv[5:]:
    name = os.path.basename(path)
    run = subprocess.run(
        [tessgraph, "run", graph, "--out", out, "--no-cache", "--allow", os.path.dirname(path),
         "--set", f"file={path}"],
        capture_output=True, text=True,
    )
    if run.returncode != 0:
        print(f"{name}: not read here: {run.stderr.splitlines()[0]}")
        continue
    report = json.load(open(os.path.join(out, "crossings.json")))
    ours = report["pairs"] + report["contacts"]
    points, faces, _ = read_obj(path)
    points, faces = weld_(points, faces)
    triangles, owners = fan(faces)
    distinct = [len(set(t)) == 3 for t in triangles.tolist()]
    triangles, owners = triangles[distinct], owners[distinct]
    theirs = judged(points, triangles, owners)
    both = theirs | left_out(points, triangles, owners)
    compared += 1
    if ours != len(both):
        wrong += 1
        print(f"{name}: {ours} here, {len(both)} there")
    elif ours:
        print(f"{name}: agrees, {ours} ({len(both) - len(theirs)} of them left out by the judge)")
print(f"{compared} meshes compared, {wrong} differ")
sys.exit(wrong > 0 or compared == 0)
