"""Which parameters change nothing: `mansard explore sensitivity` by elimination. On each data set of a list only those parameters are
halved and doubled that changed no model on the sets before, so that the list should begin with what is quick.
usage: tools/sensitivity.py MANSARD LIST DATA OUT [MODULE...]
LIST is as tools/datasets.toml, DATA the folder of its paths. What is left after a set is in OUT/left-NAME.txt; a run that was stopped goes on
with the same command. A parameter with which the program crashes is named, and not tried again. Runs have one thread: put
`nice` before it.
"""
import csv
import json
import pathlib
import subprocess
import sys
import tomllib

MODULES = "block slice sweep fracture segment profile extrude refine label pipeline vegetation".split()


def written(dataset):
    """One data set as a list of its own."""
    lines = ["[[dataset]]"]
    for key, value in dataset.items():
        if isinstance(value, dict):
            value = "{ " + ", ".join(f'"{k}" = {json.dumps(v)}' for k, v in value.items()) + " }"
        else:
            value = json.dumps(value)
        lines.append(f"{key} = {value}")
    return "\n".join(lines) + "\n"


def trials(runs, name):
    """(parameter, models) of every run on a data set; those that failed have no models."""
    if not runs.exists():
        return []
    rows = [row for row in csv.reader(runs.open()) if len(row) >= 10 and row[0] == name]
    return [(row[1], row[-2] if not row[-1] else "") for row in rows]


def run(program, listing, data, folder, name, left, order):
    """Halves and doubles all of `left`; gives those that crashed the program."""
    crashed = []
    while True:
        asked = [key for key in left if key not in crashed]
        command = [program, "explore", "sensitivity", "--parameters", ",".join(asked), "--datasets", listing, "--data", data]
        code = subprocess.run([*command, "-o", folder, "--overwrite", "-j", "1", "-q"], stdout=subprocess.DEVNULL).returncode
        if code > 1:
            sys.exit(code)
        if code >= 0:
            return crashed
        # Runs are in the order of the options: it was the last parameter that has runs, or the next one.
        seen = {key for key, _ in trials(folder / "runs.csv", name)}
        last = max((order.index(key) for key in seen if key), default=-1)
        near = [key for key in order[max(last, 0) : last + 2] if key in asked]
        print(f"{name}: the program crashed with {' or '.join(near)}", flush=True)
        crashed += near


def main():
    program, listing, data = sys.argv[1:4]
    out = pathlib.Path(sys.argv[4])
    modules = sys.argv[5:] or MODULES
    options = json.loads(subprocess.check_output([program, "options", "--all", "--json"]))["options"]
    kinds = ("number", "integer", "flag", "choice")
    left = [f"{o['module']}.{o['name']}" for o in options if o["module"] in modules and o["kind"] in kinds and o["default"]]
    order = list(left)
    print(f"{len(left)} parameters")
    for dataset in tomllib.load(open(listing, "rb"))["dataset"]:
        name = dataset["name"]
        folder = out / name
        folder.mkdir(parents=True, exist_ok=True)
        (out / f"{name}.toml").write_text(written(dataset))
        crashed = run(program, str(out / f"{name}.toml"), data, folder, name, left, order)
        done = trials(folder / "runs.csv", name)
        usual = next(models for key, models in done if not key)
        changed = {key for key, models in done if key and models != usual} | set(crashed)
        left = [key for key in left if key not in changed]
        (out / f"left-{name}.txt").write_text("".join(key + "\n" for key in left))
        print(f"{name}: {len(changed - set(crashed))} change models, {len(left)} did not on any set so far", flush=True)


main()
