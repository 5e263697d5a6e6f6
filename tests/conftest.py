"""Hypothesis draws the same cases in every run of the suite; HYPOTHESIS_PROFILE=search draws new ones.

What it keeps is in build/, as all else that tests write.

Where byte code is not to be written, every one of the many processes that tests start would compile all anew.

A suite that is started in the background may ignore signals that the tests send to the processes they start, and these
would inherit that.
"""

import os
import sys
from pathlib import Path

from hypothesis import settings

from support.processes.heard_signals import hear_signals

sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
os.environ.setdefault("HYPOTHESIS_STORAGE_DIRECTORY", str(Path(__file__).parents[1] / "build/hypothesis"))
settings.register_profile("steady", derandomize=True, deadline=None, max_examples=30)
settings.register_profile("search", deadline=None, max_examples=2000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "steady"))

hear_signals()
