"""Other libraries doing the work of our benchmarks, on the same data.

    python3 peers.py LIBRARY WORK FOLDER

FOLDER holds the input as raw little-endian arrays, `points.f64` and the like.
The program prepares the work, says `ready` (or `absent` and why), and for each
line it is given does the work once and answers with the nanoseconds of
processor time, all threads together. `cargo bench` starts it; by hand:

    printf 'run\\nrun\\n' | python3 peers.py libigl closest FOLDER
"""

import io
import os
import subprocess
import sys
import time

# One thread each, as ours runs when it is compared.
for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "IGL_NUM_THREADS"):
    os.environ.setdefault(name, "1")


def array(folder, name, width):
    """The array `name`, as rows of `width`."""
    import numpy

    kind = name.rsplit(".", 1)[1]
    kinds = {"f64": "<f8", "u32": "<u4"}
    found = numpy.fromfile(os.path.join(folder, name), dtype=kinds[kind])
    return found.reshape(-1, width)


def fcpw_closest(folder):
    import fcpw
    import numpy

    positions = array(folder, "positions.f64", 3).astype(numpy.float32)
    triangles = array(folder, "triangles.u32", 3).astype(numpy.int32)
    points = numpy.asfortranarray(array(folder, "points.f64", 3).astype(numpy.float32))
    scene = fcpw.scene_3D()
    scene.set_object_count(1)
    scene.set_object_vertices(positions, 0)
    scene.set_object_triangles(triangles, 0)
    scene.build(fcpw.aggregate_type.bvh_surface_area, True)
    radii = numpy.full(len(points), numpy.inf, dtype=numpy.float32)

    def work():
        found = fcpw.interaction_3D_list()
        scene.find_closest_points(points, radii, found)
        return found

    return work


def libigl_closest(folder):
    import igl
    import numpy

    positions = array(folder, "positions.f64", 3)
    triangles = array(folder, "triangles.u32", 3).astype(numpy.int64)
    points = array(folder, "points.f64", 3)
    tree = igl.AABB()
    tree.init(positions, triangles)
    return lambda: tree.squared_distance(positions, triangles, points)


def scipy_diffuse(folder):
    """Each pass half of the old direction and half of the neighbours' mean."""
    import numpy
    from scipy import sparse

    directions = array(folder, "directions.f64", 3)
    edges = array(folder, "edges.u32", 2)
    passes = 50
    ends = numpy.concatenate([edges, edges[:, ::-1]])
    count = len(directions)
    ones = numpy.ones(len(ends))
    weights = sparse.csr_matrix((ones, (ends[:, 0], ends[:, 1])), (count, count))
    valence = numpy.asarray(weights.sum(axis=1)).ravel()
    mean = sparse.diags(0.5 / numpy.maximum(valence, 1)) @ weights
    step = (mean + 0.5 * sparse.identity(count)).tocsr()

    def work():
        field = directions
        for _ in range(passes):
            field = step @ field
            field /= numpy.linalg.norm(field, axis=1)[:, None]
        return field

    return work


def trimesh_weld(folder):
    import trimesh

    points = array(folder, "points.f64", 3)
    return lambda: trimesh.grouping.unique_rows(points)


def scipy_weld_near(folder):
    """All pairs within the distance, and what they connect."""
    import numpy
    from scipy import sparse
    from scipy.spatial import cKDTree

    points = array(folder, "points.f64", 3)
    distance = float(array(folder, "distance.f64", 1)[0, 0])

    def work():
        pairs = cKDTree(points).query_pairs(distance, output_type="ndarray")
        joined = (numpy.ones(len(pairs), bool), (pairs[:, 0], pairs[:, 1]))
        graph = sparse.coo_matrix(joined, (len(points), len(points)))
        return sparse.csgraph.connected_components(graph, directed=False)

    return work


def meshlib_mesh(folder):
    import numpy
    from meshlib import mrmeshnumpy

    positions = array(folder, "positions.f64", 3)
    triangles = array(folder, "triangles.u32", 3).astype(numpy.int32)
    return mrmeshnumpy.meshFromFacesVerts(triangles, positions)


def meshlib_intersect(folder):
    from meshlib import mrmeshpy

    part = mrmeshpy.MeshPart(meshlib_mesh(folder))
    mrmeshpy.findSelfCollidingTriangles(part)
    return lambda: mrmeshpy.findSelfCollidingTriangles(part)


def meshlib_write(kind):
    def prepare(folder):
        from meshlib import mrmeshpy

        mesh = meshlib_mesh(folder)
        path = os.path.join(folder, "written." + kind)
        return lambda: mrmeshpy.saveMesh(mesh, path)

    return prepare


def meshlib_read(kind):
    def prepare(folder):
        from meshlib import mrmeshpy

        return lambda: mrmeshpy.loadMesh(os.path.join(folder, "file." + kind))

    return prepare


def trimesh_write(kind):
    def prepare(folder):
        import trimesh

        positions = array(folder, "positions.f64", 3)
        triangles = array(folder, "triangles.u32", 3).astype("int64")
        mesh = trimesh.Trimesh(positions, triangles, process=False)
        return lambda: mesh.export(file_type=kind)

    return prepare


def trimesh_read(kind):
    def prepare(folder):
        import trimesh

        with open(os.path.join(folder, "file." + kind), "rb") as file:
            content = file.read()
        return lambda: trimesh.load(io.BytesIO(content), file_type=kind, process=False)

    return prepare


def opensubdiv(folder):
    """Becomes the program that is compiled from `opensubdiv.cpp`."""
    here = os.path.dirname(os.path.abspath(__file__))
    program = os.path.join(folder, "opensubdiv")
    if not os.path.exists(program):
        source = os.path.join(here, "opensubdiv.cpp")
        command = ["c++", "-O3", "-march=native", source, "-o", program, "-losdCPU"]
        built = subprocess.run(command, capture_output=True, text=True, check=False)
        if built.returncode != 0:
            raise RuntimeError("opensubdiv.cpp does not compile: install libosd-dev")
    os.execv(program, [program, folder])


WORK = {
    ("fcpw", "closest"): fcpw_closest,
    ("libigl", "closest"): libigl_closest,
    ("scipy", "diffuse"): scipy_diffuse,
    ("trimesh", "weld"): trimesh_weld,
    ("scipy", "weld_near"): scipy_weld_near,
    ("meshlib", "intersect"): meshlib_intersect,
    ("opensubdiv", "subdivide"): opensubdiv,
    **{("meshlib", "write_" + kind): meshlib_write(kind) for kind in ("obj", "stl", "ply")},
    **{("meshlib", "read_" + kind): meshlib_read(kind) for kind in ("obj", "stl", "ply")},
    **{("trimesh", "write_" + kind): trimesh_write(kind) for kind in ("obj", "stl", "ply", "glb")},
    **{("trimesh", "read_" + kind): trimesh_read(kind) for kind in ("obj", "stl", "ply", "glb")},
}


def main():
    library, work, folder = sys.argv[1:]
    # Libraries print; the answers have the output to themselves.
    answers = os.fdopen(os.dup(1), "w")
    if (library, work) != ("opensubdiv", "subdivide"):
        os.dup2(2, 1)
    try:
        run = WORK[library, work](folder)
    except Exception as reason:  # whatever is wrong, the peer is absent
        print("absent", reason, file=answers, flush=True)
        return
    print("ready", file=answers, flush=True)
    for _ in sys.stdin:
        start = time.process_time_ns()
        result = run()
        print(time.process_time_ns() - start, file=answers, flush=True)
        del result


if __name__ == "__main__":
    main()
