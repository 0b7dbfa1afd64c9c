#!/usr/bin/env bash
# Runs mansard over a fixed list of cases and hashes everything it writes, so that two programs can be compared.
# usage: tools/output_hashes.sh [--shapes] MANSARD DATA OUT      (DATA: the folder with mvs_buildings, delft, zhongshan, …)
#
#   tools/output_hashes.sh /path/to/old/mansard DATA out/old
#   tools/output_hashes.sh build/release/bin/mansard DATA out/new
#   diff out/old/hashes.txt out/new/hashes.txt      # same bytes?
#   diff out/old/shapes.txt out/new/shapes.txt      # same buildings, whatever options and sentences say?
#   diff -r out/old/work/out/hall out/new/work/out/hall
#
# OUT/hashes.txt has a line 'sha256  case/file' for every result of every case, for what it printed (stdout, stderr) and for
# its exit code. Timings are taken out first: members called times or seconds, table cells called seconds, columns that end in _s.
# OUT/shapes.txt has a line for every file that describes buildings, scans or measurements: coordinates and numbers alone,
# without attributes, options, versions and sentences. With --shapes only the cases that have any are run, and there is no
# hashes.txt. What is left out of a file: tools/output_hashes.py.
# OUT/seconds.txt has what every case took: elapsed, user and system seconds.
# OUT must not exist, or be from an earlier run; the results stay in OUT/work. Nothing depends on where MANSARD, DATA and
# OUT are: all cases run in OUT/work with relative paths. ONLY='hall*' runs the cases of matching names alone.
# All cases take about 1.5 minutes of CPU time. Ends with 0 whether or not cases fail: their exit codes are hashed, and codes
# above 1 are printed to stderr.
set -euo pipefail
export LC_ALL=C.UTF-8
here=$(cd "$(dirname "$0")" && pwd)
mode=all
if [ "${1:-}" = --shapes ]; then
  mode=shapes
  shift
fi
if [ $# != 3 ]; then
  echo "usage: tools/output_hashes.sh [--shapes] MANSARD DATA OUT" >&2
  exit 2
fi
program=$(realpath "$1") data=$(realpath "$2") only=${ONLY:-*}
if [ -e "$3" ] && [ -n "$(ls -A "$3")" ] && [ ! -d "$3/work/streams" ]; then
  echo "$3: is not empty, and not from an earlier run; give another folder" >&2
  exit 2
fi
rm -rf "$3/work" "$3/hashes.txt" "$3/shapes.txt" "$3/seconds.txt"
mkdir -p "$3/work/streams" "$3/work/out" "$3/work/made"
out=$(realpath "$3")
cd "$out/work"
ln -s "$data" data
ln -s "$program" mansard

# case NAME VERB ARGUMENTS…: runs ./mansard VERB ARGUMENTS…, where @ is the folder of this case, out/NAME.
# `models` is for cases with files that describe buildings, `texts` for all others, which --shapes leaves out.
case_of() {
  local name=$1 code=0 TIMEFORMAT='%R %U %S'
  shift
  # shellcheck disable=SC2053
  [[ $name == $only ]] || return 0
  mkdir -p "out/$name" "streams/$name"
  { time ./mansard "${@//@/out/$name}" >"streams/$name/stdout" 2>"streams/$name/stderr" </dev/null || code=$?; } 2>seconds
  echo "$code" >"streams/$name/exit"
  echo "$(<seconds) $name" >>"$out/seconds.txt"
  [ "$code" -le 1 ] || echo "$name: exit code $code: $(head -c 300 "streams/$name/stderr")" >&2
}
models() { case_of "$@" -j 2 -q; }
texts() { [ $mode = shapes ] || case_of "$@"; }

# Footprints with tags as OpenStreetMap has them, good and bad ones.
jq '.features |= [to_entries[] | .key as $n | .value | .properties += {
    "height": ["12", "9.5 m", null, "39'"'"'4\"", "nonsense", "3;4", 14][$n % 7],
    "building:levels": [3, null, "5", 2.5, -1][$n % 5],
    "min_height": (if $n % 11 == 0 then 3 else null end),
    "roof:shape": ["flat", "gabled", "hipped", "half-hipped", "pyramidal", "skillion", "gambrel", "mansard", "dome",
                   "round", "saltbox", null, "side_hipped"][$n % 13],
    "roof:height": [null, "2", 3.5][$n % 3],
    "roof:angle": (if $n % 4 == 0 then "35" else null end),
    "roof:direction": ["N", "135", null, null, "WSW"][$n % 5],
    "roof:orientation": [null, "across", "along"][$n % 3]}]' data/regent_street/regent_st_200m_local.geojson >made/tags.geojson

mvs=data/mvs_buildings
hall=("$mvs/cgal_building.off" "$mvs/cgal_footprints.geojson")
b9=("$mvs/b9_mesh.off" "$mvs/b9_footprints.geojson")
delft=(data/delft/delft_west_mesh.ply data/delft/delft_west_footprints.geojson --mesh-offset 84800 447400 0)
block_a=(data/sim_rotterdam/block_A_sim_mesh.ply data/sim_rotterdam/block_A_footprints.geojson)
zhongshan=data/zhongshan/zhongshan_A
synthetic=data/textured/synthetic
regent=data/regent_street/regent_st_200m_local.geojson
terrace=(out/terrace-scan/mesh.ply out/terrace-scan/footprints.geojson)

# ---- reconstruct: every format, plain and compressed ----
models hall             reconstruct "${hall[@]}" --formats all --picture --layers -o @
models hall-compressed  reconstruct "${hall[@]}" --formats glb,tiles,stl --write-compress -o @ --report out/hall-compressed.json
models hall-paper       reconstruct "${hall[@]}" --preset paper --layers -o @
models hall-chordatlas  reconstruct "${hall[@]}" --preset chordatlas --layers -o @
models hall-derived     reconstruct "${hall[0]}" --derive-footprints --formats all --layers -o @
models hall-overhang    reconstruct "${hall[@]}" --extrude-overhang 0.5 --seed 3 --formats cityjson,glb,plans -o @
models b9               reconstruct "${b9[@]}" --formats cityjson,plans -o @
models delft            reconstruct "${delft[@]}" --formats all --layers --write-tile-triangles 2000 -o @
models block-a          reconstruct "${block_a[@]}" --layers -o @
models zhongshan-L19    reconstruct "${zhongshan}_L19.ply" "${zhongshan}_footprints.geojson" -o @
models zhongshan-L18    reconstruct "${zhongshan}_L18.ply" "${zhongshan}_footprints.geojson" -o @

# ---- the same scan in every format of meshes ----
for file in houses.obj houses.glb; do
  models "$file" reconstruct "$synthetic/$file" "$synthetic/houses_footprints.geojson" -o @
done
models houses-tiles reconstruct "$synthetic/tiles/tileset.json" "$synthetic/houses_footprints_wgs84.geojson" -o @

# ---- simulate, and what is made of it ----
models terrace-scan     simulate --block terrace --seed 7 --preset oblique-aerial --simulate-size 24 --picture -o @
models detached-scan    simulate --block detached --seed 5 --preset lidar-2.5d --simulate-size 30 -o @
models courtyard-scan   simulate --block courtyard --seed 3 --preset clean --simulate-exact false --resolution 0.6 --simulate-size 30 -o @
models footprints-scan  simulate --footprints "${hall[1]}" --seed 2 --resolution 1 -o @
models plans-scan       simulate out/terrace-scan/plans.json --preset nadir-drone --resolution 0.5 -o @
models model-scan       simulate data/sim_rotterdam/block_A_truth.obj --preset lidar-2.5d --resolution 1.5 -o @
for kind in terrace detached courtyard; do
  models $kind          reconstruct out/$kind-scan/mesh.ply out/$kind-scan/footprints.geojson -o @
  models $kind-measured evaluate out/$kind/model.city.json out/$kind-scan/mesh.ply --truth out/$kind-scan/truth.city.json -o @
done

# ---- extrude ----
models tags             extrude made/tags.geojson --formats all --picture -o @
models regent           extrude $regent --roof-shape hipped --write-compress -o @
models regent-profile   extrude $regent --profile "0,0 0,6 4,9" -o @
models regent-overhang  extrude $regent --roof-shape gabled --extrude-overhang 0.4 --formats cityjson,plans -o @
for town in denhaag/denhaag_subs zurich/zurich_subset; do
  name=${town%%/*}
  models "$name"         extrude "data/${town}_footprints.geojson" --roof-shape half-hipped --crs local -o @
  models "$name-profile" extrude "data/${town}_footprints.geojson" --profile "0,0 0,4 2,8 9,10" --crs local -o @
done
models zurich-cityjson  extrude data/zurich/zurich_subset_lod2.json --roof-shape mansard -o @
models tags-in-a-file   extrude made/tags.geojson -o @/tags.city.jsonl
models hall-plans       extrude out/hall/plans.json -o @
models delft-plans      extrude out/delft/model.glb -o @/again.city.json
models hall-capped      extrude out/hall/model.city.json --extrude-overhang 0.3 -o @/capped.json

# ---- convert: every format to every format ----
every_format=()
for extension in city.json city.jsonl obj glb 3dtiles gpkg stl geojson json; do every_format+=(-o "@/a.$extension"); done
for file in model.city.json model.city.jsonl model.obj model.glb model.3dtiles model.gpkg model.geojson plans.json; do
  models "convert-$file" convert "out/hall/$file" "${every_format[@]}"
done
models convert-compressed convert out/delft/model.gpkg "${every_format[@]}" --write-compress
for shell in part building block; do
  models "shell-$shell" convert out/delft/plans.json -o @/a.stl --write-stl-shell $shell
done

# ---- segment, label, evaluate, explore ----
models hall-segments    segment "${hall[@]}" -o @/why.gpkg --export-mps @/program.mps --report @/why.json
models delft-segments   segment "${delft[@]}" -o @/why.gpkg --export-mps @/program.mps --report @/why.json
models hall-labelled    label "${hall[0]}" out/hall/model.city.json -o @/labelled.ply
models hall-labelled-glb label "${hall[0]}" out/hall/plans.json -o @/labelled.glb
models terrace-labelled label out/terrace-scan/mesh.ply out/terrace/model.glb --truth-mesh out/terrace-scan/mesh.ply -o @/labelled.ply
models block-a-labelled label "${block_a[0]}" out/block-a/model.city.json --truth data/sim_rotterdam/block_A_truth.obj -o @/labelled.ply
models block-a-measured evaluate out/block-a/model.city.json "${block_a[0]}" --footprints "${block_a[1]}" --truth data/sim_rotterdam/block_A_truth.obj -o @
models hall-measured    evaluate out/hall/model.gpkg "${hall[0]}" --footprints "${hall[1]}" -o @/report.json
models truth-measured   evaluate data/sim_rotterdam/block_A_truth.obj "${block_a[0]}" -o @/report.json
models gamma            explore gamma "${terrace[@]}" --grid gamma=20,50 -o @
models quality          explore quality "${terrace[@]}" --grid profile.quality=simple,high -o @
models profiles         explore profiles "${terrace[@]}" -o @ --no-pictures
models grid             explore grid --grid alpha=20,60 --grid segment.gis_edges=ignore,hard "${terrace[@]}" -o @ --no-pictures

# ---- texts ----
texts info-models       info --json out/hall/model.city.json out/hall/model.city.jsonl out/hall/model.obj out/hall/model.glb \
                        out/hall/model.3dtiles out/hall/model.gpkg out/hall/model.stl out/hall/model.geojson out/hall/plans.json
texts info-models-text  info -v out/hall/model.city.json out/delft/model.gpkg out/delft/model.3dtiles out/tags/model.glb
texts info-inputs       info --json "${hall[@]}" "${delft[@]:0:2}" "${block_a[@]}" $synthetic/houses.obj $synthetic/houses.glb \
                        $synthetic/tiles data/textured/campus/tileset.json out/block-a-measured/error.tif out/hall-labelled/labelled.ply
texts info-others       info --json data/zurich/zurich_subset_lod2.json data/denhaag/DH_01_subs.city.json data/sim_rotterdam/block_A_truth.obj
texts info-text         info "${hall[@]}" data/zurich/zurich_subset_lod2.json $synthetic/tiles out/block-a-measured/error.tif
texts options           options
texts options-json      options --json
texts attributes        options --attributes
texts attributes-json   options --attributes --json
texts explain           explain
texts explain-json      explain --json
texts explain-code      explain extrude-prism
texts manual            manual
texts version           --version
texts help              --help
for shell in bash zsh fish; do texts completion-$shell completion $shell; done
for verb in reconstruct segment extrude convert info simulate evaluate label explore serve options explain; do
  texts "help-$verb"    $verb --help
done
for verb in reconstruct segment extrude simulate evaluate explore; do texts "help-all-$verb" $verb --help-all; done

[ $mode = shapes ] || python3 "$here/output_hashes.py" bytes . >"$out/hashes.txt"
python3 "$here/output_hashes.py" shapes . >"$out/shapes.txt"
ls "$out"/{hashes,shapes}.txt 2>/dev/null || true
