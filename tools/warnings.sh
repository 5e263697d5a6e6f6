#!/usr/bin/env bash
# Compile the core, its bindings and its tests in C++ with each compiler that is here, where a warning of
# -Wall -Wextra -Wpedantic is an error. Usage: [COMPILERS="g++ clang++-16"] tools/warnings.sh PYTHON
set -euo pipefail
cd "$(dirname "$0")/.."
python=$1
PATH="$(cd "$(dirname "$python")" && pwd):$PATH"
work=build/warnings

found=()
for compiler in ${COMPILERS:-g++ clang++}; do
    if command -v "$compiler" > /dev/null; then found+=("$compiler"); else echo "$compiler is not here"; fi
done
if [ ${#found[@]} -eq 0 ]; then echo "no compiler is here: install g++ or clang" >&2; exit 1; fi

# Give the sources to a compiler, and what it says only if it ends with an error.
build() {
    local folder=$1
    shift
    mkdir -p "$folder"
    { cmake -S "$1" -B "$folder" -G Ninja -DCMAKE_CXX_COMPILER="$2" -DVOROTOOL_WERROR=ON "${@:3}" \
        && cmake --build "$folder"; } > "$folder.log" 2>&1 || { cat "$folder.log"; exit 1; }
}

for compiler in "${found[@]}"; do
    build "$work/$compiler" src "$compiler" -DVOROTOOL_TESTING=ON -DPython_EXECUTABLE="$python"
    "$work/$compiler/tests/core_tests"
    echo "$("$compiler" --version | head -n 1): no warning"
done
