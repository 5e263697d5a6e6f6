"""Options of inputs, and of the frame that they are computed in."""

from __future__ import annotations

from vorotool.products.options.row import ALL, BATCHES, COMPUTING, SHAPES, SITES, SKELETONS, Option

_OTHERS = "delaunay alphashape"
# Rows stay rows: one argument a line would hide the table.
# fmt: off
INPUT = (
    Option("--columns X,Y[,LABEL]", f"{SITES} voronoi distance info", "Columns of a point list, by name or number "
        "(from 1)."),
    Option("--input-format FORMAT", f"{ALL} info", "Format of the input, where it is unclear.", complete="inputs"),
    Option("--input-layer NAME", ALL, "Layer of an input that has several; FILE:LAYER, such as map.gpkg:roads, works "
        "for every file."),
    Option("--input-crs CRS", f"{COMPUTING} info", "Coordinate reference system of an input that states none, such as "
        "EPSG:3857; nothing is reprojected.", "names.crs"),
    Option("--crs CRS", COMPUTING, "Coordinate reference system to work and write in: inputs in another one are "
        "reprojected.", "names.crs"),
    Option("--y-up/--y-down", ALL, "Direction of y in the input; default: up on maps and in DXF, down in images and "
        "SVG."),
    Option("--page N|all", f"{ALL} info", "Page of an image stack, from 0; all makes each page an input of a batch.",
        "numbers.page"),
    Option("--volume", "tessellate", "Read all pages of a stack, or an array with three axes, as one volume (z, y, x), "
        "and points with their z."),
    Option("--space", "delaunay alphashape", "Take points in space, by their x, y and z; --columns X,Y,z=Z names the "
        "columns."),
    Option("--pixel-size SIZE|auto", BATCHES, "Side of a pixel, or unit of the coordinates, such as 0.325um: scales "
        "what is written in tables and vectors, and lengths with a unit, such as --max-distance 5um, where the input "
        "states none; auto takes the unit that the input states.", "lengths.pixel_size"),
    Option("--pixel-size SIZE|auto", "draw", "Side of a pixel, or unit of the coordinates, such as 0.325um, for "
        "--scale-bar and --scale 1:N; auto takes what the input states.", "lengths.pixel_size"),
    Option("--spacing SX,SY[,SZ]|auto", f"tessellate delaunay {SHAPES}", "Sides of a pixel, or of a voxel, such as "
        "0.325,0.5um: distances, lengths and results are in their unit; auto takes what the image states.",
        "lengths.spacing"),
    Option("--seeds", SITES, "What the seeds of an image are; default: components of a mask (0, and 1 or 255 or all "
        "bits), else labels.", "choice:pixels components labels centroids"),
    Option("--seeds", SHAPES, "What the objects of an image are; default: components of a mask (0, and 1 or 255 or all "
        "bits), else labels.", "choice:components labels"),
    Option("--connectivity", "tessellate", "Connectivity of the components of an image, default 8, or of a volume, "
        "default 26.", "choice:8 4 26 6"),
    Option("--connectivity", f"{_OTHERS} {SHAPES}", "Connectivity of the components of an image; default 8.",
        "choice:8 4"),
    Option("--threshold T|otsu", BATCHES, "Pixels brighter than this are foreground.", "numbers.threshold"),
    Option("--invert", BATCHES, "Swap foreground and background."),
    Option("--min-area AREA", BATCHES, "Drop objects of a mask smaller than AREA: pixels or 5um2, in volumes voxels or "
        "5um3.", "lengths.area"),
    Option("--fill-holes [AREA]", BATCHES, "Fill the holes of the objects of a mask first: all, or those of at most "
        "AREA.", "lengths.holes", False),
    Option("--outline", SHAPES, "Outline of the objects of an image: around pixels (default), or half-way between the "
        "centers of pixels.", "choice:crack contour"),
    Option("--border", "skeleton-exact", "Whether objects end at the border of an image (closed, default) or continue "
        "beyond it (open), so that the skeleton runs to the border and does not fork.", "choice:closed open"),
    Option("--simplify TOLERANCE", SHAPES, "Remove vertices of outlines first, which then move by at most this; "
        "outlines that touch still touch.", "lengths.length"),
    Option("--join-tolerance D", SHAPES, "Largest gap between ends of lines of a DXF input that are joined; default "
        "0.005 mm, or 1/100000 of the extent if the unit is unknown.", "lengths.length_or_zero",
        acts_on="?may_be_drawn"),
)
# fmt: on

_BOUNDS = (
    ", in the units of the input or with a unit, such as 0,0,20,10mm; default: the image, or the bounds and a tenth "
    "around them."
)
_PAGE = "Rectangle that pictures show, and the page of SVG to scale; default: everything, or the page of an SVG input."
_CELLS = "cells table statistics measures layer:cells layer:diagram"
# Rows stay rows: one argument a line would hide the table.
# fmt: off
FRAME = (
    Option("--size WxH", _OTHERS, "Frame of W x H pixels from pixel (0, 0).", "numbers.size"),
    Option("--size WxH[xD]", "tessellate", "Frame of W x H pixels from pixel (0, 0), or of W x H x D voxels.",
        "numbers.size_or_volume"),
    Option("--window X,Y,W,H", _OTHERS, "Frame whose first pixel is (X, Y).", "numbers.window"),
    Option("--window X,Y[,Z],W,H[,D]", "tessellate", "Frame whose first pixel is (X, Y), or voxel (X, Y, Z).",
        "numbers.window_or_volume"),
    Option("--cell-size SIDE", "tessellate", "Side of a pixel in the units of points, lines or polygons on a map, or "
        "with a unit; --window, --max-distance and distances are in the units of the map, too.",
        "lengths.exact_length"),
    Option("--like RASTER", "tessellate", "Use the frame and the pixels of this image, whose header alone is read: "
        "results overlay it pixel by pixel, also on a map.", "names.image", complete="inputs:image"),
    Option("--frame X,Y[,Z],W,H[,D]", "delaunay", f"Rectangle that cells are clipped to{_BOUNDS} With Z and D the box, "
        "in space; default there: the bounds of the points.", "lengths.rectangle_or_box",
        acts_on=f"{_CELLS} .page"),
    Option("--frame X,Y,W,H", "voronoi", f"Rectangle that cells are clipped to{_BOUNDS}", "lengths.rectangle"),
    Option("--frame X,Y,W,H", SKELETONS, f"Rectangle that skeletons outside polygons are clipped to{_BOUNDS}",
        "lengths.rectangle", acts_on="diagram side=exterior side=both .page"),
    Option("--frame X,Y,W,H", "alphashape distance", _PAGE, "lengths.rectangle", acts_on=".page"),
    Option("--frame X,Y,W,H", "draw", _PAGE, "lengths.rectangle"),
    Option("--clip POLYGONS", "delaunay", "File of polygons that cells are clipped to as well.",
        complete="inputs:polygons", acts_on=_CELLS),
    Option("--clip POLYGONS", "voronoi", "File of polygons that cells are clipped to as well; the frame is then around "
        "these.", complete="inputs:polygons"),
    Option("--enclosures LINES", "voronoi", "File of lines or polygons that divide the plane: each face is divided "
        "among the sites that meet it.", complete="inputs:polygons"),
)
# fmt: on
