"""Skeletons as GraphML.

networkx takes 4 times as long for 90,000 edges, once its graph is made (`tests/benchmarks/libraries.py graphml`).
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from typing import Any, BinaryIO
from xml.sax.saxutils import escape, quoteattr

from vorotool.convert.tables import listed
from vorotool.formats.results.features import line_column
from vorotool.formats.text.row_writer import Column, RowShape, write_rows
from vorotool.formats.text.tables import json_text
from vorotool.numeric.coordinates import current_written
from vorotool.numeric.xml_text import xml_characters
from vorotool.types.features import Lines
from vorotool.types.skeleton.skeleton import Skeleton
from vorotool.types.skeleton.tables import SkeletonGraph, skeleton_graph

_NODE_KEYS = {"x": "double", "y": "double", "r": "double", "degree": "long"}
_LARGEST = sys.float_info.max
_HEAD = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<graphml xmlns="http://graphml.graphdrawing.org/xmlns" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"\n'
    ' xsi:schemaLocation="http://graphml.graphdrawing.org/xmlns http://graphml.graphdrawing.org/xmlns/1.0/graphml.xsd">\n'
)


def write_graphml(
    out: BinaryIO,
    skeleton: Skeleton,
    *,
    by: str = "branch",
    flatten: float | None = None,
) -> None:
    """Write a skeleton as an undirected graph in GraphML, with the columns of `skeleton_graph`; geometry is WKT."""
    graph = skeleton_graph(skeleton, by=by, flatten=flatten)
    values = {name: listed(column) for name, column in graph.edges.items()}
    kinds = {name: _kind(column) for name, column in values.items()}
    kinds["voro_geometry" if "geometry" in values else "geometry"] = "string"
    out.write(_HEAD.encode())
    for name, kind in _NODE_KEYS.items():
        out.write(f'<key id="n_{name}" for="node" attr.name="{name}" attr.type="{kind}"/>\n'.encode())
    for number, (name, kind) in enumerate(kinds.items()):
        named = quoteattr(xml_characters(name))
        out.write(f'<key id="e{number}" for="edge" attr.name={named} attr.type="{kind}"/>\n'.encode())
    out.write(b'<graph edgedefault="undirected">\n')
    if len(graph.nodes):
        x, y = skeleton.as_given.vertices[graph.nodes].T.copy()
        own = (x, y, skeleton.radius[graph.nodes], skeleton.degree[graph.nodes])
        columns = [Column("", graph.nodes), *(Column("", values) for values in own)]
        first, *others = (f'<data key="n_{name}">' for name in _NODE_KEYS)
        between = (f'">{first}', *(f"</data>{name}" for name in others))
        shape = RowShape(('<node id="', *between, "</data></node>\n"))
        write_rows(out, columns, shape)
    columns = [
        Column("", list(_openings(graph, by, values, kinds))),
        line_column(Lines(graph.points, graph.start), "wkt"),
    ]
    shape = RowShape(("", "", "</data></edge>\n"), "", "LINESTRING EMPTY")
    write_rows(out, columns, shape)
    out.write(b"</graph>\n</graphml>\n")


def _openings(
    graph: SkeletonGraph, by: str, values: Mapping[str, list[Any]], kinds: Mapping[str, str]
) -> Iterator[str]:
    """One text an edge, up to its first point."""
    data = [_elements(f'<data key="e{n}">', column, kinds[name]) for n, (name, column) in enumerate(values.items())]
    ends = (graph.edges[by].tolist(), graph.source.tolist(), graph.target.tolist())
    for number, source, target, *row in zip(*ends, *data, strict=True):
        yield f'<edge id="{number}" source="{source}" target="{target}">{"".join(row)}<data key="e{len(data)}">'


def _elements(start: str, values: list[Any], kind: str) -> Iterator[str]:
    """Return the elements of a column, empty where there is no value."""
    precision = current_written().how.precision
    text: Callable[[Any], str] = str if kind == "long" else json_text
    if kind == "double":
        text = (
            (lambda value: f"{value:.{precision}g}")
            if precision
            else lambda value: repr(float(value)).removesuffix(".0")
        )
    elif kind == "string":
        text = lru_cache(_escaped) if {type(value) for value in values} <= {str, type(None)} else _escaped
    return ("" if value is None else f"{start}{text(value)}</data>" for value in values)


def _escaped(value: Any) -> str:
    text = value if isinstance(value, str) else json_text(value)
    return escape(xml_characters(text), {"\r": "&#13;"})  # which parsers would take for the end of a line


def _kind(values: list[Any]) -> str:
    """The type of an attribute; what has no type of its own is text."""
    kinds = {type(value) for value in values if value is not None}
    if kinds <= {int} and all(value is None or -(2**63) <= value < 2**63 for value in values):
        return "long"
    if kinds <= {int, float} and all(value is None or abs(value) <= _LARGEST for value in values):
        return "double"
    return "boolean" if kinds == {bool} else "string"
