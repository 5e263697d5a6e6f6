"""What files of results have in common: their type, the polygons that they are of, and sites of these."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from vorotool import _core
from vorotool.errors import InputError
from vorotool.formats.io.arrays import npz_columns
from vorotool.formats.io.sources import Source
from vorotool.formats.parsing.json import parse_json, read_y_axis
from vorotool.formats.parsing.reader_options import ReadOptions, shortened
from vorotool.formats.polygons.json import read_json, write_items
from vorotool.formats.results.rows import PREFIXES, ArrayRows, JsonRows, Rows, is_number
from vorotool.formats.text.row_writer import Column, RowShape, write_list_rows
from vorotool.formats.text.tables import json_bytes, json_text, write_arrays
from vorotool.types.fields import MEMBER as Y_AXIS
from vorotool.types.fields import UNSTATED
from vorotool.types.polygons.polygon_set import PolygonSet
from vorotool.types.skeleton.segment_voronoi import SiteTable
from vorotool.types.table import Lookup

ABOUT = "about"
"""The array with the UTF-8 of JSON of what is no list: type and version, and what is known of polygons and sites."""

VERSION = 1
_RINGS = ("ring_starts", "ring_kind", "ring_polygon")
_MOST = 2**31 - 1


# ---- writing -------------------------------------------------------------------------------------
def head_of(kind: str, own: Mapping[str, Any], polygons: PolygonSet) -> dict[str, Any]:
    """Return the members before the lists: type and version, what a result has of its own, and where it lies."""
    names = ("crs", "unit", "connectivity")
    known = {name: getattr(polygons, name) for name in names if getattr(polygons, name) is not None}
    return {"type": kind, "version": VERSION, **own, Y_AXIS: polygons.y_axis, **known}


def write_head(out: BinaryIO, head: Mapping[str, Any]) -> None:
    """Write the beginning of a document."""
    out.write(json_text(head).removesuffix("}").encode() + b",\n")


class Parts(NamedTuple):
    """A result as its files hold it."""

    head: dict[str, Any]
    polygons: PolygonSet
    lists: dict[str, list[Member]]


def write_document(out: BinaryIO, parts: Parts, fmt: str) -> None:
    """Write a result as JSON, one object of a list a line of text, or as 1-D arrays; all indices are 0-based."""
    if fmt == "npz":
        write_arrays(out, document_arrays(parts))
        return
    write_head(out, parts.head)
    write_items(out, parts.polygons)
    for name, members in parts.lists.items():
        write_list(out, name, members)
    out.write(b"}\n")


def document_arrays(parts: Parts) -> dict[str, NDArray[Any]]:
    """Return the same as 1-D arrays."""
    made: dict[str, NDArray[Any]] = {}
    for name, members in parts.lists.items():
        made |= arrays_of(PREFIXES[name], members)
    return {**made, **polygon_arrays(parts.polygons), **about_array(parts.head, parts.polygons)}


def polygon_arrays(polygons: PolygonSet) -> dict[str, NDArray[Any]]:
    """Return the arrays of polygons."""
    return {
        "ring_x": polygons.xy[:, 0],
        "ring_y": polygons.xy[:, 1],
        **{name: getattr(polygons, name) for name in _RINGS},
        "polygon_feature": polygons.feature,
    }


def about_array(head: Mapping[str, Any], polygons: PolygonSet, **more: Any) -> dict[str, NDArray[Any]]:
    """Return the array with what is no list, and with the ids and properties of polygons."""
    described = described_rows(len(polygons), polygons.ids, polygons.properties)
    return {ABOUT: np.frombuffer(json_bytes({**head, **more, "polygons": described}), dtype=np.uint8)}


def described_rows(count: int, ids: Sequence[Any] | None, properties: Mapping[str, Sequence[Any]]) -> list[Any]:
    """Return id and properties of each site or polygon as an object of JSON, as far as there are any."""
    made: list[dict[str, Any]] = [{} for _ in range(count)] if ids is None else [{"id": value} for value in ids]
    if properties:
        columns = {name: list(values) for name, values in properties.items()}
        for row, each in enumerate(made):
            each["properties"] = {name: values[row] for name, values in columns.items()}
    return made


# ---- reading -------------------------------------------------------------------------------------
def _document(source: Source, kind: str, noun: str) -> Mapping[str, Any]:
    """Parse the JSON of a result, whose type and version are stated."""
    document = parse_json(source)
    if not isinstance(document, Mapping) or document.get("type") != kind:
        raise InputError(f'{source.name} holds no {noun}; its type should be "{kind}"')
    if document.get("version") != VERSION:
        found = shortened(document.get("version"))
        raise InputError(f"{source.name}: version {found} of {kind} is not supported; write version {VERSION}")
    return document


def opened(source: Source, options: ReadOptions, kind: str, noun: str) -> Rows:
    """Open a result that was written as JSON or as NPZ."""
    if source.format != "npz":
        return JsonRows(source.name, _document(source, kind, noun))
    arrays = npz_columns(source, options)
    about = ArrayRows(source.name, arrays, {}).array(ABOUT)
    if about.dtype != np.uint8:
        raise InputError(f"{source.name}: {ABOUT} is of type {about.dtype}; write bytes (uint8)")
    document = _document(Source(f"{source.name}, {ABOUT}", about.tobytes(), "json"), kind, noun)
    return ArrayRows(source.name, arrays, document)


def read_polygons(rows: Rows, options: ReadOptions) -> PolygonSet:
    """Read the polygons of a result, and what it says about all of them."""
    document = rows.document
    if isinstance(rows, ArrayRows):
        polygons = _of_arrays(rows, options)
    else:
        items = {"polygons": rows.list_of("polygons")}
        polygons = read_json(Source(rows.name, b"", "json", items), options)
    return replace(
        polygons,
        y_axis=read_y_axis(rows.name, document, UNSTATED),
        crs=document.get("crs"),
        connectivity=document.get("connectivity"),
        unit=stated(rows, "unit", None, lambda unit: isinstance(unit, str | None), "the unit is", "a name, such as mm"),
    )


def _of_arrays(rows: ArrayRows, options: ReadOptions) -> PolygonSet:
    described = JsonRows(rows.name, rows.document).list_of("polygons")
    check_described(rows, "polygons")
    options.check_vertices(rows.name, len(rows.array("ring_x")))
    rings: dict[str, Any] = {name: rows.integers(name, 0, _MOST) for name in _RINGS}
    with naming_values(rows.name):
        ArrayRows(rows.name, {name: rows.array(name) for name in ("ring_x", "ring_y")}, {}).together("")
        return PolygonSet(
            xy=np.stack([rows.reals("ring_x"), rows.reals("ring_y")], axis=1),
            **rings,
            feature=rows.integers("polygon_feature", 0, _MOST).astype(np.int32),
            **(named_rows(described) if options.properties else {}),
        )


def check_described(rows: Rows, member: str) -> None:
    """Refuse properties that are no objects."""
    described = JsonRows(rows.name, rows.document)
    described.values(member, "properties", lambda value: isinstance(value, dict | None), "an object")


def named_rows(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return ids and properties as columns; see `described_rows`."""
    ids = [row.get("id") for row in rows] if any("id" in row for row in rows) else None
    own = [row.get("properties") or {} for row in rows]
    names = dict.fromkeys(name for each in own for name in each)
    return {"ids": ids, "properties": {name: [each.get(name) for each in own] for name in names}}


def stated(rows: Rows, member: str, usual: Any, is_right: Callable[[Any], bool], has: str, form: str) -> Any:
    """Read a member of a document that says something of the whole result."""
    value = rows.document.get(member, usual)
    if not is_right(value):
        raise InputError(f"{rows.name}: {has} {shortened(value)}; write {form}")
    return value


def optional_pairs(
    rows: Rows, member: str, name: str, exist: NDArray[np.bool_], words: Callable[[int], str]
) -> NDArray[np.float64]:
    """Read pairs that some items of a list have, and others have not."""
    pairs = rows.pairs(member, name, optional=True)
    wrong = np.flatnonzero(np.isnan(pairs[:, 0]) == exist)
    if wrong.size:
        at = int(wrong[0])
        raise InputError(f"{rows.name}, {member} {at}: the {words(at)} is {'[x, y]' if exist[at] else 'null'}")
    return pairs


def read_sites(rows: Rows, polygons: PolygonSet) -> SiteTable:
    """Read the sites of a result, all of them vertices and edges of its polygons."""
    kind = rows.choices("sites", "kind", SITE_KINDS)
    polygon = rows.indices("sites", "polygon", len(polygons))
    ring, index = (rows.indices("sites", name, len(polygons.xy)) for name in ("ring", "index"))
    number = polygons.polygon_starts[polygon] + ring
    bad = np.flatnonzero(number >= polygons.polygon_starts[polygon + 1])
    if bad.size:
        raise InputError(f"{rows.name}, sites {bad[0]}: there is no ring {ring[bad[0]]} in polygon {polygon[bad[0]]}")
    bad = np.flatnonzero(index >= np.diff(polygons.ring_starts)[number])
    if bad.size:
        raise InputError(f"{rows.name}, sites {bad[0]}: the ring has no vertex {index[bad[0]]}")
    source = rows.index_pairs("sites", "source", ("source_ring", "source_index"), _MOST, optional=True)
    ends = None
    if rows.has("sites", "from") or rows.has("sites", "to"):
        ends = np.stack([rows.pairs("sites", name, optional=True) for name in ("from", "to")], axis=1)
    return SiteTable(kind, polygon, ring, index, source[:, 0], source[:, 1], ends)


def stated_name(rows: Rows, member: str, has: str, *names: str) -> str:
    """Read a member that has one of some names, by default the first."""
    return str(stated(rows, member, names[0], lambda value: value in names, has, " or ".join(names)))


def read_frame(rows: Rows) -> tuple[float, float, float, float]:
    """Read the rectangle that a result was cut by."""

    def is_right(value: Any) -> bool:
        are_numbers = type(value) is list and len(value) == 4 and all(map(is_number, value))
        return are_numbers and bool(np.isfinite(value).all()) and min(value[2:]) >= 0

    x, y, w, h = map(float, stated(rows, "frame", None, is_right, "the frame is", "[x, y, w, h]"))
    return (x, y, w, h)


@contextmanager
def naming_values(name: str) -> Iterator[None]:
    """Let what values say of their arrays begin with the name of the input."""
    try:
        yield
    except InputError as error:
        if str(error).startswith(name):
            raise
        raise InputError(f"{name}: {error.marked}") from error


# ---- lists of objects ----------------------------------------------------------------------------
SITE_KINDS = ("vertex", "edge")


class Member(NamedTuple):
    """A member that all objects of a list have."""

    name: str
    columns: Sequence[tuple[str, Column]]
    """The values in JSON, with the text before each."""
    after: str
    """The text behind the last one."""
    arrays: dict[str, NDArray[Any]]
    """The same as arrays, by their names."""


def numbers(name: str, values: NDArray[np.floating]) -> Member:
    """Make a member of numbers; NaN is null."""
    values = np.ascontiguousarray(values)
    missing = np.isnan(values)
    columns = [("", Column("", values))]
    if missing.any():
        columns = [("", _texts(["", "null"], missing)), ("", Column("", values, missing))]
    return Member(name, columns, "", {name: values})


def indices(name: str, values: NDArray[np.integer], none_of: int | None = None) -> Member:
    """Make a member of integers; of indices below a count, -1 is null."""
    return Member(name, [("", _index_column(values, none_of))], "", {name: values})


def choices(name: str, names: Sequence[str | bool], values: NDArray[Any]) -> Member:
    """Make a member of names, or of truth values, by their numbers; -1 is null."""
    texts = [*map(json_text, names), "null"]
    chosen = np.where(values < 0, len(names), values)
    return Member(name, [("", _texts(texts, chosen))], "", {name: values.astype(np.int8)})


def truths(name: str, values: NDArray[np.bool_]) -> Member:
    """Make a member of truth values."""
    return Member(name, [("", _texts(["false", "true"], values))], "", {name: values})


def places(
    name: str, xy: NDArray[np.floating], exists: NDArray[np.bool_] | None = None, *, is_exact: bool = False
) -> Member:
    """Make a member of pairs ``[x, y]``, null where they do not exist; those that are exact have all digits."""
    pair = [np.ascontiguousarray(values) for values in xy.T]
    made = {f"{name}_{axis}": values for axis, values in zip("xy", pair, strict=True)}
    return _pair(name, [Column("", values, is_place=is_exact) for values in pair], exists, made)


def index_pairs(
    name: str,
    pair: NDArray[np.integer],
    parts: tuple[str, str],
    exists: NDArray[np.bool_] | None = None,
    none_of: int | None = None,
) -> Member:
    """Make a member of pairs of integers, whose arrays are named; null where they do not exist."""
    columns = [_index_column(values, none_of) for values in pair.T]
    return _pair(name, columns, exists, dict(zip(parts, pair.T, strict=True)))


def _pair(
    name: str, pair: Sequence[Column], exists: NDArray[np.bool_] | None, arrays: dict[str, NDArray[Any]]
) -> Member:
    first, second = pair
    if exists is None:
        return Member(name, [("[", first), (",", second)], "]", arrays)
    given = (replace(column, missing=~exists) for column in pair)
    parts = [_texts(["null", "["], exists), next(given), _texts(["", ","], exists), next(given)]
    return Member(name, [("", column) for column in (*parts, _texts(["", "]"], exists))], "", arrays)


def _index_column(values: NDArray[np.integer], none_of: int | None) -> Column:
    if none_of is None:
        return Column("", np.ascontiguousarray(values, dtype=np.int64))
    return _texts([*map(str, range(none_of)), "null"], values % (none_of + 1))


def _texts(names: list[str], index: NDArray[Any]) -> Column:
    """Make a column of texts by their numbers."""
    return Column("", Lookup(names, np.ascontiguousarray(index, dtype=np.int32)))


def write_list(out: BinaryIO, name: str, members: Sequence[Member]) -> None:
    """Write a comma and a member of a document that is a list of objects."""
    around, columns, text = [], [], "{"
    for number, member in enumerate(members):
        text += f'{"," if number else ""}"{member.name}":'
        for before, column in member.columns:
            around.append(text + before)
            columns.append(column)
            text = ""
        text = member.after
    shape = RowShape((*around, f"{text}}}"), ",\n", "")
    out.write(f',\n"{name}":['.encode())
    write_list_rows(out, columns, shape)
    out.write(b"]")


def arrays_of(prefix: str, members: Sequence[Member]) -> dict[str, NDArray[Any]]:
    """Return the arrays of all members."""
    return {f"{prefix}_{name}": values for member in members for name, values in member.arrays.items()}


def site_members(table: SiteTable) -> list[Member]:
    """Return the members of sites; outside of features that overlap they have the ends ``from`` and ``to``."""
    source = np.stack([table.source_ring, table.source_index], axis=1)
    made = [
        choices("kind", SITE_KINDS, table.kind),
        *(indices(name, getattr(table, name)) for name in ("polygon", "ring", "index")),
        index_pairs("source", source, ("source_ring", "source_index"), table.source_ring >= 0),
    ]
    if table.ends is not None:
        exists = ~np.isnan(table.ends[:, 0, 0])
        made += [places(name, table.ends[:, end], exists, is_exact=True) for end, name in enumerate(("from", "to"))]
    return made


# ---- polygons on a lattice -----------------------------------------------------------------------
LATTICE_STEP = "lattice_step"
"""The member that says that coordinates were rounded to multiples of this for the result."""


def as_written(polygons: PolygonSet) -> tuple[PolygonSet, float]:
    """Return polygons as they were given, and the step of their lattice, 0 for none."""
    given = polygons.as_given
    if given is polygons:
        return polygons, 0.0
    placed, step = _placed(given)
    return (given, step) if np.array_equal(placed, polygons.xy) else (polygons, 0.0)


def as_read(polygons: PolygonSet, document: Mapping[str, Any]) -> PolygonSet:
    """Move the vertices of polygons to their lattice, if the document says that a result was computed there."""
    return polygons.moved(_placed(polygons)[0]) if document.get(LATTICE_STEP) and len(polygons) else polygons


def _placed(polygons: PolygonSet) -> tuple[Any, float]:
    """Where the lattice has the vertices, and its step."""
    vertices, origin, exponent, _ = _core.arrangement.place_on_lattice(polygons.xy, 0, None)
    step = math.ldexp(1.0, exponent)
    return np.asarray(origin) + step * vertices.astype(np.float64), step
