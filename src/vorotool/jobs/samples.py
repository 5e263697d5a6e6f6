"""Write the samples that come with the package."""

from __future__ import annotations

import os
from pathlib import Path

from vorotool.errors import OutputError, UsageError
from vorotool.formats.samples import sample
from vorotool.products.formats import EXTENSIONS, FORMATS
from vorotool.products.samples import SAMPLES


def write_sample(name: str, output: str | None) -> None:
    """Write a sample; the bytes are those of the package."""
    from vorotool.formats.io.atomic_output import open_output

    path = sample(name)
    is_binary = not FORMATS[EXTENSIONS[path.suffix]].is_text
    if output is None and is_binary:
        raise UsageError(f"{path.name} is binary: name a file with -o {path.name}")
    with open_output(output or "-", binary=is_binary) as out:
        out.write(path.read_bytes())


def write_all_samples(folder: str) -> None:
    """Write every sample into a folder, which is made if it is missing; never replace a file with other content."""
    from vorotool.formats.io.atomic_output import make_folder
    from vorotool.formats.io.commit import committed_together
    from vorotool.formats.io.descriptors import STANDARD

    if folder == STANDARD:
        raise UsageError("--all writes files: name a folder with -o")
    make_folder(folder)
    targets = {name: Path(folder) / name for name in SAMPLES}
    missing = {name: target for name, target in targets.items() if not _is_written(name, target)}
    with committed_together():
        for name, target in missing.items():
            write_sample(name, str(target))


def _is_written(name: str, target: Path) -> bool:
    """Whether a sample is in its place already; refuse to replace anything else that is there."""
    if not os.path.lexists(target):
        return False
    if target.is_file() and target.read_bytes() == sample(name).read_bytes():
        return True
    raise OutputError(f"{target} exists with other content, which is never replaced: name another folder with -o")
