"""Coordinate reference systems by name: whether two are the same, and whether one is geographic."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from vorotool.errors import Kind, Message, option

if TYPE_CHECKING:
    from vorotool.numeric.arrays import Floats

_FORMS = (
    r"(?i)urn:(?:x-)?ogc:def:crs:(\w+):[^:]*:(\w+)",
    r"(?i)https?://www\.opengis\.net/def/crs/(\w+)/[^/]+/(\w+)",
    r"(?i)https?://www\.opengis\.net/gml/srs/(\w+)\.xml#(\w+)",
    r"(\w+)::?(\w+)",
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

_WELL_KNOWN = r"\s*(?P<kind>[A-Z_]+)\s*\[\s*\"(?P<name>[^\"]*)\""
"""How the text of a system begins that is spelled out, not named (WKT of either version)."""

_SRID = r"(?i)\ASRID\s*=\s*(\d{1,9})\s*;\s*"

_GEOGRAPHIC_KINDS = ("GEOGCS", "GEOGCRS", "GEOGRAPHICCRS", "GEODCRS", "GEODETICCRS")

LONGITUDE_LATITUDE = "urn:ogc:def:crs:OGC:1.3:CRS84"
"""Longitude and latitude as columns of these names have them."""


def crs_name(crs: Any) -> str:
    """Give the plain name of a coordinate reference system, for messages."""
    text = _text_of(crs)
    spelled = re.match(_WELL_KNOWN, text)
    if spelled is not None:
        return spelled["name"]
    for form in _FORMS:
        found = re.fullmatch(form, text)
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
    if re.match(_WELL_KNOWN, _text_of(a)) or re.match(_WELL_KNOWN, _text_of(b)):
        return _text_of(a) == _text_of(b)  # one name may be that of several
    return _one_name(a) == _one_name(b)


def _one_name(crs: Any) -> str:
    name = crs_name(crs)
    return _SAME.get(name, name)


def is_geographic(crs: Any) -> bool:
    """Tell whether a system is known to be of longitude and latitude in degrees; None is not."""
    if crs is None:
        return False
    spelled = re.match(_WELL_KNOWN, _text_of(crs))
    if spelled is not None:
        return spelled["kind"] in _GEOGRAPHIC_KINDS
    authority, _, code = _one_name(crs).partition(":")

    is_listed = authority == "EPSG" and code.isdecimal() and int(code) in GEOGRAPHIC_CODES
    return is_listed or f"{authority}:{code}" in _LONGITUDE_LATITUDE


def crs_member(name: str) -> dict[str, Any] | None:
    """Give the ``crs`` member of GeoJSON for a name in any of the usual forms; None if it is in none."""
    text = name.strip()
    if not any(re.fullmatch(form, text) for form in _FORMS):
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
    if re.match(_WELL_KNOWN, text):
        return text
    return {"OGC:CRS84": "EPSG:4326", "OGC:CRS83": "EPSG:4269", "OGC:CRS27": "EPSG:4267"}.get(
        _one_name(crs), crs_name(crs)
    )


def without_number(text: str) -> tuple[str, int]:
    """Take the number (SRID) of its reference system off extended well-known text; 0 where it has none."""
    srid = re.match(_SRID, text)
    return (text, 0) if srid is None else (text[srid.end() :], int(srid[1]))


_RUNS = """
3819-3821 3823-3824 3888-3889 3906 4001-4025 4027-4036 4040-4047 4052-4055 4074-4075 4080-4081 4120-4216 4218-4327
4329 4339 4341 4343 4345 4347 4349 4351 4353 4355 4357 4359 4361 4363 4365 4367 4369 4371 4373 4375 4377 4379 4381
4383 4386 4388 4463 4466 4469-4470 4472 4475 4480 4482-4483 4490 4555 4557-4558 4600-4646 4657-4765 4801-4811
4813-4821 4823-4824 4883 4885 4887 4889 4891 4893 4895 4898 4900-4904 4907 4909 4921 4923 4925 4927 4929 4931 4933
4935 4937 4939 4941 4943 4945 4947 4949 4951 4953 4955 4957 4959 4961 4963 4965 4967 4969 4971 4973 4975 4977 4979
4981 4983 4985 4987 4989 4991 4993 4995 4997 4999 5012-5013 5132 5228-5233 5245-5246 5251-5252 5263-5264 5323-5324
5340 5342 5353-5354 5359-5360 5364-5365 5370-5373 5380-5381 5392-5393 5451 5464 5467 5488-5489 5524-5527 5545-5546
5560-5561 5592-5593 5681 5830 5885-5886 6134-6135 6207 6310-6311 6318-6319 6321-6322 6324-6325 6364-6365 6667-6668
6705-6706 6782-6783 6881-6883 6892 6894 6979-6980 6982-6983 6986-6987 6989-6990 7034-7042 7072-7073 7084-7088 7133
7135-7136 7138-7139 7372-7373 7657 7659 7661 7663 7665 7678 7680 7682-7683 7685-7686 7797-7798 7816 7843-7844
7880-7881 7885-7886 7900-7912 7915 7917 7919 7921 7923 7925 7927 7929 7931 8042-8043 8085-8086 8231-8232 8235-8237
8239-8240 8244-8246 8248-8249 8251-8252 8254-8255 8351 8399 8403 8426-8428 8430-8431 8449 8542 8544-8545 8684-8685
8694 8698-8699 8817-8818 8860 8888 8899-8902 8906-8907 8916 8918 8920 8922 8924 8926 8928 8930 8932 8934 8936 8938
8940 8942 8944 8946 8948-8949 8972-9000 9002-9003 9005-9006 9008-9009 9011-9014 9016-9019 9053-9069 9071-9072
9074-9075 9139-9140 9147-9148 9152-9153 9183-9184 9248 9251 9253 9267 9293-9294 9299 9308-9309 9332-9333 9364 9372
9379-9384 9403 9453 9469-9470 9474-9475 9546-9547 9695-9696 9701-9702 9739 9754-9758 9763 9776-9779 9781-9784 9866
9871 9893 9939 9964 9969 9974 9989-9990 10158 10175 10177-10178 10185 10191 10196 10204 10209 10214 10219 10224 10229
10237 10249 10252 10256 10260 10265 10268 10272 10277 10283-10284 10298-10300 10304-10305 10307 10309-10312
10327-10328 10345-10346 10413-10414 10468 10474-10475 10570-10571 10605-10606 10623 10628 10670-10673 20033
20040-20041 20045-20046
"""
"""Codes, and runs of codes between which no other system has one."""


_ENDS = [[int(end) for end in run.split("-")] for run in _RUNS.split()]
GEOGRAPHIC_CODES = frozenset(code for run in _ENDS for code in range(run[0], run[-1] + 1))
"""Geographic systems, of two or three dimensions, deprecated ones too."""


TO_CRS = option("--crs", "to_crs")


def note_degrees(value: Any, name: str, note: Callable[[str], None]) -> None:
    """Tell where an input is of longitude and latitude that lengths are in degrees, and what to do."""
    if is_geographic(value.crs):
        text = f"{name}: longitude and latitude are treated as planar, lengths are in degrees"
        note(Message(f"{text}; {projected_advice(value.xy)}", Kind.DEGREES, source=name))


def projected_advice(xy: Floats) -> str:
    """Name the zone of UTM that an input lies in, if it does not spread over more than two."""
    if len(xy):
        (west, south), (east, north) = xy.min(axis=0).tolist(), xy.max(axis=0).tolist()
        if west >= -180 and east <= 180 and south >= -80 and north <= 84 and east - west <= 12:
            zone = min(60, int(((west + east) / 2 + 180) // 6) + 1)
            code = f"EPSG:{(32600 if south + north >= 0 else 32700) + zone}"
            return option(f"--crs {code}", f'to_crs="{code}"') + " works in meters (UTM)"
    return f"{TO_CRS} reprojects them to a projected system"
