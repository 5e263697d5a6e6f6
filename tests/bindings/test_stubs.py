"""The types of the compiled core that are stated in src/vorotool/_core are those that it has."""

import ast
from pathlib import Path
from types import ModuleType

import pytest
from nanobind.stubgen import StubGen

import vorotool
from vorotool import _core

STUBS = Path(vorotool.__file__).parent / "_core"
ROOMS = sorted(name for name, value in vars(_core).items() if isinstance(value, ModuleType))


def statements(text):
    """What is stated of each name: bases, values, signatures of all overloads, and documentation, in no order."""
    found = {}

    def add(name, statement):
        found.setdefault(name, set()).add(statement)

    def look(nodes, prefix):
        for node in nodes:
            if isinstance(node, ast.Assign | ast.AnnAssign):
                add(
                    prefix + ast.unparse(node.targets[0] if isinstance(node, ast.Assign) else node.target),
                    ast.unparse(node),
                )
            if not isinstance(node, ast.ClassDef | ast.FunctionDef):
                continue
            name = prefix + node.name
            for line in (ast.get_docstring(node) or "").splitlines():
                add(f"{name}.__doc__", line)
            if isinstance(node, ast.ClassDef):
                add(name, f"class ({', '.join(map(ast.unparse, node.bases))})")
                look(node.body, name + ".")
            else:
                add(name, f"({ast.unparse(node.args)}) -> {ast.unparse(node.returns)}")

    look(ast.parse(text).body, "")
    return found


def test_each_room_has_a_stub():
    assert {path.stem for path in STUBS.glob("*.pyi")} == {"__init__", *ROOMS}
    [imported] = [
        node for node in ast.parse((STUBS / "__init__.pyi").read_text()).body if isinstance(node, ast.ImportFrom)
    ]
    assert sorted(alias.name for alias in imported.names) == ROOMS


@pytest.mark.parametrize("room", ROOMS)
def test_a_stub_states_what_the_room_has(room):
    fresh = StubGen(getattr(_core, room))
    fresh.put(getattr(_core, room))
    stated = statements((STUBS / f"{room}.pyi").read_text(encoding="utf-8"))
    assert stated == statements(fresh.get()), "write the stubs anew with `make stubs`"


@pytest.mark.parametrize("room", ROOMS)
def test_no_type_has_a_name_of_cpp_only(room):
    """Where nanobind knows no type of Python, it quotes that of C++; a call would fail."""
    for node in ast.walk(ast.parse((STUBS / f"{room}.pyi").read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef):
            types = [node.returns, *(argument.annotation for argument in node.args.args if argument.annotation)]
            parts = [part for kind in types for part in ast.walk(kind)]
            assert not [part.value for part in parts if isinstance(part, ast.Constant) and isinstance(part.value, str)]


def test_another_signature_is_found():
    old = "def f(a: int) -> None: ...\nclass C:\n    x = 0\n    def g(self) -> int: ...\n"
    for change in (
        ("a: int", "a: float"),
        ("None", "int"),
        ("x = 0", "x = 1"),
        ("-> int", "-> str"),
        ("def g", "def h"),
    ):
        assert statements(old.replace(*change)) != statements(old)
    assert statements("class C:\n    def g(self) -> int: ...\n    x = 0\ndef f(a: int) -> None: ...") == statements(old)
