"""Skeletons as graphs of networkx."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vorotool.errors import UsageError
from vorotool.geometry.skeleton.graph import skeleton_graph
from vorotool.geometry.skeleton.skeleton import Skeleton

if TYPE_CHECKING:
    import networkx


def to_networkx(skeleton: Skeleton, *, by: str = "branch", flatten: float | None = None) -> networkx.MultiGraph[int]:
    """Give a skeleton as an undirected graph of networkx, which has to be installed.

    Nodes are numbers of vertices, with ``x``, ``y`` and ``r``. Edges have the number of their branch or arc for a key,
    and ``branch`` (also ``arc``), ``polygon``, ``id``, ``side``, ``kind``, ``length``, ``r_min``, ``r_max``, ``r_mean``
    as `branch_table` has them, and ``geometry``, a shapely LineString; the properties of the polygon, too. What does
    not exist is left out. The graph has ``crs`` if the input had.

    Parameters
    ----------
    skeleton : Skeleton
        Which.
    by : {"branch", "arc"}
        What an edge is. A closed branch joins a node with itself.
    flatten : float, optional
        How far the geometry may be from parabolas; by default 1/4096 of the larger side of the bounds.

    Returns
    -------
    networkx.MultiGraph
        As told above.

    Raises
    ------
    UsageError
        If networkx is not installed, ``by`` is something else, or the tolerance is not positive.

    Examples
    --------
    >>> from vorotool import skeleton_exact
    >>> graph = to_networkx(skeleton_exact([[0, 0], [4, 0], [4, 2], [0, 2]]))
    >>> sorted(dict(graph.degree).values()), max(r for _, r in graph.nodes(data="r"))
    ([1, 1, 1, 1, 3, 3], 1.0)
    """
    try:
        import networkx
    except ImportError:
        raise UsageError("networkx is not installed: pip install networkx") from None
    import shapely

    parts = skeleton_graph(skeleton, by=by, flatten=flatten)
    polygons = skeleton.polygons
    graph: networkx.MultiGraph[int] = networkx.MultiGraph(**({} if polygons.crs is None else {"crs": polygons.crs}))
    places, radii = skeleton.vertices[parts.nodes].tolist(), skeleton.radius[parts.nodes].tolist()
    for node, (x, y), r in zip(parts.nodes.tolist(), places, radii, strict=True):
        graph.add_node(node, x=x, y=y, r=r)
    columns = {name: parts.edges[name].tolist() for name in parts.edges}
    first, last = parts.start[:-1].tolist(), parts.start[1:].tolist()
    for row, (a, b) in enumerate(zip(parts.source.tolist(), parts.target.tolist(), strict=True)):
        own = {name: values[row] for name, values in columns.items() if values[row] is not None}
        described: dict[str, Any] = {}
        if "polygon" in own:
            described = {key: values[own["polygon"]] for key, values in polygons.properties.items()}
        own["geometry"] = shapely.LineString(parts.points[first[row] : last[row]])
        attributes = {**described, **{f"voro_{key}" if key in described else key: value for key, value in own.items()}}
        graph.add_edge(a, b, key=own[by], **attributes)
    return graph
