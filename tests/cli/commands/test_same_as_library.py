"""A command computes what the library computes, by the same engine: there is one policy for both."""

import json
import warnings
from functools import cache, partial

import numpy as np
import pytest

import vorotool as v
from support.documents import DATA


@cache
def read(name):
    with warnings.catch_warnings(action="ignore"):
        return v.read(DATA / name)


DOTS, SHAPES = partial(read, "dots.csv"), partial(read, "two-shapes.json")
SKELETON = cache(lambda: v.skeleton_exact(SHAPES()))
FAMILY = cache(lambda: v.alpha_complex(DOTS()))
SHAPE = cache(lambda: v.alpha_shape(FAMILY(), r=60))
FRAME, SIZE = (0, 0, 512, 512), (512, 512)
CLOUD = np.random.default_rng(3).random((60, 3)).round(3)
SOLID, SURFACE = cache(lambda: v.delaunay(CLOUD)), cache(lambda: v.alpha_shape(CLOUD, r=0.3))

SAME = {
    **{
        f"tessellate dots.csv --size 60x50 --max-distance 6.5 -o a.{fmt}": lambda: v.tessellate(
            DOTS(), shape=(50, 60), max_distance=6.5
        )
        for fmt in ("npy", "png", "tif", "txt")
    },
    "tessellate cells.png --what neighbors -o a.csv": lambda: v.neighbor_table(v.tessellate(read("cells.png"))),
    "delaunay dots.csv -o a.csv": lambda: v.delaunay(DOTS()),
    "delaunay dots.csv --what triangles -o a.csv": lambda: v.delaunay(DOTS()),
    "delaunay dots.csv --what cells -o a.geojson": lambda: v.voronoi_cells(DOTS()),
    "delaunay dots.csv --what cells --frame 0.5,10,300,200.25 -o a.csv": lambda: v.voronoi_cells(
        DOTS(), frame=(0.5, 10, 300, 200.25)
    ),
    "delaunay dots.csv --what cells --clip two-shapes.json -o a.json": lambda: v.voronoi_cells(DOTS(), clip=SHAPES()),
    "delaunay dots.csv --graph gabriel -o a.csv": lambda: v.proximity_graph(DOTS(), "gabriel"),
    "delaunay dots.csv --graph relative -o a.json": lambda: v.proximity_graph(DOTS(), "relative"),
    "delaunay dots.csv --graph mst --method digital-valid --size 512x512 -o a.geojson": lambda: v.proximity_graph(
        DOTS(), "mst"
    ),
    "delaunay dots.csv --what statistics --frame 0,0,512,512 -o a.csv": lambda: v.cell_statistics(DOTS(), frame=FRAME),
    "delaunay dots.csv --what measures --frame 0,0,512,512 -o a.csv": lambda: v.cell_statistics(DOTS(), frame=FRAME),
    "delaunay dots.csv --method digital --size 512x512 -o a.json": lambda: v.digital_triangulation(DOTS(), shape=SIZE),
    "delaunay dots.csv --method digital --size 512x512 --what triangles -o a.obj": lambda: v.digital_triangulation(
        DOTS(), shape=SIZE
    ),
    "delaunay dots.csv --what compare --size 512x512 -o a.csv": lambda: (
        v.compare_digital(DOTS(), shape=SIZE).differences
    ),
    "alphashape dots.csv -r 60 -o a.csv": SHAPE,
    "alphashape dots.csv -r 60 --method digital-valid -o a.geojson": SHAPE,
    "alphashape dots.csv -r 60 --what general -o a.wkt": SHAPE,
    "alphashape dots.csv -r 60 --what hull -o a.csv": lambda: v.alpha_hull(SHAPE()),
    "alphashape dots.csv --what family -o a.csv": FAMILY,
    "alphashape dots.csv --what spectrum -o a.csv": FAMILY,
    "alphashape dots.csv --what curves -o a.csv": lambda: v.alpha_curves(FAMILY()),
    "alphashape dots.csv -r 60 --what table --hole-threshold 1e9 --region-threshold 900 -o a.json": lambda: (
        v.alpha_shape(FAMILY(), r=60, hole_threshold=1e9, region_threshold=900)
    ),
    "alphashape dots.csv --what persistence -o a.csv": lambda: v.persistence(DOTS()),
    "skeleton-exact two-shapes.json -o a.npz": SKELETON,
    "skeleton-exact two-shapes.json --prune angle=60 --what branches -o a.csv": lambda: v.prune(SKELETON(), angle=60),
    "skeleton-exact two-shapes.json --what elements -o a.csv": SKELETON,
    "skeleton-exact two-shapes.json --join-junctions -o a.graphml": lambda: v.join_junctions(SKELETON()),
    "skeleton-exact two-shapes.json --side exterior --frame 0,0,400,200 -o a.csv": lambda: v.skeleton_exact(
        SHAPES(), side="exterior", frame=(0, 0, 400, 200)
    ),
    "skeleton-exact two-shapes.json --what offset -d -20,5 -o a.csv": lambda: v.offset(SHAPES(), [-20, 5]),
    "skeleton-exact two-shapes.json --what offset -d -10,10 -o a.svg": lambda: v.offset(SHAPES(), [-10, 10]),
    "skeleton-exact two-shapes.json --what necks --neck 0.6 -o a.csv": lambda: v.necks(SHAPES(), neck=0.6),
    "skeleton-exact two-shapes.json --what parts --neck 0.95 -o a.geojson": lambda: v.parts(SHAPES(), neck=0.95),
    "skeleton-exact two-shapes.json --what discs --count 3 -o a.csv": lambda: v.largest_discs(SHAPES(), count=3),
    "skeleton-exact two-shapes.json --what points --every 7 -o a.csv": lambda: v.points_along(SKELETON(), every=7),
    "skeleton-exact two-shapes.json --smooth 0.5 -o a.csv": lambda: v.smooth(SKELETON(), 0.5),
    "skeleton-exact blobs.png --prune none -o a.npz": lambda: v.skeleton_exact(v.outlines(read("blobs.png"))),
    "skeleton-approx two-shapes.json --tolerance 0.05 -o a.csv": lambda: v.skeleton_approx(SHAPES(), tolerance=0.05),
    "voronoi two-shapes.json -o a.json": lambda: v.voronoi(SHAPES()),
    "voronoi two-shapes.json --what edges --max-distance 30 -o a.csv": lambda: v.voronoi(SHAPES(), max_distance=30),
    "voronoi two-shapes.json --what neighbors -o a.csv": lambda: v.voronoi(SHAPES()),
    **{f"delaunay cloud.csv --space -o a.{fmt}": SOLID for fmt in ("vtu", "ply", "stl", "obj")},
    **{f"delaunay cloud.csv --space --what {what} -o a.csv": SOLID for what in ("tetrahedra", "table")},
    **{f"alphashape cloud.csv --space -r 0.3 -o a.{fmt}": SURFACE for fmt in ("ply", "stl", "obj", "npz", "json")},
    **{
        f"alphashape cloud.csv --space -r 0.3 --what {what} -o a.csv": SURFACE
        for what in ("surface", "tetrahedra", "triangles", "edges", "table")
    },
    **{
        f"alphashape cloud.csv --space --what {what} -o a.csv": lambda: SURFACE().family
        for what in ("family", "spectrum")
    },
    "alphashape cloud.csv --space --what curves -o a.csv": lambda: v.alpha_curves(SURFACE().family),
}


@pytest.mark.parametrize("line", SAME)
def test_results(run, tmp_path, line):
    words = line.split()
    np.savetxt(tmp_path / "cloud.csv", CLOUD, "%.3f", ",", header="x,y,z", comments="")
    made, expected = tmp_path / words[-1], tmp_path / f"library.{words[-1]}"
    check = ["--verify"] if "compare" not in words else []
    done = run(*(DATA / word if (DATA / word).exists() else word for word in words), *check, "-q")
    assert (done.out, done.err) == ("", "")
    value = SAME[line]()
    has_parts = "--what" in words and not isinstance(value, v.Table)
    v.write(value, expected, what=words[words.index("--what") + 1] if has_parts else None)
    assert made.read_bytes() == expected.read_bytes() != b""


STATISTICS = {
    "delaunay dots.csv --graph mst": {"points": 53, "graph_edges": 52},
    "skeleton-exact two-shapes.json --smooth 0.5": {"smooth": 0.5},
    "skeleton-exact two-shapes.json --what offset -d -20,5": {"distances": [-20, 5], "shapes": 5, "rings": 6},
    "skeleton-exact two-shapes.json --what necks,parts --neck 1": {"necks": 6, "neck": 1.0, "pieces": 7, "cuts": 6},
    "distance two-shapes.json two-shapes.json": {"hausdorff": 0, "smallest": 0},
}


@pytest.mark.parametrize("line", STATISTICS)
def test_statistics(run, folder, line):
    words = [DATA / word if (DATA / word).exists() else word for word in line.split()]
    stats = json.loads(run(*words, "-q", "-o", "a.csv", "--stats", "-").out)
    assert {name: stats[name] for name in STATISTICS[line]} == STATISTICS[line]


# ---- features that overlap and touch -------------------------------------------------------------
OVERLAPPING = {
    "type": "GeometryCollection",
    "geometries": [
        {
            "type": "Polygon",
            "coordinates": [[[0, 0], [40, 0], [40, 30], [0, 30]], [[8, 8], [8, 20], [22, 20], [22, 8]]],
        },
        {"type": "Polygon", "coordinates": [[[30, 10], [60, 10], [60, 25], [30, 25]]]},
        {"type": "Polygon", "coordinates": [[[10, 10], [20, 10], [20, 18], [10, 18]]]},
        {"type": "LineString", "coordinates": [[45, -5], [55, 32]]},
    ],
}
"""One lies over another, one in a hole, and a line goes through one."""


@pytest.mark.parametrize("features", ["separate", "together"])
@pytest.mark.parametrize("side", ["interior", "exterior", "both"])
@pytest.mark.parametrize(
    ("command", "option"),
    [
        *(("skeleton-exact", {"gap": 0.0}), ("skeleton-exact", {"gap": 1.0})),
        *(("skeleton-approx", {"step": 3}), ("skeleton-approx", {"tolerance": 1})),
    ],
)
def test_skeletons_are_the_same(run, folder, command, option, side, features):
    (folder / "shapes.geojson").write_text(json.dumps(OVERLAPPING))
    with warnings.catch_warnings(action="ignore"):  # of overlaps, once they are taken together
        made = getattr(v, command.replace("-", "_"))
        made = made(v.read(folder / "shapes.geojson"), side=side, features=features, **option)
    v.write(made, folder / "library.json")
    ((name, value),) = option.items()
    line = f"{command} shapes.geojson --side {side} --features {features} --{name} {value} -o command.json"
    for more in ("", "--verify --stats s.json"):
        run(f"{line} {more}")
        assert (folder / "command.json").read_bytes() == (folder / "library.json").read_bytes()


@pytest.mark.parametrize("method", ["exact", "propagation"])
def test_what_is_said_of_a_tessellation(run, folder, method):
    (folder / "twice.csv").write_text("2,1\n7,5\n2,1\n1,6\n")
    done = run(f"tessellate twice.csv --size 12x9 --method {method} -o command.npy")
    assert done.err.count("warning") == 1
    with pytest.warns(v.VorotoolWarning) as told:
        made = v.tessellate(v.read(folder / "twice.csv"), shape=(9, 12), method=method)
    assert f"warning: {told[0].message}" in done.err
    np.testing.assert_array_equal(np.load(folder / "command.npy"), made.labels)
    run(f"tessellate twice.csv --method {method} --strict -o strict.npy", code=3)
