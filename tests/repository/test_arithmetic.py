"""What decides a written digit is calculated by operations that every machine rounds alike.

Sums, products, quotients and square roots are; powers, sines, logarithms and hypot differ between C libraries and with
the vector instructions that numpy or a C library chooses, products of matrices with the linear algebra, and the order
that an unstable sort leaves equal keys in with the vector instructions. What is needed is in
`geometry.curves.inverse_functions`.
"""

import ast
import re
from pathlib import Path

import pytest

SOURCES = Path(__file__).parents[2] / "src"
CORE = sorted(SOURCES.rglob("*.[ch]pp"))
MODULES = sorted((SOURCES / "vorotool").rglob("*.py"))

ALIKE = frozenset(
    {"inf", "nan", "pi", "isfinite", "isnan", "isinf", "floor", "ceil", "sqrt", "isqrt", "gcd", "lcm", "comb", "prod"}
    | {"ldexp", "nextafter", "ulp", "factorial"}
)
"""What may be used of math; all else of it is the C library's."""

OF_LIBRARIES = frozenset(
    {f"{arc}{name}{h}" for arc in ("", "arc") for name in ("sin", "cos", "tan") for h in ("", "h")}
    | {"arctan2"}
    | {"exp", "exp2", "expm1", "log", "log2", "log10", "log1p", "logaddexp", "power", "float_power", "hypot"}
    | {"dot", "vdot", "inner", "matmul", "einsum", "tensordot", "linalg", "fft", "polynomial", "roots", "polyfit"}
    | {"cbrt", "polyval", "convolve", "correlate", "interp", "geomspace", "logspace"}
)
"""What may not be used of numpy."""

IN_CORE = re.compile(
    r"std::(a?sinh?|a?cosh?|a?tanh?|atan2|exp2?|expm1|log(2|10|1p|b)?|pow|cbrt|hypot|erfc?|[lt]gamma|fma|reduce|"
    r"transform_reduce)\b|long double|__float128|#pragma (GCC optimize|STDC FP_CONTRACT)"
)


EXACT = frozenset(
    {
        "step",
        "total * sum_to(index) - n * everything",
        "vx - ux",
        "vy - uy",
        "ux * vy - uy * vx",
        "bx - ax",
        "by - ay",
        "cx - ax",
        "cy - ay",
        "cx - bx",
        "cy - by",
    }
    | {"(bx - ax) * (cy - ay) - (by - ay) * (cx - ax)"}
)
"""Fractions of which there are squares."""


def _faults(tree):
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(value=ast.Name(id="np"), attr=name) if name in OF_LIBRARIES:
                yield node.lineno, f"np.{name}"
            case ast.Attribute(value=ast.Name(id="math"), attr=name) if name not in ALIKE:
                yield node.lineno, f"math.{name}"
            case ast.ImportFrom(module="math", names=names):
                yield from ((node.lineno, f"math.{name.name}") for name in names if name.name not in ALIKE)
            case ast.BinOp(op=ast.MatMult()):
                yield node.lineno, "@"
            case ast.BinOp(op=ast.Pow(), left=left, right=right) if not _is_exact_power(left, right):
                yield node.lineno, ast.unparse(node)
            case ast.Call(func=ast.Attribute(attr="argsort" | "argpartition"), keywords=given):
                if not any(word.arg == "kind" and ast.unparse(word.value) == "'stable'" for word in given):
                    yield node.lineno, ast.unparse(node)


def _is_exact_power(left, right):
    """Of whole numbers and of two, and of fractions: those of doubles are the C library's."""
    text = ast.unparse(left)
    of_whole = isinstance(left, ast.Constant) and (left.value == 2 or isinstance(left.value, int))
    return of_whole or text in EXACT or text.startswith("Fraction(") or text.isupper()


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(SOURCES)))
def test_no_digit_is_left_to_a_library(path):
    assert list(_faults(ast.parse(path.read_text(encoding="utf-8")))) == []


@pytest.mark.parametrize("path", CORE, ids=lambda path: str(path.relative_to(SOURCES)))
def test_no_digit_of_the_core_is_left_to_a_library(path):
    without_comments = re.sub(r"//.*", "", path.read_text(encoding="utf-8"))
    assert [found.group() for found in IN_CORE.finditer(without_comments)] == []


def test_the_compiler_fuses_no_products_and_sums():
    assert "-ffp-contract=off" in (SOURCES / "compile_options.cmake").read_text(encoding="utf-8")
    builds = [*SOURCES.glob("*.cmake"), *SOURCES.rglob("CMakeLists.txt")]
    assert not [path for path in builds if "fast-math" in path.read_text(encoding="utf-8")]
