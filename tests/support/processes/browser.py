"""Pages in a real browser where there is one."""

import shutil
import subprocess

import pytest

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
needs_browser = pytest.mark.skipif(
    BROWSER is None, reason="no chromium: the page is not shown (apt-get install chromium)"
)


def browse(*arguments):
    """Run the browser without a network."""
    options = ("--headless", "--no-sandbox", "--disable-gpu", "--host-resolver-rules=MAP * ~NOTFOUND")
    return subprocess.run(
        [BROWSER, *options, "--virtual-time-budget=5000", *arguments], capture_output=True, check=True, timeout=120
    ).stdout.decode()
