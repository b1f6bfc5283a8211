#!/usr/bin/env bash
# Makes the corpora of all fuzz targets in fuzz/corpus: every shipped file, every past failure, every wrong file of the
# tests. Needs a built linkwear: cargo build --release.
set -euo pipefail
cd "$(dirname "$0")/.."
linkwear=${LINKWEAR:-target/release/linkwear}
corpus=fuzz/corpus

# seed TARGET FILE..: under a name made of the path, so that none hides another.
seed() {
    local target=$1 file
    shift
    mkdir -p "$corpus/$target"
    for file in "$@"; do
        cp "$file" "$corpus/$target/$(tr / _ <<< "${file#./}")"
    done
}

seed mechanism mechanisms/*.toml src/cli/starter.toml tests/data/*.toml $(find codegen/tests/spec_fail -maxdepth 1 -name '*.toml')
seed modal_data $(grep -rl '^format = "linkwear modal data"' --include=*.toml tests codegen/tests)
seed readings $(find examples/data gamma/tests/data -name '*.csv')
for target in mechanism expression readings modal_data fit_file journal; do
    if [ -d "fuzz/regressions/$target" ]; then
        seed "$target" fuzz/regressions/"$target"/*
    fi
done

# Formulas: every text of the shipped files.
mkdir -p "$corpus/expression" "$corpus/fit_file" "$corpus/journal"
at=0
grep -ohE '"[^"]{2,80}"' mechanisms/*.toml codegen/tests/spec_fail/*.toml | sort -u | while read -r text; do
    at=$((at + 1))
    printf '%s' "${text:1:-1}" > "$corpus/expression/text$at"
done

# Readings under the names that the target asks for; fits and a journal by the program.
printf 'unit,wear,exposure\na,0,0\na,1.5,10\na,2.5,20\nb,0,0\nb,2,10\nb,4.5,20\n' > "$corpus/readings/small.csv"
printf 'unit,wear,exposure\na,0.5,1\na,0.5,2\na,1,3\nb,1,1\nb,1,2\nb,2.5,3\n' > "$corpus/readings/rounded.csv"
fit() {
    "$linkwear" fit examples/data/sliding_wear_100g.csv --unit unit --wear wear_um --exposure cycles --from-zero \
        --format json "${@:2}" > "$corpus/fit_file/$1.json"
}
fit gamma
fit power --power-law
fit wiener --process wiener
fit gaussian --process inverse-gaussian
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$linkwear" life mechanisms/rssr.toml --rigid --trajectories 20 --out "$scratch/life" > "$scratch/answer"
cp "$scratch/life/life.journal" "$corpus/journal/"
head -n 5 "$scratch/life/life.journal" > "$corpus/journal/short"
wc -l < <(find "$corpus" -type f)
