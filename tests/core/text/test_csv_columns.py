"""Delimited text in the core, against Python's float() and csv module."""

import csv
import io
import math
import random
import struct
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vorotool import _core

PIECE = 1 << 18  # kPieceBytes: texts above it are cut for the threads

NASTY = """
    0 -0 0.0 -0.0 1 +1 1. .5 -.5 1e5 1E5 1e+5 1e-5 1e308 1.7976931348623157e308 -1.7976931348623157e308
    4.9406564584124654e-324 2.2250738585072014e-308 2.2250738585072011e-308 2.4703282292062327e-324 1e-400 -1e-400 0.1
    0.30000000000000004 9007199254740993 9007199254740992.99999999999999999999 1.00000000000000011102230246251565
    179769313486231580793728971405303415079934132710037826936173778980444968292764750946649017977587207096330286416
    123456789012345678901234567890 0.000000000000000000000000000000000000000000000000000000000000000000000000000001
    00000000000000000000000000000001 1e0000000000000000000005 6.02214076e23 0e999999999 8.5e-99999
"""
NOT_NUMBERS = """
    abc 1.5x 1,5 0x10 1_000 --1 +-1 1e e5 . - + 1.2.3 ١
"""
NOT_FINITE = ["nan", "NaN", "-nan", "inf", "-Inf", "Infinity", "+inf", "1e309", "-1e999999", "1" + "0" * 400]


def parse(text, delimiter=",", columns=(0, 1), **options):
    return _core.text.parse_numbers(
        text.encode() if isinstance(text, str) else text, delimiter, list(columns), **options
    )


def error_of(text, *arguments, **options):
    with pytest.raises(_core.text.TextError) as caught:
        parse(text, *arguments, **options)
    return caught.value.args


def bits(values):
    return [struct.pack("<d", value) for value in values]


def test_nasty_numbers_are_rounded_as_python_does():
    values = parse("".join(f"{text},1\n" for text in NASTY.split()))
    assert bits(values[:, 0]) == bits(float(text) for text in NASTY.split())


@settings(max_examples=50, deadline=None)
@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1), st.integers(1, 17))
def test_random_numbers_are_rounded_as_python_does(values, digits):
    texts = [repr(value) for value in values] + [f"{value:.{digits}g}" for value in values]
    texts = [text for text in texts if math.isfinite(float(text))]
    read = parse("\n".join(texts), columns=[0])[:, 0]
    assert bits(read) == bits(float(text) for text in texts)


def test_random_bit_patterns_and_long_digits():
    generator = random.Random(7)
    patterns = (struct.unpack("<d", generator.randbytes(8))[0] for _ in range(20000))
    texts = [repr(value) for value in patterns if math.isfinite(value)]
    texts += [f"{generator.getrandbits(200)}e{generator.randint(-360, 240)}" for _ in range(20000)]
    assert bits(parse("\n".join(texts), columns=[0])[:, 0]) == bits(map(float, texts))


@pytest.mark.parametrize("text", ["", "1 2", *NOT_NUMBERS.split()])
def test_what_is_not_a_number(text):
    assert error_of(f'1;2\n3;"{text}"\n', ";") == ("not_number", 2, 1, text, 0, 0)


@pytest.mark.parametrize("text", NOT_FINITE)
def test_what_is_not_finite(text):
    assert error_of(f"# c\n1,2\n\n3,{text}\n") == ("not_finite", 4, 1, text[:40], 0, 0)


def test_layout_of_lines():
    text = '# comment\r\n\r\n x , y \r\n 1 , "2" \r\n   \t\r\n  # more\r\n+3.5,4'
    np.testing.assert_array_equal(parse(text, header_records=1), [[1, 2], [3.5, 4]])


@pytest.mark.parametrize(
    ("text", "delimiter"),
    [
        ("1,2\n3,4", ","),
        ("1;2\n3;4", ";"),
        ("1\t2\n3\t4", "\t"),
        (" 1  2\n3\t 4 ", " "),
        ("1 2 # a\n3 4#", " "),
    ],
)
def test_delimiters(text, delimiter):
    if text.endswith("#"):
        assert error_of(text, delimiter)[:4] == ("not_number", 2, 1, "4#")
        text = text.replace("4#", "4 #")
    np.testing.assert_array_equal(parse(text, delimiter), [[1, 2], [3, 4]])


@pytest.mark.parametrize("text", ["", "\n", "# only\n# comments", "x,y\n"])
def test_no_rows(text):
    assert parse(text, header_records=1).shape == (0, 2)


def test_ragged_rows():
    assert error_of("1,2\n3,4\n\n5,6,7\n8") == ("field_count", 4, 3, "", 3, 2)
    assert error_of("x,y,z\n1,2\n", header_records=1, fields=3) == ("field_count", 2, 2, "", 2, 3)
    assert error_of("1,2\n3,4,\n") == ("field_count", 2, 3, "", 3, 2)


def test_open_quotes():
    assert error_of('1,2\n3,"4\n5,6\n') == ("open_quote", 2, 1, '"4', 0, 0)
    assert error_of('1,2\n3,"4"x\n') == ("open_quote", 2, 1, '"4"x', 0, 0)
    # Stray quotes far apart do not swallow the lines between them.
    assert error_of('1,2,"a\n3,4,b\n5,6,"c"\n')[:2] == ("open_quote", 1)


def test_quoted_fields_may_hold_anything():
    text = b'1,"a, ""b""\n# no comment",2\n3, plain "5" ,4\n5,x,oops\n'
    assert _core.text.parse_fields(text, ",", [1]) == [['a, "b"\n# no comment', 'plain "5"', "x"]]
    assert error_of(text, columns=[0, 2]) == ("not_number", 4, 2, "oops", 0, 0)
    assert _core.text.line_of_row(text, ",", 0, 1) == 3
    assert _core.text.line_of_row(text, ",", 0, 3) == 0


@settings(deadline=None, max_examples=8)
@given(st.lists(st.lists(st.text(), min_size=3, max_size=3), min_size=1, max_size=5))
def test_quoted_text_reads_as_the_csv_module_reads_it(rows):
    out = io.StringIO()
    csv.writer(out, quoting=csv.QUOTE_ALL, lineterminator="\n").writerows(rows)
    read = _core.text.parse_fields(out.getvalue().encode("utf-8", "replace"), ",", [0, 1, 2])
    expected = [[text.encode("utf-8", "replace").decode() for text in column] for column in zip(*rows, strict=True)]
    assert read == expected


def long_text(quotes):
    generator = random.Random(3)
    lines = []
    for i in range(3 * PIECE // 20):
        if i % 97 == 0:
            lines.append(generator.choice(["", '# comment, "', "   "]))
        name = '"two\nlines"' if quotes and i % 50 == 0 else f'"n{i}"' if quotes else f"n{i}"
        lines.append(f"{i},{generator.random()!r},{name}")
    return "\n".join(lines).encode()


@pytest.mark.parametrize("quotes", [False, True])
def test_results_do_not_depend_on_threads(quotes):
    text = long_text(quotes)
    rows = 3 * PIECE // 20
    results = [parse(text, threads=threads) for threads in (1, 2, 3, 8)]
    np.testing.assert_array_equal(results[0][:, 0], np.arange(rows))
    for result in results[1:]:
        np.testing.assert_array_equal(result, results[0])
    fields = [_core.text.parse_fields(text, ",", [2], threads=threads) for threads in (1, 3)]
    assert fields[0] == fields[1]
    assert {_core.text.count_rows(text, ",", threads=threads) for threads in (1, 2, 5)} == {rows}


@cache
def text_with_errors(quotes):
    rows = [[b"%d" % i, b"2", b'"q"' if quotes else b"q"] for i in range(4 * PIECE // 12)]
    for bad in (30000, 50000, 80000):
        rows[bad][1] = b"bad%d" % bad
    return b"\n".join(map(b",".join, rows))


@pytest.mark.parametrize("quotes", [False, True])
@pytest.mark.parametrize("threads", [1, 2, 3, 8])
def test_the_first_error_is_reported_whatever_the_threads(quotes, threads):
    assert error_of(text_with_errors(quotes), threads=threads) == ("not_number", 30001, 1, "bad30000", 0, 0)


def test_multi_line_records_keep_line_numbers_across_pieces():
    rows = ['1,2,"a\nb"'] * (2 * PIECE // 10) + ["1,x,c"]
    assert error_of("\n".join(rows), threads=2)[:2] == ("not_number", 2 * (len(rows) - 1) + 1)


@pytest.mark.parametrize("size", [PIECE - 1, PIECE, PIECE + 1, 2 * PIECE - 1, 2 * PIECE])
@pytest.mark.parametrize("end", ["", "\n", "\r\n"])
def test_a_text_as_long_as_a_piece(size, end):
    body = "1,2\n" * (size // 4)
    text = body + "3,4".ljust(size - len(body) + 3) + end
    assert len(parse(text, threads=2)) == size // 4 + 1


def test_nesting():
    assert _core.text.find_too_deep(b"[[1], [2]]", 2) is None
    assert _core.text.find_too_deep(b"[[1], [[2]]]", 2) == 7
    assert _core.text.find_too_deep(rb'["[[[\"[[[", "(\\"]', 1) is None
    assert _core.text.find_too_deep(b"]]]][", 1) is None
    assert _core.text.find_too_deep(b"(" * 10**6, 100) == 100
    assert _core.text.find_too_deep(b'["' + b"\\", 1) is None


def format_text(values, missing=None, **options):
    masks = missing or [None] * len(values)
    return b"".join(_core.text.format_rows(values, masks, **options)).decode()


def test_format_of_each_type():
    text = format_text(
        [
            np.array([-(2**63), 2**63 - 1]),
            np.array([0, 2**64 - 1], dtype=np.uint64),
            np.array([100000.0, 0.1]),
            ["a,b", 'say "é"'],
        ]
    )
    assert text == '-9223372036854775808,0,100000,"a,b"\n9223372036854775807,18446744073709551615,0.1,"say ""é"""\n'


def test_format_of_missing_fields():
    mask = np.array([True, False, False])
    values = [np.array([1, 2, 3]), np.array([0.5, math.nan, math.inf])]
    assert format_text(values, [mask, mask]) == ",\n2,\n3,\n"
    assert format_text([np.array([1, 2])], [np.array([True, False])]) == '""\n2\n'


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (-0.0, "-0"),
        (5.0, "5"),
        (1e15, "1000000000000000"),
        (1e16, "1e+16"),
        (1e-5, "0.00001"),
        (9.9e-6, "9.9e-06"),
        (0.1, "0.1"),
        (1 / 3, "0.3333333333333333"),
        (-1.7976931348623157e308, "-1.7976931348623157e+308"),
        (5e-324, "5e-324"),
    ],
)
def test_shortest_text(value, text):
    assert format_text([np.array([value])]) == text + "\n"


@settings(max_examples=50, deadline=None)
@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1), st.integers(1, 17))
def test_text_of_numbers(values, digits):
    array = np.array(values)
    shortest = format_text([array]).split()
    assert bits(map(float, shortest)) == bits(values)
    assert [_digits(text) for text in shortest] == [_digits(repr(value)) for value in values]
    assert format_text([array], digits=[digits]).split() == [f"{value:.{digits}g}" for value in values]


def _digits(text):
    return len(text.split("e")[0].replace(".", "").lstrip("-0").rstrip("0"))


def test_text_does_not_depend_on_threads():
    values = np.random.default_rng(5).normal(size=(2, 50000))
    texts = [b"".join(_core.text.format_rows([*values], [None, None], [], threads)) for threads in (1, 2, 3, 8)]
    assert len(set(texts)) == 1
    assert texts[0].count(b"\n") == 50000
    np.testing.assert_array_equal(parse(texts[0]), values.T)


def test_format_refuses_columns_of_other_types_and_lengths():
    with pytest.raises(TypeError, match="float64, int64 or uint64"):
        format_text([np.array([1], dtype=np.int16)])
    with pytest.raises(ValueError, match="one length"):
        format_text([np.array([1, 2]), np.array([1])])
    with pytest.raises(ValueError, match="one length"):
        format_text([np.array([1, 2])], [np.array([True])])


def rows(*columns, around=None, separator="", missing=""):
    shape = None if around is None else (around, separator, missing)
    return b"".join(_core.text.format_rows(list(columns), [None] * len(columns), [], 2, shape)).decode()


def test_rows_of_any_shape():
    numbers, reals = np.array([1, 2]), np.array([0.5, math.nan])
    text = rows(numbers, reals, ['"a,b"', "null"], around=("{", ";", " ", "}"), separator=",\n", missing="-")
    assert text == '{1;0.5 "a,b"},\n{2;- null}'  # texts as they are
    assert rows(numbers[:0], around=("[", "]"), separator=",") == ""
    with pytest.raises(ValueError, match="one text more"):
        rows(numbers, around=("[", ",", "]"))


def test_separators_stand_between_all_rows_of_all_blocks():
    count = 40_000
    text = rows(np.arange(count), around=("", ""), separator=" ")
    assert text == " ".join(map(str, range(count)))


def test_columns_that_look_up():
    values = np.array([0.25, -1e300, 1 / 3])
    index = np.array([[2, 0], [1, 1], [0, 2], [2, 2]], dtype=np.int32)
    texts = _core.text.NumberTexts(values)
    assert len(texts) == 3
    for column in (values, texts):
        shown = rows((column, index[:, 0]), (column, index[:, 1])).split()  # columns of a matrix: strided
        assert shown == [f"{float(values[a])!r},{float(values[b])!r}" for a, b in index]
    assert rows((np.array([7, 8, 9]), index[:, 0]), ["a", "b", "c", "d"]) == "9,a\n8,b\n7,c\n9,d\n"
    assert rows((["x", "y,"], np.array([1, 0], dtype=np.int32))) == '"y,"\nx\n'
    assert rows((values[:0], index[:0, 0]), (values, index[:0, 1])) == ""


def test_texts_of_numbers_are_those_of_columns():
    values = np.random.default_rng(3).normal(size=20_000)
    values[::1000] = math.inf
    index = np.random.default_rng(4).integers(0, len(values), 30_000).astype(np.int32)
    for precision in (0, 3):
        expected = format_text([values[index]], digits=[precision])
        for threads in (1, 3):
            texts = _core.text.NumberTexts(values, precision, threads)
            assert format_text([(texts, index)], digits=[precision]) == expected


@pytest.mark.parametrize("bad", [-1, 3, 2**31 - 1])
def test_an_index_out_of_range_is_refused(bad):
    index = np.array([0, bad], dtype=np.int32)
    for values in (np.arange(3), _core.text.NumberTexts(np.arange(3.0)), ["a", "b", "c"]):
        with pytest.raises(IndexError, match="out of range"):
            rows((values, index))
    with pytest.raises(ValueError, match="one length"):
        rows(np.arange(3), (np.arange(3), np.array([0, 1], dtype=np.int32)))
