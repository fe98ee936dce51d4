"""Draws the pictures of docs/figures.md from the figures' own graphs.

    pip install pyvista pillow
    python docs/figures/render.py [FIGURE...]     # from the workspace's folder

Each graph is run with other outputs: polygons instead of triangles, and for each
face how many others it crosses, which the picture shows in red.
"""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
TESSGRAPH = ROOT / "target/release/tessgraph"
STONE, RED, LINE = "#f2ecdf", "#f0402c", "#2b2b2b"
WIDTH, GAP = 1080, 12

# Directions from which surfaces are seen.
CORNER = (-1.0, -1.7, 0.9)
VALLEY = (0.35, -1.6, 0.75)
FUNNEL = (0.3, -0.8, 2.4)
SADDLE = (0.5, -1.6, 1.0)
KINDS = (("monoclastic", VALLEY), ("synclastic", FUNNEL), ("anticlastic", SADDLE))

# Per figure: columns, height to width of a tile, then (mesh, direction) in
# reading order, and the mesh whose copies are coloured as one.
FIGURES = {
    "01": (4, 0.8, [(name, CORNER) for name in ("component", "surface", "boxes", "facade")], "component"),
    "02": (3, 0.8, [(f"{kind}_default", view) for kind, view in KINDS], "brick"),
    "03": (3, 0.6, [(name, (0.15, -1.6, 0.45)) for name in ("divergent", "parallel", "convergent")], "brick"),
    "05": (3, 0.8, [(f"{kind}_{passes}", view) for kind, view in KINDS
                    for passes in ("plain", "few", "many")], "brick"),
    "07": (3, 0.8, [(f"{kind}_{state}", view) for state in ("default", "corrected")
                    for kind, view in KINDS], "brick"),
    "09": (4, 1.1, [(name, VALLEY) for name in ("coarse_simple", "coarse_compensated",
                                                "dense_simple", "dense_compensated")], None),
    "10": (3, 0.85, [("component", CORNER)] + [(name, VALLEY) for name in
                                              ("base", "default", "by_target", "even")], "component"),
    "11": (2, 0.6, [(name, (-0.35, -1.6, 0.5)) for name in ("distorted", "translated")], "component"),
    "13": (2, 0.75, [(name, (-0.3, -1.2, 1.0)) for name in ("default", "controlled")], "component"),
}


def run(figure, meshes):
    """Runs the figure's graph for these meshes as OBJ; the folder of results."""
    graph = ROOT / f"graphs/figures/figure_{figure}.ron"
    text = graph.read_text()
    outputs = {f"{mesh}.obj": mesh for mesh in meshes}
    outputs |= {f"{mesh}.csv": f"{mesh}_crossings.field" for mesh in meshes
                if f'"{mesh}_crossings"' in text}
    listed = "".join(f'        "{path}": "{result}",\n' for path, result in outputs.items())
    text = re.sub(r"outputs: \{.*?\n    \}", lambda _: "outputs: {\n" + listed + "    }", text, flags=re.S)
    out = tempfile.mkdtemp()
    # Beside the original, so that its paths hold.
    copy = graph.with_name(f".{figure}_pictures.ron")
    copy.write_text(text)
    try:
        subprocess.run([TESSGRAPH, "run", copy, "--out", out, "--no-cache"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    finally:
        copy.unlink()
    return Path(out)


def read(path):
    """Positions and polygons of an OBJ file."""
    points, faces = [], []
    for line in path.read_text().splitlines():
        kind, *rest = line.split() or [""]
        if kind == "v":
            points.append([float(x) for x in rest[:3]])
        elif kind == "f":
            faces.append([int(corner.split("/")[0]) - 1 for corner in rest])
    return np.array(points), faces


def crossing(path, count, together):
    """Which faces belong to a component that crosses another one."""
    if not path.is_file():
        return np.zeros(count, bool)
    rows = [line.split(",")[-1] for line in path.read_text().splitlines()]
    red = np.array([float(x) for x in rows if re.fullmatch(r"-?\d+(\.\d+)?", x)][-count:]) > 0
    if together and count % together == 0:
        red = red.reshape(-1, together).any(axis=1).repeat(together)
    return red


def polydata(points, faces):
    return pv.PolyData(points, np.hstack([[len(face), *face] for face in faces]))


def draw(plotter, points, faces, red):
    for colour, chosen in ((STONE, ~red), (RED, red)):
        part = [face for face, take in zip(faces, chosen) if take]
        if part:
            plotter.add_mesh(polydata(points, part), color=colour, smooth_shading=False,
                             ambient=0.35 if colour == STONE else 0.7, diffuse=0.75, specular=0.0)
    edges = polydata(points, faces).extract_all_edges()
    plotter.add_mesh(edges, color=LINE, line_width=1.6)


def look(plotter, points, direction, aspect):
    """A parallel view from a direction that fills a tile."""
    back = np.array(direction) / np.linalg.norm(direction)
    right = np.cross((0, 0, 1), back)
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    across, upward = points @ right, points @ up
    middle = [(values.min() + values.max()) / 2 for values in (across, upward)]
    focus = right * middle[0] + up * middle[1]
    far = 4 * np.ptp(points, axis=0).max()
    depth = (points @ back).max()
    plotter.camera_position = [focus + back * (depth + far), focus + back * depth, tuple(up)]
    plotter.camera.parallel_projection = True
    plotter.camera.parallel_scale = max(np.ptp(upward), np.ptp(across) * aspect) / 2 * 1.06
    plotter.camera.clipping_range = (0.1 * far, 3 * far)


def tile(out, mesh, direction, size, together):
    points, faces = read(out / f"{mesh}.obj")
    red = crossing(out / f"{mesh}.csv", len(faces), together)
    # Drawn twice as large and shrunk: smooth lines without a blur.
    plotter = pv.Plotter(off_screen=True, window_size=[2 * size[0], 2 * size[1]], lighting="light kit")
    plotter.set_background("white")
    draw(plotter, points, faces, red)
    look(plotter, points, direction, size[1] / size[0])
    image = Image.fromarray(plotter.screenshot(return_img=True))
    plotter.close()
    return image.resize(size, Image.LANCZOS)


def palette():
    """Shades from the lines over the stone to white, and of the red, which a
    palette of its own would lose."""
    def ramp(stops, count):
        stops = np.array([[int(stop[k:k + 2], 16) for k in (1, 3, 5)] for stop in stops])
        at = np.linspace(0, len(stops) - 1, count)
        return np.stack([np.interp(at, range(len(stops)), stops[:, k]) for k in range(3)], axis=1)

    colours = np.concatenate([ramp([LINE, STONE], 32), ramp([STONE, "#ffffff"], 4),
                              ramp([LINE, RED, STONE], 12)])
    image = Image.new("P", (1, 1))
    image.putpalette(np.rint(colours).astype(int).ravel().tolist())
    return image


def picture(figure):
    columns, aspect, tiles, part = FIGURES[figure]
    width = WIDTH // columns
    size = (width, int(width * aspect))
    out = run(figure, [mesh for mesh, _ in tiles] + ([part] if part else []))
    together = len(read(out / f"{part}.obj")[1]) if part else None
    rows = -(-len(tiles) // columns)
    sheet = Image.new("RGB", (width * columns, size[1] * rows), "white")
    for k, (mesh, direction) in enumerate(tiles):
        place = (k % columns * width + GAP, k // columns * size[1] + GAP)
        inner = (size[0] - 2 * GAP, size[1] - 2 * GAP)
        sheet.paste(tile(out, mesh, direction, inner, together), place)
    path = ROOT / f"docs/figures/figure_{figure}.png"
    sheet.quantize(palette=palette(), dither=Image.Dither.NONE).save(path, optimize=True)
    print(f"{path.relative_to(ROOT)}: {os.path.getsize(path) // 1000} kB")


for figure in sys.argv[1:] or FIGURES:
    picture(figure)
