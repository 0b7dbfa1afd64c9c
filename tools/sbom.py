#!/usr/bin/env python3
"""Writes the software bill of materials of a release, as SPDX 2.3 JSON: docs/packaging.md, "A release".
usage: tools/sbom.py OUT.spdx.json --build FOLDER --commit COMMIT [--licences FOLDER] [-- RELEASED_FILE…]
--build: where the programs and the Python package were built, by ninja. RELEASED_FILE: files that are released; their hashes
are listed. --licences: also write the licence texts of everything that is listed into FOLDER, one file for each.

Three sources are compared, and where they disagree nothing is written: the tables of docs/dependencies.md (what is used,
and its licence), what was built (the libraries that the programs are linked with, the headers that were compiled), and the
lock files of npm. Versions are those of the machine that builds. SOURCE_DATE_EPOCH is the date of the bill: the same release
gives the same bytes."""
import argparse
import base64
import datetime
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
NAMESPACE = "https://mansard.example/spdx/"
# What g++ links by itself: no row of docs/dependencies.md is for these, but the one of g++.
COMPILERS = {"libc6": "LGPL-2.1-or-later", "libstdc++6": "GPL-3.0-or-later WITH GCC-exception-3.1",
             "libgcc-s1": "GPL-3.0-or-later WITH GCC-exception-3.1"}
OWN_LICENCES = {"LicenseRef-OSGPL": ("libopenscenegraph-dev", "OpenSceneGraph Public License: the LGPL 2.1 with the exceptions of the wxWindows licence")}


def fail(words):
    sys.exit(f"sbom: {words}")


def said(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.stdout if done.returncode == 0 else ""


def rows(section, header):
    """The rows of the table under a heading of docs/dependencies.md, as dictionaries by column."""
    text = (ROOT / "docs/dependencies.md").read_text(encoding="utf-8")
    found = re.search(rf"^## {re.escape(section)}\n(.*?)(?=^## |\Z)", text, re.M | re.S)
    lines = [line for line in found.group(1).splitlines() if line.startswith("|")] if found else []
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    if len(cells) < 3 or cells[0][0] != header:
        fail(f"docs/dependencies.md has no table with '{header}' under '{section}'")
    return [dict(zip(cells[0], row, strict=True)) for row in cells[2:]]


class Debian:
    """What dpkg says of this machine's packages."""

    def __init__(self):
        self.known = {}

    def field(self, package, field):
        key = (package, field)
        if key not in self.known:
            self.known[key] = said("dpkg-query", "-W", f"-f=${{{field}}}\\n", package).strip().split("\n")[0]
        return self.known[key]

    def version(self, package):
        return self.field(package, "Version") or fail(f"the package {package} is not installed here")

    def files(self, package):
        lists = [pathlib.Path(f"/var/lib/dpkg/info/{package}{end}.list") for end in ("", ":" + self.field(package, "Architecture"))]
        return [line for one in lists if one.exists() for line in one.read_text(encoding="utf-8").splitlines()]

    def libraries(self, package):
        """The files that the links of a development package lead to: lib*.so."""
        return {os.path.realpath(path) for path in self.files(package) if re.search(r"/lib[^/]*\.so$", path) and os.path.islink(path)}

    def owner(self, path):
        for name in (path, re.sub(r"^/usr(?=/lib)", "", path)):
            if found := said("dpkg", "-S", name):
                return found.split(":")[0]
        return fail(f"no package has {path}")


def headers_compiled(build):
    """The headers of the system that any source includes, as the compiler has told ninja."""
    said_so = {line.strip() for line in said("ninja", "-C", str(build), "-t", "deps").splitlines() if line.startswith("    /usr/")}
    return said_so or fail(f"{build} was not built by ninja")


def needed(binary):
    dynamic = said("objdump", "-p", str(binary))
    names = re.findall(r"NEEDED\s+(\S+)", dynamic)
    return names or fail(f"{binary} is linked with nothing: not a program")


def path_of(soname):
    found = re.search(rf"^\s*{re.escape(soname)} \(libc6,x86-64[^)]*\) => (\S+)|^\s*{re.escape(soname)} .*=> (\S+)",
                      said("/sbin/ldconfig", "-p"), re.M)
    return (found.group(1) or found.group(2)) if found else fail(f"{soname} is not installed here")


def npm(lock, wanted=None):
    """The packages of a lock file that are part of what is built."""
    packages = json.loads((ROOT / lock).read_text(encoding="utf-8"))["packages"]
    out, open_ = {}, list(wanted if wanted is not None else packages[""].get("dependencies", {}))
    while open_:
        name = open_.pop()
        if name not in out:
            out[name] = packages[f"node_modules/{name}"]
            open_ += out[name].get("dependencies", {})
    return dict(sorted(out.items()))


class Bill:
    def __init__(self, version, commit):
        self.version, self.commit = version, commit
        self.packages, self.relations = {}, set()

    def add(self, name, **fields):
        key = "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name)
        self.packages[key] = {"name": name, "SPDXID": key, "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
                              "licenseConcluded": "NOASSERTION", "copyrightText": "NOASSERTION", **fields}
        return key

    def debian(self, debian, package, licence, row, soname=None):
        version = debian.version(package)
        sources = f"row {row} of docs/dependencies.md" if row else "linked by the compiler"
        key = "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", package)
        sonames = {soname} if soname else set()
        if key in self.packages:
            sonames |= set(re.findall(r"\S+\.so\S*", self.packages[key]["sourceInfo"]))
        if sonames:
            sources += ", linked as " + " ".join(sorted(sonames))
        return self.add(package, versionInfo=version, licenseDeclared=licence, sourceInfo=sources,
                        supplier="Organization: Debian", primaryPackagePurpose="LIBRARY",
                        externalRefs=[{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                                       "referenceLocator": f"pkg:deb/debian/{package.replace('+', '%2B')}@{version.replace('+', '%2B').replace(':', '%3A')}"
                                                           f"?arch={debian.field(package, 'Architecture')}&distro=bookworm"}])

    def npm(self, name, package, licence, lock):
        digest, value = package["integrity"].split("-", 1)
        return self.add(name, versionInfo=package["version"], licenseDeclared=licence, downloadLocation=package.get("resolved", "NOASSERTION"),
                        sourceInfo=lock, supplier="NOASSERTION", primaryPackagePurpose="LIBRARY",
                        checksums=[{"algorithm": digest.upper(), "checksumValue": base64.b64decode(value).hex()}],
                        externalRefs=[{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                                       "referenceLocator": f"pkg:npm/{name.replace('@', '%40')}@{package['version']}"}])

    def relate(self, one, kind, other):
        self.relations.add((one, kind, other))

    def document(self):
        when = datetime.datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), datetime.timezone.utc)
        used = {p.get("licenseDeclared", "") for p in self.packages.values()}
        own = [{"licenseId": key, "extractedText": text, "name": text.split(":")[0]}
               for key, (_, text) in OWN_LICENCES.items() if any(key in licence for licence in used)]
        return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
                "name": f"mansard-{self.version}",
                "documentNamespace": f"{NAMESPACE}mansard-{self.version}-{self.commit}",
                "creationInfo": {"created": when.strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Organization: the mansard contributors", "Tool: tools/sbom.py"]},
                "documentDescribes": ["SPDXRef-mansard"],
                **({"hasExtractedLicensingInfos": own} if own else {}),
                "packages": [self.packages[key] for key in sorted(self.packages)],
                "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b}
                                  for a, kind, b in sorted({("SPDXRef-DOCUMENT", "DESCRIBES", "SPDXRef-mansard"), *self.relations})]}


def bill_of(version, commit, build, released):
    binaries = [build / "bin/mansard", build / "bin/mansard-reader", *sorted(build.glob("python/mansard/_core*.so"))]
    compiled = headers_compiled(build)
    debian, bill = Debian(), Bill(version, commit)
    whole = bill.add("mansard", versionInfo=version, licenseDeclared="Apache-2.0", licenseConcluded="Apache-2.0",
                     copyrightText="Copyright 2026 the mansard contributors", supplier="Organization: the mansard contributors",
                     sourceInfo=f"commit {commit}", primaryPackagePurpose="APPLICATION")
    for path in released:
        file = bill.add(path.name, versionInfo=version, licenseDeclared="Apache-2.0", packageFileName=path.name,
                        supplier="Organization: the mansard contributors", primaryPackagePurpose="ARCHIVE",
                        checksums=[{"algorithm": "SHA256", "checksumValue": hashlib.sha256(path.read_bytes()).hexdigest()}])
        bill.relate(whole, "CONTAINS", file)

    linked = {}  # soname: the binaries
    for binary in binaries:
        part = bill.add(binary.name, versionInfo=version, licenseDeclared="Apache-2.0", primaryPackagePurpose="APPLICATION",
                        supplier="Organization: the mansard contributors")
        bill.relate(whole, "CONTAINS", part)
        for soname in needed(binary):
            linked.setdefault(soname, []).append(part)

    file_of = {soname: os.path.realpath(path_of(soname)) for soname in linked}

    # Every library of the tables is linked, or compiled in from its headers; nothing else is linked.
    left = dict(linked)
    for row in rows("Libraries", "package"):
        brought, licence = re.findall(r"`([^`]+)`", row["package"]), row["licence"]
        name = brought[0]
        libraries = {path for one in brought for path in debian.libraries(one)}
        found = sorted(soname for soname in linked if file_of[soname] in libraries)
        for soname in found:
            left.pop(soname, None)
            library = bill.debian(debian, debian.owner(file_of[soname]), licence, name, soname)
            for part in linked[soname]:
                bill.relate(part, "DYNAMIC_LINK", library)
        if not found:
            if not {path for one in brought for path in debian.files(one)} & compiled:
                fail(f"docs/dependencies.md lists {name}, and it is neither linked nor are its headers compiled")
            bill.relate(whole, "STATIC_LINK", bill.debian(debian, name, licence, name))
    for soname in sorted(left):
        package = debian.owner(file_of[soname])
        if package not in COMPILERS:
            fail(f"{soname} of {package} is linked, and docs/dependencies.md has no row for it")
        library = bill.debian(debian, package, COMPILERS[package], None, soname)
        for part in linked[soname]:
            bill.relate(part, "DYNAMIC_LINK", library)

    for row in rows("The Python package", "package"):
        name = row["package"].strip("`")
        library = bill.debian(debian, name, row["licence"], name)
        if name == "pybind11-dev":
            bill.relate(whole, "STATIC_LINK", library)
        else:
            bill.relate(library, "RUNTIME_DEPENDENCY_OF" if name != "python3-dev" else "BUILD_DEPENDENCY_OF", whole)

    # The page, and the decoder of LAZ: packages of npm.
    listed = {}
    for row in rows("The page of the workbench", "package"):
        if row["in the program"] == "yes":
            for name in row["package"].split(", "):
                listed[name.split(" ")[0]] = (name.split(" ")[1], row["licence"])
    inside = npm("apps/workbench/package-lock.json", json.loads((ROOT / "apps/workbench/package.json").read_text())["dependencies"])
    if {name: package["version"] for name, package in inside.items()} != {name: version for name, (version, _) in listed.items()}:
        fail("the page has " + ", ".join(n + " " + p["version"] for n, p in inside.items()) +
             ", and docs/dependencies.md lists " + ", ".join(n + " " + v for n, (v, _) in sorted(listed.items())))
    for name, package in inside.items():
        bill.relate(whole, "CONTAINS", bill.npm(name, package, listed[name][1], "apps/workbench/package-lock.json"))
    for name, package in npm("cmake/laz/package-lock.json").items():
        bill.relate(whole, "CONTAINS", bill.npm(name, package, "Apache-2.0 AND BSD-3-Clause", "cmake/laz/package-lock.json"))
    return bill


def licence_texts(bill, folder, build):
    npm_folders = [build / "apps/server/page/workbench", build / "laz"]
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("LICENSE", "NOTICE"):
        (folder / f"mansard-{name}").write_bytes((ROOT / name).read_bytes())
    for package in bill.packages.values():
        name, purl = package["name"], package.get("externalRefs", [{}])[0].get("referenceLocator", "")
        if purl.startswith("pkg:deb/"):
            source = pathlib.Path("/usr/share/doc") / name / "copyright"
        elif purl.startswith("pkg:npm/"):
            places = [place / "node_modules" / name for place in npm_folders]
            source = next((f for place in places for f in sorted(place.glob("LICEN[SC]E*")) + sorted(place.glob("COPYING*"))), None)
            ours = ROOT / "packaging/copyright"
            if source is None and any(place.exists() for place in places) and name in ours.read_text(encoding="utf-8"):
                source = ours  # laz-perf has no text in its package: the notice of ours, and what it refers to
        else:
            continue
        if source is None or not source.exists():
            fail(f"no licence text of {name}")
        (folder / name.replace("/", "-").lstrip("@")).write_bytes(source.read_bytes())
    # What the texts of Debian refer to.
    for text in sorted(pathlib.Path("/usr/share/common-licenses").iterdir()):
        if text.is_file() and any(f"/usr/share/common-licenses/{text.name}".encode() in f.read_bytes() for f in folder.iterdir()):
            (folder / f"common-{text.name}").write_bytes(text.read_bytes())


def main():
    words = sys.argv[1:]
    released = words[words.index("--") + 1:] if "--" in words else []
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--commit", required=True)
    parser.add_argument("--licences", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    asked = parser.parse_args(words[:words.index("--")] if "--" in words else words)
    if "SOURCE_DATE_EPOCH" not in os.environ:
        fail("SOURCE_DATE_EPOCH is the date of the bill, and not set")
    version = re.search(r"project\(mansard VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)
    bill = bill_of(version, asked.commit, asked.build, [pathlib.Path(path) for path in released])
    asked.out.write_text(json.dumps(bill.document(), indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    if asked.licences:
        licence_texts(bill, asked.licences, asked.build)
    print(f"{asked.out}: {len(bill.packages)} packages, {len(bill.relations)} relations")


if __name__ == "__main__":
    main()
