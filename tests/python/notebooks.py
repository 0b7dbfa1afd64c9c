"""Runs the code of notebooks from top to bottom, as Jupyter would, without Jupyter: notebooks.py NOTEBOOK…"""

import json
import os
import pathlib
import sys
import tempfile

os.environ.setdefault("MPLBACKEND", "Agg")
root = pathlib.Path(__file__).resolve().parents[2]
for name in sys.argv[1:]:
    notebook = json.loads(pathlib.Path(name).read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        os.symlink(root / "data", "data")
        scope = {"__name__": "__main__"}
        for number, cell in enumerate(notebook["cells"], 1):
            if cell["cell_type"] == "code":
                exec(compile("".join(cell["source"]), f"{name}, cell {number}", "exec"), scope)
        os.chdir(root)
    print(name, "runs")
