"""Images that say how large their pixels are, or where they lie on a map."""

import numpy as np
import rasterio
import tifffile

MASK = np.zeros((40, 60), np.uint8)
MASK[5:20, 5:25] = MASK[25:36, 20:55] = 255


def write_sized(path, kind="ome", sides=(0.5, 0.5), unit="µm", values=MASK):
    """An image of a microscope, of ImageJ, or, where the kind is a unit of resolutions, of any other program."""
    if kind == "ome":
        axes = "XYZ"[: len(sides)]
        units = (unit,) * len(axes) if isinstance(unit, str) else unit
        sizes = {f"PhysicalSize{axis}": side for axis, side in zip(axes, sides, strict=True)}
        sizes |= {f"PhysicalSize{axis}Unit": each for axis, each in zip(axes, units, strict=True)}
        tifffile.imwrite(path, values, ome=True, metadata={"axes": "ZYX"[-values.ndim :], **sizes})
    else:
        more = (
            {"imagej": True, "metadata": {"unit": unit.replace("µ", "u")}}
            if kind == "imagej"
            else {"resolutionunit": kind}
        )
        tifffile.imwrite(path, values, resolution=(1 / sides[0], 1 / sides[1]), **more)


def write_map(path, values=MASK, transform=None, crs="EPSG:2056", **options):
    """A GeoTIFF; without a transform, with pixels of 25 m in Switzerland."""
    bands = values.reshape(-1, *values.shape[-2:])
    kind = {
        "driver": "GTiff",
        "dtype": values.dtype,
        **dict(zip(("count", "height", "width"), bands.shape, strict=True)),
    }
    transform = transform or rasterio.Affine(25, 0, 2600000, 0, -25, 1200000)
    with rasterio.open(path, "w", **kind | options, crs=crs, transform=transform) as file:
        file.write(bands)
    return path


def about(path):
    """What an image says of its place."""
    with rasterio.open(path) as file:
        return file.transform, file.crs, file.shape, file.nodata, file.tags().get("AREA_OR_POINT")


def pixels(path):
    with rasterio.open(path) as file:
        return file.read()
