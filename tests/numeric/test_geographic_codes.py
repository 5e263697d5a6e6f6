"""Which systems are of longitude and latitude: compared with the registry that pyproj has."""

from pyproj.database import query_crs_info
from pyproj.enums import PJType

from vorotool.numeric.crs import is_geographic

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
