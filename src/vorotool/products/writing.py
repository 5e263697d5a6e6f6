"""From a value and a format to the function that writes the one in the other."""

from __future__ import annotations

from typing import Any, BinaryIO

from vorotool.errors import UsageError, meant
from vorotool.products.formats import FORMATS, GENERAL, resolved
from vorotool.products.registry import Product, is_of, parts_of, public_types

_IN_PLACE = "Table", "LedOn", "SmoothLines"
"""Types that are written under the name of another result, in the formats of rows and features."""


def write_product(
    out: BinaryIO,
    value: Any,
    product: Product,
    fmt: str,
    *,
    flatten: float | None = None,
    precision: int | None = None,
    threads: int = 0,
    path: str = "-",
) -> None:
    """Write a result in one of its formats; pictures and pages are none of these."""
    chosen = FORMATS[fmt]
    resolved("numeric.coordinates:record_value")(value)
    options: dict[str, Any] = {"flatten": flatten, "precision": precision, "threads": threads}
    writer = chosen.writers.get(product.what, chosen.writer)
    if writer is None and fmt not in product.data:
        source = next(name for name in chosen.made_from if name in product.data)
        with resolved(chosen.maker)(out, product.what, path) as taker:
            write_product(taker, value, product, source, **options)
        return
    writer = writer or (GENERAL if is_of(value, *_IN_PLACE) else product.own.get(fmt, GENERAL))
    given = {"fmt": fmt, "what": product.what, **options}
    resolved(writer.function)(out, value, **{name: given[name] for name in writer.takes})


def chosen_part(value: Any, fmt: str, what: str | None) -> Product:
    """Choose what of a value is written."""
    parts, name = parts_of(value), type(value).__name__
    if not parts:
        *others, last = public_types()
        raise UsageError(f"a {name} cannot be written: give a {', '.join(others)} or {last}")
    if what is not None and not (isinstance(what, str) and what in parts):
        instead = f"use {' or '.join(parts)}" if len(parts) > 1 else "leave it out"
        raise UsageError(f"what={what!r} is not a result of a {name}: {instead}{meant(str(what), parts)}")
    having = [each for each in parts.values() if fmt in each.written]
    usual = [each for each in having if fmt in each.usual_for]
    chosen = parts[what] if what is not None else next(iter([*usual, *having, *parts.values()]))
    if fmt not in chosen.written:
        possible = dict.fromkeys([*chosen.written, *chosen.layers])
        part = chosen.what if len(parts) > 1 else f"a {name}"
        raise UsageError(f"{part} cannot be written as {fmt!r}: use one of {', '.join(possible)}")
    return chosen
