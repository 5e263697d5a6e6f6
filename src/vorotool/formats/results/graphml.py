"""Skeletons as GraphML.

networkx takes 4 times as long for 90,000 edges, once its graph is made (`tests/benchmarks/libraries.py graphml`).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, BinaryIO
from xml.sax.saxutils import escape, quoteattr

import numpy as np

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
        Column("", _openings(graph, by, values)),
        line_column(Lines(graph.points, graph.start), "wkt"),
    ]
    shape = RowShape(("", "", "</data></edge>\n"), "", "LINESTRING EMPTY")
    write_rows(out, columns, shape)
    out.write(b"</graph>\n</graphml>\n")


def _openings(graph: SkeletonGraph, by: str, values: Mapping[str, list[Any]]) -> list[str]:
    """One text an edge, up to its first point."""
    keys = [(f'<data key="e{number}">', _kind(column)) for number, column in enumerate(values.values())]
    last = f'<data key="e{len(keys)}">'
    texts, precision = [], current_written().how.precision
    ends = (graph.edges[by].tolist(), graph.source.tolist(), graph.target.tolist())
    for number, source, target, *row in zip(*ends, *values.values(), strict=True):
        data = "".join(
            f"{key}{_text(value, kind, precision)}</data>"
            for (key, kind), value in zip(keys, row, strict=True)
            if value is not None
        )
        texts.append(f'<edge id="{number}" source="{source}" target="{target}">{data}{last}')
    return texts


def _text(value: Any, kind: str, precision: int) -> str:
    if kind == "double":
        return f"{value:.{precision}g}" if precision else repr(float(value)).removesuffix(".0")
    if kind == "string":
        text = value if isinstance(value, str) else json_text(value)
        return escape(xml_characters(text), {"\r": "&#13;"})  # which parsers would take for the end of a line
    return json_text(value)


def _kind(values: list[Any]) -> str:
    """The type of an attribute; what has no type of its own is text."""
    kinds = {type(value) for value in values if value is not None}
    if kinds <= {int} and all(value is None or -(2**63) <= value < 2**63 for value in values):
        return "long"
    if kinds <= {int, float} and all(value is None or np.isfinite(value) for value in values):
        return "double"
    return "boolean" if kinds == {bool} else "string"
