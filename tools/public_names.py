"""Write the public names for type checkers: `tools/public_names.py > src/vorotool/__init__.pyi`."""

import vorotool

HEAD = '''"""Exact Voronoi diagrams of images, points and polygons: the types of all public names."""

# Made of the table in __init__.py by tools/public_names.py; `make lint` compares both.
'''


def stub() -> str:
    """Return an import of each public name from its home, classes before functions."""
    names = sorted((home, name[0].islower(), name) for name, home in vorotool._HOME.items())
    imports = [f"from {home} import (\n    {name} as {name},\n)" for home, _, name in names]
    return "\n".join([HEAD, *imports, "", "_HOME: dict[str, str]", "__version__: str", "__all__: list[str]"])


if __name__ == "__main__":
    print(stub())  # noqa: T201
