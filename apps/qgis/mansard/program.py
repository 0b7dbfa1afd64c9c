"""Finds and runs the program, with progress, log and cancel."""

import os
import re
import selectors
import shutil
import signal
import subprocess

from qgis.core import QgsProcessingException

SETTING = "MANSARD_PROGRAM"
PROGRESS = re.compile(r"^mansard: (\S+) (.*)\((\d+) %\)$")
# Exit codes: docs/cli.md. 1: finished, but some buildings are simpler than their plans.
FINISHED = (0, 1)


def program():
    """The path of mansard: the environment, then the setting, then PATH."""
    candidates = [os.environ.get(SETTING)]
    try:
        from processing.core.ProcessingConfig import ProcessingConfig

        candidates.append(ProcessingConfig.getSetting(SETTING))
    except ImportError:
        pass
    for candidate in candidates:
        if candidate:
            if os.access(candidate, os.X_OK) and os.path.isfile(candidate):
                return candidate
            raise QgsProcessingException(
                f"The program '{candidate}' cannot be run. Correct it in Settings > Options > Processing > Providers > "
                "mansard.")
    found = shutil.which("mansard")
    if not found:
        raise QgsProcessingException(
            "The program mansard was not found. Install it, or name it in Settings > Options > Processing > Providers > "
            "mansard.")
    return found


def _tell(line, lines, is_error_stream, feedback):
    progress = PROGRESS.match(line)
    if progress:
        feedback.setProgressText(f"{progress.group(1)} {progress.group(2)}")
        feedback.setProgress(int(progress.group(3)))
        return
    lines.append(line)
    if not is_error_stream:
        feedback.pushConsoleInfo(line)
    elif "error[" not in line:  # errors are the exception at the end
        feedback.pushInfo(line)


def run(arguments, feedback):
    """Runs mansard; what it prints goes to the log. Cancelled: it gets SIGINT and leaves no results."""
    command = [program(), *[str(argument) for argument in arguments]]
    feedback.pushCommandInfo(" ".join(command))
    # QGIS sets variables for its own libraries, which may be others than those of the program.
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONHOME", "PYTHONPATH")}
    printed, errors = [], []
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, bufsize=0,
                          env=environment) as process, selectors.DefaultSelector() as streams:
        streams.register(process.stdout, selectors.EVENT_READ, (printed, False))
        streams.register(process.stderr, selectors.EVENT_READ, (errors, True))
        rest = {process.stdout: b"", process.stderr: b""}  # of a line that has not ended
        stopping = False
        while streams.get_map():
            if feedback.isCanceled() and not stopping:
                stopping = True
                process.send_signal(signal.SIGINT)
            for key, _ in streams.select(timeout=0.2):
                data = os.read(key.fd, 65536)
                *lines, rest[key.fileobj] = (rest[key.fileobj] + data).split(b"\n")
                if not data:
                    streams.unregister(key.fileobj)
                    lines = [rest[key.fileobj]] if rest[key.fileobj] else []
                for line in lines:
                    _tell(line.decode(errors="replace"), *key.data, feedback)
        code = process.wait()
    if feedback.isCanceled():
        return code, printed
    if code not in FINISHED:
        raise QgsProcessingException("\n".join(line for line in errors if "error[" in line) or
                                     f"mansard ended with exit code {code}")
    return code, printed
