"""What val3dity finds in a CityJSON file, for the tools beside this one."""
import json
import subprocess


def check(program, model, report):
    """The report of the program on a model: written to a file, and returned."""
    subprocess.run([program, model, "--report", report], stdout=subprocess.DEVNULL, check=False)
    return json.loads(report.read_text(encoding="utf-8"))


def errors_of(found):
    """A line for each error of a report."""
    return ([f'val3dity: {f["id"]}: {e["code"]}' for f in found["features"] for e in
             f.get("errors", []) + [e for p in f.get("primitives", []) for e in p["errors"]]] +
            [f'val3dity: {e["code"]} of the file' for e in found.get("dataset_errors", [])])
