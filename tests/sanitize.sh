#!/usr/bin/env bash
# Build the core and its bindings with address and undefined-behaviour sanitizers, and run the suite on them.
# Usage: tests/sanitize.sh PYTHON [pytest arguments]
set -euo pipefail
cd "$(dirname "$0")/.."
python=$1; shift
work=build/sanitize

# An environment of its own that sees the libraries of the first, but not its vorotool.
if [ ! -x "$work/venv/bin/python" ]; then
    "$python" -m venv --without-pip "$work/venv"
    "$python" -c 'import sys; print(*(path for path in sys.path if path.endswith("site-packages")), sep="\n")' \
        > "$("$work/venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/libraries.pth"
fi
"$work/venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-build-isolation --no-deps \
    --force-reinstall -C cmake.define.VOROTOOL_SANITIZE=ON \
    -C build-dir="$work/build" . 2> "$work/install.log" || { cat "$work/install.log"; exit 1; }

# Python itself is not instrumented: its leaks are not ours, and the runtime has to be loaded first, in the processes
# that tests start as well. A report ends a process: a test whose process ended so fails.
compiler=${CXX:-g++}
export ASAN_OPTIONS=detect_leaks=0${ASAN_OPTIONS:+:$ASAN_OPTIONS} UBSAN_OPTIONS=print_stacktrace=1
export PATH="$PWD/$work/venv/bin:$PATH"
if [ $# -eq 0 ]; then set -- tests; fi
LD_PRELOAD="$("$compiler" -print-file-name=libasan.so) $("$compiler" -print-file-name=libstdc++.so)" \
    "$work/venv/bin/python" -m pytest -q -p no:cacheprovider "$@"
