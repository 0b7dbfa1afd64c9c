#!/usr/bin/env bash
# Plants words that texts should not have, and wants each to be named with its line, and nothing else.
#   planted_words.sh REPOSITORY SCRATCH
set -euo pipefail
repository=$1 scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch"
words() { node "$repository/tests/house/words.mjs" "$repository/tests/house/words.txt" "$@"; }
wants() {  # file, what must be said of it
  if words "$1" > "$scratch/said" 2>&1; then
    echo "accepted: $(cat "$1")" >&2
    exit 1
  fi
  grep -qF -- "$2" "$scratch/said" || { echo "not said: $2" >&2; cat "$scratch/said" >&2; exit 1; }
}

printf 'One line.\nThe room ingest reads files.\n' > "$scratch/word.md"
wants "$scratch/word.md" "word.md:2: 'room': say module"
printf 'Models are held\nagainst the mesh.\n' > "$scratch/over_two_lines.md"
wants "$scratch/over_two_lines.md" "over_two_lines.md:1: 'held against': say compare with"
printf 'The file may be packed.\n' > "$scratch/strings.txt"
wants "$scratch/strings.txt" "strings.txt:1: 'packed': say compressed"
printf '`room` and [a page](rooms/door.md).\n\n```sh\nroom packed\n```\n\nTwo plant rooms.\n' > "$scratch/code.md"
words "$scratch/code.md"
if words > /dev/null 2>&1; then echo "no files were accepted" >&2; exit 1; fi
rm -rf "$scratch"
