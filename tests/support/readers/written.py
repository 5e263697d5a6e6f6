"""The bytes of a value in a format, as the library writes them."""

import io

from vorotool.products.writing import chosen_part, write_product


def written(value, fmt, what=None, **options):
    """Give what a file would hold."""
    out = io.BytesIO()
    write_product(out, value, chosen_part(value, fmt, what), fmt, **options)
    return out.getvalue()
