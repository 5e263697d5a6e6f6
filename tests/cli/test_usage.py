"""Options that do not go together, mistyped commands, and what is said of options."""

import numpy as np
import pytest

PROPAGATION = ("tessellate", "dots.csv", "-o", "a.tif", "--method", "propagation")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["tessellate"], ["no input given"]),
        (["tessellate", "dots.csv", "mask.pbm", "-o", "a.png"], ["2 inputs"]),
        (["tessellate", "dots.csv"], ["-o", "-f"]),
        (["tessellate", "dots.csv", "--what", "lables"], ["'lables'", "labels"]),
        (["tessellate", "dots.csv", "-o", "a.xyz"], [".xyz", "png"]),
        (["tessellate", "dots.csv", "-f", "bmp"], ["bmp"]),
        (["tessellate", "dots.csv", "--what", "distance", "-o", "a.png"], ["distance cannot be written as png"]),
        (["tessellate", "dots.csv", "--what", "labels,table"], ["-o STEM"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--out-dir", "."], ["not both"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--size", "0x5"], ["'0x5'", "640x480"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--window", "1,2,3"], ["'1,2,3'"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--window", "1,2,3,0"], ["at least 1"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--size", "5x5", "--window", "0,0,5,5"], ["--size", "--window"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--max-distance", "-1"], ["max_distance is -1"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--passes", "1"], ["--method propagation"]),
        (
            ["tessellate", "dots.csv", "-o", "a.png", "--method", "propagation", "--max-distance", "3"],
            ["--max-distance", "--method propagation"],
        ),
        (
            ["tessellate", "dots.csv", "--method", "propagation", "--what", "distance", "-o", "a.tif"],
            ["--what distance", "--method propagation"],
        ),
        (["tessellate", "dots.csv", "-o", "a.png", "--seeds", "pixels"], ["--seeds"]),
        (["tessellate", "mask.pbm", "-o", "a.png", "--threshold", "nan"], ["'nan'"]),
        (["tessellate", "mask.pbm", "-o", "a.png", "--columns", "1,2"], ["--columns"]),
        (["tessellate", "mask.pbm", "-o", "a.png", "--size", "4x4"], ["--size"]),
        (["tessellate", "dots.csv", "-f", "text", "--stats", "-"], ["--stats -"]),
        (["tessellate", "dots.csv", "-o", "dots.csv", "-f", "text"], ["dots.csv", "input"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--layers", "roads"], ["'roads'"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--layers", "cells"], ["--layers"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--threads", "-1"], ["-1"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--size", "9" * 5000 + "x1"], ["expected width and height"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--max-distance", "1e999999999"], ["expected a decimal"]),
        (["tessellate", "mask.pbm", "-o", "a.png", "--connectivity", "4", "--seeds", "pixels"], ["to components"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--dtype", "uint32"], ["--dtype"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--chunk", "64x64"], ["--chunk"]),
        (["tessellate", "dots.csv", "-f", "zarr"], ["a Zarr store is a folder"]),
        (["tessellate", "dots.csv", "-o", "a.png", "--what", "color", "--width", "99"], ["--width"]),
        (["tessellate", "dots.csv", "-o", "a.npy", "--precision", "3"], ["--precision"]),
        (
            ["tessellate", "missing.csv", "-o", "a.svg", "--layers", "diagram"],
            ["--layers"],
        ),
        (
            ["tessellate", "dots.csv", "-o", "a.png", "--input-format", "xyz"],
            ["--input-format 'xyz'"],
        ),
        (
            ["draw", "mask.pbm", "-o", "a.png", "--input-format", "xyz"],
            ["--input-format 'xyz'"],
        ),
        (["paint"], ["paint"]),
        (["--color"], ["--color"]),
    ],
)
def test_usage(run, folder, arguments, words):
    done = run(*arguments)
    assert done.code == 2, done.err
    assert all(word in done.err for word in words), done.err
    assert (folder / "dots.csv").read_text().startswith("x,y,name")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("delauney", "'delauney'"),
        ("skeleton_exact", "did you mean skeleton-exact"),
        ("Tesselate", "did you mean tessellate?"),
        ("polyhedra", "use one of tessellate, delaunay,"),
    ],
)
def test_a_mistyped_command(run, name, words):
    done = run(name, "dots.csv")
    assert (done.code, done.out) == (2, "")
    assert words in done.err


def test_quiet_wins(run, folder):
    assert run("tessellate", "mask.pbm", "-o", "a.png", "-q", "-v").err == ""
    assert run("tessellate", "mask.pbm", "-o", "a.png", "-v").err != ""


@pytest.mark.parametrize("name", ["tif", "TIFF", "pgm", "ppm"])
def test_names_of_formats(run, folder, name):
    from PIL import Image

    kind = "TIFF" if name[0] in "tT" else "PPM"
    Image.fromarray(np.eye(4, dtype=np.uint8)).save(folder / "image", format=kind)
    assert run("tessellate", "image", "--input-format", name, "-o", "a.png").code == 0
    assert run("draw", "image", "--input-format", name, "-o", "a.svg").code == 0
