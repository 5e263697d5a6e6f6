"""What is refused, with the exit code and the user's own text: a case a mechanism, for whichever command has it.

Rules of the table of options are tested in `tests/jobs/test_refusals.py`, values in `options/test_values.py`.
"""

from pathlib import Path

import numpy as np
import pytest
import tifffile

from support.processes.leftovers import contents

DATA = Path(__file__).parents[2] / "data"
USAGE = {
    # ---- inputs, outputs, formats
    "tessellate": "no input given",
    "tessellate dots.csv mask.pbm -o a.png": "2 inputs",
    "tessellate dots.csv": "-o",
    "tessellate dots.csv -o a.png --out-dir .": "not both",
    "tessellate dots.csv --what labels,table": "-o STEM",
    "tessellate dots.csv --what lables": "'lables'",
    "tessellate dots.csv -o a.xyz": ".xyz",
    "tessellate dots.csv -f bmp": "bmp",
    "delaunay dots.csv -o a.kml": ".kml files can be read, but not written",
    "tessellate dots.csv --what distance -o a.png": "distance cannot be written as png",
    "tessellate dots.csv --what labels,table -f png,tiff,csv -o a": "tiff",
    "tessellate dots.csv --what labels,table -f tiff,,csv -o a": "''",
    "tessellate dots.csv -f zarr": "a Zarr store is a folder",
    "tessellate dots.csv --input-format abc -o a.png": "--input-format 'abc'",
    "tessellate dots.csv --layers cells -o a.png": "--layers applies only to pictures (-f svg)",
    "tessellate dots.csv -f text --stats -": "--stats -",
    "tessellate dots.csv -o dots.csv -f text": "dots.csv",
    "skeleton-exact - --overlay - -o a.png": "name a file for one of them",
    "info - -": "-",
    "delaunay dots.csv --overlay -o a.png": "'-o'",
    "distance dots.csv": "Missing argument 'B'",
    "distance dots.csv dots.csv dots.csv": "unexpected extra argument",
    "distance dots.csv .": "B . stands for several files",
    "completion csh": "'bash', 'zsh', 'fish'",
    "sample dot": "'dot'",
    "distance - -": "same stream",
    "skeleton-exact two-shapes.json -f shp": "Shapefile",
    "skeleton-exact two-shapes.json -f shp -o /dev/stdout": "/dev/stdout",
    "delaunay dots.csv --clip clip.wkt --what cells -o x.json --stats clip.wkt": "clip.wkt",
    "delaunay dots.csv --clip clip.wkt --what cells -f wkt -o clip.wkt": "clip.wkt",
    "tessellate dots.csv --what color --overlay mask.pbm -o x.png --stats mask.pbm": "mask.pbm",
    "delaunay mask.pbm dots.csv --clip clip.wkt --what cells --out-dir out --stats clip.wkt": "clip.wkt",
    "tessellate --files-from list.csv --table x.csv --stats list.csv": "list.csv",
    "tessellate --files-from list.csv --table list.csv": "list.csv",
    "tessellate --files-from list.csv --what table --out-dir out --stats out/tessellate.manifest.jsonl": "--stats",
    "tessellate --files-from list/dots.png --out-dir list": "--files-from",
    "--color": "--color",
    "delauney dots.csv": "'delauney'",
    "skeleton_exact dots.csv": "did you mean skeleton-exact",
    "delaunay a.csv --every 3": "delaunay has no --every: skeleton-approx, skeleton-exact have it",
    "draw a.csv --passes 1": "draw has no --passes: tessellate has it",
    "draw a.csv --widht 1": "--width",
    "draw a.csv --layers seeds": "'seeds': not one of cells",
    "draw a.csv --layers cells,seed": "'seed' is not one of cells",
    # ---- names that are like others
    "skeleton-exact a.png --what centerlines": "did you mean centerline?",
    "skeleton-exact a.png --what skeleton,Centrelines": "did you mean centerline?",
    "skeleton-exact a.png --ends mddle": "'mddle' is not one of 'middle', 'corner', 'none'; did you mean middle?",
    "delaunay dots.csv --graph x": "'delaunay', 'gabriel', 'relative', 'mst'\n",
    "delaunay dots.csv -f jsn": "did you mean json",
    "delaunay dots.csv -o a.geojsn": "did you mean .geojson",
    "delaunay dots.csv -o a.svg --color edge=red": "did you mean edges?",
    "delaunay dots.csv --input-format cvs": "did you mean csv?",
    # ---- what another kind of input has
    "tessellate mask.pbm -o a.png --columns 1,2": "but the input is an image",
    "delaunay mask.pbm --method digital --size 9x9": "--size",
    "delaunay mask.pbm --input-crs EPSG:3857": "--input-crs",
    "tessellate dots.csv -o a.png --seeds pixels": "--seeds",
    "tessellate dots.csv -o a.png --size 9x9 --min-area 3": "--min-area",
    "skeleton-exact two-shapes.json --outline crack": "--outline",
    "skeleton-exact two-shapes.json --what thickness -o a.tif": "--what",
    "skeleton-exact two-shapes.json --border open": "--border",
    "skeleton-exact two-shapes.json --join-tolerance 1": "--join-tolerance",
    "voronoi dots.csv --spacing 1,2": "--spacing",
    "voronoi mask.pbm --spacing 1,2,3": "--spacing",
    "delaunay dots.csv --pixel-size auto": "--pixel-size",
    "draw mask.pbm --label-by x -f svg": "--label-by 'x': the input has no columns",
    "draw mask.pbm --scale 2 -f svg": "--scale",
    "delaunay dots.csv --label-by x -f svg": "--label-by 'x'",
    "voronoi streets.geojson --by size": "--by 'size'",
    "tessellate mask.pbm --cell-size 2 -o a.tif": "--cell-size",
    "tessellate mask.pbm --like mask.pbm -o a.tif": "--like applies to lists of points",
    "tessellate dots.csv --page 0 -o a.png": "--page",
    "delaunay dots.csv --input-layer a": "--input-layer",
    "alphashape dots.csv -r 5um": "has a unit, but the unit of the input is unknown",
    "delaunay space.csv --what hull": "--space",
    "delaunay space.csv -f ply": "--space",
    "delaunay space.csv --space --graph mst": "--graph",
    "delaunay space.csv --space --method digital": "--method digital",
    "delaunay space.csv --space --y-down": "--y-down",
    "delaunay space.csv --space --frame 0,0,1,1": "--frame",
    "skeleton-approx two-shapes.json --step 4 --what offset": "'offset'",
    "skeleton-approx two-shapes.json --step 4 --what thickness": "'thickness'",
    "skeleton-approx two-shapes.json --step 4 -d 1": "no -d",
    # ---- what no output shows, or has a size of its own
    "tessellate dots.csv -o a.npy --precision 3": "--precision",
    "tessellate dots.csv -o a.png --pixel-size 0.5um": "--pixel-size",
    "tessellate dots.csv -o a.tif --pixel-size 2mm": "--pixel-size",
    "skeleton-exact two-shapes.json --flatten 1": "no curves",
    "delaunay dots.csv --frame 0,0,1,1": "--frame",
    "delaunay dots.csv --what table --with name": "--with",
    "delaunay dots.csv --with nothing": "'nothing'",
    "delaunay dots.csv --with name,": "'name,'",
    "delaunay dots.csv --with name -f obj": "--with",
    "tessellate dots.csv --what color --frames 3 -o a.png": "--frames",
    "delaunay dots.csv -f svg --layers cellar": "not one of cells, triangles",
    "skeleton-exact two-shapes.json -f svg --layers offset": "skeleton in SVG has polygons",
    "skeleton-exact two-shapes.json -f svg --color cells=red": "--color",
    "delaunay dots.csv --color scale-bar=red -f svg": "scale-bar",
    "skeleton-exact two-shapes.json -f svg --scale 1e9": "the page would be",
    "skeleton-exact two-shapes.json -f svg --scale 1:2": "--scale",
    "draw mask.pbm --page 0 -o a.png --aspect 2": "--aspect",
    # ---- values
    "alphashape dots.csv -r 0": "r is 0",
    "alphashape dots.csv --alpha 0": "alpha must be negative",
    "alphashape dots.csv -r 3 --alpha -3": "r and alpha each set the radius",
    "alphashape dots.csv -r inf --what hull": "the convex hull",
    "skeleton-exact two-shapes.json --what offset -d 0,2": "a distance is 0",
    "skeleton-exact two-shapes.json --what offset -d 1mm,1000um --pixel-size 1mm": "the distance 1 is repeated",
    "skeleton-exact two-shapes.json --side both --frame 0,0,1e71,1": "use numbers of at most 1e+70",
    "tessellate dots.csv -o a.png --max-distance 5um --pixel-size 2": "--pixel-size",
    "tessellate dots.csv -o a.png --max-distance 5parsec": "--max-distance '5parsec'",
    "tessellate dots.csv -o a.png --window 0.5,0,15,20": "--window '0.5,0,15,20'",
    "tessellate streets.geojson --cell-size 10 --window 0,0,15,20 -o a.tif": "the nearest W,H is 20,20",
    "tessellate mask.pbm --fill-holes 5um2 -o a.png": "--fill-holes 5um2",
    "tessellate mask.pbm --min-area 5um3 --pixel-size 1um --what table": "pixels have areas, such as 5um2",
    "skeleton-exact two-shapes.json --what centerline --from=1e308,-1e308": "1e+308",
    "skeleton-exact two-shapes.json --what points --every 1e300km --pixel-size 1e-20nm": "--every '1e300km'",
    "tessellate dots.csv --size 9x9 --spacing 1,2,3 -o a.png": "--spacing",
    "tessellate dots.csv --size 9x9 --spacing 1,2 --pixel-size 3 -o a.png": "--pixel-size",
    "tessellate dots.csv --size 9x9 --spacing 1,2 --max-distance 3um -o a.png": "--max-distance 3um",
    "draw two-shapes.json --pixel-size 2mm -f svg": "--pixel-size",
    "draw two-shapes.json --layers cells -f svg": "--layers",
    # ---- volumes
    "tessellate stack.tif --volume --size 9x9 -o a.tif": "--size 9x9",
    "tessellate stack.tif --volume --window 1,2,3,4 -o a.tif": "--window",
    "tessellate space.csv --size 9x8x7 --spacing auto -o a.tif": "--spacing",
    "tessellate space.csv --size 9x8x7 --spacing 1,2 -o a.tif": "--spacing",
    "tessellate stack.tif --volume -o a.png": "labels cannot be written as png: use --what color, or one of tiff",
    "tessellate stack.tif --volume --max-distance 1um -o a.tif": "--max-distance 1um",
    "tessellate stack.tif --volume --slice 3 --what color -o a.png": "--slice 3",
    "tessellate stack.tif --volume --levels 1 -o a.zarr": "--levels",
    "tessellate stack.tif --volume --chunk 9x9 -o a.zarr": "--chunk 9x9",
    "tessellate stack.tif --volume --layers objects --what color -o a.png": "--layers",
    # ---- many inputs
    "tessellate stack.tif --page all": "name a folder for their outputs with --out-dir",
    "tessellate - --page all --out-dir out": "- is standard input",
    "tessellate more": "more stands for several inputs",
    "tessellate dots.csv --resume -o a.png": "--resume",
    "tessellate dots.csv --table dots.csv -o a.png": "--table dots.csv",
    "tessellate dots.csv --table s.csv --stats s.csv -o a.png": "--table s.csv",
    "tessellate more - --out-dir out": "- is standard input",
    "tessellate more --out-dir out --what color --overlay -": "--overlay -",
    "tessellate more --out-dir out -j 2 --cluster tcp://127.0.0.1:1": "-j sets worker processes",
    "tessellate more --table all.csv --resume": "--resume needs --out-dir",
    "tessellate more --table all.png": "written as CSV, TSV or JSON",
    "tessellate more --table - --stats -": "--stats -",
    "tessellate more --table out/p.csv --what table --out-dir out": "--table out/p.csv",
    "tessellate more --table t.csv --what table,neighbors": "--what table,neighbors",
    "tessellate more --table t.csv --what labels": "labels",
    "tessellate more --table t.csv --fields abc": "?P<name>",
    "tessellate more --table t.csv --fields (?P<a>": "'(?P<a>'",
    "tessellate more --out-dir out --stats more/p.csv": "--stats more/p.csv",
    "tessellate more --what table --out-dir more": "more/p.csv is also the input more/p.csv",
    "tessellate more more/p.csv --out-dir out": "more/p.csv",
    "tessellate --files-from /dev/null --out-dir out": "no input given",
    "tessellate more --out-dir=": "'': not a name",
    "tessellate dots.csv --cluster local -o a.png": "--cluster",
}
OTHERS = {
    # ---- 3: inputs
    "tessellate nowhere.csv -o a.png": (3, "nowhere.csv"),
    "tessellate more/*.png --out-dir out": (3, "more/*.png"),
    "tessellate --files-from missing --out-dir out": (3, "the list missing cannot be read"),
    "delaunay dots.csv --space": (3, "x, y and z"),
    "delaunay dots.csv --what cells --clip none.geojson": (3, "none.geojson"),
    "delaunay dots.csv --what cells --clip line.wkt": (3, "line.wkt"),
    "voronoi dots.csv --clip flat.wkt": (3, "the clip has no area"),
    "voronoi dots.csv --enclosures mask.pbm": (3, "--enclosures"),
    "delaunay dots.csv --what cells --frame 1e17,0,1,1": (3, "width and height must be positive"),
    "delaunay mask.pbm --overlay dots.csv -o a.png": (3, "dots.csv"),
    "draw dots.csv -o a.png": (3, "dots.csv"),
    "skeleton-exact mask.pbm --page 3": (3, "--page 3"),
    "skeleton-exact stack.tif": (3, "stack.tif has 3 pages: choose one with --page 0 to --page 2, or --page all"),
    "tessellate stack.tif --volume --seeds labels --spacing auto -o a.tif": (3, "states no voxel size"),
    "tessellate labels.npy --min-area 3 -o a.png": (3, "--min-area"),
    "tessellate mask.pbm --what table --pixel-size auto": (3, "states no pixel size"),
    "tessellate streets.geojson --cell-size 10 --window 900,900,10,10 -o a.tif": (3, "no feature has a cell"),
    "skeleton-exact two-shapes.json --gap 20": (3, "use a gap below"),
    "skeleton-exact two-shapes.json --smooth 1e-9": (3, "fitted curves need at least"),
    "tessellate streets.geojson --cell-size 1e-99 -o a.tif": (3, "more than 2^44 cells"),
    "tessellate --files-from old.csv -0 --out-dir out": (3, "old.csv"),
    "tessellate none.tif --volume -o a.tif": (3, "none.tif"),
    "tessellate space.csv --volume --input-format tiff -o a.tif": (3, "space.csv"),
    # ---- 4: outputs
    "delaunay dots.csv -o no/such/a.csv": (4, "no/such/a.csv"),
    "tessellate dots.csv -o a.png --stats no/such/s.json": (4, "no/such/s.json"),
    "tessellate dots.csv --table old.csv -o a.png --no-clobber": (4, "old.csv"),
    "tessellate more --out-dir old.csv": (4, "old.csv"),
    "tessellate more --table no/such/all.csv": (4, "no/such/all.csv"),
    # ---- 5: limits
    "tessellate dots.csv --what color --size 6000x6000 -o a.gif": (5, "6000 x 6000"),
    "tessellate far.csv --max-pixels 1000000000000000 -o a.tif": (5, "704053 x 663839 pixels"),
    "tessellate far.csv --max-pixels 1000000000000000 --what table": (5, "704053 x 663839 pixels"),
    "delaunay far.csv --max-pixels 1000000000000000 --method digital-valid": (5, "704053 x 663839 pixels"),
    "alphashape far.csv --max-pixels 1000000000000000 --method digital-valid": (5, "704053 x 663839 pixels"),
    "delaunay dots.csv --max-sites 2": (5, "--max-sites"),
    "skeleton-exact two-shapes.json --max-sites 10": (5, "--max-sites"),
    "voronoi two-shapes.json --max-sites 3": (5, "more than the limit of 3"),
    "delaunay dots.csv -o a.png --width 100000": (5, "--width"),
    "tessellate dots.csv --size 2000x2000 -f svg": (5, ""),
    "tessellate mask.pbm --max-pixels 31 -o a.png": (5, "--max-pixels"),
    "delaunay dots.csv --method digital-valid --max-pixels 9": (5, ""),
    "skeleton-exact two-shapes.json -o a.png --max-pixels 1000": (5, "--max-pixels"),
    "draw mask.pbm --overlay mask.pbm --max-pixels 9 -o a.png": (5, "--max-pixels"),
    "skeleton-exact two-shapes.json --what points --every 1e-9": (5, ""),
    "skeleton-approx two-shapes.json --step 1e-9": (5, "1e-09"),
    "tessellate streets.geojson --cell-size 0.0001 -o a.tif": (5, "--cell-size"),
    "tessellate stack.tif --volume --max-pixels 98 -o a.tif": (5, "--max-pixels 98"),
    "tessellate dots.csv --size 4000x2500 --spacing 1,1999999 --what distance2 -o a.npy": (5, "64 bits"),
    "tessellate dots.csv --dtype uint8 --size 9x9 --max-sites 2 -o a.npy": (5, "--max-sites"),
}


@pytest.mark.parametrize(("line", "expected"), [*((line, (2, text)) for line, text in USAGE.items()), *OTHERS.items()])
def test_what_is_refused(run, folder, line, expected):
    (folder / "more").mkdir()
    (folder / "more/p.csv").write_text("x,y\n2,1\n7,5\n")
    (folder / "more/q.csv").write_text("x,y\n2,1\n7,5\n")
    (folder / "old.csv").write_text("old\nlines\n")
    (folder / "far.csv").write_text("x,y\n704052,10\n5,663838\n100,100\n")
    (folder / "clip.wkt").write_text("POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0))\n")
    (folder / "list.csv").write_text("dots.csv\n")
    (folder / "list").mkdir()
    (folder / "list/dots.png").write_text("dots.csv\n")
    (folder / "space.csv").write_text("x,y,z\n1,2,0\n8,3,4\n")
    (folder / "line.wkt").write_text("LINESTRING (0 0, 1 1)")
    (folder / "flat.wkt").write_text("POLYGON ((0 0, 1 1, 2 2, 0 0))")
    np.save(folder / "labels.npy", np.repeat(np.array([[3, 5, 0]], np.uint8), 4, axis=0))
    tifffile.imwrite(folder / "stack.tif", np.eye(9, 11, dtype=np.uint8)[None].repeat(3, 0), photometric="minisblack")
    is_sample = [(DATA / word).is_file() and not (folder / word).exists() for word in line.split()]
    before = contents(folder)
    run(
        *(DATA / word if sample else word for word, sample in zip(line.split(), is_sample, strict=True)),
        code=expected[0],
        says=expected[1],
    )
    assert contents(folder) == before
