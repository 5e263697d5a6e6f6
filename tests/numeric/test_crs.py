"""Names of coordinate reference systems: one system, however its name is written."""

import pytest
from pyproj.database import query_crs_info
from pyproj.enums import PJType

from support.few import few
from vorotool.numeric.crs import crs_member, crs_name, is_geographic, same_crs

FORMS = [
    "{}:{}",
    "urn:ogc:def:crs:{}::{}",
    "urn:ogc:def:crs:{}:8.5:{}",
    "urn:x-ogc:def:crs:{}:1.3:{}",
    "http://www.opengis.net/def/crs/{}/0/{}",
    "https://www.opengis.net/def/crs/{}/1.3/{}",
    "{}::{}",
]


def named(name):
    return {"type": "name", "properties": {"name": name}}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize(("authority", "code"), few([("epsg", "2056"), ("OGC", "CRS84"), ("EPSG", "3857")], 2))
def test_one_system_in_all_forms(form, authority, code):
    text = form.format(authority, code)
    plain = f"{authority}:{code}".upper()
    for crs in (text, named(text), crs_member(text)):
        assert crs_name(crs) == plain
        assert same_crs(crs, plain)
    assert not same_crs(text, "EPSG:3035")


def test_other_names_of_one_system():
    assert same_crs("EPSG:4326", named("urn:ogc:def:crs:OGC:1.3:CRS84"))
    assert same_crs({"type": "EPSG", "properties": {"code": 4326}}, "CRS:84")
    assert same_crs("http://www.opengis.net/gml/srs/epsg.xml#900913", "EPSG:3857")
    assert not same_crs("EPSG:4326", "EPSG:4258")
    assert crs_member("OGC:CRS84") == crs_member("CRS:84") == named("urn:ogc:def:crs:OGC:1.3:CRS84")
    assert crs_member("EPSG:4326") == named("urn:ogc:def:crs:EPSG::4326")


def test_what_is_in_no_form_is_itself_alone():
    link = {"type": "link", "properties": {"href": "crs.wkt"}}
    assert same_crs(link, {"properties": {"href": "crs.wkt"}, "type": "link"})
    assert not same_crs(link, named("Lambert"))
    assert crs_name(named("Lambert 93")) == "Lambert 93"
    assert crs_member("Lambert 93") is None
    assert not any(map(is_geographic, (None, link, "Lambert", 7, [], {"properties": None})))


@pytest.mark.parametrize("code", [4326, 4258, 4269, 4979, 4490])
def test_longitude_and_latitude(code):
    assert is_geographic(crs_member(f"EPSG:{code}"))
    assert not is_geographic(f"EPSG:{code}0")


GEOGRAPHIC = {PJType.GEOGRAPHIC_2D_CRS, PJType.GEOGRAPHIC_3D_CRS}


def test_all_codes_are_known_for_what_they_are():
    known = query_crs_info(auth_name="EPSG", allow_deprecated=True)
    assert len(known) > 5000
    # codes that came after the table was made are in a newer registry only
    newest = max(int(each.code) for each in known if is_geographic(f"EPSG:{each.code}"))
    wrong = [
        each.code
        for each in known
        if is_geographic(f"EPSG:{each.code}") != (each.type in GEOGRAPHIC) and int(each.code) <= newest
    ]
    assert len(wrong) <= 5, wrong
