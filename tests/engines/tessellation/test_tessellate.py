"""The exact engine against brute force, and the relations that any tessellation must satisfy."""

import warnings

import numpy as np
import pytest

import vorotool
from support.families.families import FAMILIES
from support.oracles.oracles import nearest_labels
from vorotool import _core
from vorotool.engines.tessellation.frames import SIMD_LEVELS, as_seeds, default_frame
from vorotool.engines.tessellation.tessellate import verify_rows
from vorotool.engines.tessellation.tessellator import Tessellator
from vorotool.errors import InputError, LimitError, UsageError, VorotoolWarning
from vorotool.types.pixels import Frame
from vorotool.types.points.seed_set import SeedSet

LEVELS = SIMD_LEVELS[: SIMD_LEVELS.index(_core.tessellation.widest_simd()) + 1]


@pytest.fixture(params=LEVELS)
def simd(request, monkeypatch):
    monkeypatch.setenv("VOROTOOL_SIMD", request.param)
    return request.param


def sweep_of(x, y, labels, frame, scale=1, **options):
    with warnings.catch_warnings(action="ignore", category=VorotoolWarning):  # duplicates are part of the families
        return Tessellator(SeedSet(x, y, labels, scale=scale), Frame(*frame), **options)


# ---- against brute force ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", FAMILIES)
def test_every_family_is_exact_with_128_bits(simd, name, monkeypatch):
    rng = np.random.default_rng(5)
    frame = (0, 0, 40, 30)
    x, y = FAMILIES[name](rng, 40, 30, 60, 256)
    far = 2**30  # one seed beyond the bound of doubles turns the whole sweep to 128-bit integers
    x, y = np.append(x, far), np.append(y, far)
    labels = rng.permutation(len(x)).astype(np.uint32) + 1
    sweep = sweep_of(x, y, labels, frame, 256)
    assert sweep.arithmetic == "filtered float64 with int128"
    np.testing.assert_array_equal(sweep.labels(), nearest_labels(x, y, labels, frame, 256))


@pytest.mark.parametrize(
    ("reach", "arithmetic"),
    [(2**16 - 64, "float64"), (2**24, "float64 with int128"), (2**31, "filtered float64 with int128")],
)
def test_near_ties_of_far_seeds(simd, reach, arithmetic):
    """Seeds at nearly equal distances of 2^16 … 2^31 from all pixels: only exact arithmetic tells them apart."""
    rng = np.random.default_rng(reach)
    frame = (-16, -16, 32, 32)
    for _ in range(12):
        angle = np.sort(rng.random(40)) * 2 * np.pi
        x = np.rint(np.cos(angle) * reach).astype(np.int64)
        y = np.rint(np.sin(angle) * reach).astype(np.int64)
        labels = rng.permutation(40).astype(np.uint32) + 1
        sweep = sweep_of(x, y, labels, frame)
        assert sweep.arithmetic == arithmetic
        np.testing.assert_array_equal(sweep.labels(), nearest_labels(x, y, labels, frame))


@pytest.mark.parametrize("frame", [(0, 0, 140_001, 2), (0, 0, 2, 140_001), (-70_000, 5, 140_000, 1)])
def test_frames_longer_than_two_to_the_seventeen(simd, frame):
    rng = np.random.default_rng(1)
    x = rng.integers(frame[0], frame[0] + frame[2], 9)
    y = rng.integers(frame[1], frame[1] + frame[3], 9)
    labels = np.arange(1, 10, dtype=np.uint32)
    sweep = sweep_of(x, y, labels, frame)
    np.testing.assert_array_equal(sweep.labels(), nearest_labels(x, y, labels, frame))


# ---- bands, windows, threads, types ----------------------------------------------------------------------------


@pytest.mark.parametrize("family", ["uniform", "lattice", "clustered", "dense", "outside"])
def test_bands_windows_and_threads_agree_with_the_whole(simd, family):
    rng = np.random.default_rng(3)
    x, y = FAMILIES[family](rng, 211, 307, 900, 1)
    labels = rng.permutation(len(x)).astype(np.uint32) + 1
    whole = sweep_of(x, y, labels, (0, 0, 211, 307), threads=1).labels()
    for threads in range(2, 6):
        assert sweep_of(x, y, labels, (0, 0, 211, 307), threads=threads).labels().tobytes() == whole.tobytes()
    sweep = sweep_of(x, y, labels, (0, 0, 211, 307))
    for first, rows in [(0, 1), (1, 17), (150, 157), (306, 1)]:
        assert sweep.labels(first, rows).tobytes() == whole[first : first + rows].tobytes()
    for fx, fy, w, h in [(5, 9, 1, 1), (100, 0, 111, 13), (33, 44, 55, 66)]:
        part = sweep_of(x, y, labels, (fx, fy, w, h)).labels()
        assert part.tobytes() == whole[fy : fy + h, fx : fx + w].tobytes()


def test_large_image_takes_many_bands_and_streams_past_the_cache(simd):
    rng = np.random.default_rng(8)
    x, y = rng.integers(0, 2500, (2, 3000))
    labels = rng.permutation(3000).astype(np.uint32) + 1
    sweep = sweep_of(x, y, labels, (0, 0, 2499, 2501))  # rows are not multiples of a vector
    out = np.full((2501, 2499), 7, dtype=np.int32)
    assert sweep.labels(out=out) is out
    np.testing.assert_array_equal(out[1200:1210], nearest_labels(x, y, labels, (0, 1200, 2499, 10)))
    verify_rows(sweep)


# ---- metamorphic relations -------------------------------------------------------------------------------------


# ---- the public function and its errors ------------------------------------------------------------------------


def test_snapping_is_counted_warns_where_it_is_coarse_or_is_refused():
    seeds = vorotool.seeds_from_points(vorotool.PointSet([[0.1, 0], [2, 1]]))  # a warning would fail
    assert (seeds.snapped, seeds.scale) == (1, 2**37)
    assert 0 < seeds.largest_move <= 2.0**-39
    with pytest.warns(VorotoolWarning, match=r"1 of 2 seeds moved to the nearest 2\^-17 pixel"):
        far = vorotool.seeds_from_points(vorotool.PointSet([[0.1, 0], [2.0**22, 1]]))
    assert far.snapped == 1
    assert 2.0**-20 <= far.largest_move <= 2.0**-18
    with pytest.raises(InputError, match=r"point \[0\] is \(0\.1, 0\.0\)"):
        vorotool.seeds_from_points(vorotool.PointSet([[0.1, 0], [2, 1]]), strict=True)


def test_duplicates_warn_or_are_refused():
    seeds = SeedSet([3, 3, 5], [1, 1, 1], [2, 1, 3])
    with pytest.warns(VorotoolWarning, match="1 of 3 seeds lie on another seed"):
        assert set(Tessellator(seeds, Frame(0, 0, 9, 2)).labels().ravel()) == {1, 3}
    with pytest.raises(InputError, match="remove the duplicates"):
        Tessellator(seeds, Frame(0, 0, 9, 2), strict=True)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: vorotool.tessellate(np.empty((0, 2)), shape=(4, 4)), InputError, "no seeds"),
        (lambda: vorotool.tessellate([[0, np.nan]], shape=(4, 4)), InputError, r"point \[0\] is \(0\.0, nan\)"),
        (lambda: vorotool.tessellate([[0, 0, 0]], shape=(4, 4)), InputError, r"shape \(n, 2\)"),
        (lambda: vorotool.tessellate("abc", shape=(4, 4)), InputError, "invalid seeds: 'abc' is not"),
        (lambda: vorotool.tessellate([[1e300, 0]], shape=(4, 4)), InputError, r"at most 2\^44"),
        (lambda: vorotool.tessellate([[2.0**43, 0]], shape=(4, 4)), InputError, "too far from the frame"),
        (lambda: vorotool.tessellate([[0, 0]], shape=(0, 4)), InputError, "at least 1 x 1"),
        (lambda: vorotool.tessellate([[0, 1 / 256]], window=(2**56, 0, 4, 4)), InputError, "nearer window"),
        (lambda: vorotool.tessellate([[0, 0]], window=(0, -(10**30), 4, 4)), InputError, "nearer window"),
        (lambda: vorotool.tessellate([[0, 0]], window=(0.5, 0, 4, 4)), UsageError, "four integers"),
        (lambda: vorotool.tessellate([[0, 0]], shape=np.full(2, 60000, np.uint16)), LimitError, "3600000000 pixels"),
        (lambda: vorotool.tessellate([[0, 0]], shape=(4, 4), window=(0, 0, 4, 4)), UsageError, "not both"),
        (lambda: vorotool.tessellate([[0, 0]], shape=(10**6, 10**6)), LimitError, "max_pixels="),
        (lambda: vorotool.tessellate([[0, 0]], shape=(1, 2**31), max_pixels=2**40), LimitError, "a side has at most"),
        (lambda: vorotool.tessellate([[0, 0]], shape=(4, 4), threads=-1), UsageError, "threads is -1"),
        (lambda: vorotool.tessellate([[0, 0]], shape=(4, 4), dtype=float), UsageError, "cannot have type float64"),
        (
            lambda: vorotool.tessellate([[i, 0] for i in range(300)], shape=(4, 4), dtype="u1"),
            LimitError,
            "do not fit uint8",
        ),
        (lambda: vorotool.tessellate([[0, 0]], shape=(4, 4), max_distance=-1), UsageError, "0 or larger"),
        (lambda: vorotool.tessellate([[0, 0]], shape=(4, 4), max_distance=np.nan), UsageError, "0 or larger"),
        (lambda: vorotool.tessellate([[0, 0]], shape=(4, 4), method="fast"), UsageError, "must be 'exact' or"),
        (lambda: vorotool.tessellate([[0, 0]], shape=(4, 4), out=np.empty((3, 3), np.int32)), UsageError, "shape"),
    ],
)
def test_bad_input_is_named(call, error, message):
    with pytest.raises(error, match=message):
        call()


def test_unknown_instruction_set_is_refused(monkeypatch):
    monkeypatch.setenv("VOROTOOL_SIMD", "mmx")
    with pytest.raises(UsageError, match="this machine has portable"):
        vorotool.tessellate([[0, 0]], shape=(4, 4))


def test_a_frame_that_nobody_gave_has_at_most_2_to_28_pixels():
    side = 2**14
    for far in ([side, side - 1], [704052.0, 663838.0]):
        with pytest.raises(LimitError, match=r"more than 268435456: give shape=\(H, W\) or window=\(x, y, w, h\)"):
            vorotool.tessellate([far], max_pixels=10**15)
    assert default_frame(as_seeds([[side - 1, side - 1]])).pixels == 2**28
    assert vorotool.tessellate([[side, side]], shape=(2, 2)).labels.tolist() == [[1, 1], [1, 1]]


def test_a_frame_that_is_too_large_is_refused_before_seeds_are_told_of():
    points = [[500000.123, 4649776.371], [500321.517, 4650012.29]]
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        with pytest.raises(LimitError, match="the smallest frame that holds the points"):
            vorotool.tessellate(points)
    assert not told
