"""Builds the wheel of the Python package with CMake: the backend of pyproject.toml (PEP 517), without dependencies.

    pip install .                                                  builds in build/wheel
    pip install . --config-settings=build-dir=build/release        takes what is built there already

The wheel holds the extension module, the package around it, and mansard-reader, which reads OSGB, FBX, COLLADA and STL
(docs/decisions/0052) and is looked for beside the module. The libraries that it links (GDAL, GEOS, CBC, Embree, …)
are those of the machine and are not bundled: docs/python.md says why.
"""

import base64
import hashlib
import os
import pathlib
import re
import stat
import subprocess
import sys
import sysconfig
import tarfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def _version():
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(mansard VERSION ([0-9.]+)", text).group(1)


def _metadata():
    readme = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    return (
        "Metadata-Version: 2.1\nName: mansard\n"
        f"Version: {_version()}\n"
        "Summary: Clean, watertight, labelled and editable building models of a city scan\n"
        "License: Apache-2.0\nRequires-Python: >=3.9\nRequires-Dist: numpy\n"
        "Description-Content-Type: text/markdown\n\n" + readme
    )


def _jobs():
    """As many as there are cores, and no more than 1.5 GB of memory each: a compiler may want that much."""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_AVPHYS_PAGES")
    return max(1, min(os.cpu_count() or 1, memory // 1_500_000_000))


def _built(config_settings):
    """The folder of the package and the program mansard-reader, built."""
    folder = ROOT / (config_settings or {}).get("build-dir", "build/wheel")
    if not (folder / "CMakeCache.txt").exists() or folder == ROOT / "build/wheel":
        subprocess.run(
            ["cmake", "-S", str(ROOT), "-B", str(folder), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
             "-DMANSARD_TESTS=OFF", "-DMANSARD_PYTHON=ON", "-DMANSARD_PAGE=OFF", "-DMANSARD_QUICK_BUILD=ON",
             "-DMANSARD_UNITY=ON", f"-DPython3_EXECUTABLE={sys.executable}"],
            check=True, stdout=sys.stderr)
    subprocess.run(["cmake", "--build", str(folder), "--target", "mansard_python", "mansard_reader", "-j", str(_jobs())],
                   check=True, stdout=sys.stderr)
    return folder / "python" / "mansard", folder / "bin" / "mansard-reader"


def _tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    return f"{python}-{python}-{platform}"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    package, reader = _built(config_settings)
    version, tag = _version(), _tag()
    info = f"mansard-{version}.dist-info"
    files = {}
    for path in sorted(package.iterdir()):
        if path.is_file():
            files[f"mansard/{path.name}"] = path.read_bytes()
    files[f"mansard/{reader.name}"] = reader.read_bytes()
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: mansard {version}\nRoot-Is-Purelib: false\nTag: {tag}\n").encode()
    for name in ("LICENSE", "NOTICE", "packaging/copyright"):  # the last of what is compiled in
        files[f"{info}/licenses/{os.path.basename(name)}"] = (ROOT / name).read_bytes()
    record = ""
    for name, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(data)}\n"
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    name = f"mansard-{version}-{tag}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, name), "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, data in files.items():
            entry = zipfile.ZipInfo(path)  # dated 1980: the same files give the same wheel
            executable = path.endswith((".so", "/mansard-reader"))
            # pip makes executable what is a regular file with this permission.
            entry.external_attr = (stat.S_IFREG | (0o755 if executable else 0o644)) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, data)
    return name


def build_sdist(sdist_directory, config_settings=None):
    name = f"mansard-{_version()}"
    listed = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z"], check=True, capture_output=True).stdout
    with tarfile.open(os.path.join(sdist_directory, name + ".tar.gz"), "w:gz") as archive:
        for path in listed.decode().split("\0"):
            if path and (ROOT / path).is_file():
                archive.add(ROOT / path, f"{name}/{path}")
    return name + ".tar.gz"
