"""Coordinate reference systems, as far as their names tell: which is meant, and whether two are one."""

from __future__ import annotations

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

_LONGITUDE_LATITUDE = frozenset({"OGC:CRS84", "OGC:CRS83", "OGC:CRS27"})

_WELL_KNOWN = re.compile(r"\s*(?P<kind>[A-Z_]+)\s*\[\s*\"(?P<name>[^\"]*)\"")
"""How the text of a system begins that is spelled out, not named (WKT of either version)."""

_SRID = re.compile(r"\ASRID\s*=\s*(\d{1,9})\s*;\s*", re.IGNORECASE)

_GEOGRAPHIC_KINDS = ("GEOGCS", "GEOGCRS", "GEOGRAPHICCRS", "GEODCRS", "GEODETICCRS")

LONGITUDE_LATITUDE = "urn:ogc:def:crs:OGC:1.3:CRS84"
"""Longitude and latitude as columns of these names have them."""


def crs_name(crs: Any) -> str:
    """Give the plain name of a coordinate reference system, for messages."""
    text = _text_of(crs)
    spelled = _WELL_KNOWN.match(text)
    if spelled is not None:
        return spelled["name"]
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
    import json

    return json.dumps(crs, default=str, sort_keys=True)


def same_crs(a: Any, b: Any) -> bool:
    """Tell whether two names mean one system; EPSG:4326 has the longitude first in files, as OGC:CRS84 has."""
    if _WELL_KNOWN.match(_text_of(a)) or _WELL_KNOWN.match(_text_of(b)):
        return _text_of(a) == _text_of(b)  # one name may be that of several
    return _one_name(a) == _one_name(b)


def _one_name(crs: Any) -> str:
    name = crs_name(crs)
    return _SAME.get(name, name)


def is_geographic(crs: Any) -> bool:
    """Tell whether a system is known to be of longitude and latitude in degrees; None is not."""
    if crs is None:
        return False
    spelled = _WELL_KNOWN.match(_text_of(crs))
    if spelled is not None:
        return spelled["kind"] in _GEOGRAPHIC_KINDS
    authority, _, code = _one_name(crs).partition(":")
    from vorotool.numeric.geographic_codes import GEOGRAPHIC_CODES

    is_listed = authority == "EPSG" and code.isdecimal() and int(code) in GEOGRAPHIC_CODES
    return is_listed or f"{authority}:{code}" in _LONGITUDE_LATITUDE


def crs_member(name: str) -> dict[str, Any] | None:
    """Give the ``crs`` member of GeoJSON for a name in any of the usual forms; None if it is in none."""
    text = name.strip()
    if not any(form.fullmatch(text) for form in _FORMS):
        return None
    plain = crs_name(text)
    authority, _, code = plain.partition(":")
    is_longitude_latitude = authority != "EPSG" and _SAME.get(plain, plain) == "OGC:CRS84"
    urn = LONGITUDE_LATITUDE if is_longitude_latitude else f"urn:ogc:def:crs:{authority}::{code}"
    return {"type": "name", "properties": {"name": urn}}


def member_of_text(text: str | None) -> dict[str, Any] | None:
    """Give the ``crs`` member of GeoJSON for what a library says of a file: a name, or a system that is spelled out."""
    if not text:
        return None
    return crs_member(text) or {"type": "name", "properties": {"name": text}}


def crs_text(crs: Any) -> str | None:
    """Give what libraries of maps take for a ``crs`` member: authority and code, or the system spelled out."""
    if crs is None:
        return None
    text = _text_of(crs)
    if _WELL_KNOWN.match(text):
        return text
    return {"OGC:CRS84": "EPSG:4326", "OGC:CRS83": "EPSG:4269", "OGC:CRS27": "EPSG:4267"}.get(
        _one_name(crs), crs_name(crs)
    )


def without_number(text: str) -> tuple[str, int]:
    """Take the number (SRID) of its reference system off extended well-known text; 0 where it has none."""
    srid = _SRID.match(text)
    return (text, 0) if srid is None else (text[srid.end() :], int(srid[1]))
