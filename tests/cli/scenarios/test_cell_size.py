"""``tessellate --cell-size``: points, lines and polygons of a map as images on it, checked with rasterio."""

import json
from fractions import Fraction

import numpy as np
import pytest
import rasterio
import rasterio.features
import shapely

from support.documents import DATA
from support.families.geojson import collection

RNG = np.random.default_rng(21)
XY = np.round(RNG.uniform((2600000, 1199000), (2603000, 1201000), (40, 2)), 1)


def read(path):
    with rasterio.open(path) as file:
        return file.read(1), file.transform, file.crs, file.nodata


def write(path, geometries, crs="EPSG:2056"):
    path.write_text(collection(geometries, [{"name": f"n{k}"} for k in range(len(geometries))], crs=crs))


def centers(transform, shape):
    a, _, c, _, e, f = tuple(transform)[:6]
    x, y = np.meshgrid(c + a * (np.arange(shape[1]) + 0.5), f + e * (np.arange(shape[0]) + 0.5))
    return np.stack([x, y], axis=2)


def nearest_misses(labels, transform, sites):
    """Pixels whose label is farther than the nearest site, by more than sites were moved."""
    distances = np.linalg.norm(centers(transform, labels.shape)[:, :, None] - sites, axis=3)
    chosen = np.take_along_axis(distances, labels[:, :, None].astype(int) - 1, axis=2)[:, :, 0]
    return (chosen > distances.min(axis=2) + 2 * transform.a / 256).sum()


@pytest.mark.parametrize("kind", ["csv", "geojson"])
def test_points(run, tmp_path, kind):
    if kind == "csv":
        np.savetxt(tmp_path / "in.csv", XY, delimiter=",", header="x,y", comments="", fmt="%.1f")
    else:
        write(tmp_path / "in.geojson", [shapely.Point(xy) for xy in XY])
    run(f"tessellate in.{kind} --cell-size 25 -o out.tif --verify -q")
    labels, transform, crs, nodata = read(tmp_path / "out.tif")
    assert (transform.a, transform.e, crs, nodata) == (25, -25, "EPSG:2056" if kind == "geojson" else None, None)
    low, high = XY.min(axis=0), XY.max(axis=0)
    assert (transform.c, transform.f) == (25 * (low[0] // 25), 25 * -(-high[1] // 25))
    assert labels.shape == (-(-high[1] // 25) - low[1] // 25, -(-high[0] // 25) - low[0] // 25)
    assert nearest_misses(labels, transform, XY) == 0


def test_polygons_are_those_of_rasterio(run, folder_of_data):
    run("tessellate lakes.geojson --cell-size 0.05 --max-distance 0 -o out.tif -q")
    labels, transform, _, nodata = read("out.tif")
    assert nodata == 0
    features = json.loads((folder_of_data / "lakes.geojson").read_text(encoding="utf-8"))["features"]
    shapes = [(each["geometry"], k + 1) for k, each in enumerate(features)]
    expected = rasterio.features.rasterize(shapes, labels.shape, transform=transform, dtype="uint16")
    assert (labels == expected).all()
    rows = run("tessellate lakes.geojson --cell-size 0.05 --what table -q").rows
    assert [row["name"] for row in rows] == ["Lake Michigan", "Lake Superior", "Lake Huron"]
    counts = np.bincount(labels.ravel())[1:]
    assert np.allclose([float(row["object_area"]) for row in rows], counts * 0.05**2)


@pytest.fixture
def folder_of_data(tmp_path):

    data = DATA / "great-lakes.geojson"
    (tmp_path / "lakes.geojson").write_bytes(data.read_bytes())
    return tmp_path


def test_allocation_lines_up_with_a_mask(run, folder_of_data):
    """A GeoTIFF mask, its allocation, and vectors of both are at one place."""
    run("tessellate lakes.geojson --cell-size 0.1 --max-distance 0 -o a.tif -q")
    run("tessellate a.tif -o b.tif -q")
    a, b = read("a.tif"), read("b.tif")
    assert a[1:3] == b[1:3]
    assert (b[0][a[0] > 0] == a[0][a[0] > 0]).all()
    done = run("skeleton-exact a.tif --what shape --prune none -f geojson -q")
    shapes = [shapely.from_geojson(json.dumps(each["geometry"])) for each in json.loads(done.out)["features"]]
    features = json.loads((folder_of_data / "lakes.geojson").read_text(encoding="utf-8"))["features"]
    lakes = [shapely.from_geojson(json.dumps(each["geometry"])) for each in features]
    overlap = shapely.union_all(shapes).intersection(shapely.union_all(lakes)).area
    assert overlap > 0.93 * shapely.union_all(lakes).area


def test_small_features_are_told_of(run, tmp_path):
    write(tmp_path / "in.geojson", [shapely.box(0, 0, 100, 100), shapely.box(3, 3, 4, 4), shapely.box(30, 30, 50, 50)])
    words = "warning: 2 of 3 features without a cell, because they are small, covered or outside: 2, 3"
    run("tessellate in.geojson --cell-size 10 -o out.tif", says=words)
    labels, *_ = read(tmp_path / "out.tif")
    assert (labels == 1).all()


# ---- units of the map ---------------------------------------------------------------------------
@pytest.mark.parametrize(("cell", "factor"), [("0.0125km", ()), ("12.5", ("--pixel-size", "2ft"))])
def test_distances_are_in_units_of_the_map(run, tmp_path, cell, factor):
    """Every pixel of all three results, against the places of seeds and centers as fractions."""
    quarters = [(2, 2), (43, 58), (19, 7)]  # of cells of 12.5, so that no seed is moved
    places = [(2600000 + Fraction(25 * x, 8), 1200000 + Fraction(25 * y, 8)) for x, y in quarters]
    write(tmp_path / "in.geojson", [shapely.Point(*map(float, place)) for place in places])
    window = ["--window", "2600000,1200000,150,200"]
    words = ["tessellate", "in.geojson", "--cell-size", cell, *window, *factor, "-q", "--stats", "s.json"]
    for what in ("distance", "distance2"):
        run(*words, "--what", what, "-o", f"{what}.tif")
    unit = 2 if factor else 1
    stats = json.loads((tmp_path / "s.json").read_text())
    step = Fraction(stats["distance2_step"])
    with rasterio.open(tmp_path / "distance2.tif") as file:
        squares, (scale,) = file.read(1), file.scales
    with rasterio.open(tmp_path / "distance.tif") as file:
        distances = file.read(1)
    assert squares.dtype.kind in "iu"
    assert scale == float(step * step)
    cells = Fraction(25, 2)
    for row, column in np.ndindex(squares.shape):
        x, y = 2600000 + (column + Fraction(1, 2)) * cells, 1200200 - (row + Fraction(1, 2)) * cells
        least = min((x - a) ** 2 + (y - b) ** 2 for a, b in places) * unit * unit
        assert int(squares[row, column]) * step * step == least
        assert float(distances[row, column]) == pytest.approx(float(least) ** 0.5, rel=1e-7)


def test_the_largest_distance_is_in_units_of_the_map(run, tmp_path):
    """1 km cells, 20 km: the disc of a radius of 20 cells, not of 20 000."""
    write(tmp_path / "in.geojson", [shapely.Point(2650500, 1250500)])
    words = ["--cell-size", "1000", "--window", "2600000,1200000,101000,101000", "-q", "-o", "out.tif"]
    for length in ("20000", "20km"):
        run("tessellate in.geojson", *words, "--max-distance", length)
        labels, *_ = read(tmp_path / "out.tif")
        y, x = np.indices(labels.shape) - 50
        assert (labels > 0).tolist() == (x * x + y * y <= 400).tolist()
    rows = run("tessellate in.geojson", *words[:5], "--what", "table", "--max-distance", "20km").rows
    assert float(rows[0]["max_distance"]) == 20000
    assert float(rows[0]["area"]) == np.count_nonzero(labels) * 10**6
