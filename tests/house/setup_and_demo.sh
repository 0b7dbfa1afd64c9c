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
  mkdir -p "$(dirname "$scratch/bin/$1")"
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
setup() { "$repository/tools/setup.sh" "$@" > "$scratch/stdout" 2> "$scratch/stderr"; }
setup_with() {  # an edit of packages.txt, by sed; purposes
  sed "$1" "$repository/packages.txt" > "$scratch/packages.txt"
  setup --list "$scratch/packages.txt" "${@:2}"
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

# the Makefile: in a folder of its own, with stand-ins for all that it calls
makefile() {
  cp "$repository/Makefile" "$scratch/"
  mkdir "$scratch/tools"
  for tool in setup demo; do
    stand_in "tools/$tool.sh" ''
    mv "$scratch/bin/tools/$tool.sh" "$scratch/tools/"
  done
  stand_in cmake ''
  stand_in ctest ''
}
called_make() { (cd "$scratch" && JOBS=1 make "$1") > "$scratch/stdout" 2>&1; }

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
  setup_installs_only_what_the_purposes_need)
    machine 0 'chromium|libcgal-dev|libpng-dev|libbenchmark-dev'
    setup build || fail "setup failed"
    called '^apt-get .*install -y --no-install-recommends libpng-dev$' || fail "[build] has libpng-dev and not the others"
    : > "$calls"
    setup build bench || fail "setup failed"
    called '^apt-get .*install .* libpng-dev libbenchmark-dev libcgal-dev$' || fail "not what [build] and [bench] need"
    ;;
  setup_installs_a_package_of_two_purposes_once)
    machine 0 'libcgal-dev'
    setup test bench || fail "setup failed"
    called '^apt-get .*install -y --no-install-recommends libcgal-dev$' || fail "not once"
    ;;
  setup_fails_when_a_purpose_is_unknown)
    machine 0 'make'
    ! setup build biuld || fail "the purpose was ignored"
    grep -q 'no section \[biuld\]; it has: build test' "$scratch/stderr" || fail "the error does not list the purposes"
    ! called '^apt-get' || fail "installed nevertheless"
    ;;
  setup_takes_a_list_without_sections)
    machine 0 'left-pad'
    printf 'left-pad  # for a test\n' > "$scratch/list"
    setup --list "$scratch/list" || fail "setup failed"
    called '^apt-get .*install .*left-pad$' || fail "not installed"
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
  make_demo_installs_and_configures_nothing_for_tests)
    makefile
    called_make demo || fail "make demo failed"
    called '^tools/setup.sh build$' || fail "not the packages of [build] alone"
    called '^cmake --preset release -DMANSARD_TESTS=OFF' || fail "configured with tests"
    called '^cmake --build --preset release --target mansard' || fail "not built"
    called '^tools/demo.sh' || fail "no demo"
    ;;
  make_demo_keeps_the_tests_that_make_test_configured)
    makefile
    mkdir -p "$scratch/build/release/tests"
    touch "$scratch/build/release/tests/CTestTestfile.cmake"
    called_make demo || fail "make demo failed"
    called '^cmake --preset release -DMANSARD_TESTS=ON' || fail "configured without tests"
    ;;
  make_compiles_folders_as_units_in_a_new_folder_only)
    for target in demo test; do
      makefile
      called_make $target || fail "make $target failed"
      called '^cmake --preset release .*-DMANSARD_UNITY=ON' || fail "make $target: one by one in a new folder"
      mkdir -p "$scratch/build/release"
      touch "$scratch/build/release/CMakeCache.txt"
      : > "$scratch/calls"
      called_make $target || fail "make $target failed"
      ! called 'MANSARD_UNITY' || fail "make $target: a folder that was configured is configured otherwise"
      rm -r "$scratch/build" "$scratch/tools"
    done
    ;;
  make_test_installs_configures_and_builds_all)
    makefile
    called_make test || fail "make test failed"
    called '^tools/setup.sh build test package$' || fail "not the packages of tests too"
    ! called 'MANSARD_TESTS=OFF' || fail "configured without tests"
    called '^cmake --build --preset release -j 1$' || fail "not all was built"
    called '^ctest --preset release --no-tests=error' || fail "no tests, or none would pass"
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
