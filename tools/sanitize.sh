#!/usr/bin/env bash
# Build the core, its tests in C++ and its bindings with address and undefined-behaviour sanitizers, and run the suite
# on them; before that, the tests in C++ with the sanitizer of threads; then, for MINUTES of the environment, damaged
# files (tests/fuzz/bytes.py).
# Usage: [MINUTES=5] tools/sanitize.sh PYTHON [pytest arguments]
set -euo pipefail
cd "$(dirname "$0")/.."
python=$1; shift
work=build/sanitize

# What cannot run so, and why.
left_out=(
    # The sanitizer keeps memory that was freed, and more around what is not: peaks are its own.
    --deselect tests/cli/scenarios/test_zarr.py::test_memory_is_that_of_a_row_of_chunks
    # A browser does not start with the sanitizer's allocator, and shows pages without the core.
    --deselect tests/render/pages/test_alpha_html.py::test_the_page_counts_what_the_library_does
    --deselect tests/render/pages/test_alpha_html.py::test_the_page_is_drawn
    --deselect tests/render/pages/test_alpha_html.py::test_the_buttons_and_the_slider_move_r
    --deselect tests/render/pages/test_space_html.py::test_the_page_counts_what_the_library_does
    --deselect tests/render/pages/test_space_html.py::test_the_page_is_drawn
    --deselect tests/render/pages/test_space_html.py::test_a_triangulation_is_shown
    --deselect tests/render/pages/test_space_html.py::test_without_webgl_the_page_says_so
    --deselect tests/render/pages/test_space_html.py::test_keys_the_wheel_and_fingers_move_the_view
    # groff is C++ as well, and frees memory by another name than it was taken.
    --deselect tests/documents/test_blocks.py::test_the_manual_pages_are_read_without_warnings
)

# An environment of its own that sees the libraries of the first, but not its vorotool.
if [ ! -x "$work/venv/bin/python" ]; then
    "$python" -m venv --without-pip "$work/venv"
    "$python" -c 'import sys; print(*(path for path in sys.path if path.endswith("site-packages")), sep="\n")' \
        > "$("$work/venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')/libraries.pth"
fi
install() {
    "$work/venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-build-isolation --no-deps \
        --force-reinstall -C install.strip=false -C cmake.define.VOROTOOL_SANITIZE="$1" \
        -C cmake.define.VOROTOOL_TESTING=ON -C build-dir="$work/build-${1%,*}" . 2> "$work/install.log" \
        || { cat "$work/install.log"; exit 1; }
}
install thread
TSAN_OPTIONS=halt_on_error=1 "$("$work/venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')"/vorotool/core_tests
install address,undefined

# Python itself is not instrumented: its leaks are not ours, and the runtime has to be loaded first, in the processes
# that tests start as well. A report ends a process: a test whose process ended so fails. More memory than there is, is
# refused as without the sanitizer.
compiler=${CXX:-g++}
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1${ASAN_OPTIONS:+:$ASAN_OPTIONS}
export UBSAN_OPTIONS=print_stacktrace=1
export PATH="$PWD/$work/venv/bin:$PATH"
sanitized() {
    LD_PRELOAD="$("$compiler" -print-file-name=libasan.so) $("$compiler" -print-file-name=libstdc++.so)" \
        "$work/venv/bin/python" "$@"
}

if [ $# -eq 0 ]; then
    set -- tests "${left_out[@]}"
    if "$work/venv/bin/python" -c 'import xdist' 2> /dev/null; then set -- -n "$(nproc)" "$@"; fi
fi
sanitized -m pytest -q -p no:cacheprovider "$@"

if [ -n "${MINUTES:-}" ]; then
    # The workers of the fuzzer say nothing: reports go to files.
    rm -f "$work"/report.*
    ASAN_OPTIONS="$ASAN_OPTIONS:log_path=$PWD/$work/report" UBSAN_OPTIONS="$UBSAN_OPTIONS:log_path=$PWD/$work/report" \
        sanitized tests/fuzz/run.py bytes --minutes "$MINUTES" --seed "${SEED:-1}" --workers "$(nproc)" \
        || { cat "$work"/report.* 2> /dev/null; exit 1; }
fi
