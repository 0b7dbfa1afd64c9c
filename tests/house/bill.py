#!/usr/bin/env python3
"""Checks the software bill of materials of what was built: bill.py REPOSITORY BUILD SCRATCH

That it lists exactly the dependencies of docs/dependencies.md and the libraries of the programs is looked up here in another
way than tools/sbom.py does. Then it is shown that a bill is refused where the three sources disagree."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

repository, build, scratch = (pathlib.Path(path).resolve() for path in sys.argv[1:4])
shutil.rmtree(scratch, ignore_errors=True)
scratch.mkdir(parents=True)
environment = {**os.environ, "SOURCE_DATE_EPOCH": "1700000000"}
wrong = []


def check(right, words):
    if not right:
        wrong.append(words)


def made(root, out):
    return subprocess.run([sys.executable, root / "tools/sbom.py", out, "--build", build, "--commit", "0" * 40, "--licences",
                           scratch / "licences", "--", repository / "LICENSE"], env=environment, capture_output=True, text=True, check=False)


done = made(repository, scratch / "a.json")
if done.returncode != 0:
    sys.exit(done.stderr)
bill = json.loads((scratch / "a.json").read_text(encoding="utf-8"))
made(repository, scratch / "b.json")
check((scratch / "a.json").read_bytes() == (scratch / "b.json").read_bytes(), "two runs give two bills")

# The programs: what the dynamic loader would look for.
linked = set()
for binary in [build / "bin/mansard", build / "bin/mansard-reader", *build.glob("python/mansard/_core*.so")]:
    said = subprocess.run(["readelf", "-d", binary], capture_output=True, text=True, check=True).stdout
    linked |= set(re.findall(r"\(NEEDED\).*\[(.*)\]", said))
told = {name for package in bill["packages"] for name in re.findall(r"\S+\.so\S*", package.get("sourceInfo", ""))}
check(linked == told, f"linked and not listed: {linked - told}; listed and not linked: {told - linked}")
check(len(linked) > 15, f"only {len(linked)} libraries are linked")

# The tables: from the heading to the next one, whatever has a package of Debian in its first cell.
text = (repository / "docs/dependencies.md").read_text(encoding="utf-8")
tables = {}
for part in text.split("\n## ")[1:]:
    tables[part.split("\n")[0]] = re.findall(r"^\| `([a-z0-9.+-]+)`", part, re.M)
rows = set(tables["Libraries"]) | set(tables["The Python package"])
of_rows = {row for package in bill["packages"] for row in re.findall(r"row (\S+) of", package.get("sourceInfo", ""))}
check(rows == of_rows, f"rows without a package: {rows - of_rows}; packages without a row: {of_rows - rows}")

# What npm would install for those that use the page, and the decoder of LAZ.
inside = set()
for lock in ("apps/workbench/package-lock.json", "cmake/laz/package-lock.json"):
    for path, package in json.loads((repository / lock).read_text(encoding="utf-8"))["packages"].items():
        if path and not package.get("dev") and not package.get("optional"):
            inside.add((path.removeprefix("node_modules/"), package["version"]))
listed = {(p["name"], p["versionInfo"]) for p in bill["packages"] if any("pkg:npm" in r["referenceLocator"] for r in p.get("externalRefs", []))}
check(inside == listed, f"npm: {inside ^ listed}")

# A licence and its text for each, and notices of what is inside the packages.
copyright = (repository / "packaging/copyright").read_text(encoding="utf-8")
static = {r["relatedSpdxElement"] for r in bill["relationships"] if r["relationshipType"] == "STATIC_LINK"}
for package in bill["packages"]:
    name = package["name"]
    check(re.fullmatch(r"[A-Za-z0-9.()+ -]+", package["licenseDeclared"]), f"{name}: no licence")
    if "externalRefs" in package:
        file = scratch / "licences" / name.replace("/", "-").lstrip("@")
        check(file.exists() and file.stat().st_size > 200, f"{name}: no text of its licence")
    if package["SPDXID"] in static or (name, package["versionInfo"]) in listed:
        check(name in copyright, f"packaging/copyright does not name {name}")

# What SPDX 2.3 demands.
ids = [package["SPDXID"] for package in bill["packages"]] + [bill["SPDXID"]]
check(len(ids) == len(set(ids)) and all(re.fullmatch(r"SPDXRef-[A-Za-z0-9.-]+", one) for one in ids), "identifiers")
for relation in bill["relationships"]:
    check({relation["spdxElementId"], relation["relatedSpdxElement"]} <= set(ids), f"{relation} leads nowhere")
check(bill["spdxVersion"] == "SPDX-2.3" and bill["dataLicense"] == "CC0-1.0", "head of the bill")
check(bill["creationInfo"]["created"] == "2023-11-14T22:13:20Z", "the date is not that of the release")

# Where the sources disagree there is no bill.
copy = scratch / "copy"
for file in ("docs/dependencies.md", "apps/workbench/package.json", "apps/workbench/package-lock.json", "cmake/laz/package-lock.json",
             "CMakeLists.txt", "LICENSE", "NOTICE", "packaging/copyright", "tools/sbom.py"):
    (copy / file).parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(repository / file, copy / file)
planted = [(r"\| `libgeos-dev`.*\n", "", "docs/dependencies.md has no row for it"),
           (r"(\| `libgeos-dev`)", r"| `liblapack-dev` | x | MIT | x | x |\n\1", "lists liblapack-dev, and it is neither linked"),
           (r"(\| `libgeos-dev`)", r"| `libnothing-dev` | x | MIT | x | x |\n\1", "libnothing-dev"),
           (r"\| preact [0-9.]+", "| preact 1.0.0", "docs/dependencies.md lists"),
           (r"\| three .*\n", "", "docs/dependencies.md lists")]
for pattern, instead, words in planted:
    changed, times = re.subn(pattern, instead, text)
    check(times == 1, f"{pattern} occurs {times} times")
    (copy / "docs/dependencies.md").write_text(changed, encoding="utf-8")
    (scratch / "c.json").unlink(missing_ok=True)
    refused = made(copy, scratch / "c.json")
    check(refused.returncode != 0 and words in refused.stderr and not (scratch / "c.json").exists(),
          f"{pattern} was not refused: {refused.stderr}")
for words in wrong:
    print(words)
if wrong:
    sys.exit(1)
print(f"{len(bill['packages'])} packages, {len(linked)} linked libraries")
shutil.rmtree(scratch)
