#!/usr/bin/env bash
# Runs tools/setup.sh and tools/demo.sh among stand-ins that write down how they are called.
#   setup_and_demo.sh REPOSITORY CASE
set -euo pipefail
repository=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/bin"
calls=$scratch/calls
: > "$calls"
export PATH=$scratch/bin:$PATH

fail() { echo "$*" >&2; echo "calls were:" >&2; cat "$calls" >&2; exit 1; }
stand_in() {  # name, body
  printf '#!/bin/bash\necho "%s $*" >> "%s"\n%s\n' "$1" "$calls" "$2" > "$scratch/bin/$1"
  chmod +x "$scratch/bin/$1"
}
called() { grep -qE -- "$1" "$calls"; }

# setup: a machine that lacks the packages named, and a user with the id given
machine() {  # user id, missing packages as a regex
  stand_in dpkg-query "[[ \${@: -1} =~ ^($2)\$ ]] && exit 1; echo installed"
  stand_in apt-get ''
  stand_in sudo '"$@"'
  stand_in id "echo $1"
}
setup() { "${1:-$repository}/tools/setup.sh" > "$scratch/stdout" 2> "$scratch/stderr"; }
setup_with() {  # an edit of packages.txt, by sed
  mkdir "$scratch/tools"
  cp "$repository/tools/setup.sh" "$scratch/tools/"
  sed "$1" "$repository/packages.txt" > "$scratch/packages.txt"
  setup "$scratch"
}

# demo: a program that leaves what `reconstruct` leaves and ends with the code given
program() {
  cat > "$scratch/bin/mansard" <<END
#!/bin/bash
echo "mansard \$*" >> "$calls"
out=\$(sed -E 's/.* -o ([^ ]+).*/\\1/' <<< "\$*")
mkdir -p "\$out"
for file in run.json model.city.json picture.png; do echo made > "\$out/\$file"; done
exit $1
END
  chmod +x "$scratch/bin/mansard"
}
demo() { MANSARD=$scratch/bin/mansard RESULTS=$scratch/out "$repository/tools/demo.sh" > "$scratch/stdout"; }

case $2 in
  setup_with_nothing_missing_calls_neither_apt_nor_sudo)
    machine 1000 'nothing'
    setup || fail "setup failed"
    ! called '^(apt-get|sudo)' || fail "nothing was missing"
    ;;
  setup_installs_only_what_is_missing)
    machine 0 'libpng-dev|libgmp-dev'
    setup || fail "setup failed"
    called '^apt-get .*update' || fail "no update"
    called '^apt-get .*install -y --no-install-recommends libgmp-dev libpng-dev$' || fail "not these two"
    ! called '^sudo' || fail "root needs no sudo"
    ;;
  setup_asks_for_root_only_to_install)
    machine 1000 'cmake'
    setup || fail "setup failed"
    called '^sudo .*apt-get .*install .*cmake$' || fail "no sudo"
    ;;
  setup_skips_a_package_whose_command_is_there)
    machine 0 'npm|make'
    stand_in npm ''
    setup || fail "setup failed"
    called '^apt-get .*install -y --no-install-recommends make$' || fail "npm is there already"
    ;;
  setup_installs_a_package_whose_command_is_not_there)
    machine 0 'npm|make'
    setup_with 's/unless:npm/unless:no-such-command/' || fail "setup failed"
    called '^apt-get .*install -y --no-install-recommends make npm$' || fail "not these two"
    ;;
  setup_fails_when_a_line_cannot_be_understood)
    machine 0 'nothing'
    ! setup_with 's/unless:npm/unles:npm/' || fail "the line was swallowed"
    grep -q "npm: 'unles:npm'" "$scratch/stderr" || fail "no word of the line"
    ;;
  setup_fails_when_a_package_cannot_be_installed)
    machine 0 'cmake'
    stand_in apt-get '[[ "$*" != *install* ]]'
    ! setup || fail "the failure was swallowed"
    ;;
  demo_names_a_model_and_a_picture_that_exist)
    program 0
    demo || fail "demo failed"
    for sample in delft hall b9; do
      for file in model.city.json picture.png; do
        grep -q "$scratch/out/$sample/$file" "$scratch/stdout" || fail "no word of $sample/$file"
      done
    done
    [[ $(wc -l < "$calls") -eq 3 ]] || fail "three samples, three runs"
    ;;
  demo_accepts_buildings_that_fell_back)
    program 1
    demo || fail "exit code 1 is no failure"
    ;;
  demo_fails_with_the_code_of_the_program)
    program 3
    code=0
    demo || code=$?
    [[ $code -eq 3 ]] || fail "exit code $code instead of 3"
    ;;
  demo_fails_when_the_program_leaves_nothing)
    stand_in mansard ''
    ! demo 2> "$scratch/stderr" || fail "a path was printed for a file that is not there"
    ;;
  demo_does_not_repeat_itself)
    program 1
    demo
    : > "$calls"
    demo || fail "second demo failed"
    [[ ! -s $calls ]] || fail "all was up to date"
    ;;
  demo_runs_again_when_the_program_is_newer)
    program 0
    demo
    : > "$calls"
    touch -d '+1 minute' "$scratch/bin/mansard"
    demo
    [[ $(wc -l < "$calls") -eq 3 ]] || fail "three samples were out of date"
    ;;
  demo_runs_again_when_a_picture_is_gone)
    program 0
    demo
    : > "$calls"
    rm "$scratch/out/b9/picture.png"
    demo
    called 'data/b9/' && [[ $(wc -l < "$calls") -eq 1 ]] || fail "one sample was incomplete"
    ;;
  *)
    fail "no such case: $2"
    ;;
esac
