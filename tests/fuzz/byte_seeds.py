"""Small valid files of every format that is read: what the fuzzer of bytes begins with."""

import gzip
import io
import itertools
import sqlite3
import struct
import tempfile
import zipfile
import zlib
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import ezdxf
import laspy
import numpy as np
import shapely
import tifffile
from PIL import Image, features

import vorotool
from support.families.tiff_files import LONG, SHORT, grey, tiff_file


@dataclass(frozen=True)
class Bundle:
    """An input: its kind, the name that is read, and the content of its files by their names."""

    kind: str
    name: str
    files: dict[str, bytes]


GREY = np.random.default_rng(1).integers(0, 9, (13, 11), dtype=np.uint8)
DOTS = [[1, 2], [8.5, 3], [4, 9.25], [7, 7], [0.5, 0]]
SHAPES = [[[0, 0], [9, 0], [9, 6], [0, 6]], [[2, 2], [2, 4], [5, 4]], [[20, 1], [25, 3], [21, 8]]]


def seeds() -> list[Bundle]:
    """All of them, in the same order on every run."""
    return [
        Bundle(kind, name, {name: data})
        for kind, name, data in (
            *_pngs(),
            *_tiffs(),
            *_stacks(),
            *_pictures(),
            *_arrays(),
            *_maps(),
            *_layers(),
            *_texts(),
            *_clouds(),
            *_drawings(),
            *_results(),
        )
    ] + [*_stores(), *_ome_stores(), *_shapefiles()]


def _saved(image: Image.Image, fmt: str, **options: object) -> bytes:
    out = io.BytesIO()
    image.save(out, fmt, **options)
    return out.getvalue()


def _pngs() -> list[tuple[str, str, bytes]]:
    grey = Image.fromarray(GREY * 20)
    palette = Image.fromarray(GREY)
    palette.putpalette(list(range(27)))
    images = [grey, Image.fromarray(GREY > 4), palette, grey.convert("RGB"), grey.convert("RGBA"), grey.convert("LA")]
    images.append(Image.fromarray(GREY.astype(np.uint16) * 999))
    files = [_saved(image, "PNG") for image in images]
    text = b"iTXtComment\0\1\0\0\0" + zlib.compress(b"a comment " * 9)
    chunk = (len(text) - 4).to_bytes(4, "big") + text + zlib.crc32(text).to_bytes(4, "big")
    return [("png", "a.png", data) for data in (*files, files[0][:33] + chunk + files[0][33:])]


def _pictures() -> list[tuple[str, str, bytes]]:
    grey, palette = Image.fromarray(GREY * 20), Image.fromarray(GREY)
    palette.putpalette(list(range(27)))
    turned = Image.Exif()
    turned[274] = 6  # the orientation
    animation = {"save_all": True, "append_images": [palette.rotate(180), grey]}
    kinds: dict[str, list[tuple[Image.Image, dict[str, object]]]] = {
        "jpeg": [(grey, {}), (grey.convert("RGB"), {"progressive": True, "exif": turned}), (grey.convert("CMYK"), {})],
        "bmp": [(grey, {}), (grey.convert("1"), {}), (palette, {}), (grey.convert("RGBA"), {})],
        "gif": [(grey, {}), (palette, {"transparency": 2, "interlace": 1}), (palette, animation)],
        "webp": [(grey, {}), (grey, {"lossless": True, "exif": turned}), (grey.convert("RGBA"), animation)],
        "avif": [(grey, {"exif": turned}), (grey.convert("RGBA"), {})],
    }
    known = [kind for kind in kinds if kind != "avif" or "avif" in features.get_supported()]
    return [(k, f"a.{k}", _saved(image, k.upper(), **options)) for k in known for image, options in kinds[k]]


def _tiff(value: np.ndarray, **options: object) -> bytes:
    out = io.BytesIO()
    tifffile.imwrite(out, value, **options)
    return out.getvalue()


def _tiffs() -> list[tuple[str, str, bytes]]:
    files = []
    plain: tuple[dict[str, object], ...] = ({}, {"tile": (16, 16)}, {"bigtiff": True})
    compressed: tuple[dict[str, object], ...] = ({"compression": "zlib"}, {"compression": "lzma", "rowsperstrip": 4})
    numbers = itertools.product(("u1", ">u2", "i4", "f4"), (*plain, *compressed))
    for dtype, options in (*numbers, *itertools.product("?", plain)):
        byteorder = ">" if dtype[0] == ">" else "<"
        files.append(_tiff(GREY.astype(dtype), byteorder=byteorder, metadata=None, **options))
    for options in ({"compression": "zlib", "predictor": 2, "tile": (16, 16)}, {"imagej": True, "resolution": (4, 5)}):
        files.append(_tiff(GREY.astype("u2"), **options))
    places = [(33550, 12, 3, (2.0, 2.0, 0.0), True), (33922, 12, 6, (0.0, 0.0, 0.0, 5.0, 7.0, 0.0), True)]
    keys = (1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 2056)
    tags = [*places, (34735, 3, len(keys), keys, True), (42113, 2, 0, "3", True)]
    files.append(_tiff(GREY, metadata=None, extratags=tags))
    sizes = {"PhysicalSizeX": 0.25, "PhysicalSizeY": 0.25}
    files.append(_tiff(GREY, ome=True, metadata={"axes": "YX", "UUID": "urn:uuid:0", **sizes}))
    for compression in ("tiff_adobe_deflate", "tiff_lzw", "packbits"):
        files.append(_saved(Image.fromarray(GREY.astype(bool)), "TIFF", compression=compression))
    color = np.dstack([GREY, GREY + 1, GREY + 2])
    for options in ({"planarconfig": "separate"}, {"planarconfig": "contig", "compression": "zlib"}):
        value = np.moveaxis(color, 2, 0) if options["planarconfig"] == "separate" else color
        files.append(_tiff(value, photometric="rgb", metadata=None, **options))
    out = io.BytesIO()
    with tifffile.TiffWriter(out) as writer:
        for page in (GREY, GREY[:5]):
            writer.write(page, contiguous=False, metadata=None)
    files.append(out.getvalue())
    for compression in ("tiff_lzw", "packbits", "jpeg"):
        files += [_saved(Image.fromarray(value), "TIFF", compression=compression) for value in (GREY, color)]
    files.append(_saved(Image.fromarray(GREY > 4), "TIFF", compression="group4"))
    four = GREY[:, :10] & 7
    files.append(tiff_file(grey(10, 13, bits=4), [(four[:, ::2] << 4 | four[:, 1::2]).tobytes()]))
    strips = [row.tobytes() for row in GREY]
    files.append(tiff_file(grey(11, 13, 1) | {42113: (2, [55, 0]), 266: (SHORT, [2])}, strips, left_out=[3, 4]))
    files.append(tiff_file(grey(11, 13, 1) | {282: (LONG, [3])}, strips))
    return [("tiff", "a.tif", data) for data in files]


def _stacks() -> list[tuple[str, str, bytes]]:
    """Volumes with a description of OME, of ImageJ or of tifffile; one with smaller copies below its pages."""
    cube, sides = np.stack([GREY, GREY[::-1], GREY + 1]), {"PhysicalSizeX": 0.25, "PhysicalSizeY": 0.25}
    about = {"axes": "ZYX", "UUID": "urn:uuid:0", "PhysicalSizeZ": 2, **sides}
    options: tuple[dict[str, object], ...] = ({}, {"compression": "zlib", "tile": (16, 16)}, {"bigtiff": True})
    files = [_tiff(cube, ome=True, photometric="minisblack", metadata=about, **option) for option in options]
    files.append(_tiff(cube, imagej=True, metadata={"axes": "ZYX", "spacing": 2, "unit": "um"}))
    files.append(_tiff(cube, photometric="minisblack", metadata={"axes": "ZYX"}))
    out = io.BytesIO()
    with tifffile.TiffWriter(out, ome=True) as writer:
        writer.write(cube, subifds=1, photometric="minisblack", metadata=about)
        writer.write(cube[:, ::2, ::2], subfiletype=1, photometric="minisblack")
    return [("ome-tiff", "a.ome.tif", data) for data in (*files, out.getvalue())]


def _arrays() -> list[tuple[str, str, bytes]]:
    files = []
    values = (GREY, GREY.astype(">i4"), GREY > 3, GREY / 3, np.asfortranarray(GREY), np.dstack([GREY] * 3))
    for value in (*values, np.array(DOTS), np.array(DOTS, np.float32), np.ones((4, 3))):
        out = io.BytesIO()
        np.save(out, value)
        files.append(out.getvalue())
    text = "\n".join(" ".join(map(str, row)) for row in GREY).encode()
    pixels = [b"P2 11 13 # largest\n9\n" + text, b"P5\n11 13\n255\n" + GREY.tobytes(), b"P4 10 2\n\xff\x40\x01\x80"]
    pixels += [b"P1 3 2\n1 0 1 010", b"P3 2 1 255 1 2 3 4 5 6", b"P6 1 2 65535\n" + bytes(12)]
    return [("npy", "a.npy", data) for data in files] + [("pnm", "a.pgm", data) for data in pixels]


def _maps() -> list[tuple[str, str, bytes]]:
    import json

    rings = [[*ring, ring[0]] for ring in SHAPES]
    geometries = [
        {"type": "Polygon", "coordinates": rings[:2]},
        {"type": "MultiPolygon", "coordinates": [rings[:2], rings[2:]]},
        {"type": "LineString", "coordinates": DOTS},
        {"type": "MultiLineString", "coordinates": [DOTS[:2], DOTS[2:]]},
        {"type": "Point", "coordinates": [1, 2, 3]},
        {"type": "MultiPoint", "coordinates": DOTS},
    ]
    features = [
        {"type": "Feature", "properties": {"id": n, "name": "a\u00e9"}, "geometry": g} for n, g in enumerate(geometries)
    ]
    crs = {"type": "name", "properties": {"name": "EPSG:3057"}}
    values = [{"type": "FeatureCollection", "features": part} for part in (features[:4], features[4:], features)]
    values += [values[0] | {"crs": crs}, geometries[1], {"type": "GeometryCollection", "geometries": geometries[:3]}]
    wkt = "POLYGON ((0 0, 9 0, 9 6, 0 6, 0 0), (2 2, 2 4, 5 4, 2 2))"
    texts = [wkt, "MULTIPOLYGON (((0 0, 1 0, 0 1, 0 0)), ((5 5, 6 5, 5 6, 5 5)))", "LINESTRING Z (0 0 1, 5 5 2, 9 1 3)"]
    texts += [
        "MULTIPOINT ((1 2), (3 4))\nPOINT (5 6)",
        "SRID=3057;POINT (1 2)",
        f"GEOMETRYCOLLECTION ({wkt})",
        "CURVEPOLYGON (CIRCULARSTRING (0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 3 3, 3 1, 1 1))\nTRIANGLE ((9 9, 8 9, 9 8, 9 9))",  # noqa: E501
        "MULTISURFACE (((0 0, 1 0, 1 1, 0 0)), CURVEPOLYGON (COMPOUNDCURVE (CIRCULARSTRING (5 5, 6 6, 7 5), (7 5, 5 5))))",  # noqa: E501
        "GEOMETRYCOLLECTION Z (TIN Z (((0 0 1, 1 0 1, 0 1 1, 0 0 1))), MULTICURVE Z ((0 0 1, 3 3 2)))",
        "POINT EMPTY",
    ]
    return [("geojson", "a.geojson", json.dumps(value).encode()) for value in values] + [
        ("wkt", "a.wkt", text.encode()) for text in texts
    ]


def _layer(folder: Path, name: str) -> Path:
    """A file of polygons with attributes, as its extension says."""
    shells = [[ring, SHAPES[1:2] if ring is SHAPES[0] else []] for ring in (SHAPES[0], SHAPES[2])]
    crs = {"type": "name", "properties": {"name": "EPSG:3057"}}
    rings = [ring for shell, holes in shells for ring in (shell, *holes)]
    shapes = vorotool.PolygonSet(
        np.concatenate([np.array(ring) for ring in rings]),
        np.cumsum([0, *map(len, rings)]),
        [0, 1, 0],
        [0, 0, 1],
        properties={"name": ["a", "b"], "n": [1, None], "r": [0.5, 2.0]},
        y_axis="up",
        crs=crs,
    )
    vorotool.write(shapes, folder / name)
    return folder / name


def _layers() -> list[tuple[str, str, bytes]]:
    wkb = shapely.to_wkb(shapely.polygons(SHAPES[0], SHAPES[1:2]), hex=True)
    kml = '<kml xmlns="http://www.opengis.net/kml/2.2"><Placemark><Point><coordinates>8,47</coordinates></Point></Placemark>'
    gpx = '<gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1"><wpt lat="47" lon="8"/></gpx>'
    rows = f'id,geometry\n7,"{shapely.from_wkb(wkb).wkt}"\n8,{wkb}\n9,SRID=3057;POINT (1 2)\n'
    with tempfile.TemporaryDirectory() as folder:
        files = [(fmt, f"a.{fmt}", _layer(Path(folder), f"a.{fmt}").read_bytes()) for fmt in ("gpkg", "fgb", "parquet")]
        with closing(sqlite3.connect(Path(folder) / "a.gpkg")) as database, database:
            view = "WITH RECURSIVE n(i) AS (VALUES (1) UNION ALL SELECT i + 1 FROM n LIMIT 3) SELECT n.i, polygons.* "
            (table,) = database.execute("SELECT table_name FROM gpkg_contents").fetchone()
            database.execute(f"CREATE VIEW v AS {view.replace('polygons', table)} FROM n, {table}")
            database.execute("UPDATE gpkg_contents SET table_name = 'v'")
            database.execute("UPDATE gpkg_geometry_columns SET table_name = 'v'")
        files.append(("gpkg", "a.gpkg", (Path(folder) / "a.gpkg").read_bytes()))
    arcs = struct.pack("<BIIBII", 1, 10, 1, 1, 8, 5) + struct.pack("<10d", 0, 0, 4, 0, 4, 4, 0, 4, 0, 0)
    files.append(("wkb", "a.wkb", struct.pack("<BII", 1, 12, 2) + arcs + bytes.fromhex(wkb)))
    texts = [("kml", "a.kml", f"{kml}</kml>"), ("gpx", "a.gpx", gpx), ("csv", "a.csv", rows), ("wkb", "a.wkb", wkb)]
    return [*files, *((kind, name, text.encode()) for kind, name, text in texts)]


def _clouds() -> list[tuple[str, str, bytes]]:
    header = (
        "ply\nformat {} 1.0\nelement vertex 5\nproperty double x\nproperty double y\nproperty uchar z\nend_header\n"
    )
    rows = np.zeros(5, [("xy", ">f8", 2), ("z", "u1")])
    rows["xy"] = DOTS
    text = "".join(f"{x} {y} 1\n" for x, y in DOTS)
    files = [("ply", header.format("ascii") + text), ("obj", f"v {text.strip()}".replace("\n", "\nv ") + "\nf 1 2 3\n")]
    files += [("xyz", text), ("xyz", "5\nfive atoms\n" + "".join(f"C {line}\n" for line in text.splitlines()))]
    clouds = []
    for name in ("las", "laz"):
        data = laspy.LasData(laspy.LasHeader(point_format=6, version="1.4"))
        data.x, data.y = np.transpose(DOTS)
        out = io.BytesIO()
        data.write(out, do_compress=name == "laz")
        clouds.append(("las", f"a.{name}", out.getvalue()))
    binary = header.format("binary_big_endian").encode() + rows.tobytes()
    return [("ply", "b.ply", binary), *((kind, f"a.{kind}", each.encode()) for kind, each in files), *clouds]


def _shapefiles() -> list[Bundle]:
    with tempfile.TemporaryDirectory() as folder:
        path = _layer(Path(folder), "a.shp")
        files = {part.name: part.read_bytes() for part in sorted(path.parent.iterdir())}
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return [Bundle("shp", "a.shp", files), Bundle("shp", "a.zip", {"a.zip": out.getvalue()})]


def _texts() -> list[tuple[str, str, bytes]]:
    rows = "".join(f"{x},{y},n{i}\n" for i, (x, y) in enumerate(DOTS))
    tables = [
        rows,
        "x,y,name\n" + rows,
        "lon;lat\n1;2\n3;4\n",
        "x\ty\n1\t2\n",
        "# made\n 1 2\n 3 4\n",
        '"x","y"\n"1","2"\n',
    ]
    tables += ["id,WKT\n1,POINT (1 2)\n", "\ufeffX,Y\r\n1e3,-.5\r\n", "label,x,y\n3,1,2\n4,5,6\n"]
    node = "4 2 1 1\n# points\n1 0 0 5 1\n2 9 0 6 0\n3 9 6 7 0\n4 0 6 8 1\n"
    poly = "4 2 0 1\n1 0 0 1\n2 9 0 1\n3 9 6 1\n4 0 6 1\n4 1\n1 1 2 1\n2 2 3 1\n3 3 4 1\n4 4 1 1\n0\n"
    lists = ["[[1,2],[3,4.5],[6,7]]", "[[[0,0],[9,0],[9,6]],[[1,1],[2,1],[2,2]]]", "[[0,0],[9,0],[9,6],[4,2]]"]
    shell = '{"shell":[[0,0],[9,0],[9,9],[0,9]],"holes":[[[1,1],[2,1],[2,2]]],"properties":{"name":"a"}}'
    lists.append(f'{{"polygons":[{shell},{{"line":[[10,1],[12,2]]}}]}}')
    rows = '{"x":1,"y":2.5,"name":"a"}\n{"x":4,"y":0,"name":null}\n{"x":9,"y":9,"name":"b"}\n'
    ring = (
        '{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[0,0],[9,0],[9,9],[0,0]]]}}\n'
    )
    lines = [rows, ring + ring, f"\x1e{ring}\x1e{ring}"]
    return (
        [("csv", "a.csv", text.encode()) for text in tables]
        + [("json", "a.jsonl", text.encode()) for text in lines]
        + [("node", "a.node", node.encode()), ("poly", "a.poly", poly.encode())]
        + [("json", "a.json", text.encode()) for text in lists]
    )


def _drawings() -> list[tuple[str, str, bytes]]:
    style = "<style>.a{fill:none;stroke:red}#b,g rect{display:none}</style>"
    shapes = (
        '<path id="a" class="a" d="M1 2L9 2q3 4 0 8zm1 1c1 2 3 4 5 6s1 2 0-3A4 3 20 1 0 2 2Z" '
        'transform="rotate(20 3 4)"/>'
        '<g transform="matrix(1 .2 -.3 1 4 5) scale(2)" fill-rule="evenodd"><rect x="1" width="5" height="4" rx="1"/>'
        '<ellipse cx="10" rx="3" ry="2mm"/><polygon points="0,0 4,0 4,3"/><line x2="5" stroke="red"/></g>'
    )
    uses = '<symbol id="s" viewBox="0 0 2 2"><circle r="1"/></symbol><use href="#s" x="3" width="9" height="9"/>'
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="90mm" height="5cm" viewBox="0 0 30 20">'
    svg = [f"{head}{style}{shapes}</svg>", f"{head}<defs><g id='g'>{shapes}</g></defs>{uses}<use href='#g'/></svg>"]
    entities = [
        "LINE 10 0.0 20 0.0 11 9.0 21 0.0",
        "ARC 10 9.0 20 5.0 40 5.0 50 270.0 51 90.0",
        "LINE 10 9.0 20 10.0 11 0.0 21 0.0",
        "CIRCLE 10 5.0 20 4.0 40 1.0 230 -1.0",
        "LWPOLYLINE 100 AcDbEntity 100 AcDbPolyline 90 3 70 1 10 20.0 20 0.0 42 0.5 10 24.0 20 0.0 10 24.0 20 5.0",
        "ELLIPSE 100 AcDbEntity 100 AcDbEllipse 10 40.0 20 0.0 11 3.0 21 1.0 40 0.5 41 0.0 42 4.0",
        "SPLINE 100 AcDbEntity 100 AcDbSpline 70 8 71 2 72 6 73 3 40 0 40 0 40 0 40 1 40 1 40 1 "
        "10 0.0 20 20.0 10 5.0 20 29.0 10 9.0 20 20.0",
        "INSERT 2 B 10 50.0 20 3.0 41 2.0 50 30.0 70 2 44 5.0",
        "TEXT 10 0.0 20 0.0 40 1.0 1 hello",
    ]
    block = "0 SECTION 2 BLOCKS 0 BLOCK 2 B 70 0 10 0.0 20 0.0 0 CIRCLE 8 0 10 0.0 20 0.0 40 1.0 0 ENDBLK 0 ENDSEC "
    drawn = " ".join(f"0 {kind} 8 cut {rest}" for kind, _, rest in (entity.partition(" ") for entity in entities))
    text = f"0 SECTION 2 HEADER 9 $ACADVER 1 AC1015 9 $INSUNITS 70 4 0 ENDSEC {block}"
    text += f"0 SECTION 2 ENTITIES {drawn} 0 ENDSEC 0 EOF "
    dxf = text.replace(" ", "\n").encode()
    binary = io.BytesIO()
    ezdxf.read(io.StringIO(dxf.decode())).write(binary, fmt="bin")
    return [
        *(("svg", "a.svg", drawing.encode()) for drawing in svg),
        ("svg", "a.svgz", gzip.compress(svg[0].encode(), mtime=0)),
        ("dxf", "a.dxf", dxf),
        ("dxf", "a.dxf", binary.getvalue()),
    ]


def _results() -> list[tuple[str, str, bytes]]:
    """What the tool itself writes and reads."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.json"
        shape = vorotool.skeleton_exact([[0, 0], [6, 0], [6, 3], [0, 5]])
        vorotool.write(shape, path)
        found.append(("skeleton", "a.json", path.read_bytes()))
        vorotool.write(shape, path.with_suffix(".npz"))
        found.append(("npz", "a.npz", path.with_suffix(".npz").read_bytes()))
        vorotool.write(vorotool.offset(shape, [0.5, 1]), path)
        found.append(("offsets", "a.json", path.read_bytes()))
        cells = vorotool.voronoi([*shape.to_shapely()[:2], "POINT (9 9)"], max_distance=3)
        vorotool.write(cells, path)
        found.append(("voronoi", "a.json", path.read_bytes()))
        vorotool.write(cells, path.with_suffix(".npz"))
        found.append(("npz", "a.npz", path.with_suffix(".npz").read_bytes()))
    return found


def _stores() -> list[Bundle]:
    import zarr
    from zarr import codecs

    options = [
        {},
        {"compressors": None, "serializer": codecs.BytesCodec(endian="big")},
        {"compressors": [codecs.GzipCodec(), codecs.Crc32cCodec()], "filters": [codecs.TransposeCodec(order=(1, 0))]},
        {"compressors": [codecs.BloscCodec(cname="lz4")]},
        {"shards": (16, 12)},
        {"zarr_format": 2, "order": "F"},
    ]
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for number, option in enumerate(options):
            path = Path(folder) / f"{number}.zarr"
            array = zarr.create_array(path, shape=GREY.shape, dtype="u2", chunks=(8, 6), **option)
            array[:9] = GREY[:9]
            found.append(_store("zarr", path))
    return found


def _store(kind: str, path: Path) -> Bundle:
    files = {f"a.zarr/{p.relative_to(path)}": p.read_bytes() for p in sorted(path.rglob("*")) if p.is_file()}
    return Bundle(kind, "a.zarr", files)


def _ome_stores() -> list[Bundle]:
    """Images and volumes of OME-Zarr, of both formats, with coarser copies, further axes and labels."""
    import zarr

    found = []
    with tempfile.TemporaryDirectory() as folder:
        for number, (version, axes) in enumerate(itertools.product((2, 3), ("yx", "zyx", "tczyx"))):
            path, shape = Path(folder) / str(number), ((1, 1, 2, *GREY.shape)[-len(axes) :])
            levels = []
            for level in range(2):
                where, sides = path / str(level), (*shape[:-2], *(side >> level for side in GREY.shape))
                chunks = (*(1 for _ in axes[:-2]), 8, 6)
                array = zarr.create_array(where, shape=sides, dtype="u1", chunks=chunks, zarr_format=version)
                rows = (*sides[:-2], sides[-2] - 4, sides[-1])
                array[..., : rows[-2], :] = np.broadcast_to(GREY[: rows[-2], : rows[-1]], rows)
                scale = [{"type": "scale", "scale": [0.5 * 2**level] * len(axes)}]
                levels.append({"path": str(level), "coordinateTransformations": scale})
            named = [{"name": axis, "type": "space", "unit": "micrometer"} for axis in axes]
            _write_ome(path, version, {"multiscales": [{"axes": named, "datasets": levels, "name": "a"}]})
            found.append(_store("ome-zarr", path))
    return found


def _write_ome(folder: Path, version: int, about: dict[str, object]) -> None:
    import json

    if version == 3:
        made = {"zarr_format": 3, "node_type": "group", "attributes": {"ome": {"version": "0.5"} | about}}
        (folder / "zarr.json").write_text(json.dumps(made))
    else:
        (folder / ".zgroup").write_text('{"zarr_format": 2}')
        (folder / ".zattrs").write_text(json.dumps(about))
