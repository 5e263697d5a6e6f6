"""Coordinate reference systems, as far as their names tell: which is meant, and whether two are one."""

from __future__ import annotations

import json
import re
from typing import Any

_FORMS = (
    re.compile(r"urn:(?:x-)?ogc:def:crs:(\w+):[^:]*:(\w+)", re.IGNORECASE),
    re.compile(r"https?://www\.opengis\.net/def/crs/(\w+)/[^/]+/(\w+)", re.IGNORECASE),
    re.compile(r"https?://www\.opengis\.net/gml/srs/(\w+)\.xml#(\w+)", re.IGNORECASE),
    re.compile(r"(\w+)::?(\w+)"),
)
"""How authority and code are written: URN, URL, the URL of GML 2, and plainly."""

_SAME = {
    "EPSG:4326": "OGC:CRS84",  # x is the longitude in all files that are read
    "EPSG:4269": "OGC:CRS83",
    "EPSG:4267": "OGC:CRS27",
    "CRS:84": "OGC:CRS84",
    "CRS:83": "OGC:CRS83",
    "CRS:27": "OGC:CRS27",
    "OGC:84": "OGC:CRS84",
    "EPSG:900913": "EPSG:3857",
    "EPSG:3785": "EPSG:3857",
    "ESRI:102100": "EPSG:3857",
    "ESRI:102113": "EPSG:3857",
}
"""Other names of one system."""

_GEOGRAPHIC_CODES = (
    *(4326, 4979, 4322, 4019),  # WGS 84, WGS 72, GRS 1980
    *(4258, 4937, 4230, 4171, 4275, 4277, 4289, 4299, 4300, 4312, 4313, 4314, 4149, 4150, 4151, 4173, 4180),  # Europe
    *(4121, 4124, 4156, 4200, 4207, 4231, 4265, 4274, 4284, 4619, 4659, 4670, 4761, 4765, 5324, 6706, 7683, 8086),
    *(4267, 4269, 4140, 4152, 4617, 4759, 6318, 4170, 4618, 4674, 4225),  # the Americas
    *(4167, 4272, 4202, 4203, 4283, 7844, 4301, 4612, 6668, 4214, 4490, 4610, 4737, 4148, 4222),  # elsewhere
)
_GEOGRAPHIC = frozenset({"OGC:CRS84", "OGC:CRS83", "OGC:CRS27", *(f"EPSG:{code}" for code in _GEOGRAPHIC_CODES)})
"""Systems of longitude and latitude in degrees that are met most: of others nobody is told of degrees."""

LONGITUDE_LATITUDE = "urn:ogc:def:crs:OGC:1.3:CRS84"
"""Longitude and latitude as columns of these names have them."""


def crs_name(crs: Any) -> str:
    """Give the plain name of a coordinate reference system, for messages.

    Parameters
    ----------
    crs : object
        The ``crs`` member of GeoJSON, or a name in any of the usual forms.

    Returns
    -------
    str
        Authority and code; of what is none of the usual forms, the text.

    Examples
    --------
    >>> crs_name({"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::3857"}})
    'EPSG:3857'
    >>> crs_name("http://www.opengis.net/def/crs/OGC/1.3/CRS84")
    'OGC:CRS84'
    """
    text = _text_of(crs)
    for form in _FORMS:
        found = form.fullmatch(text)
        if found is not None:
            return f"{found[1]}:{found[2]}".upper()
    return text


def _text_of(crs: Any) -> str:
    if isinstance(crs, str):
        return crs.strip()
    properties = crs.get("properties") if isinstance(crs, dict) else None
    if isinstance(properties, dict):
        if isinstance(properties.get("name"), str):
            return str(properties["name"]).strip()
        if isinstance(properties.get("code"), int):  # {"type": "EPSG", …}: older than the form with a name
            return f"{crs.get('type')}:{properties['code']}"
    return json.dumps(crs, default=str, sort_keys=True)


def same_crs(a: Any, b: Any) -> bool:
    """Tell whether two names mean one system; EPSG:4326 has the longitude first in files, as OGC:CRS84 has.

    Examples
    --------
    >>> same_crs("EPSG:4326", "urn:ogc:def:crs:OGC:1.3:CRS84"), same_crs("EPSG:4326", "EPSG:3857")
    (True, False)
    """
    return _one_name(a) == _one_name(b)


def _one_name(crs: Any) -> str:
    name = crs_name(crs)
    return _SAME.get(name, name)


def is_geographic(crs: Any) -> bool:
    """Tell whether a system is known to be of longitude and latitude in degrees; None is not.

    Examples
    --------
    >>> is_geographic("EPSG:4258"), is_geographic("EPSG:2056"), is_geographic(None)
    (True, False, False)
    """
    return crs is not None and _one_name(crs) in _GEOGRAPHIC


def crs_member(name: str) -> dict[str, Any] | None:
    """Give the ``crs`` member of GeoJSON for a name in any of the usual forms; None if it is in none.

    Examples
    --------
    >>> crs_member("EPSG:3857")["properties"]["name"]
    'urn:ogc:def:crs:EPSG::3857'
    >>> crs_member("Lambert") is None
    True
    """
    text = name.strip()
    if not any(form.fullmatch(text) for form in _FORMS):
        return None
    plain = crs_name(text)
    authority, _, code = plain.partition(":")
    is_longitude_latitude = authority != "EPSG" and _SAME.get(plain, plain) == "OGC:CRS84"
    urn = LONGITUDE_LATITUDE if is_longitude_latitude else f"urn:ogc:def:crs:{authority}::{code}"
    return {"type": "name", "properties": {"name": urn}}
