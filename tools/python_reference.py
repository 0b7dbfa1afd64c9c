#!/usr/bin/env python3
"""Writes the reference of docs/python.md from the docstrings of the package, and its type stubs.

    PYTHONPATH=build/release/python tools/python_reference.py docs/python.md          rewrites the page
    PYTHONPATH=build/release/python tools/python_reference.py --check docs/python.md  fails where it would change
"""

import inspect
import re
import sys

import mansard

BEGIN, END = "<!-- reference: begin, by tools/python_reference.py -->\n", "<!-- reference: end -->\n"


def signature(name, function):
    try:
        return f"{name}{inspect.signature(function)}"
    except ValueError:  # pybind11 puts it into the first line of the docstring
        first = function.__doc__.splitlines()[0]
        found = re.match(r"\w+\(self: [\w.]+(?:, )?(.*?)\)", first)
        return f"{name}({found.group(1)})" if found else f"{name}()"


def text(value):
    """The docstring in Markdown: sections as lists; pybind11's signature left out."""
    lines = inspect.getdoc(value).splitlines()
    if lines and re.match(r"\w+\(.*\)( -> .*)?$", lines[0]):
        lines = [line for line in lines[1:] if line.strip()]
    out, indent = [], False
    for line in lines:
        if re.match(r"(Args|Returns|Attributes):$", line):
            out.append({"Args": "Arguments:", "Returns": "Returns:", "Attributes": "Attributes:"}[line[:-1]])
            out.append("")
            indent = True
        elif indent and re.match(r"    \S", line):
            entry = line.strip()
            named = re.match(r"([\w*]+(?:, [\w*]+)*): (.*)", entry)
            out.append(f"- `{named.group(1)}`: {named.group(2)}" if named else f"- {entry}")
        elif indent and line.startswith("        "):
            out.append("  " + line.strip())
        else:
            out.append(line)
    page = "\n".join(out)
    page = re.sub(r":(?:func|class|data|attr):`([^`]+)`", r"`\1`", page)
    return page.replace("``", "`").strip()


def reference():
    out = ["## Functions\n"]
    functions = [name for name in mansard.__all__ if inspect.isfunction(getattr(mansard, name))]
    for name in functions:
        function = getattr(mansard, name)
        out.append(f"### `{signature(name, function)}`\n\n{text(function)}\n")
    out.append("## Classes\n")
    for name in mansard.__all__:
        found = getattr(mansard, name)
        if not inspect.isclass(found):
            continue
        out.append(f"### `{name}`\n\n{text(found)}\n")
        rows = []
        for member, value in sorted(vars(found).items()):
            if member.startswith("_") and member != "__geo_interface__":
                continue
            if isinstance(value, property):
                rows.append(f"| `{member}` | {text(value)} |")
            elif callable(value) and getattr(value, "__doc__", None):
                brief = text(value).splitlines()[0]
                rows.append(f"| `{signature(member, value).replace('|', chr(92) + '|').replace('(self, ', '(').replace('(self)', '()')}` | {brief} |")
        if rows:
            out.append("| member | |\n|---|---|\n" + "\n".join(rows) + "\n")
    return "\n".join(out)


def main():
    check = sys.argv[1] == "--check"
    path = sys.argv[-1]
    with open(path, encoding="utf-8") as file:
        page = file.read()
    before, rest = page.split(BEGIN)
    _, after = rest.split(END)
    wanted = before + BEGIN + "\n" + reference() + "\n" + END + after
    if check:
        if wanted != page:
            sys.exit(f"{path} is not what the docstrings say; run tools/python_reference.py {path}")
        return
    with open(path, "w", encoding="utf-8") as file:
        file.write(wanted)


main()
