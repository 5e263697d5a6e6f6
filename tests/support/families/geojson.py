"""Features of GeoJSON as text."""

import json

from shapely.geometry import mapping


def collection(geometries, properties=None, *, crs=None, **members):
    """Give the text of features of shapes or of objects, with the properties of each, in a system by its name."""
    named = {} if crs is None else {"crs": {"type": "name", "properties": {"name": crs}}}
    rows = [{} for _ in geometries] if properties is None else properties
    features = [
        {"type": "Feature", "properties": row, "geometry": each if isinstance(each, dict) else mapping(each)}
        for each, row in zip(geometries, rows, strict=True)
    ]
    return json.dumps({"type": "FeatureCollection", **named, **members, "features": features})
