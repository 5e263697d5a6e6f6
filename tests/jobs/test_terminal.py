"""Text for people: nothing in it drives a terminal, and any encoding can hold it."""

import io

import pytest

from vorotool.jobs.terminal import escaped, print_text


def test_control_characters_and_changes_of_direction_are_escaped():
    for code in (*range(0x20), *range(0x7F, 0xA0), 0x61C, 0x200E, 0x2028, 0x202E, 0x2066, 0x2069):
        text = escaped(f"a{chr(code)}b")
        assert text == f"a{chr(code)!r}b".replace("'", "")
        assert text.isascii()
        assert text.isprintable()


def test_other_characters_stay():
    assert escaped("é 日本 µm — a\\n 'q'") == "é 日本 µm — a\\n 'q'"


@pytest.mark.parametrize("encoding", ["ascii", "cp1252", "cp437", "gbk", "iso-8859-1", "utf-8"])
def test_what_an_encoding_lacks_is_escaped(encoding):
    stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding, errors="strict", newline="")
    print_text("a…日µ\udc80\n", stream)
    written = stream.detach().getvalue().decode(encoding)
    for character in "a…日µ\udc80\n":
        assert character in written or character.encode("unicode_escape").decode() in written
