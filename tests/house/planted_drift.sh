#!/usr/bin/env bash
# Plants one disagreement at a time in a copy of the docs, and wants the site's build to name it.
#   planted_drift.sh REPOSITORY MANSARD WORK SCRATCH     WORK: where tools/site.sh has installed what it needs
set -euo pipefail
repository=$1 mansard=$2 work=$3 scratch=$4
rm -rf "$scratch"
mkdir -p "$scratch"

# What the build reads, without what git ignores; large files are linked.
copy() {
  rm -rf "$scratch/tree"
  mkdir -p "$scratch/tree"
  for name in "$repository"/* "$repository/.ci" "$repository/.github"; do
    case $(basename "$name") in
      build* | out) ;;
      docs | mansard) cp -r "$name" "$scratch/tree/" ;;
      *) ln -s "$name" "$scratch/tree/" ;;
    esac
  done
}
refuses() {  # what must be said
  if node "$work/build.mjs" "$scratch/tree" "$mansard" "$scratch/site" > "$scratch/said" 2>&1; then
    echo "the site was built though: $1" >&2
    exit 1
  fi
  grep -qF -- "$1" "$scratch/said" || { echo "not said: $1" >&2; cat "$scratch/said" >&2; exit 1; }
  [[ ! -e $scratch/site ]] || { echo "half a site was left" >&2; exit 1; }
}
plant() {  # file, text, what must be said
  cp "$scratch/tree/$1" "$scratch/kept"
  printf '\n%s\n' "$2" >> "$scratch/tree/$1"
  refuses "$1: $3"
  cp "$scratch/kept" "$scratch/tree/$1"
}

copy
plant docs/cli.md 'Try `--no-such-option`.' 'the option --no-such-option does not exist in the program'
plant docs/cli.md '`mansard segment a.obj b.json --picture`' 'mansard segment has no option --picture'
plant docs/cli.md $'```sh\nmansard rebuild a.obj b.json\n```' 'mansard rebuild: there is no such verb'
plant docs/sweep.md 'Turn `sweep.gama`.' 'the option sweep.gama does not exist in the program'
plant docs/sweep.md $'| option | default | |\n|---|---|---|\n| `gamma` | 11 m² | |' \
  'gamma is 11 m² there and 10 in the program'
plant docs/sweep.md $'| option | default | |\n|---|---|---|\n| `delta` | 11 m² | |' 'the table of options names delta'
plant docs/solver.md 'Gives up with `solver-tired`.' 'the code solver-tired does not exist in the program'
plant docs/solver.md 'Held by `Solver.never_errs`.' 'there is no test Solver.never_errs'
plant docs/solver.md 'Held by `Solver.never_errs_…`.' 'there is no test Solver.never_errs_'
plant docs/formats.md 'Parts have `ms_colour`.' 'the attribute ms_colour does not exist in the program'
plant docs/formats.md 'See [there](nowhere.md).' 'the link nowhere.md leads nowhere'
plant docs/formats.md 'See [there](cli.md#no-such-section).' 'the link cli.md#no-such-section leads to no section'
plant docs/formats.md '![A picture](pictures/none.png)' 'the link pictures/none.png leads nowhere'
plant docs/cli.md $'| exit code | when |\n|---|---|\n| 0 | all done |' 'the exit codes are'

# In the sources, and of pages as a whole.
echo 'const char* planted = "ms_planted";' > "$scratch/tree/mansard/formats/planted.cpp"
refuses 'mansard/formats/planted.cpp: the attribute ms_planted is not in the list'
rm "$scratch/tree/mansard/formats/planted.cpp"
mkdir "$scratch/tree/docs/attic"
echo '# A page in no menu' > "$scratch/tree/docs/attic/old.md"
refuses 'docs/attic/old.md: is no page of the site'
rm -r "$scratch/tree/docs/attic"
mv "$scratch/tree/docs/rays.md" "$scratch/rays.md"
refuses 'docs/rays.md: every module has a page'
for part in picture guarantees cost references; do
  case $part in
    picture) sed '/^!\[/d' "$scratch/rays.md" ;;
    guarantees) sed '/^## Guarantees/d' "$scratch/rays.md" ;;
    cost) sed 's/^Cost: /It takes /' "$scratch/rays.md" ;;
    references) sed 's/^References: /See /' "$scratch/rays.md" ;;
  esac > "$scratch/tree/docs/rays.md"
  needs="its $part"
  [[ $part != picture ]] || needs='a picture'
  refuses "docs/rays.md: a module's page needs $needs"
done
cp "$repository/docs/rays.md" "$scratch/tree/docs/rays.md"

# A page that the search must find no longer has the words.
sed -i -E 's/Debian/Fedora/g; s/[Pp]ackag(e|es|ed|ing)\b/bundle/g' "$scratch/tree/docs/packaging.md"
refuses "search: 'Debian package' does not find docs/packaging.html"
rm -rf "$scratch"
