#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# docs/demo.sh FOLDER: what kompono does, in four parts, on the layouts and measurements of this repository. Needs kompono
# on the PATH and runs from the repository's root; everything it writes goes to FOLDER. ./dev demo calls it.
set -euo pipefail
out=$1
mkdir -p "$out"
rm -f "$out"/*

if [[ -t 1 && -z ${NO_COLOR:-} ]]; then bold=$'\e[1m' dim=$'\e[2m' plain=$'\e[0m'; else bold='' dim='' plain=''; fi

part() { printf '\n%s%s%s\n' "$bold" "$*" "$plain"; }
note() { printf '\n'; printf '%s\n' "$@"; }

# run WORD...: prints the command as one would type it, then runs it.
run() {
  local word line='$'
  for word in "$@"; do
    if [[ $word =~ ^[A-Za-z0-9_./=,:+-]+$ ]]; then
      line+=" $word"
    elif [[ $word == *\'* ]]; then
      line+=" \"$word\""
    else
      line+=" '$word'"
    fi
  done
  printf '\n%s%s%s\n' "$dim" "$line" "$plain"
  "$@"
}

part '1. A layout file is a machine'
note 'The table-top pyramid of the KSM paper: three glides on inclined rails, parallelogram struts.'
run kompono describe layouts/machines/ksm_pyramid.toml
note 'Where must the carriages stand for a tool pose?'
run kompono solve layouts/machines/ksm_pyramid.toml --pose X=20,Y=-15,Z=10
note 'The same geometry as a formula for a controller; drive 1 is the one the paper prints.'
run kompono export layouts/machines/ksm_pyramid.toml --to formula --drive struts.q1

part '2. A real printer, calibrated from its own probe'
note 'Klipper probed an FLSUN V400 at seven places and its owner measured twelve distances. kompono fits the same nine numbers;' \
  "'published' is what Klipper's solver found from the same data."
run kompono calibrate layouts/machines/flsun_v400.toml layouts/measurements/klipper_delta/fzechert_01.csv \
  --published layouts/measurements/klipper_delta/fzechert_01.json \
  -o "$out/flsun_v400_calibrated.toml" --report "$out/flsun_v400.json"

part '3. An open base: two foundations coupled only electronically'
note 'A water-jet machine after SO: a lambda mechanism moves the sheet, the jet head stands on a foundation of its own. The true' \
  'machine has the errors SO names: the foundations are not where the drawing has them, links are off by hundredths, the jet' \
  'leaves the head beside its axis. It cuts 60 holes whose places are measured with 0.02 mm of noise; 40 more, without noise,' \
  'only judge the result. SO gives 0.75 to 0.82 mm before identification.'
run kompono measure layouts/machines/so_waterjet_lambda.toml --true layouts/measurements/so_waterjet_true.toml \
  --points 100 --held-out 0.4 --held-out-exact --components xy --region Z=0:0 --sigma-mm 0.02 --seed 2 -o "$out/holes.csv"
run kompono calibrate layouts/machines/so_waterjet_lambda.toml "$out/holes.csv" \
  -o "$out/so_waterjet_calibrated.toml" --report "$out/so_waterjet.json"

part '4. The catalog remembers'
run kompono catalog add "$out/machines.db" layouts/machines/ksm_pyramid.toml
run kompono catalog add "$out/machines.db" "$out/flsun_v400_calibrated.toml" --report "$out/flsun_v400.json"
run kompono catalog add "$out/machines.db" "$out/so_waterjet_calibrated.toml" --report "$out/so_waterjet.json"
note 'Which machines have an open base and a residual below 0.1 mm?'
run kompono catalog query "$out/machines.db" "base = 'open' and rms_after_um < 100"
note 'How much did each calibration gain?'
run kompono catalog query "$out/machines.db" 'calibrations > 0' \
  --columns 'name, formula, rms_before_um, rms_after_um, rms_before_um / rms_after_um as gain' --sort 'gain desc'

note "The files are in $out."
