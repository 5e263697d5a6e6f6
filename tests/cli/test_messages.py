"""What is said is known by its kind and by the input that it is about, never by its words."""

import os

import pytest

from support.processes.ended import ended_python


def test_quiet_wins(run, folder):
    assert run("tessellate mask.pbm -o a.png -q -v").err == ""
    assert run("tessellate mask.pbm -o a.png -v").err != ""


def test_an_input_whose_name_begins_the_message_is_named(run, tmp_path):
    (tmp_path / "there").write_text("x,y\n")
    assert run("tessellate there -f text", code=3).err.startswith("error: there: no seeds")


def test_an_input_of_a_batch_whose_name_is_in_the_warning_is_named_all_the_same(run, tmp_path):
    for name in ("seeds", "other"):
        (tmp_path / name).write_text("1,2\n1,2\n")
    outcome = run("tessellate seeds other --out-dir out -f npy")
    said = sorted(line for line in outcome.err.splitlines() if "warning" in line)
    assert [line.split(" of 2 seeds lie ")[0] for line in said] == ["warning: other: 1", "warning: seeds: 1"]


def test_advice_names_the_option_of_the_output(run, folder):
    """``-o`` is no help where the statistics or the table could not be written."""
    for name in ("have.json", "have.csv"):
        (folder / name).write_text("{}")
    (folder / "more.csv").write_bytes((folder / "dots.csv").read_bytes())
    run("delaunay dots.csv -o a.csv --stats have.json --no-clobber", code=4, says="--stats")
    run("delaunay dots.csv more.csv --table have.csv --no-clobber", code=4, says="--table")
    for options, option, name in (
        ("-o a.csv --stats /proc/s.json", "--stats", "/proc/s.json"),
        ("-f csv -o /dev/fd/foo", "-o", "/dev/fd/foo"),
    ):
        place = name.rpartition("/")[0]
        words = f"error: {name} cannot be written: no file can be created in {place}; write elsewhere with {option}\n"
        assert run(f"delaunay dots.csv {options}", code=4).err == words


def test_arrays_of_a_skeleton_are_no_points(run, folder):
    run("skeleton-exact mask.pbm -o a.npz")
    for command in ("delaunay", "alphashape"):
        done = run(command, "a.npz", code=3)
        assert ("JSON" in done.err, "--input-format" in done.err) == (True, False)


HOSTILE = "a\x1b[31m\nb\u202e.csv"


@pytest.mark.parametrize("arguments", [["info"], ["delaunay"], ["skeleton-exact", "--no-such-option"], [HOSTILE]])
@pytest.mark.parametrize("content", [None, "x,y\n1,nonsense\n", "x,y\n1,2\n3,4\n5,9\n"])
def test_names_of_files_do_not_drive_the_terminal(run, tmp_path, arguments, content):
    if content is not None:
        (tmp_path / HOSTILE).write_text(content)
    outcome = run("", *arguments, HOSTILE, code=None)
    shown = outcome.err + (outcome.out if arguments == ["info"] else "")
    assert not set("\x1b\u202e") & set(shown)
    if arguments == ["info"]:
        assert "a\\x1b[31m\\nb\\u202e.csv" in shown


SEVERAL = """
import os, sys
from vorotool.cli.main import main
for arguments in %r:
    child = os.fork()
    if not child:
        main(arguments)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    print(f"\\n{arguments[0]} ends with {code}", flush=True)
"""


@pytest.mark.parametrize("encoding", ["ascii", "gbk"])
def test_any_encoding_of_the_terminal_will_do(tmp_path, encoding):
    (tmp_path / "日.csv").write_text("x,y\n1,2\n")
    commands = [["sample"], ["alphashape", "--help"], ["voronoi", "-h"], ["info", "日.csv"]]
    environment = {**os.environ, "PYTHONIOENCODING": encoding}
    done = ended_python("-c", SEVERAL % commands, cwd=tmp_path, env=environment, text=False)
    assert (done.returncode, done.stderr) == (0, b"")
    out = done.stdout
    for name, *_ in commands:
        said, end, out = out.partition(f"\n{name} ends with 0\n".encode())
        assert len(said) > 20
        assert end
    assert out == b""


@pytest.mark.parametrize(
    ("line", "code", "says"),
    [
        ("delaunay https://example.com/a.csv", 3, "nothing is read from the network: download it first"),
        ("delaunay file:///tmp/none.csv", 3, "give its path, without file://"),
        ("tessellate none.csv", 3, "none.csv: there is no such file"),  # that the output is binary does not matter
        ("tessellate two/a.csv", 2, "redirect with -f png, or print text with -f text"),
        ("tessellate two/a.csv --volume", 2, "name a file with -o, or redirect with -f tiff\n"),
        ("voronoi dots.csv --input-crs EPSG:99999 -o a.gpkg", 2, "EPSG:99999"),
        ("voronoi dots.csv --input-crs EPSG:99999 -o a.geojson", 2, "EPSG:99999"),
        ("delaunay dots.csv --crs 25833", 2, "EPSG:25833"),
        ("tessellate two --out-dir out", 2, "two/*.csv"),
        ("completion", 2, "Choose from bash, zsh, fish\n"),
        ("completion bahs", 2, "did you mean bash?"),
        ("alphashape dots.csv --auto -r 3", 2, "-r and --auto"),
        ("delaunay dots.csv -o a.csv2", 2, "did you mean .csv?"),
    ],
)
def test_messages_say_what_helps(run, folder, line, code, says):
    pytest.importorskip("pyproj")
    (folder / "two").mkdir()
    for name in ("two/a.csv", "two/a.tsv"):
        (folder / name).write_text("x,y\n1,2\n3,4\n")
    run(line, code=code, says=says)


def test_a_file_whose_name_begins_like_an_option_is_found(run, folder):
    for name in ("-x.csv", "-d.csv", "-1.csv"):  # no option, one of another command, and a number
        (folder / name).write_text("x,y\n1,2\n3,4\n")
        for command in ("info", "delaunay"):
            run(
                f"{command} {name}",
                code=2,
                says=f"{name} is taken for an option: for the file of this name write ./{name}",
            )
            run(f"{command} ./{name}")
    assert "file" not in run("delaunay -y.csv", code=2).err


@pytest.mark.parametrize("what", ["skeleton", "discs", "necks", "centerline", "table"])
def test_open_lines_are_advised_what_all_results_take(run, folder, what):
    (folder / "a.wkt").write_text("LINESTRING (0 0, 9 0, 9 9)\n")
    said = "open lines have no interior: close them, or use --side exterior for the skeleton around them"
    run(f"skeleton-exact a.wkt --what {what}", says=said)
    (folder / "b.wkt").write_text("POLYGON ((0 0, 9 0, 9 9, 0 0))\n")
    assert "interior" not in run(f"skeleton-exact b.wkt --what {what}").err
