#!/usr/bin/env python3
"""Memory of `mansard serve` and the times of edits, on a project of any size: docs/workbench.md, "Measured".

    serve_memory.py MANSARD PROJECT FOOTPRINTS MESH…

PROJECT is a new folder. The inputs are read, a run is made, 20 buildings are edited (one after the other, each first
dragged five times), and the project is opened again. Memory is the resident size of the process (VmRSS and its maximum
VmHWM); times are those of requests as a client sees them. Seconds of the processor are of the whole process.
"""
import json
import pathlib
import re
import statistics
import subprocess
import sys
import time
import urllib.error
import urllib.request


class Server:
    def __init__(self, mansard, project):
        self.began = time.time()
        self.process = subprocess.Popen([mansard, "serve", project, "--port", "0"], stdout=subprocess.PIPE, text=True)
        link = self.process.stdout.readline().strip()
        self.address, self.token = re.match(r"(http://[^/]+)/.*token=(\S+)", link).groups()

    def call(self, method, path, body=None):
        request = urllib.request.Request(self.address + path, method=method,
                                         data=None if body is None else json.dumps(body).encode(),
                                         headers={"Authorization": "Bearer " + self.token,
                                                  "Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=1200) as reply:
            return json.load(reply)

    def settle(self):
        while self.call("GET", "/api/status")["busy"]:
            time.sleep(0.2)

    def tell(self, what):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        now, most = (int(re.search(name + r":\s+(\d+)", status)[1]) / 1024 for name in ("VmRSS", "VmHWM"))
        clock = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        print(f"{what}: {now:.0f} MB now, at most {most:.0f} MB until then; {(int(clock[11]) + int(clock[12])) / 100:.1f} s"
              f" of the processor, {time.time() - self.began:.1f} s since the start", flush=True)

    def stop(self):
        self.process.terminate()
        self.process.wait()


def edit(server, run, building, times):
    """Raises the level at which roofs are cut off by 0.3 m: five previews and the edit."""
    parts = [{"id": part["id"], "plan": part["plan"]} for part in building["parts"]]
    for step in range(5):
        for part in parts:
            part["plan"]["cap"] += 0.06
        changes = [{"building": building["id"], "revision": building["revision"], "parts": parts}]
        began = time.time()
        server.call("POST", f"/api/runs/{run}/preview", {"changes": changes})
        times["first preview of a building" if step == 0 else "further previews"].append(time.time() - began)
    began = time.time()
    try:
        server.call("POST", f"/api/runs/{run}/edits", {"what": "higher", "changes": changes})
        times["edits"].append(time.time() - began)
    except urllib.error.HTTPError as refused:
        print("refused:", refused.read()[:200])


def main(mansard, project, footprints, *meshes):
    server = Server(mansard, project)
    server.tell("empty")
    server.call("POST", "/api/project/inputs", {"meshes": list(meshes), "footprints": footprints})
    server.settle()
    server.tell("inputs read")
    run = server.call("POST", "/api/runs", {"label": "bench"})["run"]
    server.settle()
    server.tell("after a run")
    buildings = server.call("GET", f"/api/runs/{run}/buildings")["buildings"]
    server.settle()
    server.tell(f"{len(buildings)} buildings listed")
    server.stop()
    server = Server(mansard, project)
    buildings = server.call("GET", f"/api/runs/{run}/buildings")["buildings"]
    server.tell("opened again, listed")
    server.settle()
    server.tell("opened again, inputs read")
    times = {"first preview of a building": [], "further previews": [], "edits": []}
    usable = [b for b in buildings if b["parts"]]
    for i in range(20):
        edit(server, run, usable[i * len(usable) // 20], times)
    server.tell("after 20 edits")
    for what, all_times in times.items():
        if all_times:
            print(f"{what}: median {1000 * statistics.median(all_times):.0f} ms, most {1000 * max(all_times):.0f} ms")
    server.stop()


if __name__ == "__main__":
    main(*sys.argv[1:])
