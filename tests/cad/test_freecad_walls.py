"""The rights that the FreeCAD process gives up before it opens a file, tested without FreeCAD."""

import json
import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest

from cad.freecad import drawing_process

pytestmark = pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() not in drawing_process.DENIED,
    reason="the filter of calls is written for Linux on x86_64 and aarch64",
)
TRIED = """
import ctypes, json, os, resource, signal, socket, subprocess, sys, threading
sys.path.insert(0, sys.argv[1])
import drawing_process
libc = ctypes.CDLL(None, use_errno=True)
assert libc.prctl(38, 1, 0, 0, 0) == 0
drawing_process.keep_to_files(libc, sys.argv[2])
drawing_process.deny_calls(libc)
def tried(call):
    try:
        call()
    except BaseException as error:
        return type(error).__name__
    return "done"
def called(numbers, *arguments):
    def call():
        if libc.syscall(numbers[os.uname().machine], *arguments) < 0:
            raise OSError(ctypes.get_errno(), "")
    return call
secret = (sys.argv[3] + "/secret").encode()
parent = os.getppid()
results = {
    "signal to a thread": tried(called({"x86_64": 234, "aarch64": 131}, parent, parent, 0)),
    "limit of another": tried(lambda: resource.prlimit(parent, resource.RLIMIT_NOFILE)),
    "priority of another": tried(lambda: os.setpriority(os.PRIO_PROCESS, parent, 19)),
    "fork": tried(lambda: os.fork() or os._exit(0)),
    "session": tried(os.setsid),
    "shorten": tried(lambda: os.truncate(secret, 0)),
    "mode": tried(lambda: os.chmod(secret, 0)),
    "owner": tried(lambda: os.chown(secret, os.getuid(), os.getgid())),
    "own signal": tried(lambda: signal.raise_signal(signal.SIGCHLD)),
    "own limit": tried(lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0))),
    "own state": tried(lambda: open("/proc/self/statm").read()),
    "settings": tried(lambda: open("/etc/hosts").close()),
    "another process": tried(lambda: open(f"/proc/{parent}/environ").close()),
    "socket": tried(lambda: socket.socket()),
    "unix": tried(lambda: socket.socket(socket.AF_UNIX)),
    "exec": tried(lambda: os.execv("/bin/true", ["true"])),
    "child": tried(lambda: subprocess.run(["/bin/true"], check=True)),
    "kill": tried(lambda: os.kill(os.getppid(), 0)),
    "own folder": tried(lambda: open(sys.argv[2] + "/inside", "w").close()),
    "other folder": tried(lambda: open(sys.argv[3] + "/outside", "w").close()),
    "other file": tried(lambda: open(sys.argv[3] + "/secret").close()),
    "library": tried(lambda: open("/usr/lib/os-release").close()),
    "thread": tried(lambda: threading.Thread(target=int).start()),
}
ruled = libc.syscall(444, None, 0, 1) >= 1
print(json.dumps([results, ruled]))
"""


@pytest.fixture(scope="module")
def tried(tmp_path_factory):
    own, other = tmp_path_factory.mktemp("own"), tmp_path_factory.mktemp("other")
    (other / "secret").write_text("secret")
    folder = Path(drawing_process.__file__).parent
    command = [sys.executable, "-c", TRIED, str(folder), str(own), str(other)]
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=60, env={"PATH": os.environ["PATH"]}
    )
    assert done.returncode == 0, done.stderr
    assert (other / "secret").read_text() == "secret"
    return json.loads(done.stdout)


@pytest.mark.parametrize("what", ["socket", "unix", "exec", "child", "kill", "fork", "session"])
def test_network_programs_and_signals_are_refused(tried, what):
    assert tried[0][what] == "PermissionError"


@pytest.mark.parametrize("what", ["signal to a thread", "limit of another", "priority of another"])
def test_other_processes_are_left_alone(tried, what):
    assert tried[0][what] == "PermissionError"


@pytest.mark.parametrize("what", ["shorten", "mode", "owner"])
def test_files_of_others_stay_as_they_are(tried, what):
    assert tried[0][what] == "PermissionError"


@pytest.mark.parametrize("what", ["own folder", "library", "thread", "own signal", "own limit", "own state"])
def test_what_drawing_needs_is_allowed(tried, what):
    assert tried[0][what] == "done"


@pytest.mark.parametrize("what", ["other folder", "other file", "settings", "another process"])
def test_files_of_others_are_out_of_reach(tried, what):
    results, ruled = tried
    if not ruled:
        pytest.skip("this kernel has no Landlock")
    assert results[what] == "PermissionError"
