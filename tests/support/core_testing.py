"""The submodules of vorotool._core_testing, which a build for tests has and a wheel has not."""

try:
    from vorotool._core_testing import alpha, segment_voronoi
except ImportError as error:
    raise ImportError(
        "vorotool._core_testing is not there: this test calls parts of the compiled core that no wheel has. "
        "`make build` builds them (CMake option VOROTOOL_TESTING)"
    ) from error

__all__ = ["alpha", "segment_voronoi"]
