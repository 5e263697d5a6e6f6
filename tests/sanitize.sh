#!/usr/bin/env bash
# Build the core with address and undefined-behaviour sanitizers and run the tests that reach it.
# Usage: tests/sanitize.sh PYTHON [pytest arguments]
set -euo pipefail
cd "$(dirname "$0")/.."
python=$1; shift
work=build/sanitize
packages=$("$python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')

# An environment of its own that sees the libraries of the first, but not its vorotool.
if [ ! -x "$work/venv/bin/python" ]; then
    "$python" -m venv --without-pip "$work/venv"
    "$work/venv/bin/python" -c 'import pathlib, sys, sysconfig
pathlib.Path(sysconfig.get_path("purelib"), "libraries.pth").write_text(sys.argv[1] + "\n")' "$packages"
fi
"$work/venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-build-isolation --no-deps \
    --force-reinstall -C cmake.define.VOROTOOL_SANITIZE=ON -C build-dir="$work/build" . 2> "$work/install.log" \
    || { cat "$work/install.log"; exit 1; }

# Python itself is not instrumented: its leaks are not ours, and the runtime has to be loaded first.
compiler=${CXX:-g++}
export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1
LD_PRELOAD="$("$compiler" -print-file-name=libasan.so) $("$compiler" -print-file-name=libstdc++.so)" \
    "$work/venv/bin/python" -m pytest -q -p no:cacheprovider tests/core tests/engines tests/formats "$@"
