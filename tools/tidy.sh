#!/usr/bin/env bash
# clang-tidy of the core, or of the files named: tools/tidy.sh [FILE...]
set -euo pipefail
cd "$(dirname "$0")/.."
tidy=(.venv/bin/clang-tidy --quiet --extra-arg=-std=c++20 --extra-arg=-Isrc)
if [ "$(uname -m)" = x86_64 ]; then
    for set in avx2 avx512f avx512dq avx512vl avx512bw; do tidy+=("--extra-arg=-m$set"); done
fi
if [ $# -eq 0 ]; then mapfile -t files < <(find src/core -name '*.cpp'); else files=("$@"); fi
printf '%s\0' "${files[@]}" | xargs -0 -I FILE -P "$(nproc)" "${tidy[@]}" FILE --
